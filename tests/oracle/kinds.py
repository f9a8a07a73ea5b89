"""Kinds of random structures: each takes a `Draw` and returns `Parts`."""

from dataclasses import replace
from functools import partial

import numpy as np
import shapes
from closed_forms import groove
from draw import Draw, Parts, assembled, floor_under, moved, named, rotation

import limitblocks as lb
from limitblocks import structures


def forest(draw):
    """Boxes on the floor or each on the top of one before it, two to a top at most, side by side."""
    boxes, below, places = {}, {}, []
    x = 0.0
    for k in range(draw.count(1, 8)):
        name, sides = f"b{k}", draw.sides()
        if places and draw.either(0.6):
            parent, low, high = places.pop(draw.count(0, len(places) - 1))
            # upper blocks larger than their place lean over; the formula says whether they fall
            middle = (low + high) / 2 + draw.uniform(-0.3, 0.3, 2) * np.minimum(sides[:2], high - low)
            if draw.either(0.6):
                sides[:2] = np.minimum(sides[:2], (high - low) * 1.2)
            z = boxes[parent][1][2]
        else:
            parent, z = "floor", 0.0
            middle = np.array([x + sides[0] / 2, draw.uniform(-0.1, 0.1)])
            x += 4.0 * sides[0]
        half = sides[:2] / 2
        low, high = np.array([*(middle - half), z]), np.array([*(middle + half), z + sides[2]])
        boxes[name], below[name] = (low, high), parent
        if draw.either():
            places.append((name, low[:2], high[:2]))
        else:  # two places, left and right
            cut = draw.uniform(0.4, 0.6)
            at = low[0] + cut * sides[0]
            places.append((name, low[:2], np.array([at - 0.02 * sides[0], high[1]])))
            places.append((name, np.array([at + 0.02 * sides[0], low[1]]), high[:2]))
    boxes = {**floor_under(boxes), **boxes}
    interfaces = [one for name, parent in below.items() for one in stood(boxes, name, parent, draw.joint)]
    blocks = [shapes.box(n, *ends, draw.weight() if n in below else None) for n, ends in boxes.items()]
    return Parts(blocks, ["floor"], interfaces, [loaded_on(name, below) for name in below])


def stood(boxes, name, parent, joint_of):
    return shapes.touching({parent: boxes[parent], name: boxes[name]}, joint_of)


def loaded_on(name, below):
    """What an interface under block `name` carries: the block and all that stands on it."""
    names = {name}
    for other, parent in below.items():  # parents come first
        if parent in names:
            names.add(other)
    return names


def slope(draw):
    """A forest, supports and all, turned about a level axis."""
    parts = forest(draw)
    axis = draw.uniform(0.0, 2 * np.pi)
    return moved(parts, rotation((np.cos(axis), np.sin(axis), 0.0), draw.uniform(0.02, 0.3)))


def spire(draw):
    """Frusta of one polygon on top of one another, each foot within the top below."""
    corners = np.sort(draw.uniform(0, 2 * np.pi, 16)[: draw.count(3, 6)])
    n = len(corners)
    ring = np.array([(np.cos(a), np.sin(a)) for a in 2 * np.pi * (np.arange(n) + 0.3 * np.cos(corners)) / n])
    size, at, z = draw.size(), np.zeros(2), 0.0
    blocks = [shapes.frustum("floor", 2 * size * ring, 2 * size * ring, (-size, 0.0))]
    values, below = [], {}
    for k in range(draw.count(2, 7)):
        name, top = f"b{k}", size * draw.uniform(0.5, 1.1)
        tip = at + draw.uniform(-0.2, 0.2, 2) * size
        height = size * draw.uniform(0.3, 1.5)
        foot = at + size * ring
        made = shapes.frustum(name, foot, tip + top * ring, (z, z + height), 1.0)
        blocks.append(replace(made, unit_weight=draw.weight() / made.volume))
        lower = blocks[-2].name
        level = np.column_stack([foot, np.full(n, z)])
        values.append(shapes.interface(lower, name, level, (0, 0, 1), draw.joint()))
        below[name] = lower
        z, size = z + height, top * 10 ** -abs(draw.uniform(0, draw.size_spread / 3))
        at = tip + draw.uniform(-0.5, 0.5, 2) * (top - size) * 0.5
    return Parts(blocks, ["floor"], values, [loaded_on(name, below) for name in below])


