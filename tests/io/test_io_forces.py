"""Forces and displaced blocks for Rhino, COMPAS and glTF, read back by other programs: equilibrium."""

import json
from dataclasses import replace

import compas
import meshio
import numpy as np
import pytest
import rhino3dm
import trimesh
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app

ARCH = lb.structures.arch(lb.OrdunaLourenco(0.6), radius=5.0, thickness=0.8, voussoirs=7, embrace=2.8)
BOUNDS = lb.bounds(ARCH)
NAMES = [block.name for block in ARCH.blocks]
#: Of a block's weight: how exactly the bounds are in equilibrium.
BALANCED = 1e-5


def out_of_balance(acting):
    """Largest force, over the weight, and moment, over weight times size, left on a free block.

    `acting` has an entry an interface: block i, block j, point, force and moment of i on j.
    """
    worst = 0.0
    for block in ARCH.free_blocks:
        force = block.weight * np.array([BOUNDS.lower, 0.0, -1.0])
        moment = np.zeros(3)
        for i, j, point, vector, turning in acting:
            sign = (block.name == j) - (block.name == i) + 0.0
            force += sign * np.array(vector)
            moment += sign * (np.cross(np.subtract(point, block.centroid), vector) + turning)
        worst = max(
            worst, np.abs(force).max() / block.weight, np.abs(moment).max() / (block.weight * block.size)
        )
    return worst


def rhino(file):
    """Objects of a Rhino file by layer."""
    model = rhino3dm.File3dm.Read(str(file))
    layers = {layer.Index: layer.Name for layer in model.Layers}
    found = {}
    for item in model.Objects:
        found.setdefault(layers[item.Attributes.LayerIndex], []).append(item)
    return found


def xyz(point):
    return np.array([point.X, point.Y, point.Z])


def arrows(file):
    """What acts according to the arrows of a Rhino file, from their ends and scale alone, and the moments."""
    for item in rhino(file)["forces"]:
        if isinstance(item.Geometry, rhino3dm.LineCurve):
            text = dict(item.Attributes.GetUserStrings())
            tail, tip = xyz(item.Geometry.PointAtStart), xyz(item.Geometry.PointAtEnd)
            assert item.Attributes.ObjectDecoration == rhino3dm.ObjectDecoration.EndArrowhead
            assert item.Attributes.Name == f"{text['from block']}|{text['on block']}"
            force = (tip - tail) / float(text["scale, m/N"])
            assert force == pytest.approx([float(n) for n in text["force, N"].split(",")], rel=1e-9, abs=1e-6)
            moment = [float(n) for n in text["moment, N m"].split(",")]
            yield text["from block"], text["on block"], tail, force, moment


def test_rhino_has_three_layers_and_arrows_that_hold_every_block(tmp_path):
    file = lb.files.write_forces(ARCH, tmp_path / "arch.3dm", BOUNDS)
    found = rhino(file)
    assert set(found) == {"blocks", "displaced", "forces"}
    assert [item.Attributes.Name for item in found["blocks"]] == NAMES
    assert [item.Attributes.Name for item in found["displaced"]] == NAMES
    acting = list(arrows(file))
    assert len(acting) == len(ARCH.interfaces)
    assert out_of_balance(acting) < BALANCED
    acting[3] = (*acting[3][:3], 1.001 * acting[3][3], acting[3][4])
    assert out_of_balance(acting) > 10 * BALANCED


def test_the_longest_arrow_and_the_scale_that_is_said(tmp_path):
    diagonal = np.linalg.norm(np.ptp(np.concatenate([block.vertices for block in ARCH.blocks]), axis=0))
    for file, scale in (("own.3dm", None), ("given.3dm", 1e-4)):
        path = lb.files.write_forces(ARCH, tmp_path / file, BOUNDS, scale=scale)
        (dot,) = (i.Geometry for i in rhino(path)["forces"] if isinstance(i.Geometry, rhino3dm.TextDot))
        said = float(dot.Text.partition("1 m is ")[2].partition(" N")[0])
        lengths = [
            np.linalg.norm(xyz(i.Geometry.PointAtEnd) - xyz(i.Geometry.PointAtStart))
            for i in rhino(path)["forces"]
            if i.Geometry is not dot and isinstance(i.Geometry, rhino3dm.LineCurve)
        ]
        largest = np.linalg.norm(BOUNDS.stress_resultants[:, :3], axis=1).max()
        assert max(lengths) == pytest.approx(largest / said)
        if scale:
            assert said == pytest.approx(1.0 / scale)
        else:
            assert f"{said:e}"[0] in "125"
            assert 0.15 / 2.5 * diagonal < max(lengths) <= 0.15 * diagonal * (1 + 1e-12)


