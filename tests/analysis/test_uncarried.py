"""Blocks that no interface pushes or pulls against their dead load: by hand, and where they are told."""

import logging
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from stones import model_of, sloping
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.analysis.uncarried import uncarried
from limitblocks.cli import app
from limitblocks.joints import Guide
from limitblocks.practice import dowel, reinforced, tie

DRY = lb.OrdunaLourenco(0.6)
WORDS = "friction alone holds"


def between(*others, lean=0.0, joint=DRY, size=1.0, weight=20e3):
    """A stone between two supports, its faces leaning out by `lean` as it goes up, and other supports."""
    boxes = {
        "floor": lb.Block.box("floor", np.multiply(size, (0.8, 1, 1)), np.multiply(size, (0, 0, -1))),
        "ceiling": lb.Block.box("ceiling", np.multiply(size, (0.8, 1, 1)), np.multiply(size, (0, 0, 1))),
    }
    t = 0.5 * lean
    across = (-size / 2, size / 2)

    def prism(name, outline, *unit_weight):
        return lb.Block.prism(name, np.multiply(size, outline).tolist(), across, *unit_weight)

    stones = [
        prism("left", [(-2, -0.5), (-0.5 + t, -0.5), (-0.5 - t, 0.5), (-2, 0.5)]),
        prism("right", [(0.5 - t, -0.5), (2, -0.5), (2, 0.5), (0.5 + t, 0.5)]),
        prism("stone", [(-0.5 + t, -0.5), (0.5 - t, -0.5), (0.5 + t, 0.5), (-0.5 - t, 0.5)], weight),
        *(boxes[name] for name in others),
    ]
    return model_of(stones, ["left", "right", *others], joint)


def named(model):
    return lb.diagnose(model).uncarried


@pytest.mark.parametrize("size", [1.0, 1e-3, 1e3])
@pytest.mark.parametrize(
    ("others", "lean", "expected"),
    [
        ((), 0.0, ("stone",)),  # clamped
        (("floor",), 0.0, ()),
        (("ceiling",), 0.0, ("stone",)),  # clamped, and contacts do not pull
        (("ceiling", "floor"), 0.0, ()),
        ((), 0.3, ()),  # a keystone
        ((), 1e-3, ()),  # that of a long arch: the faces of a drawing are exact or tell how accurate they are
        ((), -0.3, ("stone",)),  # upside down: both faces push it down
    ],
)
def test_what_carries_a_stone_is_a_push_from_below(others, lean, expected, size):
    """In millimetres, too, with a weight of 1e-9 N."""
    assert named(between(*others, lean=lean, size=size, weight=20e3 / size)) == expected


@pytest.mark.parametrize(
    ("along", "expected"),
    [
        ((0, 0, -1), ()),
        ((0, 0, 1), ("stone",)),  # up, off the floor
        ((0, 1, 0), ("stone",)),  # out between the walls
        ((1, 0, 1), ()),  # up, and against a wall
        ((0, 1, -1e-3), ()),
        ((0, 1, 1e-3), ("stone",)),
    ],
)
@pytest.mark.parametrize("turn", [(0, 0, 0), (0.4, -1.1, 2.0)])
def test_the_dead_load_says_what_is_below(along, expected, turn):
    turned = Rotation.from_rotvec(turn).as_matrix()
    model = between("floor")
    stones = [block.moved(turned, (3, -2, 1)) for block in model.blocks]
    found = lb.find_interfaces(stones, DRY)
    assert (
        named(replace(model, blocks=stones, interfaces=found, dead=lb.mass_proportional(turned @ along)))
        == expected
    )


def test_a_load_that_lifts_a_stone_turns_what_carries_it():
    def lifted(force, *others):
        up = lb.loads.force("stone", (0, 0, force), (0, 0, 0))
        return replace(between(*others), dead=lb.self_weight() + up)

    assert named(lifted(10e3)) == named(lifted(21e3, "floor")) == ("stone",)
    assert named(lifted(21e3, "ceiling")) == ()


def test_a_load_that_is_none_but_for_rounding_needs_nothing():
    """-.3 + .1 + .2 N is 3e-17 N."""
    stones = [*between(weight=0.3).blocks, lb.Block.box("other", (1, 1, 1), (1.25, 0, 1), 20e3)]
    model = model_of(stones, ["left", "right"], DRY)
    up = sum((lb.loads.force("stone", (0, 0, z), (0, 0, 0)) for z in (0.1, 0.2)), lb.self_weight())
    assert named(model) == ("stone",)
    assert np.linalg.norm(up.on(model.free_blocks)[0, :3]) > 0.0
    assert named(replace(model, dead=up)) == ()


def rod(model, end, at):
    return reinforced(model, tie(end, at, "stone", (0, 0, 0), area=3e-4, strength=235e6))


