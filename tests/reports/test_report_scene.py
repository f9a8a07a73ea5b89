import json
import re
import sys
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks.drawing.chains import chains, joints_between
from limitblocks.drawing.view import towards
from limitblocks.evidence.interface_states import interface_states
from limitblocks.practice import passive_fill, reinforced, tie
from limitblocks.reports import assets, files
from limitblocks.reports.interfaces import MOST, active_interfaces, interface_rows
from limitblocks.reports.scene import scene, short, without_noise

JOINT = lb.OrdunaLourenco(0.6)
FOLDER = assets.FOLDER / "viewer"


@pytest.fixture(scope="module")
def arch():
    return lb.structures.arch(JOINT, radius=2.0, thickness=0.4, voussoirs=9)


@pytest.fixture(scope="module")
def results(arch):
    return lb.bounds(arch), lb.load_path(arch)


@pytest.fixture(scope="module")
def shown(arch, results):
    return json.loads(json.dumps(scene(arch, results, "arch"), allow_nan=False))


def rows(values, size):
    return np.array([np.nan if v is None else v for v in values], dtype=float).reshape(-1, size)


def test_scene_holds_the_geometry(arch, shown):
    blocks = shown["blocks"]
    assert blocks["name"] == [block.name for block in arch.blocks]
    assert [blocks["name"][k] for k in blocks["support"]] == list(arch.supports)
    centroids = rows(blocks["centroid"], 3) + shown["origin"]
    for block, centroid, kind in zip(arch.blocks, centroids, blocks["shape"], strict=True):
        shape = shown["shapes"][kind]
        assert np.allclose(centroid + rows(shape["vertices"], 3), block.vertices, atol=1e-5)
        assert [tuple(face) for face in shape["faces"]] == list(block.faces)
    outlines = [shown["outlines"][k] for k in shown["interfaces"]["outline"]]
    for interface, outline in zip(arch.interfaces, outlines, strict=True):
        assert np.allclose(rows(outline["corners"], 3), interface.polygon @ interface.axes[:2], atol=1e-5)
        assert np.allclose(rows(outline["axes"], 3), interface.axes, atol=1e-5)


def test_a_survey_far_from_the_origin_is_the_same_picture():
    """Six digits of a northing are 10 m, and WebGL draws with seven: the picture counts from its middle."""

    def stones(offset):
        boxes = [((4.0, 1.0, 0.2), (0.0, 0.0, -0.1)), ((0.5, 1.0, 2.0), (0.125, 0.0, 1.0))]
        blocks = [lb.Block.box(str(k), size, np.add(at, offset), 20e3) for k, (size, at) in enumerate(boxes)]
        return model_of(blocks, ["0"], JOINT)

    offset = np.array([512345.0, 5398765.0, 312.0])  # m
    near, far = stones(np.zeros(3)), stones(offset)
    pictures = [scene(model, (), "") for model in (near, far)]
    assert np.subtract(*(one.pop("origin") for one in reversed(pictures))).tolist() == offset.tolist()
    assert pictures[0] == pictures[1]
    here, there = (interface_rows(model, lb.bounds(model))[0]["centre_of_pressure"] for model in (near, far))
    assert np.allclose(np.subtract(there, here), offset, rtol=0.0, atol=1e-5)


def test_blocks_of_one_shape_share_it():
    model = lb.structures.wall(JOINT, length=4.0, courses=6)
    shown = scene(model, (), "wall")
    assert len(shown["shapes"]) == 3  # whole and half blocks, and the base
    assert len(shown["outlines"]) < 10 < len(model.interfaces)


def test_scene_holds_forces_and_states_of_collapse(arch, results, shown):
    for result, one in zip(results, shown["results"], strict=True):
        states = interface_states(arch, result)
        last = one["steps"][-1]
        Q = rows(last["stress_resultants"], 6)
        scale = np.abs(states.stress_resultants).max()
        assert np.allclose(Q, states.stress_resultants, rtol=1e-5, atol=1e-6 * scale)
        assert [shown["states"][k] for k in last["states"]] == list(states.state)
        assert np.allclose(last["utilisation"], states.utilisation, atol=1e-4)
        # force and centre of pressure as the viewer makes them of Q, in the convention of Fig. 10
        axes = np.array([interface.axes for interface in arch.interfaces])
        assert np.allclose(-np.einsum("ma,mab->mb", Q[:, :3], axes), states.force, atol=1e-4 * scale)
        e = np.stack([-Q[:, 4], Q[:, 3]], axis=1) / Q[:, 2:3]
        centre = states.centroid + np.einsum("ma,mab->mb", e, axes[:, :2])
        assert np.allclose(centre, states.centre_of_pressure, atol=1e-4)