def row(draw):
    """Boxes of any size side by side on the floor, each touching the next; some with a stone on top."""
    boxes, x = {}, 0.0
    for k in range(draw.count(2, 5)):
        sides = draw.sides()
        y = draw.uniform(-0.2, 0.2) * sides[1]
        low, high = np.array([x, y - sides[1] / 2, 0.0]), np.array([x + sides[0], y + sides[1] / 2, sides[2]])
        boxes[f"b{k}"] = (low, high)
        if draw.either(0.3):
            top = low + (0.2, 0.2, 0.0) * sides + (0.0, 0.0, sides[2])
            top[2] = high[2]
            boxes[f"t{k}"] = (
                top,
                top + sides * draw.uniform(0.2, 0.6) * 10 ** -abs(draw.uniform(0, draw.size_spread)),
            )
        x = high[0] + (draw.size() if draw.either(0.15) else 0.0)
    return assembled(draw, boxes)


def jammed(draw):
    """A row against one wall, or between two, that do not move."""
    boxes = _row_boxes(draw)
    low, high = np.min([e[0] for e in boxes.values()], axis=0), np.max([e[1] for e in boxes.values()], axis=0)
    size = (high - low).max()
    walls = {"left": ((low[0] - size, low[1], 0.0), (low[0], high[1], high[2]))}
    if draw.either():
        walls["right"] = ((high[0], low[1], 0.0), (high[0] + size, high[1], high[2]))
    return assembled(draw, {**walls, **boxes}, walls)


def _row_boxes(draw):
    boxes, x = {}, 0.0
    for k in range(draw.count(1, 4)):
        sides = draw.sides()
        end = x + sides[0]
        boxes[f"b{k}"] = (np.array([x, -sides[1] / 2, 0.0]), np.array([end, sides[1] / 2, sides[2]]))
        x = end
    return boxes


def wall(draw):
    """Two or three stones of one height, touching or apart, bridged by others, themselves bridged or not."""
    height, size, depth = draw.size(), draw.size(), draw.size()
    n, gap = draw.count(2, 3), 0.0 if draw.either() else size * draw.uniform(0.1, 1.0)
    boxes, x, ends = {}, 0.0, []
    for k in range(n):
        width = size * draw.uniform(0.5, 1.5)
        boxes[f"a{k}"] = (np.array([x, -depth / 2, 0.0]), np.array([x + width, depth / 2, height]))
        ends.append((x, x + width))
        x += width
        x += gap
    top, rise, tops = height, draw.size(), []
    high = top + rise
    for k in range(n - 1):
        (a0, a1), (b0, b1) = ends[k], ends[k + 1]
        left = tops[-1][1] if tops and draw.either() else a1 - draw.uniform(0.15, 0.45) * (a1 - a0)
        right = b0 + draw.uniform(0.15, 0.45) * (b1 - b0)
        y = draw.uniform(-0.2, 0.2) * depth
        boxes[f"c{k}"] = (np.array([left, y - depth / 2, top]), np.array([right, y + depth / 2, high]))
        tops.append((left, right))
    stones = draw.count(0, 2)
    for k in range(stones if n == 2 else min(stones, 1)):
        left, right = (tops[0][0] + tops[0][1]) / 2, (tops[-1][0] + tops[-1][1]) / 2
        width = right - left if n == 3 else (tops[0][1] - tops[0][0]) / 3
        left = left if n == 3 else tops[0][0] + k * 1.5 * width
        boxes[f"d{k}"] = (
            np.array([left, -depth / 3, high]),
            np.array([left + width, depth / 3, high + draw.size()]),
        )
    return assembled(draw, boxes)


