import subprocess
import sys
from collections import Counter
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.quiver import Quiver
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from mpl_toolkits.mplot3d.proj3d import proj_transform
from plotted import arch, bounds, corner, inked, path, rocking
from stones import model_of, shaft

import limitblocks as lb
from limitblocks.drawing.chains import chains, thrust
from limitblocks.drawing.painter import painting_order, placed
from limitblocks.evidence.interface_states import interface_states
from limitblocks.plots.style import VERMILION
from limitblocks.practice import dowel, reinforced, tie

DRAWINGS = ["structure", "mechanism", "forces", "interface_states"]
UNITS = {"xz": "XZ", "yz": "YZ", "xy": "XY"}


def drawn(name, make, *args, **settings):
    draw = getattr(lb.plots, name)
    return (
        draw(make(), *args, **settings)
        if name == "structure"
        else draw(make(), bounds(make), *args, **settings)
    )


def polygons(ax):
    """Corners of all filled polygons of an elevation but the lines of interfaces."""
    values = [c for c in ax.collections if isinstance(c, PolyCollection) and not c.get_label().count("(")]
    return [path.vertices[:-1] for c in values for path in c.get_paths()]


def has(ax, corners):
    return any(
        len(p) == len(corners) and all(np.isclose(p, c, atol=1e-6).all(axis=1).any() for c in corners)
        for p in polygons(ax)
    )


@pytest.mark.parametrize("make", [rocking, arch, corner])
@pytest.mark.parametrize("name", DRAWINGS)
def test_drawing_is_not_blank_and_says_its_units(name, make):
    ax = drawn(name, make)
    labels = [getattr(ax, f"get_{axis}label")() for axis in ("xyz" if ax.name == "3d" else "xy")]
    assert labels == [f"{letter} (m)" for letter in ("XYZ" if ax.name == "3d" else "XZ")]
    assert (ax.name == "3d") == (make is corner)
    assert inked(ax) > 0.1


@pytest.mark.parametrize("projection", [None, "3d"])
def test_empty_axes_are_blank(projection):
    assert inked(Figure().add_subplot(projection=projection)) == 0.0


@pytest.mark.parametrize("name", DRAWINGS)
@pytest.mark.parametrize("plane", ["xz", "yz", "xy", "3d"])
def test_any_model_is_drawn_on_the_axes_and_plane_given(name, plane):
    ax = Figure().add_subplot(projection="3d" if plane == "3d" else None)
    assert drawn(name, corner, ax, plane=plane) is ax
    if plane != "3d":
        assert ax.get_aspect() == 1.0
        assert (ax.get_xlabel(), ax.get_ylabel()) == tuple(f"{letter} (m)" for letter in UNITS[plane])
    assert inked(ax) > 0.05


def test_scales_of_a_drawing_in_space_are_equal():
    ax = lb.plots.structure(corner())
    across = ax.get_proj()[:2, :3]  # to the page
    assert np.allclose(across @ across.T, (across @ across.T)[0, 0] * np.eye(2), rtol=1e-9, atol=1e-9)


def test_structure_draws_each_block_where_it_is_and_hatches_the_support():
    ax = lb.plots.structure(rocking(), names=True)
    assert has(ax, [(0, 0), (0.5, 0), (0.5, 2), (0, 2)])
    hatched = [c for c in ax.collections if c.get_hatch()]
    assert len(hatched) == 1
    assert len(hatched[0].get_paths()) == len(rocking().supports)
    assert {block.name for block in rocking().blocks} <= {text.get_text() for text in ax.texts}


def test_live_load_points_the_way_it_acts_and_can_be_left_out():
    (arrow,) = [c for c in lb.plots.structure(arch()).collections if isinstance(c, Quiver)]
    assert np.allclose(arrow.U, 0.0)
    assert arrow.V[0] < 0.0
    assert not any(isinstance(c, Quiver) for c in lb.plots.structure(arch(), live=False).collections)


