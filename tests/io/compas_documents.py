"""Documents of COMPAS in each of its layouts."""

import json

import compas
import numpy as np
from compas.datastructures import Mesh
from compas.geometry import Box, Frame, Rotation, Translation

CUBES = [Box(1.0, 1.0, 1.0, Frame([0.0, 0.0, k + 0.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])) for k in range(2)]


def written(path, document):
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def mesh_data(k=0, name=None, dtype="compas.datastructures/Mesh"):
    """A cube above another as compas 2.15 writes a mesh."""
    document = json.loads(compas.json_dumps(Mesh.from_shape(CUBES[k])))
    document |= {"dtype": dtype, "name": name or "Box"}
    return document


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
