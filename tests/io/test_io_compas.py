"""COMPAS JSON: what COMPAS itself writes and reads, and documents in the layouts of its masonry packages."""

import copy
import json
import random

import compas
import numpy as np
import pytest
from compas.datastructures import Assembly, Graph, Mesh, Part
from compas.geometry import Box, Frame, Polyhedron, Rotation, Transformation, Translation

import limitblocks as lb
from limitblocks.geometry.polygon import areas

JOINT = lb.OrdunaLourenco(0.6)
STRUCTURES = {
    "arch": lb.structures.arch(JOINT, radius=2.0, thickness=0.3, voussoirs=9, depth=0.5),
    "wall": lb.structures.wall(JOINT, length=1.6, courses=3, thickness=0.2),
    "facade": lb.structures.facade(JOINT, courses=2, openings=()),
}
CUBES = [Box(1.0, 1.0, 1.0, Frame([0.0, 0.0, k + 0.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])) for k in range(2)]


def total_area(interfaces):
    return float(sum(areas(interface.polygon[None])[0] for interface in interfaces))


def dumped(path, value):
    compas.json_dump(value, str(path))
    return path


def written(path, document):
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def fault(path):
    with pytest.raises(lb.ModelError) as caught:
        lb.files.read_blocks(path)
    assert all("\n" not in line and line.startswith(str(path)) for line in caught.value.problems)
    return str(caught.value)


def mesh_data(k=0, name=None, dtype="compas.datastructures/Mesh"):
    """A cube above another as compas 2.15 writes a mesh."""
    document = json.loads(compas.json_dumps(Mesh.from_shape(CUBES[k])))
    document |= {"dtype": dtype, "name": name or "Box"}
    return document


@pytest.mark.parametrize("name", STRUCTURES)
def test_round_trip(tmp_path, name):
    model = STRUCTURES[name]
    path = lb.files.write_blocks(model, tmp_path / "a.json")
    imported = lb.files.read_blocks(path)
    assert [block.name for block in imported.blocks] == [block.name for block in model.blocks]
    assert imported.supports == model.supports
    assert not imported.notes
    interfaces = lb.find_interfaces(imported.blocks, JOINT)
    assert len(interfaces) == len(model.interfaces)
    assert total_area(interfaces) == pytest.approx(total_area(model.interfaces), rel=1e-9)
    assert lb.files.write_blocks(model, tmp_path / "b.json").read_bytes() == path.read_bytes()


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


def assembly_document():
    """compas_assembly 0.7.1: Assembly, Graph and Block with their own dtype, supports at the nodes."""
    blocks = [mesh_data(k, dtype="compas_assembly.datastructures/Block") for k in range(2)]
    graph = {
        "attributes": {},
        "default_node_attributes": {"x": 0.0, "block": None, "is_support": False, "displacement": [0] * 6},
        "default_edge_attributes": {"interfaces": None},
        "node": {"0": {"block": blocks[0], "is_support": True}, "1": {"block": blocks[1]}},
        "edge": {"0": {"1": {"interfaces": []}}, "1": {}},
        "max_node": 1,
    }
    graph = {
        "dtype": "compas.datastructures/Graph",
        "data": graph,
        "guid": "ee82354d-fc42-4313-a084-b144c729b02c",
    }
    return {
        "dtype": "compas_assembly.datastructures/Assembly",
        "data": {"attributes": {"name": "Assembly"}, "graph": graph},
        "guid": "70c063db-050d-4434-b44b-852b32a35fdd",
    }