def arch(draw):
    """An arch of three to seven voussoirs, some heavy, some light."""
    thickness, joint = draw.uniform(0.15, 0.5), draw.joint()
    model = structures.arch(joint, radius=1.0, thickness=thickness, voussoirs=draw.count(3, 7))
    spread = draw.weight_spread / 8.0  # more than a decade and no line of thrust fits
    blocks = [
        block
        if block.name in model.supports
        else replace(block, unit_weight=10 ** draw.uniform(-spread, spread))
        for block in model.blocks
    ]
    joints = [replace(one, joint=draw.joint() if draw.either(0.2) else joint) for one in model.interfaces]
    return Parts(blocks, list(model.supports), joints)


def in_groove(draw):
    """A long prism in a groove along Y."""
    w, size = draw.uniform(0.5, 1.4), draw.size()
    mu = draw.uniform(0.05, 0.8) * np.tan(w)
    along, deep = 20.0 * size * (1.0 + mu), size
    wide = deep * np.tan(w)
    joint = lb.PointContact(mu)
    # triangle with its edge down, between y = 0 and y = along
    section = np.array([(0.0, 0.0), (wide, deep), (-wide, deep)])
    ends = [np.column_stack([section[:, 0], np.full(3, y), section[:, 1]]) for y in (0.0, along)]
    faces = ((0, 1, 2), (5, 4, 3), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0))
    prism = lb.Block("prism", np.concatenate(ends), faces, 1.0)
    prism = replace(prism, unit_weight=draw.weight() / prism.volume)
    supports, values = [], []
    for name, sign in (("right", 1.0), ("left", -1.0)):
        out = np.array([sign * np.cos(w), 0.0, -np.sin(w)])  # out of the prism
        edge = np.array([sign * wide, 0.0, deep])
        corners = np.array([(0, 0, 0), (0, along, 0), edge + np.array([0, along, 0]), edge])
        corners = (
            corners if np.cross(corners[1] - corners[0], corners[2] - corners[1]) @ out > 0 else corners[::-1]
        )
        values.append(shapes.interface("prism", name, corners, out, joint))
        at = np.array([sign * 2 * wide, along / 2, -deep])
        supports.append(lb.Block.box(name, (wide, along, deep), at))
    return Parts([*supports, prism], ["right", "left"], values, known=lambda: groove(mu, w))


def beside(draw):
    """Two structures on floors of their own, each with its own range of sizes and weights."""
    first, second = (
        [forest, row, wall, arch][draw.count(0, 3)](Draw(draw.rng.integers(2**32))) for _ in range(2)
    )
    reach = max(block.vertices[:, 0].max() for block in first.blocks)
    reach -= min(block.vertices[:, 0].min() for block in second.blocks)
    first = named("p ", first)
    second = named("q ", moved(second, np.eye(3), np.array([1.1 * reach, 0.0, 0.0])))
    carried = first.carried + second.carried if first.carried and second.carried else None
    return Parts(
        first.blocks + second.blocks,
        first.supports + second.supports,
        first.interfaces + second.interfaces,
        carried,
    )


def paper(draw):
    """A forest, level or on a slope, with the joints of Orduña and Lourenço."""
    draw.kind_of_joint = partial(lb.OrdunaLourenco, slip="paper")
    return slope(draw) if draw.either(0.2) else forest(draw)


KINDS = {
    "forest": forest,
    "slope": slope,
    "spire": spire,
    "row": row,
    "jammed": jammed,
    "wall": wall,
    "arch": arch,
    "groove": in_groove,
    "beside": beside,
    "paper": paper,
}
SHARES = (0.18, 0.06, 0.08, 0.18, 0.08, 0.18, 0.04, 0.03, 0.1, 0.07)
