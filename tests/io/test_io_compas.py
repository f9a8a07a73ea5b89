"""COMPAS JSON: what COMPAS itself writes and reads, and documents in the layouts of its masonry packages."""

import json

import compas
import numpy as np
import pytest
from compas.datastructures import Assembly, Graph, Mesh, Part
from compas.geometry import Box, Frame, Polyhedron, Rotation, Transformation, Translation
from compas_documents import (
    CUBES,
    assembly_document,
    compas_1_document,
    mesh_data,
    model_document,
    network_document,
    old_model_document,
    written,
)
from dxf_files import JOINT, STRUCTURES
from reading import fault

import limitblocks as lb


def dumped(path, value):
    compas.json_dump(value, str(path))
    return path


@pytest.mark.parametrize("name", STRUCTURES)
def test_the_same_blocks_give_the_same_file(tmp_path, name):
    one, other = (lb.files.write_blocks(STRUCTURES[name], tmp_path / f"{word}.json") for word in "ab")
    assert one.read_bytes() == other.read_bytes()


def test_read_makes_a_model_with_the_supports_of_the_file(tmp_path):
    model = STRUCTURES["arch"]
    path = lb.files.write_blocks(model, tmp_path / "arch.json")
    again = lb.read(path, joint=JOINT, unit_weight=20e3, live=model.live)
    assert again.supports == model.supports
    assert lb.bounds(again).lower == pytest.approx(lb.bounds(model).lower, rel=1e-6)
    model.save(tmp_path / "model.json")
    assert lb.read(tmp_path / "model.json").digest == model.digest
    assert "is a model file" in fault(tmp_path / "model.json")


def test_compas_reads_what_is_written(tmp_path):
    model = STRUCTURES["arch"]
    assembly = compas.json_load(str(lb.files.write_blocks(model, tmp_path / "a.json")))
    assert isinstance(assembly, Assembly)
    assert [part.name for part in assembly.parts()] == [block.name for block in model.blocks]
    for node, block in zip(assembly.graph.nodes(), model.blocks, strict=True):
        mesh = assembly.graph.node_attribute(node, "block")
        assert isinstance(mesh, Mesh)
        assert mesh.is_manifold()
        assert mesh.volume() == pytest.approx(block.volume, rel=1e-9)
        assert assembly.graph.node_attribute(node, "is_support") == (block.name in model.supports)
        assert mesh.name == block.name


def test_what_compas_writes(tmp_path):
    meshes = [Mesh.from_shape(cube) for cube in CUBES]
    graph = Graph()
    for k, mesh in enumerate(meshes):
        graph.add_node(k, block=mesh, is_support=k == 0)
    polyhedron = Polyhedron(*CUBES[1].to_vertices_and_faces())
    for k, value in enumerate((meshes, CUBES, {"supports": meshes[:1], "stones": [polyhedron]}, graph)):
        imported = lb.files.read_blocks(dumped(tmp_path / f"{k}.json", value))
        assert [block.volume for block in imported.blocks] == pytest.approx([1.0, 1.0], rel=1e-12)
        assert [block.centroid[2] for block in imported.blocks] == pytest.approx([0.5, 1.5], rel=1e-12)
        assert len(imported.supports) == (k >= 2)


