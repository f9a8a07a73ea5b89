"""A lintel with joints of four kinds: what proofs are tried on."""

import limitblocks as lb

JOINTS = {
    "points": lb.PointContact(0.6),
    "torsion": lb.OrdunaLourenco(0.6),
    "octagon": lb.OrdunaLourenco(0.6, slip="paper"),
    "crushing": lb.OrdunaLourenco(0.6, compressive_strength=3e6),
}


def lintel(kind):
    return lb.structures.eccentric_lintel(JOINTS[kind], eccentricity=0.1, direction=(1, 0, 0))
