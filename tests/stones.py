"""Models of stones put together by hand."""

from dataclasses import replace

import numpy as np

import limitblocks as lb
from limitblocks.structures import build
from limitblocks.structures.bond import Bond

SQUARE = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])


def model_of(stones, supports, joint, direction=(1, 0, 0), name=""):
    """Stones with one joint wherever they touch, under their weight, pushed along `direction`."""
    found = lb.find_interfaces(stones, joint)
    return lb.Model(stones, supports, found, lb.self_weight(), lb.mass_proportional(direction), name)


def shaft(outline=SQUARE, hole=0.6, height=1.0, courses=1):
    """Courses with a hole, `hole` times their outline about the origin, on the ground."""
    n = len(outline)
    around = np.concatenate([np.multiply(outline, by) for by in (1.0, hole)])
    corners = np.concatenate([np.column_stack([around, np.full(2 * n, z)]) for z in (0.0, height)])
    faces = []
    for k in range(n):
        j = (k + 1) % n
        faces += [(k, j, 2 * n + j, 2 * n + k), (n + j, n + k, 3 * n + k, 3 * n + j)]
        faces += [(j, k, n + k, n + j), (2 * n + k, 2 * n + j, 3 * n + j, 3 * n + k)]
    rings = [
        lb.Block(f"course {k + 1}", corners + np.array([0, 0, k * height]), faces, 20e3)
        for k in range(courses)
    ]
    return [lb.Block.box("ground", (20.0, 20.0, 1.0), (0.0, 0.0, -0.5)), *rings]


def volume(model):
    """Of the blocks that no ground holds."""
    return sum(block.volume for block in model.free_blocks)


def portal_stones(left="left", lintel="lintel"):
    """A lintel on two legs on the ground."""
    return [
        lb.Block.box("ground", (4, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box(left, (0.5, 1, 2), (-1, 0, 1), 20e3),
        lb.Block.box("right", (0.5, 1, 2), (1, 0, 1), 20e3),
        lb.Block.box(lintel, (2.5, 1, 0.4), (0, 0, 2.2), 24e3),
    ]


def jammed(joint):
    """A block between a floor and a ceiling."""
    stones = [
        lb.Block.box("floor", (3.0, 1.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("ceiling", (3.0, 1.0, 0.2), (0, 0, 1.1)),
        lb.Block.box("block", (1.0, 1.0, 1.0), (0, 0, 0.5), 20e3),
    ]
    return model_of(stones, ["floor", "ceiling"], joint)


def pair(behind, front, between):
    """Two equal low blocks one behind the other, with three joints, pushed along X."""
    stones = [
        lb.Block.box("floor", (6.0, 2.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("behind", (1.0, 1.0, 0.4), (-0.5, 0, 0.2), 20e3),
        lb.Block.box("front", (1.0, 1.0, 0.4), (0.5, 0, 0.2), 20e3),
    ]
    joints = {frozenset(("floor", "behind")): behind, frozenset(("floor", "front")): front}
    interfaces = [
        replace(one, joint=joints.get(frozenset((one.block_i, one.block_j)), between))
        for one in lb.find_interfaces(stones, between)
    ]
    return lb.Model(stones, ["floor"], interfaces, lb.self_weight(), lb.mass_proportional((1, 0, 0)))


def sloping(stone, joint, direction):
    """A block of a unit weight on a slope of 1:2, pushed along `direction`."""
    angle = np.arctan2(1.0, 2.0)
    turn = np.array([(np.cos(angle), 0, np.sin(angle)), (0, 1, 0), (-np.sin(angle), 0, np.cos(angle))])
    blocks = [
        lb.Block.box("slope", (4, 1, 0.2), (0, 0, -0.1)).moved(turn, (0, 0, 0)),
        lb.Block.box("block", (1, 1, 0.5), (0, 0, 0.25), stone).moved(turn, (0, 0, 0)),
    ]
    return model_of(blocks, ["slope"], joint, direction)


def block_off(model, off):
    """The model with one block, its interfaces and its loads moved out of the plane by `off` m."""
    name = model.free_blocks[3].name
    blocks = [b.moved(np.eye(3), (0.0, off, 0.0)) if b.name == name else b for b in model.blocks]
    return replace(model, blocks=blocks)


def imbalance(model, load_factor, stress_resultants):
    """Forces and moments on the free blocks about their centroids, (n, 6), joint by joint."""
    loads = model.dead.on(model.free_blocks) + load_factor * model.live.on(model.free_blocks)
    left = dict(zip((block.name for block in model.free_blocks), loads, strict=True))
    centroid = {block.name: block.centroid for block in model.free_blocks}
    for interface, Q in zip(model.interfaces, stress_resultants, strict=True):
        f, m = interface.axes.T @ Q[:3], interface.axes.T @ Q[3:]
        # N < 0 in compression and n points out of block i: +Q acts on block i, -Q on block j
        for name, sign in ((interface.block_i, 1.0), (interface.block_j, -1.0)):
            if name in left:
                arm = interface.centroid - centroid[name]
                left[name] = left[name] + sign * np.concatenate([f, m + np.cross(arm, f)])
    return np.array(list(left.values()))


def leaning_walls(joint, length, width, courses, t=0.4):
    """Four walls about a rectangle that only lean on each other on the right and behind: it splits there."""
    bond, blocks = Bond(2 * t, t, courses), []
    sides = {
        "front": (0, (0.0, t), length),
        "back": (0, (width - t, width), length),
        "left": (1, (0.0, t), width),
        "right": (1, (length - t, length), width),
    }
    for name, (axis, across, end) in sides.items():
        spans = [(0.0, end), (t, end - t)][:: -1 if axis else 1]
        blocks += bond.boxes(bond.pieces(name, spans, 1 - axis), axis, across, 20e3)
    ground = build.base((0.0, length), (0.0, width), t)
    return build.model_of(blocks, [ground], joint, (1.0, 0.0, 0.0), "tower")
