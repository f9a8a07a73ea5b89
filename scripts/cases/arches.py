"""Arches and a dome: least thickness, thrust, hinges, and Oppenheim's arch."""

from dataclasses import replace
from functools import cache, partial

import numpy as np

import limitblocks as lb
from cases.case import JOINTS, Case, associated, of_print
from limitblocks import structures
from limitblocks.structures.cases import COCCHETTI_RIZZI, HEYMAN, MILANKOVITCH, OPPENHEIM, Comparison


def semicircle(kind, friction, voussoirs, ratio):
    return structures.arch(kind(friction), radius=1.0, thickness=ratio, voussoirs=voussoirs)


def lumped(model):
    """Same angles, but each weight proportional to its angle and acting on the centreline."""
    n = len(model.free_blocks)
    angles = (np.arange(n) + 0.5) * np.pi / n - np.pi / 2
    weight = np.mean([part.weight for part in model.free_blocks])
    points = np.column_stack([np.sin(angles), np.zeros(n), np.cos(angles)])
    at = zip(model.free_blocks, points, strict=True)
    return replace(
        model, dead=sum((lb.loads.force(b.name, (0, 0, -weight), at=p) for b, p in at), lb.loads.Load())
    )


def least_ratio(build, low, high):
    return lb.studies.minimum(build, low, high, parameter="t/R", tolerance=1e-7).value


def least_lumped(friction, expected):
    build = partial(semicircle, lb.PointContact, friction, 201)
    return least_ratio(lambda ratio: lumped(build(ratio)), 0.97 * expected, 1.03 * expected)


def stands(friction, ratio):
    try:
        lb.bounds(lumped(semicircle(lb.PointContact, friction, 201, ratio)))
    except lb.errors.NoEquilibrium:
        return 0.0
    return 1.0


@cache
def thinnest():
    """The lumped arch at its least thickness, a small force on the keystone that just lets it stand."""
    model = lumped(semicircle(lb.PointContact, 0.7, 201, 0.10743))
    keystone = model.free_blocks[100]
    weight = sum(part.weight for part in model.free_blocks)
    push = lb.loads.force(keystone.name, (0, 0, -0.02 * weight), at=keystone.centroid)
    return model, weight / np.pi, lb.bounds(replace(model, dead=model.dead + (-1.0) * push, live=push))


def thrust():
    model, weight_per_angle, pair = thinnest()
    pairs = zip(model.interfaces, pair.stress_resultants, strict=True)
    return float(np.mean([abs(i.axes.T @ Q[:3])[0] for i, Q in pairs]) / weight_per_angle)


def haunch():
    """Mean angle from the crown of the joints that open at the haunches, degrees."""
    model, _, pair = thinnest()
    spin = {b.name: u[4] for b, u in zip(model.blocks, pair.displacement_rates, strict=True)}
    opening = np.array([abs(spin[i.block_j] - spin[i.block_i]) for i in model.interfaces])
    angle = np.degrees([np.arctan2(abs(i.centroid[0]), i.centroid[2]) for i in model.interfaces])
    near = (angle > 20) & (angle < 80)
    return float(np.average(angle[near], weights=opening[near]))


def oppenheim(joint):
    return structures.arch(joint, radius=10.0, thickness=1.5, voussoirs=7, embrace=np.radians(157.5))


def lunes(ratio):
    return structures.dome_lunes(lb.PointContact(0.8), radius=1.0, thickness=ratio, voussoirs=101)


def arches():
    group, continuous = "Arches and domes", COCCHETTI_RIZZI["t/R"]
    centreline = "semicircle, weights on the centreline, 201 voussoirs"
    for friction, known in continuous.items():
        yield of_print(group, f"{centreline}, friction {friction}", "least t/R", known,
                       partial(least_lumped, friction, known.value))  # fmt: skip
    source, value = continuous[0.7].source, continuous[0.7].value
    yield Case(group, f"{centreline}, friction 0.397", "least t/R", f"{source}: as above 0.395832",
               value, 2e-5, partial(least_lumped, 0.397, value), comparison=Comparison.IDEALISED)  # fmt: skip
    for ratio in (0.3, 0.5):
        yield Case(group, f"{centreline}, friction 0.3085, t/R {ratio}", "stands (1) or falls (0)",
                   f"{source}: none stands", 0.0, 0.0, partial(stands, 0.3085, ratio),
                   comparison=Comparison.IDEALISED)  # fmt: skip
    yield of_print(group, centreline, "thrust / (gamma t d R)", COCCHETTI_RIZZI["thrust"], thrust)
    haunches = "haunch hinge, degrees from the crown"
    yield of_print(group, centreline, haunches, COCCHETTI_RIZZI["haunch"], haunch)
    ring = partial(semicircle, lb.PointContact, 0.7, 201)
    yield of_print(group, "semicircle, 201 voussoirs", "least t/R", MILANKOVITCH,
                   lambda: least_ratio(ring, 0.104, 0.11))  # fmt: skip
    for name, kind in JOINTS.items():
        yield Case(group, f"semicircle, 27 voussoirs, friction 0.5, {name}", "least t/R",
                   "0.1067 to 0.1068, no single source", 0.10675, 5e-5,
                   partial(least_ratio, partial(semicircle, kind, 0.5, 27), 0.104, 0.11),
                   comparison=Comparison.INDICATIVE)  # fmt: skip
        yield of_print(group, f"R = 10 m, t/R = 0.15, 157.5 degrees, 7 voussoirs, {name}", "associated",
                       OPPENHEIM, partial(associated, oppenheim, kind(0.7)), quick=True)  # fmt: skip
    yield of_print(group, "hemisphere of two opposite lunes, 101 voussoirs", "least t/R", HEYMAN,
                   lambda: least_ratio(lunes, 0.041, 0.0445))  # fmt: skip