def test_assembly_of_parts_that_hold_their_shape(tmp_path):
    assembly = Assembly()
    frame = Frame([3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0])  # turned by 90 degrees about z
    box = Mesh.from_shape(Box(4.0, 1.0, 2.0))
    assembly.add_part(Part(name="beam", frame=frame, shape=box))
    block = lb.files.read_blocks(dumped(tmp_path / "a.json", assembly)).blocks[0]
    assert block.name == "beam"
    assert np.ptp(block.vertices, axis=0) == pytest.approx([1.0, 4.0, 2.0])
    assert block.centroid == pytest.approx([3.0, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("make", [assembly_document, old_model_document, compas_1_document, network_document])
def test_layouts(tmp_path, make):
    imported = lb.files.read_blocks(written(tmp_path / "a.json", make()))
    assert [block.name for block in imported.blocks] == ["block 0", "block 1"]
    assert [block.volume for block in imported.blocks] == pytest.approx([1.0, 1.0], rel=1e-12)
    assert imported.supports == ("block 0",)
    assert imported.layers == {"block 0": "support", "block 1": "block"}
    assert len(lb.find_interfaces(imported.blocks, JOINT)) == 1


def older_mesh(k):
    """COMPAS before 0.19: "datatype" and no "dtype"."""
    return {"datatype": "compas.datastructures/Mesh", "data": mesh_data(k)["data"]}


WITHOUT_DTYPE = {
    "network": network_document(),
    "meshes": [mesh_data(k)["data"] for k in range(2)],
    "by name": {"supports": [mesh_data(0)["data"]], "stones": [mesh_data(1)["data"]]},
    "polyhedra": [
        {"vertices": block.vertices.tolist(), "faces": block.faces}
        for block in (lb.Block.box("s", (1.0, 1.0, 1.0), (0.0, 0.0, k + 0.5)) for k in range(2))
    ],
    "datatype": {"supports": older_mesh(0), "stone": older_mesh(1)},
}


@pytest.mark.parametrize("layout", WITHOUT_DTYPE)
def test_files_without_dtype_are_of_compas_to_everything_that_reads(tmp_path, layout):
    path = written(tmp_path / "a.json", WITHOUT_DTYPE[layout])
    names = [block.name for block in lb.files.read_blocks(path).blocks]
    assert len(names) == 2
    assert [block.name for block in lb.files.look(path).blocks] == names
    made = {"supports": names[:1], "unit_weight": 2e4, "live": lb.mass_proportional((1.0, 0.0, 0.0))}
    model = lb.read(path, joint=JOINT, **made)
    assert [block.name for block in model.blocks] == names
    assert len(model.interfaces) == 1


@pytest.mark.parametrize("lost", ["schema_version", "interfaces", "live"])
def test_a_model_file_that_lacks_a_key_is_one(tmp_path, lost):
    """Its blocks have vertices and faces, as polyhedra of COMPAS do."""
    document = STRUCTURES["wall"].to_dict()
    del document[lost]
    for read in (lb.read, lb.files.look):
        assert f"{lost}: is missing" in fault(written(tmp_path / "a.json", document), read)


def test_transformations_of_a_model(tmp_path):
    imported = lb.files.read_blocks(
        written(tmp_path / "a.json", model_document()), unit_weight={"LIMESTONE": 22e3}
    )
    assert imported.supports == ("block 0",)
    assert set(imported.layers.values()) == {"LIMESTONE"}
    # the model turns by 90 degrees what its group and the element itself moved by 10 each
    assert imported.blocks[1].centroid == pytest.approx([0.0, 20.0, 1.5], abs=1e-9)
    assert imported.blocks[1].weight == pytest.approx(22e3, rel=1e-12)


def test_box_in_a_frame(tmp_path):
    turn = Frame([1.0, 2.0, 3.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0])
    box = Box(2.0, 3.0, 4.0, turn)
    block = lb.files.read_blocks(dumped(tmp_path / "a.json", box)).blocks[0]
    wanted = sorted(np.round([list(vertex) for vertex in box.to_vertices_and_faces()[0]], 9).tolist())
    assert sorted(np.round(block.vertices, 9).tolist()) == wanted


def test_transformations_as_compas_makes_them(tmp_path):
    """The product of compas itself against ours, for a general one."""
    matrix = Translation.from_vector([1.0, 2.0, 3.0]) * Rotation.from_axis_and_angle([1.0, 2.0, 3.0], 0.7)
    document = model_document()
    data = json.loads(compas.json_dumps(Transformation(matrix.matrix)))
    document["data"]["elements"]["e0"]["data"]["transformation"] = data
    document["data"]["transformation"] = None
    block = lb.files.read_blocks(written(tmp_path / "a.json", document)).blocks[0]
    mesh = Mesh.from_shape(CUBES[0]).transformed(matrix)
    assert block.centroid == pytest.approx(list(mesh.centroid()), abs=1e-9)
    assert mesh.volume() == pytest.approx(block.volume, rel=1e-9)


def without_guids(value):
    """A document as compas.json_dump(..., minimal=True) writes it."""
    if isinstance(value, list):
        return [without_guids(part) for part in value]
    if not isinstance(value, dict):
        return value
    left = ("guid", "name") if "dtype" in value else ()
    return {key: without_guids(part) for key, part in value.items() if key not in left}


@pytest.mark.parametrize("make", [model_document, old_model_document])
def test_models_without_guids_have_all_their_elements(tmp_path, make):
    whole = lb.files.read_blocks(written(tmp_path / "a.json", make()))
    found = lb.files.read_blocks(written(tmp_path / "b.json", without_guids(make())))
    assert [block.volume for block in found.blocks] == pytest.approx([1.0, 1.0], rel=1e-12)
    for block, same in zip(found.blocks, whole.blocks, strict=True):
        assert block.centroid == pytest.approx(same.centroid, abs=1e-12)
    assert found.supports == ("block 0",)


def test_groups_of_elements_that_no_guid_tells_are_refused(tmp_path):
    document = without_guids(model_document())
    document["data"]["elements"] = list(document["data"]["elements"].values())
    assert "save the model without minimal=True" in fault(written(tmp_path / "a.json", document))
    document = old_model_document()
    document["data"]["elements"][1]["guid"] = "e0"
    assert "two elements have the guid 'e0'" in fault(written(tmp_path / "b.json", document))


@pytest.mark.parametrize("make", [assembly_document, model_document, network_document])
def test_all_blocks_of_what_stands_under_a_key_that_says_supports_are_supports(tmp_path, make):
    """An assembly as well as a mesh: the second block of it, which it does not mark, was free."""
    stone = mesh_data(1, name="stone")
    found = lb.files.read_blocks(written(tmp_path / "a.json", {"supports": make(), "stones": [stone]}))
    assert len(found.blocks) == 3
    assert [block.name for block in found.blocks if block.name not in found.supports] == ["stone"]
    given = "LIMESTONE" if make is model_document else "support"
    assert list(found.layers.values()) == [given, given, "block"]
