"""The facade of one block that several tests compare with closed forms."""

from stones import model_of

import limitblocks as lb
from limitblocks.loads import added_mass
from limitblocks.practice import Spectrum

T, H, WEIGHT, FLOOR, ARM, FC, G = 0.5, 5.0, 18e3, 10e3, 0.35, 1.35, 9.81
SITE = Spectrum(a_g=0.25 * G, S=1.2, F0=2.5, T_C=0.5)
OWN = WEIGHT * T * H


def wall_stones():
    """One metre of a wall, a single block, and the ground that it stands on."""
    return [
        lb.Block.box("ground", (3, 1, 0.4), (0, 0, -0.2)),
        lb.Block.box("wall", (T, 1, H), (0, 0, H / 2), WEIGHT),
    ]


def facade(joint=None):
    """One metre of a facade with a floor at its top, `ARM` from its outer edge; pushed outwards along X."""
    stones = wall_stones()
    floor = added_mass("wall", (T / 2 - ARM, 0, H), weight=FLOOR)
    found = lb.find_interfaces(stones, joint or lb.PointContact(0.6))
    push = lb.mass_proportional((1, 0, 0), [floor])
    return lb.Model(stones, ["ground"], found, lb.self_weight([floor]), push)


def beam(joint=None):
    """A beam on two supports, beyond one of which it projects: 4 m long, 10 kN a metre."""
    stones = [
        lb.Block.box("left", (0.5, 1, 1), (0.25, 0, -0.5)),
        lb.Block.box("right", (0.5, 1, 1), (2.75, 0, -0.5)),
        lb.Block.box("beam", (4.0, 1, 0.5), (2.0, 0, 0.25), 20e3),
    ]
    return model_of(stones, ["left", "right"], joint or lb.PointContact(0.6))
