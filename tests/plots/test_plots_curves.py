import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from plotted import arch, bounds, corner, inked, path, rocking

import limitblocks as lb
from limitblocks.joints.rows import hinging, stacked
from limitblocks.joints.torsion import rectangle_torsion_constant

L1, L2, FRICTION = 0.15, 0.10, 0.6
JOINT = lb.OrdunaLourenco(friction=FRICTION)
RECTANGLE = lb.joints.interface([(L1, -L2), (L1, L2), (-L1, L2), (-L1, -L2)], JOINT)


def curve(ax, label=None):
    values = [line for line in ax.lines if label is None or line.get_label() == label]
    return values[0].get_xydata()


def contains(points, wanted):
    return all(np.isclose(points, one, atol=1e-9).all(axis=1).any() for one in wanted)


# ---------------------------------------------------------------------------------------- interaction


def test_slip_octagon_has_its_corners():
    octagon = lb.OrdunaLourenco(friction=FRICTION, slip="paper")
    ax = lb.plots.interaction(octagon, RECTANGLE, "V1", "V2")
    side = FRICTION * np.tan(np.pi / 8)
    assert contains(curve(ax), [(FRICTION, side), (side, FRICTION), (-FRICTION, -side), (side, -FRICTION)])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$V_1 / |N|$ (–)", "$V_2 / |N|$ (–)")
    assert ax.get_aspect() == 1.0
    assert inked(ax) > 0.05


def test_hinging_rectangle_and_stress_state_brought_to_unit_force():
    Q = [(0.0, 0.0, -50.0, 50.0 * L2, 25.0 * L1, 0.0)]
    ax = lb.plots.interaction(JOINT, RECTANGLE, "M1", "M2", stress_resultants=Q)
    corners = curve(ax, repr(JOINT))
    assert contains(corners, [(L2, L1), (-L2, L1), (-L2, -L1), (L2, -L1)])
    assert np.isclose(np.abs(corners), (L2, L1)).any(axis=1).all()
    assert np.allclose(curve(ax, "stress states"), [(L2, L1 / 2)])
    assert ax.get_xlabel() == "$M_1 / |N|$ (m)"


def test_torsion_with_shear_in_newtons_and_the_exact_curve():
    N = -240.0
    ax = lb.plots.interaction(JOINT, RECTANGLE, "V1", "T", N=N, exact=True)
    T0 = FRICTION * 240.0 * float(rectangle_torsion_constant(L1, L2))
    plane, exact = curve(ax, repr(JOINT)), curve(ax, "uniform pressure, exact")
    for points in (plane, exact):
        assert np.allclose(np.abs(points).max(axis=0), (FRICTION * 240.0, T0), rtol=1e-6)
    assert contains(plane, [(0.3 * FRICTION * 240.0, T0)])  # T = (1.3 - V) T0, Eqs (27)-(29)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$V_1$ (N)", "$T$ (N m)")


@pytest.mark.parametrize(("moment", "half"), [("M1", L2), ("M2", L1)])
def test_torsion_with_bending_agrees_with_the_effective_rectangle_at_its_ends(moment, half):
    ax = lb.plots.interaction(JOINT, RECTANGLE, moment, "T", exact=True)
    plane, exact = curve(ax, repr(JOINT)), curve(ax, "uniform pressure, effective area")
    T0 = FRICTION * float(rectangle_torsion_constant(L1, L2))
    other = L1 + L2 - half
    hinge = FRICTION * other / 2  # Eq. (22)
    assert contains(plane, [(half, hinge), (-half, hinge), (half, -hinge)])
    assert np.isclose(exact[:, 1].max(), T0, rtol=1e-6)
    assert np.allclose(exact[np.isclose(exact[:, 0], half), 1][:1], hinge, atol=1e-6)


def test_crushing_parabola():
    strength = 1e6
    joint = lb.OrdunaLourenco(friction=FRICTION, compressive_strength=strength)
    ax = lb.plots.interaction(joint, RECTANGLE, "N", "M1", N=-1e9)
    N, M = curve(ax).T
    limit = 4 * L1 * L2 * strength
    assert np.isclose(N.min(), -limit, rtol=1e-6)
    # stress block: the strip that carries N has the arm l2 (1 - N / limit)
    assert np.allclose(np.abs(M), -N * L2 * (1 + N / limit), atol=1e-5 * limit * L2)
    assert ax.get_xlabel() == "$N$ (N)"