def test_compas_reads_blocks_displaced_blocks_and_forces(tmp_path):
    file = lb.files.write_forces(ARCH, tmp_path / "arch.json", BOUNDS)
    graph = compas.json_load(str(file)).graph
    nodes = list(graph.nodes())
    meshes = {word: [graph.node_attribute(node, word) for node in nodes] for word in ("block", "displaced")}
    assert [mesh.name for mesh in meshes["displaced"]] == NAMES
    acting = []
    for u, v in graph.edges():
        for one in graph.edge_attribute((u, v), "interfaces"):
            i, j = (graph.node_attribute(end, "block").name for end in (u, v))
            acting.append((i, j, one["point"], one["force"], one["moment"]))
            assert list(one["line"].vector) == pytest.approx(
                [graph.attributes["scale"] * part for part in one["force"]], rel=1e-9, abs=1e-9
            )
    assert len(acting) == len(ARCH.interfaces)
    assert out_of_balance(acting) < BALANCED
    # the mechanism moves centroids by its rates times the magnification, and volumes not at all
    for k, (mesh, block) in enumerate(zip(meshes["displaced"], ARCH.blocks, strict=True)):
        shift = np.array(mesh.centroid()) - np.array(meshes["block"][k].centroid())
        rates = BOUNDS.displacement_rates[k]
        assert mesh.volume() == pytest.approx(block.volume, rel=1e-9)
        if not rates[3:].any():
            assert shift == pytest.approx(graph.attributes["magnification"] * rates[:3], abs=1e-9)
    again = lb.files.read_blocks(file)
    assert [block.name for block in again.blocks] == NAMES
    assert again.supports == ARCH.supports
    assert np.array([b.centroid for b in again.blocks]) == pytest.approx(
        np.array([b.centroid for b in ARCH.blocks])
    )


def test_displaced_blocks_are_rigid_and_where_the_mechanism_takes_them(tmp_path):
    graph = compas.json_load(str(lb.files.write_forces(ARCH, tmp_path / "a.json", BOUNDS))).graph
    factor = graph.attributes["magnification"]
    for k, block in enumerate(ARCH.blocks):
        mesh = graph.node_attribute(k, "displaced")
        points = np.array([mesh.vertex_coordinates(v) for v in mesh.vertices()])
        v, w = factor * BOUNDS.displacement_rates[k].reshape(2, 3)
        angle = np.linalg.norm(w)
        axis = w / angle if angle else np.zeros(3)
        arm = block.vertices - block.centroid
        # Rodrigues' formula
        turned = (
            arm * np.cos(angle)
            + np.cross(axis, arm) * np.sin(angle)
            + np.outer(arm @ axis, axis) * (1 - np.cos(angle))
        )
        assert points == pytest.approx(block.centroid + v + turned, abs=1e-9)


def test_glb_has_arrows_as_closed_meshes_and_forces_in_extras(tmp_path):
    file = lb.files.write_forces(ARCH, tmp_path / "arch.glb", BOUNDS)
    data = file.read_bytes()
    document = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    scale = document["asset"]["extras"]["scale"]
    parents = {child: node["name"] for node in document["nodes"] for child in node.get("children", ())}
    groups = {}
    for k, node in enumerate(document["nodes"]):
        groups.setdefault(parents.get(k), []).append(node)
    assert [node["name"] for node in groups["blocks"]] == NAMES
    assert [node["name"] for node in groups["displaced"]] == NAMES
    said = [node["extras"] for node in groups["forces"]]
    acting = [(s["from_block"], s["on_block"], s["at"], s["force"], s["moment"]) for s in said]
    assert len(acting) == len(ARCH.interfaces)
    assert out_of_balance(acting) < BALANCED
    # by the meshes alone, in single precision: from the point of action to the tip
    scene = trimesh.load(file, file_type="glb")
    for node, extras in zip(groups["forces"], said, strict=True):
        transform, geometry = scene.graph.get(node["name"])
        shape = scene.geometry[geometry].copy().apply_transform(transform)
        merged = trimesh.Trimesh(shape.vertices, shape.faces)
        assert merged.is_watertight
        assert merged.volume > 0.0
        force, at = np.array(extras["force"]), np.array(extras["at"])
        points = np.column_stack([shape.vertices[:, 0], -shape.vertices[:, 2], shape.vertices[:, 1]])
        along = (points - at) @ (force / np.linalg.norm(force))
        assert along.min() == pytest.approx(0.0, abs=1e-5)
        assert along.max() == pytest.approx(scale * np.linalg.norm(force), abs=1e-5)


