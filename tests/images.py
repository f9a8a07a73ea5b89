"""The same structure elsewhere: turned, mirrored or moved, in another order, with its joints and loads."""

from dataclasses import replace

import numpy as np

import limitblocks as lb


def image(model, matrix=np.eye(3), shift=(0.0, 0.0, 0.0), seed=None):  # noqa: B008
    """`matrix @ x + shift` of everything; blocks and interfaces in an order of `seed`."""
    mirrored = np.linalg.det(matrix) < 0.0
    blocks = [
        replace(
            block,
            vertices=block.vertices @ matrix.T + shift,
            faces=[face[::-1] if mirrored else face for face in block.faces],
        )
        for block in model.blocks
    ]
    interfaces = [
        replace(
            one,
            centroid=matrix @ one.centroid + shift,
            axes=(one.axes @ matrix.T)[[1, 0, 2] if mirrored else [0, 1, 2]],
            polygon=one.polygon[::-1, ::-1] if mirrored else one.polygon,
        )
        for one in model.interfaces
    ]
    if seed is not None:
        order = np.random.default_rng(seed)
        blocks = [blocks[k] for k in order.permutation(len(blocks))]
        interfaces = [interfaces[k] for k in order.permutation(len(interfaces))]
    loads = (
        lb.loads.Load(tuple((factor, _term(term, matrix, shift)) for factor, term in load.terms))
        for load in (model.dead, model.live)
    )
    return lb.Model(blocks, model.supports, interfaces, *loads)


def _term(term, matrix, shift):
    """A load term of vectors: a moment is an axial one."""
    axial = np.linalg.det(matrix)
    ways = {"direction": matrix, "force": matrix, "moment": axial * matrix}
    found = {name: tuple(way @ getattr(term, name)) for name, way in ways.items() if hasattr(term, name)}
    return replace(term, **found, **({"at": tuple(matrix @ term.at + shift)} if hasattr(term, "at") else {}))