@pytest.mark.parametrize("analysis", ["bounds", "path"])
def test_rocking_block_turns_about_its_toe(analysis):
    block = rocking().free_blocks[0]
    result = bounds(rocking) if analysis == "bounds" else path()
    scale = 0.1 * block.weight  # the live load W at 1 m does unit work: 1 / W about the toe
    ax = lb.plots.mechanism(rocking(), result, scale=scale)
    turn = 0.1
    corners = np.array([(0.0, 0.0), (0.5, 0.0), (0.5, 2.0), (0.0, 2.0)])
    arm = corners - (0.5, 0.0)
    assert has(ax, corners + turn * np.column_stack([arm[:, 1], -arm[:, 0]]))
    assert not has(ax, corners)
    outline = next(c for c in ax.collections if isinstance(c, LineCollection))
    where = outline.get_segments()[0]
    assert np.allclose([where.min(axis=0), where.max(axis=0)], [(0, 0), (0.5, 2)], atol=1e-3)
    farthest = turn * np.hypot(0.5, 2.0)
    assert f"largest displacement drawn {farthest:.2g} m" in ax.get_title()
    assert "rates" in ax.get_title()


def test_default_scale_keeps_the_drawing_legible():
    ax = lb.plots.mechanism(arch(), bounds(arch))
    moved = max(np.abs(p).max() for p in polygons(ax))
    assert 2.0 < moved < 3.5


@pytest.mark.parametrize("turned", [False, True])
def test_force_of_the_ground_on_a_rocking_block(turned):
    blocks = rocking().blocks[::-1] if turned else rocking().blocks
    interfaces = lb.find_interfaces(blocks, rocking().interfaces[0].joint)
    model = lb.Model(blocks, rocking().supports, interfaces, rocking().dead, rocking().live)
    ax = lb.plots.forces(model, lb.bounds(model))
    (arrows,) = [c for c in ax.collections if isinstance(c, Quiver)]
    assert np.allclose([arrows.X[0], arrows.Y[0]], [0.5, 0.0], atol=1e-5)
    assert np.isclose(arrows.U[0] / arrows.V[0], -0.25, atol=1e-5)  # -load factor W over W
    assert arrows.V[0] > 0.0
    size = model.free_blocks[0].weight * np.hypot(0.25, 1.0)
    assert ax.get_title() == f"contact forces; longest arrow {size / 1e3:.3g} kN"


@pytest.mark.parametrize(("level", "rounding"), [(0.0, 0.0), (-5.0, 0.0), (0.0, 1e-15)])
def test_forces_between_blocks_at_one_height_are_those_on_block_j(level, rounding):
    """One cube pushes the other along +X, wherever Z = 0 is: below it the arrow pointed the other way."""
    blocks = [
        lb.Block.box("ground", (4, 1, 0.2), (0, 0, level - 0.1)),
        lb.Block.box("a", (1, 1, 1), (-0.5, 0, level + 0.5 + rounding), 20e3),
        lb.Block.box("b", (1, 1, 1), (0.5, 0, level + 0.5), 20e3),
    ]
    interfaces = lb.find_interfaces(blocks, lb.OrdunaLourenco(0.6))
    push = lb.loads.force("a", (1e3, 0, 0), (-1, 0, level + 0.2))
    model = lb.Model(blocks, ["ground"], interfaces, lb.self_weight(), push)
    ax = lb.plots.forces(model, lb.bounds(model))
    (arrows,) = [c for c in ax.collections if isinstance(c, Quiver)]
    (between,) = [k for k, i in enumerate(interfaces) if (i.block_i, i.block_j) == ("a", "b")]
    assert arrows.U[between] > 0.0


@pytest.mark.parametrize("make", [rocking, arch, corner])
def test_legend_counts_the_interfaces_of_each_state(make):
    ax = lb.plots.interface_states(make(), bounds(make))
    counted = Counter(interface_states(make(), bounds(make)).state)
    labels = {text.get_text() for text in ax.get_legend().get_texts()}
    dots = {"thrust at a hinge"} if any("hinge" in state for state in counted) else set()
    assert labels == {f"{state} ({count})" for state, count in counted.items()} | dots


def test_thrust_line_of_a_symmetric_arch_is_symmetric_and_inside():
    ax = lb.plots.thrust_line(arch(), bounds(arch))
    line = next(line for line in ax.lines if line.get_label() == "line of thrust").get_xydata()
    assert len(line) == len(arch().interfaces)
    assert (np.diff(line[:, 0]) > 0).all()  # from the left springing to the right one
    assert np.allclose(line[::-1] * (-1, 1), line, atol=1e-3)
    radius = np.linalg.norm(line, axis=1)
    assert ((radius > 1.8 - 1e-6) & (radius < 2.2 + 1e-6)).all()
    hinges = next(line for line in ax.lines if line.get_label() == "hinge").get_xydata()
    edges = np.abs(np.linalg.norm(hinges, axis=1) - 2.0)
    assert len(hinges) == 6
    assert np.allclose(edges, 0.2, atol=1e-4)  # hinges at the intrados or the extrados


