"""Interfaces and states that the paper's surface is tried on."""

import numpy as np

import limitblocks as lb
from limitblocks.joints.torsion import rectangle_torsion_constant

L1, L2, MU, N = 0.15, 0.10, 0.7, -240.0  # Figs 8(b) and 12
SQUARE = np.array([(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])
RECTANGLE = SQUARE * [L1, L2]
AREA = 4 * L1 * L2
C_T = float(rectangle_torsion_constant(L1, L2))
COMPRESSION = (0, 0, N, 0, 0, 0)
PAPER = lb.OrdunaLourenco(MU, slip="paper")
SLIPS = {
    "paper": PAPER,
    "inner": lb.OrdunaLourenco(MU, slip="inner", sides=12),
    "outer": lb.OrdunaLourenco(MU, slip="outer", sides=12),
    "exact": lb.OrdunaLourenco(MU, slip="exact"),
    "crush": lb.OrdunaLourenco(MU, compressive_strength=2e4, slip="paper"),
    "cones": lb.OrdunaLourenco(MU, slip="exact", compressive_strength=2e4),
    "bonded": lb.OrdunaLourenco(MU, 2e4, slip="exact", cohesion=3e3, tensile_strength=1e3),
}


def states(count, seed=0):
    """Stress resultants of all sizes around the yield surface, under compression."""
    rng = np.random.default_rng(seed)
    units = np.array([MU, MU, 0.0, L2, L1, MU * C_T])
    return rng.uniform(200, 600, (count, 1)) * (
        rng.normal(size=(count, 6)) * units * 0.5 - [0, 0, 1, 0, 0, 0]
    )


def finite_differences(functions, Q):
    """Central differences (k, 6) of functions with k values."""
    steps = np.array([1e-4, 1e-4, 1e-4, 1e-5, 1e-5, 1e-5])
    central = [functions(Q + h) - functions(Q - h) for h in np.diag(steps)]
    return (np.array(central) / (2 * steps[:, None])).T


def yield_functions(Q, shear=None):
    """Eqs (23)-(30) and (36) of a rectangle, as printed; the largest of each mode."""
    V1, V2, n, M1, M2, T = np.asarray(Q).T
    octagon = np.max([abs(V1), abs(V2), (abs(V1) + abs(V2)) / np.sqrt(2)], axis=0)
    V = octagon if shear is None else shear(V1, V2)
    return {
        "twist": abs(T) / C_T + MU * n,
        "slip": V + MU * n,
        "slip-twist": abs(T) / C_T + V + 1.3 * MU * n,
        "moment-twist": abs(T) / (L1 + L2) + MU / 2 * ((abs(M1) + abs(M2)) / (L1 + L2) + n),
        "hinge": np.max([abs(M1) / L2 + n, abs(M2) / L1 + n], axis=0),
    }