def model_document():
    """compas_dem 0.6.0, on compas_model 0.9.3: blocks with a material, one of them in a group that moves."""

    def element(k, transformation=None):
        data = {
            "transformation": transformation,
            "features": [],
            "name": "Block",
            "material": "m",
            "geometry": mesh_data(k),
            "is_support": k == 0,
        }
        return {"dtype": "compas_dem.elements/Block", "data": data, "guid": f"e{k}"}

    turn = json.loads(compas.json_dumps(Rotation.from_axis_and_angle([0.0, 0.0, 1.0], np.pi / 2)))
    move = json.loads(compas.json_dumps(Translation.from_vector([10.0, 0.0, 0.0])))
    group = {"dtype": "compas_model.elements/Group", "data": {"transformation": move}, "guid": "g"}
    stone = {
        "dtype": "compas_dem.material/Stone",
        "data": {"name": "LIMESTONE", "density": 2200},
        "guid": "m",
    }
    tree = {
        "name": "root",
        "children": [{"element": "e0"}, {"element": "g", "children": [{"element": "e1"}]}],
    }
    data = {
        "transformation": turn,
        "elements": {"e0": element(0), "g": group, "e1": element(1, move)},
        "materials": {"m": stone},
        "tree": {"attributes": {}, "root": tree},
        "graph": {"node": {"0": {"element": "e0"}}, "edge": {}},
    }
    return {
        "dtype": "compas_dem.models/BlockModel",
        "data": data,
        "inheritance": ["compas_model.models/Model"],
        "guid": "3f6d76e7-335d-4592-8c19-c7e40daef87b",
    }


def old_model_document():
    """compas_model of 2024: a list of elements with "shape", transformation and frame apart."""
    elements = [
        {
            "dtype": "compas_model.elements/BlockElement",
            "data": {
                "frame": None,
                "transformation": None,
                "name": "BlockElement",
                "shape": mesh_data(k, dtype="compas_model.elements/BlockGeometry"),
                "features": [],
                "is_support": k == 0,
            },
            "guid": f"e{k}",
        }
        for k in range(2)
    ]
    root = {"name": "root", "frame": None, "children": [{"element": "e0"}, {"element": "e1"}]}
    data = {"tree": {"root": root}, "graph": {"node": {}}, "elements": elements, "materials": []}
    return {"dtype": "compas_model.models/Model", "data": data, "guid": "e27d688d"}


def compas_1_document():
    """COMPAS 1: "value" for "data", "dva" and "dna" for the defaults."""
    document = assembly_document()
    graph = document["data"]["graph"]["data"]
    graph["dna"] = graph.pop("default_node_attributes")
    for node in graph["node"].values():
        block = node["block"]
        block["value"] = block.pop("data")
        block["value"]["dva"] = block["value"].pop("default_vertex_attributes")
    document["value"] = document.pop("data") | {"graph": graph}
    return document


def network_document():
    """compas_assembly before 2019: a network beside the blocks, face vertices as text."""
    blocks = {}
    for k in range(2):
        blocks[str(k)] = data = mesh_data(k)["data"]
        data["face"] = {key: [str(vertex) for vertex in loop] for key, loop in data["face"].items()}
        data["attributes"] = {"name": "Block"}
    vertices = {"0": {"x": 0.0, "is_support": True}, "1": {"x": 0.0, "is_support": False}}
    return {"assembly": {"vertex": vertices, "edge": {}}, "blocks": blocks}


@pytest.mark.parametrize("make", [assembly_document, old_model_document, compas_1_document, network_document])
def test_layouts(tmp_path, make):
    imported = lb.files.read_blocks(written(tmp_path / "a.json", make()))
    assert [block.name for block in imported.blocks] == ["block 0", "block 1"]
    assert [block.volume for block in imported.blocks] == pytest.approx([1.0, 1.0], rel=1e-12)
    assert imported.supports == ("block 0",)
    assert imported.layers == {"block 0": "support", "block 1": "block"}
    assert len(lb.find_interfaces(imported.blocks, JOINT)) == 1


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


def changed(document, *path, to):
    document = copy.deepcopy(document)
    part = document
    for step in path[:-1]:
        part = part[step]
    if to is ...:
        del part[path[-1]]
    else:
        part[path[-1]] = to
    return document