def test_cohesion_of_a_large_area_bounds_the_curve_without_a_normal_force_too():
    cohesion, side = 2e6, 5.0  # Pa, m
    square = lb.joints.interface([(0, 0), (side, 0), (side, side), (0, side)], JOINT)
    joint = lb.OrdunaLourenco(friction=FRICTION, cohesion=cohesion)
    strength = side**2 * cohesion
    ax = lb.plots.interaction(joint, square, "N", "V1", N=-1.0, directions=4)
    assert contains(curve(ax), [(0.0, strength), (0.0, -strength), (-1.0, strength + FRICTION)])
    ax = lb.plots.interaction(joint, square, "V1", "V2", N=-1.0, directions=4)
    assert np.isclose(curve(ax).max(), strength + FRICTION)


def test_stress_states_keep_their_normal_force_on_a_curve_over_it():
    Q = [(0.0, 0.0, -3.0, 0.1, 0.0, 0.0), (0.0, 0.0, -5.0, -0.2, 0.0, 0.0)]
    ax = lb.plots.interaction(JOINT, RECTANGLE, "N", "M1", N=-8.0, stress_resultants=Q)
    assert np.allclose(curve(ax, "stress states"), [(-3.0, 0.1), (-5.0, -0.2)])
    assert contains(curve(ax, repr(JOINT)), [(-8.0, 8.0 * L2), (-8.0, -8.0 * L2)])


def test_a_joint_without_friction_has_a_curve_without_torsion():
    for names, order in (("M1", "T"), [0, 1]), (("T", "M1"), [1, 0]):
        ax = lb.plots.interaction(lb.OrdunaLourenco(0.0), RECTANGLE, *names, directions=8)
        M, T = curve(ax)[:, order].T
        assert (M.min(), M.max()) == pytest.approx((-L2, L2))
        assert not T.any()


def test_joints_are_compared_on_the_same_axes():
    octagon = lb.OrdunaLourenco(friction=FRICTION, slip="paper")
    ax = lb.plots.interaction(octagon, RECTANGLE, "V1", "V2")
    assert lb.plots.interaction(JOINT, RECTANGLE, "V1", "V2", label="circle", ax=ax) is ax
    assert np.allclose(np.linalg.norm(curve(ax, "circle"), axis=1), FRICTION)
    assert len({line.get_color() for line in ax.lines if line.get_label() in ("circle", repr(octagon))}) == 2


def test_point_contacts_have_a_curve_too():
    ax = lb.plots.interaction(lb.PointContact(friction=FRICTION), RECTANGLE, "V1", "T", directions=8)
    reach = np.abs(curve(ax)).max(axis=0)
    assert np.allclose(reach, (FRICTION, FRICTION * np.hypot(L1, L2)), rtol=1e-6)


@dataclasses.dataclass(frozen=True, repr=False)
class Unsliding(lb.joints.Queries):
    """Hinging alone: nothing limits the shear."""

    friction: float

    def yield_rows(self, polygons, stress_unit=1.0):
        return stacked([hinging(polygons)], np.abs(polygons).max(axis=1), self.friction)


WEAK = lb.OrdunaLourenco(friction=FRICTION, cohesion=1e3)
TRIANGLE = lb.joints.interface([(0, 0), (0.3, 0), (0, 0.2)], JOINT)
STATE = [(0.0, 0.0, -3.0, 0.0, 0.0, 0.0)]
STATES = [(0.0, 0.0, -2.0, 0.0, 0.0, 0.0), *STATE]


@pytest.mark.parametrize(
    ("joint", "interface", "settings", "message"),
    [
        (JOINT, RECTANGLE, {"x": "V3"}, "x, y are 'V3', 'T'; expected two of V1"),
        (JOINT, RECTANGLE, {"x": "T"}, "expected two of"),
        (JOINT, RECTANGLE, {"y": "V3"}, "x, y are 'V1', 'V3'; expected two of V1"),
        (JOINT, RECTANGLE, {"N": 5.0}, "N is 5.0, expected a compressive force"),
        (WEAK, RECTANGLE, {}, "N is missing"),
        (WEAK, RECTANGLE, {"N": -2.0, "stress_resultants": STATE}, "N = -3 N, but the curve is for N = -2 N"),
        (
            WEAK,
            RECTANGLE,
            {"N": -2.0, "stress_resultants": STATES},
            "N = -3 N, but the curve is for N = -2 N",
        ),
        (Unsliding(FRICTION), RECTANGLE, {"y": "M1"}, "carries V1 without limit"),
        (Unsliding(FRICTION), RECTANGLE, {"y": "N", "N": -1.0}, "carries V1 without limit"),
        (JOINT, RECTANGLE, {"stress_resultants": [(1.0, 2.0)]}, r"shape \(1, 2\), expected \(k, 6\)"),
        (JOINT, RECTANGLE, {"stress_resultants": np.zeros((1, 6))}, "expected compression"),
        (JOINT, TRIANGLE, {"exact": True}, "symmetric about both"),
        (JOINT, RECTANGLE, {"x": "N"}, "N is missing: give the largest"),
        (JOINT, RECTANGLE, {"x": "N", "N": -1.0, "exact": True}, "no exact curve is known"),
        (lb.OrdunaLourenco(0.6, cohesion=1e4), RECTANGLE, {"N": -1.0, "exact": True}, "with cohesion"),
    ],
)
def test_what_has_no_interaction_curve_is_refused(joint, interface, settings, message):
    with pytest.raises(lb.ModelError, match=message):
        lb.plots.interaction(joint, interface, **settings)


