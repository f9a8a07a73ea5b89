"""The document of a portal, as a model file has it, and one with its joints listed."""

import copy
import json

from stones import model_of

import limitblocks as lb

PORTAL = {
    "schema_version": 1,
    "name": "Portal",
    "blocks": [
        {"name": "ground", "box": {"size": [4.0, 1.0, 0.2], "at": [0.0, 0.0, -0.1]}},
        {"name": "left", "box": {"size": [0.5, 1.0, 2.0], "at": [-1.0, 0.0, 1.0]}, "unit_weight": 20e3},
        {"name": "right", "box": {"size": [0.5, 1.0, 2.0], "at": [1.0, 0.0, 1.0]}, "unit_weight": 20e3},
        {"name": "lintel", "box": {"size": [2.5, 1.0, 0.4], "at": [0.0, 0.0, 2.2]}, "unit_weight": 24e3},
    ],
    "supports": ["ground"],
    "joints": {"dry": {"type": "OrdunaLourenco", "friction": 0.6}},
    "interfaces": {"find": {"joint": "dry"}},
    "dead": [{"type": "SelfWeight"}],
    "live": [{"type": "MassProportional", "direction": [1, 0, 0]}],
}


def _listed():
    blocks = [lb.Block.box(b["name"], **b["box"], unit_weight=b.get("unit_weight")) for b in PORTAL["blocks"]]
    model = model_of(blocks, ["ground"], lb.OrdunaLourenco(0.6))
    return json.loads(json.dumps(model.to_dict()))


LISTED = _listed()


def changed(document, *path, to):
    """A copy of `document` with the value at `path` replaced, or taken out if `to` is Ellipsis."""
    document = copy.deepcopy(document)
    part = document
    for step in path[:-1]:
        part = part[step]
    if isinstance(part, list) and path[-1] == len(part):
        part.append(to)
    elif to is ...:
        del part[path[-1]]
    else:
        part[path[-1]] = to
    return document