NODE = ("data", "graph", "data", "node", "0", "block", "data")
ELEMENT = ("data", "elements", "e1", "data")
BAD = {
    "no number": (changed(assembly_document(), *NODE, "vertex", "0", "x", to="1"), "expected 3 numbers"),
    "truth": (changed(assembly_document(), *NODE, "vertex", "0", "x", to=True), "expected 3 numbers"),
    "vertex": (changed(assembly_document(), *NODE, "vertex", "0", to=3), "vertex 0 of a mesh is 3"),
    "face": (changed(assembly_document(), *NODE, "face", "0", to=[0, 1, 99]), "face 0 of a mesh"),
    "face missing": (changed(assembly_document(), *NODE, "face", "0", to=...), "open"),
    "huge": (changed(assembly_document(), *NODE, "vertex", "0", "x", to=1e300), "up to 1e30"),
    "no nodes": (changed(assembly_document(), "data", "graph", "data", "node", to={}), "holds no COMPAS"),
    "nodes a list": (changed(assembly_document(), "data", "graph", "data", "node", to=[]), "not sound"),
    "matrix": (changed(model_document(), *ELEMENT, "transformation", to={"matrix": [[1]]}), "4 rows"),
    "perspective": (
        changed(model_document(), *ELEMENT, "transformation", to={"matrix": np.ones((4, 4)).tolist()}),
        "expected 0, 0, 0, 1",
    ),
    "frame": (changed(model_document(), *ELEMENT, "frame", to={}), "has a frame"),
    "circle": (
        changed(
            model_document(), "data", "tree", "root", "children",
            to=[{"element": "g", "children": [{"element": "e1", "children": [{"element": "g"}]}]}],
        ),
        "runs in a circle",
    ),
    "flat box": (json.loads(compas.json_dumps(CUBES[0])) | {}, ""),
    "something else": ({"dtype": "compas.geometry/Point", "data": [0.0, 0.0, 0.0]}, "holds no COMPAS"),
    "plain": ([1, 2, 3], "holds no COMPAS"),
    "text": ("blocks", "holds no COMPAS"),
}  # fmt: skip
BAD["flat box"] = (changed(BAD["flat box"][0], "data", "zsize", to=0.0), "positive")


@pytest.mark.parametrize("case", BAD)
def test_bad_documents_are_one_clean_error(tmp_path, case):
    document, expected = BAD[case]
    assert expected in fault(written(tmp_path / "a.json", document))


@pytest.mark.parametrize("text", ["", "{", '{"dtype": NaN}', "[" * 100_000, '{"a": 1, "a": 2}', "\0\1\2"])
def test_files_that_are_no_json(tmp_path, text):
    path = tmp_path / "a.json"
    path.write_text(text, encoding="utf-8")
    fault(path)


VALUES = (None, True, -1, 1e308, 10**400, "x", [], {}, [[]], {"dtype": "a/b", "data": {}})


def damage(part, chance):
    """Change one value somewhere in a document."""
    while isinstance(part, dict | list) and part:
        key = chance.choice(list(part)) if isinstance(part, dict) else chance.randrange(len(part))
        if not isinstance(part[key], dict | list) or not part[key] or chance.random() < 0.15:
            if chance.random() < 0.3:
                del part[key]
            else:
                part[key] = copy.deepcopy(chance.choice(VALUES))
            return
        part = part[key]


def test_damaged_documents_read_or_fail_cleanly(tmp_path):
    chance = random.Random(1)
    good = [make() for make in (assembly_document, model_document, compas_1_document, network_document)]
    problems = []
    for k in range(160):
        document = copy.deepcopy(good[k % len(good)])
        for _ in range(chance.choice((1, 1, 3))):
            damage(document, chance)
        path = written(tmp_path / "a.json", document)
        try:
            lb.files.read_blocks(path)
        except lb.ModelError as error:
            problems.append(error.problems)
    assert len(problems) > 30
    assert all("\n" not in line and line.startswith(str(path)) for lines in problems for line in lines)


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