# --------------------------------------------------------------------------------------------- curves


@pytest.mark.parametrize("take", [lambda path: path, lambda path: path.collapse])
def test_convergence_draws_the_history(take):
    history = path().collapse.history
    ax = lb.plots.convergence(take(path()))
    right = next(one for one in ax.figure.axes if one is not ax)
    assert np.allclose(curve(right)[:, 1], [one.load_factor for one in history])
    flow = curve(ax, "flow")[:, 1]
    assert np.allclose(flow, [max(one.residuals["flow"], 1e-16) for one in history])
    assert ax.get_yscale() == "log"
    assert np.allclose(curve(ax, "tolerance")[:, 1], path().collapse.tolerance)
    assert "(–)" in ax.get_ylabel()
    assert "(–)" in right.get_ylabel()
    assert inked(ax) > 0.005


def test_no_two_residuals_are_drawn_alike():
    ax = lb.plots.convergence(path())
    drawn = [(line.get_color(), line.get_linestyle(), line.get_marker()) for line in ax.lines]
    assert len(ax.lines) > 7  # more than there are colours
    assert len(set(drawn)) == len(drawn)


def test_bounds_have_no_history():
    with pytest.raises(lb.LimitBlocksError, match="Bounds has no history"):
        lb.plots.convergence(bounds(rocking))


def test_load_path_is_its_curve():
    model, name = rocking(), rocking().free_blocks[0].name
    k = [block.name for block in model.blocks].index(name)
    ax = lb.plots.load_path(model, path(), name, "rY")
    moved, loads = path().curve(k, 4)
    assert np.array_equal(curve(ax), np.column_stack([moved, loads]))
    assert ax.get_xlabel().startswith(f"rotation of {name} about Y (rad)")
    kinds = {step.kind for step in path().steps} - {"polish"} | {"collapse"}
    assert {text.get_text() for text in ax.get_legend().get_texts()} == kinds
    assert inked(ax) > 0.005


def test_load_path_shows_what_moves_most():
    ax = lb.plots.load_path(rocking(), path())
    assert np.isclose(np.abs(curve(ax)[-1, 0]), np.abs(path().steps[-1].displacements[:, :3]).max())
    assert ax.get_xlabel().startswith(f"displacement of {rocking().free_blocks[0].name} along X (m)")


@pytest.mark.parametrize(
    ("block", "component", "message"),
    [
        ("nobody", None, "block 'nobody' is not a block"),
        (None, "x", "component is 'x', expected one of X, Y"),
    ],
)
def test_load_path_of_nothing_is_refused(block, component, message):
    with pytest.raises(lb.ModelError, match=message):
        lb.plots.load_path(rocking(), path(), block, component)


def test_curves_of_something_else_are_refused_by_name():
    for draw, said in (
        (lambda: lb.plots.load_path(path(), rocking()), "model is a LoadPath, expected a Model"),
        (lambda: lb.plots.load_path(rocking(), bounds(rocking)), "path is a Bounds, expected LoadPath"),
        (lambda: lb.plots.capacity(bounds(rocking)), "curve is a Bounds, expected CapacityCurve"),
        (lambda: lb.plots.settlement(path()), "curve is a LoadPath, expected SettlementCurve"),
    ):
        with pytest.raises(lb.ModelError, match=said):
            draw()


def test_load_path_of_another_model_is_refused():
    with pytest.raises(lb.LimitBlocksError, match="belongs to model"):
        lb.plots.load_path(arch(), path())


def test_polar_is_sorted_and_closed():
    angles, values = np.radians([270.0, 0.0, 90.0, 180.0]), np.array([4.0, 1.0, 2.0, 3.0])
    ax = lb.plots.polar(angles, values)
    theta, r = curve(ax).T
    assert np.allclose(theta, np.radians([0, 90, 180, 270, 360]))
    assert np.allclose(r, [1, 2, 3, 4, 1])
    assert ax.get_rmin() == 0.0
    assert "(–)" in ax.get_title()
    assert inked(ax) > 0.02


