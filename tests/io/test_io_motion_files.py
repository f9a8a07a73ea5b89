"""Results for ParaView and as glTF animations: read back by other programs and checked by mechanics."""

import json
import struct
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace

import meshio
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from stones import model_of

import limitblocks as lb
from limitblocks.evidence.load_path_result import LoadPath, PathStep
from limitblocks.practice import capacity_curve

JOINT = lb.OrdunaLourenco(0.6)
ARCH = lb.structures.arch(JOINT, radius=5.0, thickness=0.8, voussoirs=7, embrace=2.8)
BOUNDS = lb.bounds(ARCH)
DIAGONAL = np.linalg.norm(np.ptp(np.concatenate([block.vertices for block in ARCH.blocks]), axis=0))


@pytest.fixture(scope="module")
def path():
    """A path of three states on the way to a mechanism."""
    steps = []
    for share in (0.0, 0.5, 1.0):
        moved = share * BOUNDS.displacement_rates
        steps.append(PathStep(share * BOUNDS.lower, BOUNDS.stress_resultants, moved, (), {}, "step"))
    return LoadPath(tuple(steps), None)


def read_glb(path):
    """Document of a GLB file and the numbers of each of its accessors."""
    data = path.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    document, binary = json.loads(data[20 : 20 + length]), data[28 + length :]
    arrays = []
    for accessor in document["accessors"]:
        view = document["bufferViews"][accessor["bufferView"]]
        part = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        columns = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        arrays.append(
            np.frombuffer(part, {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]).reshape(-1, columns)
        )
        assert len(arrays[-1]) == accessor["count"]
    return document, arrays


def test_vtu_has_blocks_supports_and_the_mechanism(tmp_path):
    files = lb.files.write_vtu(ARCH, tmp_path / "arch.vtu", BOUNDS)
    assert [file.name for file in files] == ["arch.vtu", "arch_interfaces.vtu"]
    mesh = meshio.read(files[0])
    points = np.concatenate([block.vertices for block in ARCH.blocks])
    assert (mesh.points == points).all()
    moved = mesh.point_data["displacement"]
    factor = mesh.field_data["magnification"][0]
    rates = np.repeat(BOUNDS.displacement_rates, [len(block.vertices) for block in ARCH.blocks], axis=0)
    middles = np.repeat([b.centroid for b in ARCH.blocks], [len(b.vertices) for b in ARCH.blocks], axis=0)
    assert moved == pytest.approx(
        factor * (rates[:, :3] + np.cross(rates[:, 3:], points - middles)), abs=1e-12
    )
    largest = np.linalg.norm(moved, axis=1).max() / (0.08 * DIAGONAL)
    turn = factor * np.linalg.norm(rates[:, 3:], axis=1).max() / 0.25
    assert max(largest, turn) == pytest.approx(1.0)
    (cells,) = mesh.cells
    held = np.unique(cells.data[mesh.cell_data["support"][0] == 1])
    assert not moved[held].any()
    assert set(mesh.cell_data["block"][0].tolist()) == set(range(len(ARCH.blocks)))
    assert len(cells.data) == 6 * len(ARCH.blocks)


def test_forces_in_the_vtu_of_the_interfaces_hold_every_block(tmp_path):
    _, file = lb.files.write_vtu(ARCH, tmp_path / "arch.vtu", BOUNDS)
    mesh = meshio.read(file)
    force, number = mesh.cell_data["force"][0], mesh.cell_data["interface"][0]
    for block in ARCH.free_blocks:
        # block j exerts `force` on block i, and block i the opposite on block j
        held = sum(
            force[row]
            * ((ARCH.interfaces[k].block_i == block.name) - (ARCH.interfaces[k].block_j == block.name) + 0.0)
            for row, k in enumerate(number)
        )
        applied = block.weight * np.array([BOUNDS.lower, 0.0, -1.0])
        assert held + applied == pytest.approx(np.zeros(3), abs=1e-5 * block.weight)
    assert (mesh.cell_data["N"][0] <= 0.0).all()


def test_vtu_of_a_model_alone_and_of_a_claim_without_mechanism(tmp_path):
    file, interfaces = lb.files.write_vtu(ARCH, tmp_path / "alone.vtu")
    assert meshio.read(file).point_data == {}
    assert list(meshio.read(interfaces).cell_data) == ["interface"]
    claim = lb.results.Claim(BOUNDS.lower, BOUNDS.stress_resultants)
    file, interfaces = lb.files.write_vtu(ARCH, tmp_path / "claim.vtu", claim)
    assert meshio.read(file).point_data == {}
    assert meshio.read(interfaces).cell_data["N"][0] == pytest.approx(BOUNDS.stress_resultants[:, 2])


