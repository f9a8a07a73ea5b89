"""Arches whose hinges move: every point of their curves against a four-bar linkage of rigid bars."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import fsolve
from scipy.sparse import csr_array

import limitblocks as lb
from limitblocks.practice import capacity_curve
from limitblocks.practice.displaced import assembly_of
from limitblocks.practice.snapped import TIGHT, falls, linear_program, snapped
from limitblocks.practice.touching import pressed_in

QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])


def turned(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def hinges_of(was, now):
    """Joints of a ring that have opened: (bars before it, corner that stayed closed in the first model)."""
    ring = sorted((b.name for b in was.free_blocks), key=lambda name: int(name.split()[1]))
    ring = ["left support", *ring, "right support"]
    old, new = ({b.name: b.vertices[:, [0, 2]] for b in model.blocks} for model in (was, now))
    found = []
    for k, (one, two) in enumerate(pairwise(ring)):
        pairs = np.argwhere(np.linalg.norm(old[one][:, None] - old[two], axis=2) < 1e-9)
        gaps = np.array([np.linalg.norm(new[one][i] - new[two][j]) for i, j in pairs])
        if gaps.max() > 1e-6:
            assert gaps.min() < 1e-7
            found.append((k, old[one][pairs[gaps.argmin(), 0]]))
    return found


def load_factor(model, hinges, control, displacement):
    """Virtual work of weights and of weights along X on a linkage A B C D whose control point moved by it."""
    (_, A), (_, B), (_, C), (_, D) = hinges
    centres = {int(b.name.split()[1]): b.centroid[[0, 2]] for b in model.free_blocks}
    weights = {int(b.name.split()[1]): b.weight for b in model.free_blocks}
    bar_of = {k: sum(k > cut for cut, _ in hinges) for k in centres}
    watched, point = int(control.block.split()[1]), control.point[[0, 2]]

    def placed(bar, x, angles):
        b = A + turned(angles[0]) @ (B - A)
        c = b + turned(angles[1]) @ (C - B)
        starts = {1: (A, A), 2: (B, b), 3: (C, c)}
        old, new = starts[bar]
        return new + turned(angles[bar - 1]) @ (x - old), b, c

    def closed(angles):
        end = placed(3, D, angles)[0] - D
        return [*end, placed(bar_of[watched], point, angles)[0][0] - point[0] - displacement]

    tries = (fsolve(closed, sign * displacement * np.array([0.3, -0.3, 0.3]), xtol=1e-14, full_output=True)
             for sign in (-1, 1))  # fmt: skip
    angles = next(found[0] for found in tries if np.abs(found[1]["fvec"]).max() < 1e-10)
    _, b, c = placed(1, A, angles)
    vb = QUARTER @ (b - A)  # the first bar turns at rate one
    second, third = np.linalg.solve(np.stack([QUARTER @ (c - b), QUARTER @ (D - c)], axis=1), -vb)
    lifted = pushed = 0.0
    for k, centre in centres.items():
        if bar_of[k] in (0, 4):
            continue
        x = placed(bar_of[k], centre, angles)[0]
        vc = vb + second * QUARTER @ (c - b)
        v = {1: QUARTER @ (x - A), 2: vb + second * QUARTER @ (x - b), 3: vc + third * QUARTER @ (x - c)}
        lifted, pushed = lifted + weights[k] * v[bar_of[k]][1], pushed + weights[k] * v[bar_of[k]][0]
    return lifted / pushed


@pytest.fixture(scope="module", params=[12, 15])
def followed(request):
    arch = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=1.0, voussoirs=request.param)
    return arch, capacity_curve(arch, steps=5)


def test_every_point_is_on_a_four_bar_linkage(followed):
    arch, curve = followed
    assert curve.points[0].load_factor == pytest.approx(lb.nonassociated(arch).load_factor, rel=1e-12)
    for point in curve.points[1:]:
        hinges = hinges_of(arch, point.model)
        assert len(hinges) == 4
        expected = load_factor(arch, hinges, curve.control, point.displacement)
        assert point.load_factor == pytest.approx(expected, abs=1e-6)


def test_hinges_jump_and_no_joint_presses_across_its_gap(followed):
    arch, curve = followed
    assert curve.zero is not None
    assert curve.proven_to == curve.displacements[-1]
    jumps = [k for k, point in enumerate(curve.points) if point.snapped]
    assert jumps
    for k in jumps:
        said = curve.points[k].changes
        assert any(words.endswith("opens") for words in said)
        assert any(words.endswith("closes") for words in said)
        before, after = (curve.points[n].model for n in (k - 1, k))
        # a snap gives off energy while the live load rests: its centre stays, that of the weights sinks
        shift = [sum(b.weight * b.centroid for b in model.free_blocks) for model in (before, after)]
        moved = (shift[1] - shift[0]) / sum(b.weight for b in arch.free_blocks)
        assert moved[2] < -1e-4
        assert abs(moved[0]) < 0.2 * abs(moved[2]) + 1e-3


def test_a_structure_that_is_held_does_not_snap():
    """Negative control: before the thrust reaches a fifth joint nothing falls."""
    arch = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=1.0, voussoirs=12)
    there = pressed_in(
        assembly_of(arch), list(range(len(arch.interfaces))), -np.ones((len(arch.interfaces), 6))
    )
    assert not falls(there)
    assert snapped(there) == (there, ())


def test_rows_that_differ_by_rounding_hold_nothing():
    """Of four rows three are independent within 1e-10: x1 = x3 = -1 breaks the third by 2.5e-14 and falls."""
    rows = [
        [5.19311888e-9, 0.01, 0, 0],
        [0, 0, 5.19309398e-9, 0.01],
        [-8.30897676e-9, -0.01, 8.30897676e-9, 0.01],
        [-0.04, -0.01, 0.04, 0.01],
    ]
    motion = [-1.0, 5.19311888e-7, -1.0, 5.19309398e-7]
    assert np.abs(rows @ np.array(motion)).max() < 1e-13
    held = csr_array(rows), np.zeros(4)
    found = linear_program([1, 0, 1, 0], None, None, *held, (-1, 1), "highs", options=TIGHT)
    assert found.fun == pytest.approx(-2.0, rel=1e-9)