def test_thrust_line_of_a_column_begins_at_its_base():
    model = lb.structures.column(lb.OrdunaLourenco(friction=0.9), count=4, width=0.5, height=0.5)
    result = lb.bounds(model)
    ax = lb.plots.thrust_line(model, result)
    x, z = ax.lines[0].get_xydata().T
    assert np.allclose(z, [0.0, 0.5, 1.0, 1.5], atol=1e-9)
    above = 2.0 - z  # the weight above acts at half its height
    assert np.allclose(x - 0.25, result.lower * above / 2, atol=1e-5)


def test_thrust_line_goes_through_the_joints_of_what_is_tied():
    """Blocks of .5 m x .5 m, a rod of T at .9 m: a W = W / 2 + .9 T; under the upper one .25 a - .4 T / W."""
    own = lb.structures.column(
        lb.OrdunaLourenco(friction=0.9), count=2, width=0.5, height=0.5, unit_weight=20e3
    )
    (weight, _), pull = [block.weight for block in own.free_blocks], 1e3
    rod = tie("block 2", (0, 0, 0.9), "base", (-3, 0, 0.9), area=1e-4, strength=pull / 1e-4)
    pin = dowel(own.interfaces[0], own.interfaces[0].centroid, diameter=0.02, capacity=1e3)
    model = reinforced(own, rod, pin)
    factor = (2 * weight * 0.25 + 0.9 * pull) / (2 * weight * 0.5)
    line = lb.plots.thrust_line(model, lb.nonassociated(model)).lines[0].get_xydata()
    off = [0.25, 0.25 * factor - 0.4 * pull / weight]
    assert np.allclose(line, [(0.25 + off[0], 0.0), (0.25 + off[1], 0.5)], atol=1e-6)


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.6, 0.8, 0.0)])
def test_thrust_line_of_a_hollow_shaft_is_that_of_its_joints(direction):
    """Under a push H = a W at half the height h above a joint e = H h / W, whatever its pieces carry."""
    model = model_of(shaft(courses=3), ["ground"], lb.OrdunaLourenco(0.9), direction)
    result = lb.bounds(model)
    assert len(model.interfaces) == 12
    above = np.array([3.0, 2.0, 1.0])
    expected = np.outer(result.lower * above / 2, direction) + np.outer(3.0 - above, (0, 0, 1))
    assert thrust(interface_states(model, result), chains(model)[0]) == pytest.approx(expected, abs=1e-6)
    ax = lb.plots.thrust_line(model, result, plane="xz")
    assert ax.lines[0].get_xydata() == pytest.approx(expected[:, [0, 2]], abs=1e-6)
    assert len(ax.lines[1].get_xydata()) == 1  # one hinge, of all pieces


def test_thrust_line_of_a_stone_on_two_feet_is_between_them():
    """Feet of .2 m at x = +-.5 m, W at the middle, H = a W at z = .4 m: x = .4 a."""
    outline = [(-0.6, 0), (-0.4, 0), (-0.4, 0.2), (0.4, 0.2), (0.4, 0), (0.6, 0), (0.6, 0.6), (-0.6, 0.6)]
    stone = lb.Block.prism("stone", outline, (-0.2, 0.2), 20e3)
    model = model_of(
        [lb.Block.box("ground", (3.0, 1.0, 0.2), (0, 0, -0.1)), stone], ["ground"], lb.PointContact(0.2)
    )
    line = lb.plots.thrust_line(model, lb.nonassociated(model)).lines[0].get_xydata()
    assert line == pytest.approx(np.array([(0.2 * stone.centroid[2], 0.0)]), abs=1e-6)


def test_thrust_line_needs_a_chain():
    with pytest.raises(
        lb.ModelError, match=r"block '.*' has \d joints, each in one plane; a line of thrust needs"
    ):
        lb.plots.thrust_line(corner(), bounds(corner))


def test_blocks_in_front_hide_those_behind():
    model = lb.structures.facade(lb.OrdunaLourenco(friction=0.6), courses=7)
    elev, azim = np.radians([22.0, -60.0])
    eye = np.array([np.cos(elev) * np.cos(azim), np.cos(elev) * np.sin(azim), np.sin(elev)])
    order = painting_order([placed(block.vertices, block.faces) for block in model.blocks], eye)
    rank = {model.blocks[k].name: place for place, k in enumerate(order)}
    for interface in model.interfaces:
        towards = interface.axes[2] @ eye  # block j is in front where this is positive
        assert (rank[interface.block_j] > rank[interface.block_i]) == (towards > 0.0)