def test_load_path_is_a_collection_of_states(path, tmp_path):
    files = lb.files.write_vtu(ARCH, tmp_path / "path.pvd", path)
    sets = ET.parse(files[0]).getroot().findall("Collection/DataSet")
    assert [(one.get("timestep"), one.get("part")) for one in sets] == [
        (str(k), str(p)) for k in range(3) for p in (0, 1)
    ]
    assert {one.get("file") for one in sets} == {file.name for file in files[1:]}
    meshes = [meshio.read(tmp_path / one.get("file")) for one in sets[::2]]
    moved = [mesh.point_data["displacement"] for mesh in meshes]
    assert not moved[0].any()
    assert moved[1] == pytest.approx(moved[2] / 2.0)  # one factor for all
    assert meshes[1].field_data["load_factor"][0] == pytest.approx(BOUNDS.lower / 2.0)


def test_animation_of_a_capacity_curve_has_its_true_places(tmp_path):
    """A block that rocks: the corner above its toe goes d = h sin(angle), the centroid on a circle."""
    b, h = 0.2, 1.0
    model = lb.structures.block(lb.PointContact(0.6), width=b, height=h)
    corner = max(model.free_blocks[0].vertices.tolist(), key=lambda at: at[0] + at[2])
    curve = capacity_curve(model, control=("block 1", corner), steps=3)
    document, arrays = read_glb(lb.files.write_animation(model, tmp_path / "curve.glb", curve))
    (animation,) = document["animations"]
    names = [node.get("name") for node in document["nodes"]]
    found = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        assert names[channel["target"]["node"]] == "block 1"
        found[channel["target"]["path"]] = arrays[sampler["output"]]
    angles = np.arcsin(np.concatenate([[0.0], curve.displacements]) / h)
    turns = 2 * np.arccos(np.clip(np.abs(found["rotation"][:, 3]), 0, 1))
    assert turns == pytest.approx(angles, abs=1e-3)  # single precision
    start = np.arctan2(h / 2, -b / 2) - angles  # of the centroid, seen from the toe
    arm = np.hypot(b, h) / 2
    x, y = found["translation"][:, 0], found["translation"][:, 1]
    assert x - x[0] == pytest.approx(arm * (np.cos(start) - np.cos(start[0])), abs=1e-6)
    assert y - y[0] == pytest.approx(arm * (np.sin(start) - np.sin(start[0])), abs=1e-6)
    with pytest.raises(lb.errors.ModelError, match="belongs to model"):
        lb.files.write_animation(ARCH, tmp_path / "other.glb", curve)


def test_animation_turns_blocks_about_their_centroids(path, tmp_path):
    for result, frames in ((BOUNDS, 2), (path, 4)):
        document, arrays = read_glb(lb.files.write_animation(ARCH, tmp_path / f"{frames}.glb", result))
        (animation,) = document["animations"]
        tracks = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            times, values = arrays[sampler["input"]].ravel(), arrays[sampler["output"]]
            assert len(times) == len(values) == frames
            assert times[0] == 0.0
            assert (np.diff(times) > 0.0).all()
            tracks[channel["target"]["node"], channel["target"]["path"]] = values
        moving = {node for node, _ in tracks}
        assert {ARCH.blocks[k].name for k in moving}.isdisjoint(ARCH.supports)
        factor = meshio.read(lb.files.write_vtu(ARCH, tmp_path / f"{frames}.vtu", BOUNDS)[0]).field_data[
            "magnification"
        ][0]
        for k in moving:
            block, rate = ARCH.blocks[k], factor * BOUNDS.displacement_rates[k]
            places, turns = tracks[k, "translation"], tracks[k, "rotation"]
            assert np.linalg.norm(turns, axis=1) == pytest.approx(np.ones(frames), abs=1e-6)
            assert turns[0] == pytest.approx([0, 0, 0, 1])
            x, y, z = block.centroid - ARCH.blocks[0].centroid
            assert places[0] == pytest.approx([x, z, -y], abs=1e-5)  # Y up
            u, v, w = rate[:3]
            assert places[-1] - places[0] == pytest.approx([u, w, -v], abs=1e-5)
            wx, wy, wz = rate[3:]
            assert Rotation.from_quat(turns[-1]).as_rotvec() == pytest.approx([wx, wz, -wy], abs=1e-6)


def test_animation_far_from_the_origin_moves_as_near_it(tmp_path):
    """Tracks have single precision: 0.5 m of a northing, but all digits about a node that has it."""
    offset = np.array([512345.0, 5398765.0, 312.0])  # m
    tracks = []
    for name, at in (("near", np.zeros(3)), ("far", offset)):
        blocks = [lb.Block(b.name, b.vertices + at, b.faces, b.unit_weight) for b in ARCH.blocks]
        model = replace(ARCH, blocks=blocks, interfaces=lb.find_interfaces(blocks, JOINT))
        moves = lb.results.Claim(1.0, BOUNDS.stress_resultants, BOUNDS.displacement_rates)
        file = lb.files.write_animation(model, tmp_path / f"{name}.glb", moves)
        document, arrays = read_glb(file)
        places = (s["output"] for s in document["animations"][0]["samplers"])
        tracks.append(np.concatenate([arrays[place].ravel() for place in places]))
        read = lb.files.read_blocks(file).blocks
        assert [block.name for block in read] == [block.name for block in blocks]
        middles = [[block.centroid for block in some] for some in (read, blocks)]
        assert np.allclose(*middles, rtol=0.0, atol=1e-6)
    assert np.allclose(*tracks, atol=1e-6)


