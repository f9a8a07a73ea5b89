"""Crushing, cohesion and tension on the paper's yield surface, Eqs (39)-(42), Table 6."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rectangles import (
    AREA,
    C_T,
    COMPRESSION,
    L1,
    L2,
    MU,
    PAPER,
    RECTANGLE,
    SLIPS,
    N,
    finite_differences,
    states,
)

import limitblocks as lb
from limitblocks.joints.interaction import effective_strength

DOCS = (Path(__file__).parents[2] / "docs/choosing-a-joint.md").read_text(encoding="utf-8")


def test_crushing_flow_is_table_6_by_finite_differences_and_by_duality():
    f = 2e4
    joint, interface = replace(PAPER, compressive_strength=f), lb.joints.interface(RECTANGLE, None)
    rows = joint.yield_rows(RECTANGLE[None])
    c = PAPER.yield_rows(RECTANGLE[None]).F[0, -4:] * -1

    def eq_39(Q):
        return c @ Q + Q[2] ** 2 / (AREA * f)

    for Q in states(10):
        flow = joint.flow_directions(interface, Q)[-4:]
        gradient = finite_differences(eq_39, Q)
        np.testing.assert_allclose(flow, gradient, atol=1e-6)
        np.testing.assert_allclose(flow[:, 2], 1 + 2 * Q[2] / (AREA * f), rtol=1e-12)
        np.testing.assert_allclose(joint.flow_directions(interface, Q, MU)[-4:], flow, rtol=1e-12)
    rng = np.random.default_rng(1)
    for _ in range(50):  # any y in K* dissipates g.y at least: no state of the set does more work
        z = rng.normal(size=2)
        y = np.array([np.linalg.norm(z), *z])
        dq = -rows.F[0, 34:37].T @ y
        Q = states(1, rng.integers(1 << 30))[0]
        if joint.utilisation(interface, Q) <= 1:
            assert dq @ Q <= rows.g[0, 34:37] @ y + 1e-9


@given(share=st.floats(0.0, 1.0), f=st.floats(1e3, 1e9), along=st.sampled_from([(1, 0), (0, 1), (0, -1)]))
def test_moment_strength_is_the_stress_block(share, f, along):
    """M = |N| l (1 - |N| / (A fcef)): zero at N = 0 and at N = -A fcef."""
    joint, interface = lb.OrdunaLourenco(MU, compressive_strength=f), lb.joints.interface(RECTANGLE, None)
    force = share * f * AREA
    moment = joint.strength(interface, (0, 0, 0, *along, 0), (0, 0, -force, 0, 0, 0))
    half = L2 if along[0] else L1
    assert moment == pytest.approx(force * half * (1 - share), abs=1e-9 * f * AREA * half)


@pytest.mark.parametrize(("share", "ratio"), [(0.02, 1.131), (0.1, 1.282), (0.5, 1.5)])
def test_along_a_diagonal_the_stress_block_is_a_triangle(share, ratio):
    """A corner of legs sqrt(2 share) of the sides carries N, its centroid a third of them inside."""
    joint, interface = lb.OrdunaLourenco(MU, compressive_strength=1e4), lb.joints.interface(RECTANGLE, None)
    force = share * 1e4 * AREA
    off = joint.strength(interface, (0, 0, 0, -force * L2, force * L1, 0), (0, 0, -force, 0, 0, 0))
    assert off / (1 - 2 * np.sqrt(2 * share) / 3) == pytest.approx(ratio, abs=1e-3)
    assert f"{ratio - 1:.0%}".removesuffix("%") + " %" in DOCS


def test_eq_39_becomes_eq_36_as_the_strength_grows():
    interface = lb.joints.interface(RECTANGLE, None)
    Q = states(1)[0] * [1, 1, 1, 0.1, 0.1, 0.1]
    infinite = PAPER.strength(interface, (0, 0, 0, 1, 0.4, 0), Q)
    gaps = np.array(
        [
            1 - lb.OrdunaLourenco(MU, f).strength(interface, (0, 0, 0, 1, 0.4, 0), Q) / infinite
            for f in (1e6, 1e7, 1e8, 1e12)
        ]
    )
    assert (gaps > -1e-12).all()
    np.testing.assert_allclose(gaps[:-2] / gaps[1:-1], 10, rtol=1e-3)
    assert abs(gaps[-1]) < 1e-8


@pytest.mark.parametrize(("b", "h", "share"), [(0.5, 1.0, 0.1), (0.3, 2.0, 0.4), (1.0, 1.5, 0.01)])
@pytest.mark.parametrize("friction", [2.0, 0.0])
def test_block_rocking_with_crushing(b, h, share, friction):
    """Alpha = (b/h) (1 - W / (A fcef)), through both bounds; without friction by a moment alone."""
    weight = 20e3 * h  # per area
    joint = lb.OrdunaLourenco(friction, compressive_strength=weight / share, slip="exact")
    model = lb.structures.block(joint, width=b, height=h, depth=0.7, unit_weight=20e3)
    factor = 1.0
    if friction == 0.0:
        stone = next(block for block in model.blocks if block.unit_weight)
        factor = stone.weight * h / 2
        model = lb.Model(
            model.blocks, model.supports, model.interfaces, model.dead, lb.loads.moment(stone.name, (0, 1, 0))
        )
    bounds = lb.bounds(model)
    expected = b / h * (1 - share) * factor
    assert bounds.lower == pytest.approx(expected, rel=1e-6)
    assert bounds.upper == pytest.approx(expected, rel=1e-6)


def test_column_too_heavy_for_its_joint_falls():
    joint = lb.OrdunaLourenco(0.6, compressive_strength=0.99 * 20e3)
    with pytest.raises(lb.errors.NoEquilibrium):
        lb.bounds(lb.structures.block(joint, width=0.5, height=1.0, unit_weight=20e3))


def test_effective_strength_is_what_the_joint_takes():
    f = effective_strength(20e6)
    joint = lb.OrdunaLourenco(0.6, compressive_strength=f)
    assert joint.strength(lb.joints.interface(RECTANGLE, joint), (0, 0, -1, 0, 0, 0)) == pytest.approx(
        12e6 * AREA
    )


def test_cohesion_and_tension():
    c, ft, f = 3e3, 1e3, 2e4
    joint, interface = SLIPS["bonded"], lb.joints.interface(RECTANGLE, None)
    shear = joint.strength(interface, (0.6, 0.8, 0, 0, 0, 0), COMPRESSION)
    assert shear == pytest.approx(c * AREA - MU * N, rel=1e-12)
    torsion = joint.strength(interface, (0, 0, 0, 0, 0, 1), COMPRESSION)
    assert torsion == pytest.approx(C_T * (c * AREA - MU * N), rel=1e-12)
    assert joint.strength(interface, (0, 0, 1, 0, 0, 0)) == pytest.approx(ft * AREA, rel=1e-9)
    assert joint.strength(interface, (0, 0, -1, 0, 0, 0)) == pytest.approx(f * AREA, rel=1e-9)
    # the stress block: compression on the depth that balances N, tension on the rest
    depth = (ft * AREA - N) / (f + ft) / (2 * L1)
    moment = (f + ft) * 2 * L1 * depth * (L2 - depth / 2)
    assert joint.strength(interface, (0, 0, 0, 1, 0, 0), COMPRESSION) == pytest.approx(moment, rel=1e-12)
    dry = lb.OrdunaLourenco(MU, tensile_strength=ft)  # friction alone allows no tension
    assert dry.strength(interface, (0, 0, 1, 0, 0, 0)) == 0
    sticky = lb.OrdunaLourenco(0.0, cohesion=c)
    assert sticky.strength(interface, (1, 0, 0, 0, 0, 0), COMPRESSION) == pytest.approx(c * AREA, rel=1e-12)
