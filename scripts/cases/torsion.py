"""Torsion of a rectangular interface."""

import math
from functools import partial

import limitblocks as lb
from cases.case import Case
from limitblocks.structures.cases import ORDUNA_LOURENCO as FIG_12

L1, L2, MU, N = 0.15, 0.10, 0.7, -240.0  # m, m, -, N


def torsion(kind, M1=0.0, M2=0.0):
    joint = kind(MU)
    rectangle = lb.joints.interface([(L1, -L2), (L1, L2), (-L1, L2), (-L1, -L2)], joint)
    return joint.strength(rectangle, direction=(0, 0, 0, 0, 0, 1), given=(0, 0, N, M1, M2, 0))


def torsions():
    group, paper = "Torsion of a rectangular interface", "Orduña & Lourenço (2005)"
    rectangle = "0.30 m x 0.20 m, friction 0.7, 240 N"
    rows = [
        ("OrdunaLourenco", "T0, N m", "Fig. 12", FIG_12.value, FIG_12.tolerance, lb.OrdunaLourenco, 0.0, 0.0),
        ("OrdunaLourenco", "T0, N m", "Eqs (16)-(17)", 16.264, 5e-4, lb.OrdunaLourenco, 0.0, 0.0),
        ("ExactTorsion", "T0, N m", "Eqs (16)-(17)", 16.264, 5e-4, lb.joints.ExactTorsion, 0.0, 0.0),
        ("OrdunaLourenco", "T at A, N m", "Table 4", -MU * N * L1 / 2, 1e-6, lb.OrdunaLourenco, -L2 * N, 0.0),
        ("OrdunaLourenco", "T at B, N m", "Table 4", 0.0, 1e-6, lb.OrdunaLourenco, -L2 * N, -L1 * N),
        ("OrdunaLourenco", "T at C, N m", "Table 4", -MU * N * L2 / 2, 1e-6, lb.OrdunaLourenco, 0.0, -L1 * N),
    ]
    for name, quantity, where, value, tolerance, kind, M1, M2 in rows:
        yield Case(group, f"{rectangle}, {name}", quantity, f"{paper}, {where}", value, tolerance,
                   partial(torsion, kind, M1, M2), quick=True)  # fmt: skip
    yield Case(group, f"{rectangle}, PointContact", "T, N m", "closed form: mu |N| d/2, d the diagonal",
               -MU * N * math.hypot(L1, L2), 1e-5, partial(torsion, lb.PointContact), quick=True)  # fmt: skip