def test_load_path_has_its_steps_and_long_ones_are_thinned_out(arch, results, shown, monkeypatch):
    path = results[1]
    steps = shown["results"][1]["steps"]
    assert len(steps) == len(path.steps)
    for step, given in zip(path.steps, steps, strict=True):
        assert f"{step.load_factor:.6g}" in given["label"]
        size = np.abs(step.displacements).max()
        assert np.allclose(rows(given["displacements"], 6), step.displacements, atol=1e-3 * size)
    monkeypatch.setattr(sys.modules[scene.__module__], "MOST_NUMBERS", 1)
    thin = scene(arch, results, "arch")["results"][1]["steps"]
    last = len(path.steps) - 1
    assert [step["label"].split(":")[0] for step in thin] == [f"step 0 of {last}", f"step {last} of {last}"]


def test_largest_movement_is_drawn_at_eight_hundredths_of_the_size(arch, results, shown):
    one = shown["results"][0]
    rates = rows(one["steps"][0]["displacements"], 6) * one["magnification"]
    corners = np.concatenate([block.vertices for block in arch.blocks])
    moved = max(
        np.linalg.norm(rate[:3] + np.cross(rate[3:], block.vertices - block.centroid), axis=1).max()
        for block, rate in zip(arch.blocks, rates, strict=True)
    )
    assert moved <= 0.08 * np.linalg.norm(np.ptp(corners, axis=0)) * (1 + 1e-3)
    assert np.abs(rates[:, 3:]).max() <= 0.25 * (1 + 1e-3)


def test_the_viewer_looks_from_the_side_to_which_the_mechanism_moves(arch, results, shown):
    for result, one in zip(results, shown["results"], strict=True):
        moved = getattr(result, "collapse", result).displacement_rates
        assert one["eye"] == pytest.approx(towards(arch, moved), abs=1e-5)
    assert shown["eye"] == pytest.approx(towards(arch), abs=1e-5)


def test_thrust_line_runs_from_support_to_support(arch):
    (chain,) = chains(arch)
    assert len(chain) == len(arch.interfaces)
    ends = [{arch.interfaces[k].block_i, arch.interfaces[k].block_j} for (k,) in chain]
    assert all(one & other for one, other in pairwise(ends))
    assert ends[0] & set(arch.supports)
    assert ends[-1] & set(arch.supports)


def test_only_chains_have_a_thrust_line():
    assert chains(lb.structures.wall(JOINT, length=2.0, courses=3)) == []
    (column,) = chains(lb.structures.column(JOINT, count=4, width=1.0, height=1.0))
    assert len(column) == 4


@pytest.mark.parametrize("step", [0.0, 0.2])
def test_pieces_of_a_joint_in_one_plane_are_one_of_a_chain(step):
    """Two stones, the upper one on two feet of the lower, the second of them higher by a step."""
    low = [(0, 0), (3, 0), (3, 1 + step), (2, 1 + step), (2, 0.5), (1, 0.5), (1, 1), (0, 1)]
    high = [(0, 1), *([(1, 1), (1, 1 + step)] if step else []), (3, 1 + step), (3, 2), (0, 2)]
    stones = [
        lb.Block.box("ground", (5.0, 1.0, 1.0), (1.5, 0.5, -0.5)),
        lb.Block.prism("low", low, (0.0, 1.0), 20e3),
        lb.Block.prism("high", high, (0.0, 1.0), 20e3),
    ]
    model = model_of(stones, ["ground"], JOINT)
    named = [
        [k for k, one in enumerate(model.interfaces) if one.name == name]
        for name in ("ground|low", "low|high")
    ]
    expected = [] if step else [named]
    assert scene(model, [], "stones")["chains"] == [[tuple(joint) for joint in chain] for chain in expected]


@pytest.mark.parametrize(
    ("turn", "lift", "count"), [(0.0, 0.0, 1), (5e-3, 5e-3, 1), (0.1, 0.0, 2), (0.0, 0.1, 2)]
)
def test_pieces_are_in_one_plane_as_near_as_faces_that_touch(turn, lift, count):
    """Two areas 1 m apart along s1, one of them turned about it and lifted."""
    turned = np.array([(1, 0, 0), (0, np.cos(turn), np.sin(turn)), (0, -np.sin(turn), np.cos(turn))])
    square = np.array([(0.2, -0.2), (0.2, 0.2), (-0.2, 0.2), (-0.2, -0.2)])
    one = lb.Interface("a", "b", np.zeros(3), np.eye(3), square, JOINT)
    other = lb.Interface("a", "b", np.array([1.0, 0.0, lift]), turned, square, JOINT)
    assert len(joints_between(SimpleNamespace(interfaces=(one, other)))) == count


