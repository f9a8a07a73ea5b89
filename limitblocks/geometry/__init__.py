"""Blocks, interfaces and the contacts between blocks; no mechanics."""

from limitblocks.geometry.block import Block
from limitblocks.geometry.contact import find_interfaces
from limitblocks.geometry.interface import Interface

__all__ = ["Block", "Interface", "find_interfaces"]