def test_polar_takes_a_study_and_leaves_gaps():
    angles = np.radians([0.0, np.nan, 30.0, 60.0])  # NaN: a vertical push
    study = SimpleNamespace(angles=angles, load_factors=np.array([1.0, 9.0, np.inf, 2.0]))
    ax = lb.plots.polar(study, label="wall")
    assert len(curve(ax, "wall")) == 3  # a fan stays open
    assert np.isnan(curve(ax, "wall")[1, 1])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((np.zeros(3), np.zeros(2)), r"angles have shape \(3,\) and load factors \(2,\)"),
        ((np.zeros(3),), "ndarray has no angles"),
        (([np.nan], [1.0]), "at least one angle that is finite"),
        (([0.0], [1.0], Figure().add_subplot()), "projection 'rectilinear', expected 'polar'"),
    ],
)
def test_polar_refuses_what_it_cannot_draw(arguments, message):
    with pytest.raises(lb.LimitBlocksError, match=message):
        lb.plots.polar(*arguments)


def test_bracket_draws_every_load_factor():
    result = path().collapse
    ax = lb.plots.bracket(path(), result, bounds(rocking))
    names = [text.get_text() for text in ax.get_yticklabels()]
    widths = dict(zip(names, [bar.get_width() for bar in ax.patches], strict=True))
    assert list(widths) == ["frictionless", "non-associated", "load path", "associated"]
    assert np.isclose(widths["frictionless"], result.frictionless, atol=1e-9)
    assert widths["non-associated"] == widths["load path"] == result.load_factor
    assert np.isclose(widths["associated"], 0.25, rtol=1e-6)  # width / height
    assert {"0.25"} <= {text.get_text() for text in ax.texts}
    assert "(–)" in ax.get_xlabel()
    assert inked(ax) > 0.1


def test_bracket_says_unlimited():
    odd = dataclasses.replace(path().collapse, associated=np.inf)
    ax = lb.plots.bracket(odd)
    assert "unlimited" in {text.get_text() for text in ax.texts}


def test_bracket_claims_a_lower_end_for_all_results_or_for_none():
    result = path().collapse
    turned = dataclasses.replace(result, frictionless=np.nan, unclaimed="a joint can give power")
    for results in ((turned,), (result, turned), (turned, result)):
        said = {text.get_text() for text in lb.plots.bracket(*results).texts}
        assert "not claimed" in said
    assert "not claimed" not in {text.get_text() for text in lb.plots.bracket(result).texts}


def test_bracket_draws_a_bar_for_every_solution():
    """The second of a kind was left out; limits that a file says took the place of those computed."""
    result = path().collapse
    lifting = dataclasses.replace(result, dilatancy=0.2, load_factor=0.24)
    other = dataclasses.replace(result, load_factor=0.23)
    read = dataclasses.replace(result, from_file=True, associated=0.9)
    ax = lb.plots.bracket(read, lifting, result, other)
    names = [text.get_text() for text in ax.get_yticklabels()]
    widths = dict(zip(names, [bar.get_width() for bar in ax.patches], strict=True))
    assert widths == {
        "frictionless": result.frictionless,
        "non-associated, dilatancy 0.2": 0.24,
        "non-associated": result.load_factor,
        "non-associated (2)": 0.23,
        "associated": result.associated,
    }


@pytest.mark.parametrize(
    ("results", "message"), [((), "no result given"), ((3,), "int given"), (({},), "dict given")]
)
def test_bracket_refuses_what_is_no_result(results, message):
    with pytest.raises(lb.LimitBlocksError, match=message):
        lb.plots.bracket(*results)


def test_bracket_of_two_models_is_refused():
    with pytest.raises(lb.LimitBlocksError, match="different models"):
        lb.plots.bracket(bounds(rocking), bounds(corner))


@pytest.mark.parametrize(
    "draw",
    [
        lambda ax: lb.plots.convergence(path(), ax),
        lambda ax: lb.plots.load_path(rocking(), path(), ax=ax),
        lambda ax: lb.plots.bracket(path(), ax=ax),
        lambda ax: lb.plots.interaction(JOINT, RECTANGLE, ax=ax),
    ],
)
def test_curves_are_drawn_on_the_axes_given(draw):
    ax = Figure().add_subplot()
    assert draw(ax) is ax
    with pytest.raises(lb.LimitBlocksError, match="projection 'polar', expected 'rectilinear'"):
        draw(Figure().add_subplot(projection="polar"))


def test_polar_is_drawn_on_the_axes_given():
    ax = Figure().add_subplot(projection="polar")
    assert lb.plots.polar([0.0, 1.0], [1.0, 2.0], ax) is ax
