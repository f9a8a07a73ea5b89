"""Blocks, interfaces and the contacts between blocks; no mechanics."""

from limitblocks.geometry.accuracy import Tolerances
from limitblocks.geometry.block import Block
from limitblocks.geometry.contact import find_contacts, find_interfaces
from limitblocks.geometry.contacts import Contacts
from limitblocks.geometry.findings import NearMiss, Overlap, Sliver, Through
from limitblocks.geometry.heal import Healed, heal
from limitblocks.geometry.interface import Interface
from limitblocks.geometry.selection import Selection, select

__all__ = [
    "Block",
    "Contacts",
    "Healed",
    "Interface",
    "NearMiss",
    "Overlap",
    "Selection",
    "Sliver",
    "Through",
    "Tolerances",
    "find_contacts",
    "find_interfaces",
    "heal",
    "select",
]