def test_wrong_results_and_suffixes_are_refused(path, tmp_path):
    small = lb.structures.portal(JOINT, span=2.0, pier_width=0.6, pier_blocks=2)
    stronger = replace(ARCH, dead=2.0 * ARCH.dead)  # the same blocks: the shapes fit
    claim = lb.results.Claim(1.0, BOUNDS.stress_resultants)
    moving = lb.results.Claim(1.0, BOUNDS.stress_resultants, BOUNDS.displacement_rates)
    refused = [
        (lb.files.write_vtu, ARCH, "a.vtk", BOUNDS, "expected .vtu"),
        (lb.files.write_vtu, ARCH, "a.vtu", path, "expected .pvd"),
        (lb.files.write_vtu, ARCH, "a.pvd", BOUNDS, "expected .vtu"),
        (lb.files.write_vtu, small, "a.vtu", BOUNDS, "belongs to model"),
        (lb.files.write_vtu, stronger, "a.vtu", BOUNDS, "belongs to model"),
        (lb.files.write_animation, stronger, "a.glb", BOUNDS, "belongs to model"),
        (lb.files.write_vtu, small, "a.vtu", claim, "stress resultants"),
        (lb.files.write_animation, ARCH, "a.gltf", BOUNDS, "expected .glb"),
        (lb.files.write_animation, ARCH, "a.glb", claim, "no displacement rates"),
        (lb.files.write_animation, small, "a.glb", moving, "the model has"),
    ]
    for write, model, name, result, said in refused:
        with pytest.raises(lb.ModelError, match=said):
            write(model, tmp_path / name, result)
    assert list(tmp_path.iterdir()) == []


def test_results_of_others_are_not_overwritten(path, tmp_path):
    mine = tmp_path / "path_0001.vtu"
    mine.write_text("mine")
    with pytest.raises(lb.LimitBlocksError, match=r"path_0001\.vtu exists"):
        lb.files.write_vtu(ARCH, tmp_path / "path.pvd", path)
    assert [file.name for file in tmp_path.iterdir()] == [mine.name]  # nothing is written by halves
    lb.files.write_vtu(ARCH, tmp_path / "path.pvd", path, overwrite=True)
    assert mine.read_text() != "mine"


@pytest.mark.parametrize(
    ("package", "suffix", "write"),
    [
        ("trimesh", ".glb", lambda file: lb.files.write_blocks(ARCH, file)),
        ("trimesh", ".glb", lambda file: lb.files.write_animation(ARCH, file, BOUNDS)),
        ("meshio", ".vtu", lambda file: lb.files.write_vtu(ARCH, file, BOUNDS)),
    ],
)
def test_without_the_packages_of_the_extra_meshes(package, suffix, write, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(
        lb.errors.MissingDependency,
        match=rf"the package {package} is missing; install it by: pip install '{package}>=",
    ):
        write(tmp_path / f"a{suffix}")
    assert list(tmp_path.iterdir()) == []


def test_cells_stay_in_order_where_faces_have_different_numbers_of_corners(tmp_path):
    joint = lb.PointContact(0.6)
    prism = lb.Block(
        "prism",
        [(x, y, z) for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (0, 1))],
        [(2, 1, 0), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
        1.0,
    )
    blocks = [lb.Block.box("ground", (1, 1, 1), (0.5, 0.5, -0.5)), prism]
    model = model_of(blocks, ["ground"], joint)
    mesh = meshio.read(lb.files.write_vtu(model, tmp_path / "two.vtu")[0])
    cells = [tuple(cell) for run in mesh.cells for cell in run.data.tolist()]
    starts = {"ground": 0, "prism": 8}
    assert cells == [tuple(v + starts[b.name] for v in face) for b in blocks for face in b.faces]
    assert np.concatenate(mesh.cell_data["block"]).tolist() == [0] * 6 + [1] * 5


def test_nodes_keep_names_that_are_repeated_or_of_the_format(tmp_path):
    names = ["world", "a", "a", "0", "Stöne"]
    boxes = [lb.Block.box(name, (1, 1, 1), (2 * k, 0, 0)) for k, name in enumerate(names)]
    document, _ = read_glb(lb.files.write_blocks(boxes, tmp_path / "a.glb"))
    assert [node["name"] for node in document["nodes"]] == names
    assert [node["translation"][0] for node in document["nodes"]] == [0, 2, 4, 6, 8]
    assert not any("matrix" in node for node in document["nodes"])  # or no animation may move them