@pytest.mark.parametrize(
    ("end", "at", "expected"),
    [
        ("ceiling", (0, 0, 2), ()),
        ("left", (-1.5, 0, 0), ("stone",)),  # across: it pulls sideways
        ("left", (-1.5, 0, 0.4), ()),
        ("left", (-1.5, 0, -0.4), ("stone",)),  # it pulls down
    ],
)
def test_a_tie_pulls_and_does_not_push(end, at, expected):
    assert named(rod(between("ceiling"), end, at)) == expected


def test_dowels_guides_and_bond_carry():
    model = between()
    side = next(one for one in model.interfaces if "left" in (one.block_i, one.block_j))
    assert named(reinforced(model, dowel(side, side.centroid, diameter=0.02, capacity=30e3))) == ()
    guided = replace(model, interfaces=[*model.interfaces, replace(side, joint=Guide(1e9))])
    assert named(guided) == ()
    assert named(between(joint=lb.OrdunaLourenco(0.6, cohesion=1e4))) == ()
    mortar = lb.OrdunaLourenco(0.6, cohesion=1e4, tensile_strength=1e4)
    assert named(between("ceiling", joint=mortar)) == ()


def test_the_lowest_of_stones_over_a_gap_is_named():
    """A stone that rests on it is carried, by it."""
    stones = [*between().blocks, lb.Block.box("upper", (1, 1, 1), (0, 0, 1), 20e3)]
    assert named(model_of(stones, ["left", "right"], DRY)) == ("stone",)


def test_what_hangs_is_named_and_what_leans_on_one_side_is_not():
    """Under a ceiling with nothing at its sides, and on a slope."""
    hung = [lb.Block.box("ceiling", (1, 1, 1), (0, 0, 1)), lb.Block.box("stone", (1, 1, 1), (0, 0, 0), 20e3)]
    assert named(model_of(hung, ["ceiling"], DRY)) == ("stone",)
    assert named(sloping(20e3, DRY, (1, 0, 0))) == ()


@pytest.mark.parametrize("seed", range(4))
def test_faces_lean_no_more_than_they_are_accurate(seed):
    """Of nine stones on a floor one is over a gap: found though its faces lean, drawn within 1 mm."""
    rng = np.random.default_rng(seed)
    stones = [lb.Block.box(f"stone {k}", (1, 1, 1), (k, 0, 0), 20e3) for k in range(11)]
    stones += [lb.Block.box(f"floor {k}", (1, 1, 1), (k, 0, -1)) for k in range(11) if k != 5]
    noisy = []
    for block in stones:
        corner = (block.vertices[:, [0, 2]] > block.centroid[[0, 2]]) @ [1, 2]  # of the four in X and Z
        off = rng.normal(0.0, 1e-3, (4, 2))[corner]
        moved = block.vertices + np.stack([off[:, 0], np.zeros(len(off)), off[:, 1]], axis=1)
        noisy.append(lb.Block(block.name, moved, block.faces, block.unit_weight))
    found = lb.geometry.find_contacts(noisy, DRY, gap=0.03)
    supports = ["stone 0", "stone 10", *(one.name for one in noisy if "floor" in one.name)]
    loads = (lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    model = lb.Model(noisy, supports, found.interfaces, *loads, tolerances=found.tolerances)
    assert uncarried(model, model.tolerances) == ("stone 5",)


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def test_the_command_line_says_it(tmp_path):
    for model, times in ((between(), 1), (between("floor"), 0)):
        file = model.save(tmp_path / f"{times}.json")
        for verb in ("info", "stability", "bounds"):
            done = run(verb, file)
            said = " ".join((done.stdout + done.stderr).split())
            assert ("against their dead load: stone; is a support or a lintel" in said) == bool(times), verb


@pytest.mark.parametrize("others", [(), ("floor",)])
def test_import_and_read_say_it(tmp_path, caplog, others):
    """It said that nothing was found."""
    model = between(*others)
    file = lb.files.write_blocks(model.blocks, tmp_path / "stones.obj")
    supports = [word for name in model.supports for word in ("--supports", name)]
    done = run("import", file, "--friction", 0.6, "--live", "1,0,0", "--unit-weight", "20e3", *supports)
    assert done.exit_code == 0, done.output
    assert (WORDS in done.stderr) == (not others)
    assert ("nothing found" in done.stderr) == bool(others)
    with caplog.at_level(logging.WARNING):
        lb.read(
            file, joint=DRY, supports=model.supports, unit_weight=20e3, live=lb.mass_proportional((1, 0, 0))
        )
    assert (WORDS in caplog.text) == (not others)


@pytest.mark.parametrize("others", [(), ("floor",)])
def test_no_convergence_names_it(others):
    means = [lb.settings.Means(lb.settings.Barrier(), seed=0, budget=1)]
    with pytest.raises(lb.NotConverged) as caught:
        lb.nonassociated(replace(between(*others), live=lb.mass_proportional((0, 1, 0))), means=means)
    assert (WORDS in " ".join(caught.value.__notes__)) == (not others)
