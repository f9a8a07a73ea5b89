"""Falsified claims with the residuals that refuse them, most of them true claims changed in one respect."""

import attacks_on_mechanisms
import attacks_on_multipliers
import attacks_on_stresses
import attacks_on_structures
from attacking import ATTACKS

__all__ = [
    "ATTACKS",
    "attacks_on_mechanisms",
    "attacks_on_multipliers",
    "attacks_on_stresses",
    "attacks_on_structures",
]