def test_faces_of_blocks_in_space_look_at_the_reader():
    ax = lb.plots.structure(corner(), live=False)
    blocks = [c for c in ax.collections if isinstance(c, Poly3DCollection)]
    assert len(blocks) == len(corner().blocks)
    assert sorted(c.get_zorder() for c in blocks) == [c.get_zorder() for c in blocks]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"plane": "zx"}, "plane is 'zx', expected one of 'xz', 'yz', 'xy', '3d'"),
        ({"ax": Figure().add_subplot(projection="3d"), "plane": "xz"}, "but ax has the projection '3d'"),
        ({"ax": Figure().add_subplot(projection="polar")}, "expected plain or 3d Axes"),
        ({"ax": 3}, "expected plain or 3d Axes"),
    ],
)
def test_wrong_axes_and_planes_are_refused(settings, message):
    with pytest.raises(lb.LimitBlocksError, match=message):
        lb.plots.structure(rocking(), **settings)


@pytest.mark.parametrize("scale", [0.0, -1.0, np.inf, np.nan])
def test_wrong_scale_is_refused(scale):
    with pytest.raises(lb.LimitBlocksError, match="scale is"):
        lb.plots.mechanism(rocking(), bounds(rocking), scale=scale)


@pytest.mark.parametrize("name", [*DRAWINGS[1:], "thrust_line"])
def test_result_of_another_model_is_refused(name):
    with pytest.raises(lb.LimitBlocksError, match="belongs to model"):
        getattr(lb.plots, name)(rocking(), bounds(arch))


def test_missing_matplotlib_is_named():
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "import limitblocks as lb\n"
        "try:\n    lb.plots\n"
        "except lb.errors.MissingDependency as error:\n"
        '    sys.exit("pip install \'matplotlib>=3" not in str(error))\n'
        "sys.exit(2)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_what_a_block_that_rocks_does_not_depend_on_has_no_colour():
    """Its load factor is width over height, whatever its weight and friction: what is left is rounding."""
    found = lb.sensitivities(rocking(), bounds(rocking))
    noisy = replace(found, friction=found.friction + 1e-12, unit_weight=found.unit_weight - 1e-12 / 20e3)
    title = lb.plots.sensitivity(rocking(), noisy).get_title()
    assert title.endswith("unit weights up to 0, friction up to 0")


def test_the_live_load_of_a_tall_structure_is_an_arrow_within_the_figure():
    """It is drawn above the axes of a structure that fills them, which would cut it off."""
    ax = lb.plots.structure(
        lb.structures.tower(lb.PointContact(0.6), length=2.4, width=2.4, courses=16), plane="3d"
    )
    for word in list(ax.texts):
        word.remove()
    canvas = FigureCanvasAgg(ax.figure)
    canvas.draw()
    orange = np.abs(np.asarray(canvas.buffer_rgba())[..., :3] / 255 - to_rgb(VERMILION)).max(axis=2) < 0.02
    assert orange.sum() > 20


@pytest.mark.parametrize("draw", [lb.plots.findings, lambda model: lb.plots.mechanism(model, bounds(corner))])
def test_the_title_of_a_drawing_in_space_is_between_it_and_the_edge(draw):
    ax = draw(corner())
    canvas = FigureCanvasAgg(ax.figure)
    canvas.draw()
    frame = np.array(list(product(*(getattr(ax, f"get_{name}lim3d")() for name in "xyz"))))
    x, y, _ = proj_transform(*frame.T, ax.get_proj())
    title = ax.title.get_window_extent()
    assert len(ax.get_title().splitlines()) > 1
    assert ax.transData.transform(np.column_stack([x, y]))[:, 1].max() < title.y0
    assert title.y1 < ax.figure.bbox.y1


def test_a_thin_wall_far_from_the_origin_has_a_tick_on_its_thickness():
    stones = [lb.Block.box("base", (3.0, 0.3, 0.2), (0.0, 12.55, -0.1))]
    stones += [lb.Block.box("wall", (3.0, 0.3, 1.0), (0.0, 12.55, 0.5), 20e3)]
    ax = lb.plots.structure(model_of(stones, ["base"], lb.PointContact(0.6), (0, 1, 0)), plane="3d")
    (tick,) = ax.yaxis.get_major_locator()()
    assert 12.4 <= tick <= 12.7