def test_ties_and_fill_leave_a_thrust_line(arch):
    first, last = arch.free_blocks[0], arch.free_blocks[-1]
    rod = tie(first.name, first.centroid, last.name, last.centroid, area=1e-4, strength=235e6)
    fill = passive_fill(arch, 3.0, unit_weight=18e3, coefficient=3.0)
    assert chains(reinforced(arch, rod, *fill)) == chains(arch)


def test_numbers_are_short_and_noise_is_zero():
    assert short([1.0, 1e-12, np.nan, 1.23456789, -2e5], 1e-7) == [1, 0, None, 1.23457, -200000]
    Q = np.array([[1e3, 0.0, -1e-6, 1e-6, 0.0, 2.0], [0.0, 1e-3, 0.0, 0.0, 1e-8, 0.0]])
    expected = [[1e3, 0.0, 0.0, 1e-6, 0.0, 2.0], [0.0, 1e-3, 0.0, 0.0, 0.0, 0.0]]
    assert without_noise(Q).tolist() == expected


def test_interfaces_that_stick_are_left_out_and_those_that_move_most_come_first(arch, results):
    states = interface_states(arch, results[0])
    table = active_interfaces(arch, results[0])
    moving = {name for name, word in zip(states.names, states.state, strict=True) if word != "stick"}
    assert {row[0].text for row in table.rows} == moving
    assert table.active == len(moving) <= MOST
    keys = [(-round(row[2].value, 3), -round(row[3].value, 3)) for row in table.rows]  # moves, utilisation
    assert keys == sorted(keys)
    assert table.rows[0][2].value == 1.0
    assert active_interfaces(arch, lb.check_mcp(arch, results[1].collapse)) is None
    assert [row["name"] for row in interface_rows(arch, results[0])] == list(states.names)


def test_pieces_of_a_joint_are_told_apart_by_where_they_are():
    """A stone that slides on two feet, 1 m apart."""
    outline = [(-0.6, 0), (-0.4, 0), (-0.4, 1), (0.4, 1), (0.4, 0), (0.6, 0), (0.6, 1.2), (-0.6, 1.2)]
    ground = lb.Block.box("ground", (3.0, 1.0, 0.2), (0.0, 0.0, -0.1))
    stones = [ground, lb.Block.prism("stone", outline, (-0.2, 0.2), 20e3)]
    model = model_of(stones, ["ground"], lb.PointContact(0.2))
    bounds = lb.bounds(model)
    names = sorted(row[0].text for row in active_interfaces(model, bounds).rows)
    assert names == ["ground|stone at (-0.5, 0, 0) m", "ground|stone at (0.5, 0, 0) m"]
    assert sorted(row["centroid"][0] for row in interface_rows(model, bounds)) == [-0.5, 0.5]
    rows = interface_states(model, bounds).rows()
    assert np.allclose(sorted(row["centroid_X"] for row in rows), [-0.5, 0.5])


def test_viewer_uses_only_what_its_bundle_has():
    entry = (Path(__file__).parents[2] / "scripts" / "three" / "entry.js").read_text(encoding="utf-8")
    own = assets.scripts()[1]
    assert set(re.findall(r"\bTHREE\.(\w+)", own)) == set(re.findall(r"^  (\w+),$", entry, re.MULTILINE)) | {
        "OrbitControls"
    }


def test_bundle_comes_with_its_version_and_licence():
    package = json.loads((Path(__file__).parents[2] / "scripts" / "three" / "package.json").read_text())
    three = assets.scripts()[0]
    assert f"three.js {package['dependencies']['three']}, MIT" in three
    assert "Permission is hereby granted, free of charge" in three
    assert "three.js authors" in three


def test_all_scripts_are_in_the_page():
    own = {file.stem for file in FOLDER.glob("*.js")} - {"three.min"}
    for name in own:
        assert (FOLDER / f"{name}.js").read_text(encoding="utf-8") in assets.scripts()[1]
    assert len(own) > 10
    assert set(files.MARKS) == {".html", ".json", ".md", ".pdf"}