def test_results_that_cannot_be_written(tmp_path):
    stronger = replace(ARCH, dead=2.0 * ARCH.dead)  # the same blocks: the shapes fit
    for model, name, result, more, said in (
        (stronger, "a.3dm", BOUNDS, {}, "belongs to model"),
        (ARCH, "a.obj", BOUNDS, {}, r"takes no forces; expected one of \.3dm, \.json, \.glb, or \.vtu"),
        (ARCH, "a.glb", ARCH, {}, "no load_factor and no stress_resultants"),
        (ARCH, "a.json", BOUNDS, {"scale": 0.0}, "scale is 0 m/N"),
        (ARCH, "a.json", BOUNDS, {"scale": np.nan}, "scale"),
    ):
        with pytest.raises(lb.ModelError, match=said):
            lb.files.write_forces(model, tmp_path / name, result, **more)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "a.json").write_text("mine")
    with pytest.raises(lb.LimitBlocksError, match="exists"):
        lb.files.write_forces(ARCH, tmp_path / "a.json", BOUNDS)


@pytest.mark.parametrize("suffix", [".3dm", ".json", ".glb"])
def test_a_claim_without_mechanism_and_odd_names(tmp_path, suffix):
    names = {name: f"{name} \ud800\nö" for name in NAMES}
    renamed = lb.Model(
        [replace(block, name=names[block.name]) for block in ARCH.blocks],
        [names[name] for name in ARCH.supports],
        [replace(i, block_i=names[i.block_i], block_j=names[i.block_j]) for i in ARCH.interfaces],
        ARCH.dead,
        ARCH.live,
    )
    claim = lb.results.Claim(BOUNDS.lower, np.zeros_like(BOUNDS.stress_resultants))
    path = lb.files.write_forces(renamed, tmp_path / f"a{suffix}", claim)
    assert len(lb.files.read_blocks(path).blocks) == len(NAMES)  # neither displaced blocks nor arrows


def test_export_on_the_command_line(tmp_path):
    model, result = ARCH.save(tmp_path / "arch.json"), tmp_path / "bounds.json"
    lb.files.write_result(BOUNDS, result)

    def run(*arguments):
        return CliRunner().invoke(app, ["export", *map(str, arguments)])

    for suffix in (".3dm", ".glb", ".json", ".vtu"):
        file = tmp_path / f"out{suffix}"
        done = run(model, result, file)
        assert done.exit_code == 0, done.stderr
        assert done.stdout.split()[0] == str(file)
        assert file.exists()
    assert out_of_balance(list(arrows(tmp_path / "out.3dm"))) < BALANCED
    again = run(model, result, tmp_path / "out.3dm")
    assert again.exit_code == 2
    assert "replace it with --force" in again.stderr
    assert run(model, result, tmp_path / "out.3dm", "--force", "--scale", 1e-5).exit_code == 0
    other = replace(ARCH, dead=2.0 * ARCH.dead).save(tmp_path / "other.json")
    assert "belongs to model" in run(other, result, tmp_path / "b.3dm").stderr
    assert run(model, result, model, "--force").exit_code == 2  # what it reads


def test_a_load_path_is_exported_for_paraview_on_the_command_line(tmp_path):
    """A file a step with its load factor; each of the two suffixes was refused with the other one named."""
    model, result = ARCH.save(tmp_path / "arch.json"), tmp_path / "path.json"
    path = lb.load_path(ARCH)
    path.save(result)
    file = tmp_path / "out.pvd"
    done = CliRunner().invoke(app, ["export", *map(str, (model, result, file))])
    assert done.exit_code == 0, done.stderr
    steps = [meshio.read(tmp_path / f"out_{k:04d}.vtu").field_data for k in range(len(path.steps))]
    factors = [float(step["load_factor"][0]) for step in steps]
    assert factors == pytest.approx([step.load_factor for step in path.steps])
    wrong = CliRunner().invoke(app, ["export", *map(str, (model, result, tmp_path / "out.vtu"))])
    assert (wrong.exit_code, "expected .pvd" in wrong.stderr) == (2, True)
