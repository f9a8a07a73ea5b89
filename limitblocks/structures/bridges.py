"""Arch bridges of several spans: rings of voussoirs, bonded or not, on piers and abutments, under fill."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    base,
    model_of,
    pier,
    plain_numbers,
    prism,
    refuse,
    refuse_fewer,
    refuse_not_positive,
)
from limitblocks.structures.fills import Fill, fill_loads
from limitblocks.structures.rings import Ring, circular, refuse_rise


@plain_numbers
def arch_bridge(
    joint: Joint,
    *,
    span: float,
    rise: float,
    thickness: float,
    voussoirs: int,
    spans: int = 1,
    pier_width: float | None = None,
    pier_height: float = 2.0,
    pier_blocks: int = 4,
    rings: int = 1,
    ring_joint: Joint | None = None,
    fill: Fill | None = None,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a bridge of equal circular arches between two abutments and on piers, in the plane X, Z.

    The first span is centred at X = 0, the next ones follow along +X, a clear span and a pier apart. Piers
    stand on Z = 0. Abutments and what piers stand on are supports. Blocks are named `span 1 voussoir 1` from
    the left, with several rings `span 1 ring 1 voussoir 1` from the intrados, `pier 1 block 1` from below and
    `pier 1 springer`, the stone from which two arches spring.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces but those between rings.
    span, rise : float
        Clear span and rise of the intrados, m, as surveyed; the rise is at most half the span.
    thickness : float
        Of all rings together, m.
    voussoirs : int
        In each ring of each span.
    spans : int
        Number of spans.
    pier_width : float, optional
        Along X, m; needed with two spans or more. At least twice the thickness times the sine of the angle of
        the springing from the vertical.
    pier_height : float
        Of the springings above what the piers stand on, m.
    pier_blocks : int
        Courses of each pier, single blocks.
    rings : int
        Rings of equal thickness on one another. Their joints are all radial and in line: whether rings part
        is up to the joint between them.
    ring_joint : Joint, optional
        Joint between rings: dry, such as ``PointContact(0.5)``, or bonded by cohesion, such as
        ``OrdunaLourenco(0.5, cohesion=2e5, tensile_strength=1e5)``; `joint` unless given. The contact is one
        facet a voussoir, so that a ring that slides without dilatancy is held as by a friction angle larger
        by half the angle of a voussoir.
    fill : Fill, optional
        Height above the crown, m, unit weight, N/m3, horizontal over vertical pressure, and the part of its
        weight that joins the live load.
    depth : float
        Width of the bridge, along Y, m.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight; :func:`limitblocks.practice.worst_position` puts a
        vehicle in its place.
    """
    refuse_rise(rise, span, "clear span")
    refuse_not_positive(thickness=thickness, depth=depth, pier_height=pier_height)
    refuse_fewer(1, spans=spans, rings=rings, pier_blocks=pier_blocks)
    least = 2 * thickness * float(np.sin(2 * np.arctan(2 * rise / span)))
    width = _pier_width(spans, pier_width, least)
    pitch, height = span + width, pier_height if spans > 1 else 0.0
    each, whole = _rings(span, rise, thickness, voussoirs, rings, height)
    arches, tops = _arches(each, spans, pitch, depth, unit_weight)
    supports, piers = _abutments(whole, (spans - 1) * pitch, depth), []
    for k in range(1, spans):
        at = k * pitch - pitch / 2
        stones, top = _pier(f"pier {k}", at, width, pier_height, pier_blocks, whole, depth, unit_weight)
        piers += stones
        tops.append((stones[-1].name, top))
        y = (-depth / 2, depth / 2)
        supports.append(base((at - width / 2, at + width / 2), y, pier_height / pier_blocks, f"base {k}"))
    extra = fill_loads(fill, tops, depth, direction)
    law = _law(joint, joint if ring_joint is None else ring_joint)
    name = f"arch bridge of {spans} span{'s' * (spans > 1)}"
    return model_of([*arches, *piers], supports, law, direction, name, extra)


def _rings(
    span: float, rise: float, thickness: float, voussoirs: int, rings: int, height: float
) -> tuple[list[Ring], Ring]:
    """The rings from the intrados, and one of their whole thickness, on springings at a height, m."""
    half = 2 * np.arctan(2 * rise / span)  # between springing and crown
    radius = (span**2 / 4 + rise**2) / (2 * rise)
    lift = height - radius * float(np.cos(half))

    def ring(inner: float, size: float) -> Ring:
        return circular(radius + inner + size / 2, size, voussoirs, 2 * half).raised(lift)

    return [ring(k * thickness / rings, thickness / rings) for k in range(rings)], ring(0.0, thickness)


def _arches(
    rings: Sequence[Ring], spans: int, pitch: float, depth: float, unit_weight: float
) -> tuple[list[Block], list[tuple[str, Array]]]:
    """The voussoirs of all spans, and names and upper edges of those of the outermost rings."""
    blocks, tops = [], []
    for k in range(spans):
        named = list(_voussoirs(rings, k, k * pitch))
        blocks += [prism(name, outline, depth, unit_weight) for name, outline, _ in named]
        tops += [(name, top) for name, _, top in named[-(len(named) // len(rings)) :]]
    return blocks, tops


def _law(joint: Joint, between: Joint) -> Callable[[Block, Block], Joint]:
    """The joint of two blocks: another one between rings."""

    def law(i: Block, j: Block) -> Joint:
        return between if 0 < _ring(i) != _ring(j) > 0 else joint

    return law


def _pier_width(spans: int, given: float | None, least: float) -> float:
    """Width of the piers, or 0 where there are none."""
    if spans == 1:
        return 0.0
    if given is None or not least * (1 - 1e-12) <= given < np.inf:
        shown = "missing" if given is None else repr(given)
        refuse([f"pier width is {shown}, expected at least {least:.4g} m, what the springings need"])
    return float(given or 0.0)


def _voussoirs(rings: Sequence[Ring], k: int, at: float) -> Iterator[tuple[str, Array, Array]]:
    """Name, outline and upper edge of each voussoir of span k, centred at X = `at`, ring by ring."""
    for number, ring in enumerate(rings, start=1):
        word = f" ring {number}" if len(rings) > 1 else ""
        for j, (outline, top) in enumerate(zip(ring.voussoirs(), ring.extrados, strict=True), start=1):
            yield f"span {k + 1}{word} voussoir {j}", np.add(outline, (at, 0.0)), np.add(top, (at, 0.0))


def _abutments(ring: Ring, far: float, depth: float) -> list[Block]:
    """Supports before the first and behind the last span, whose centre is at X = `far`."""
    skewbacks = ring.skewbacks()
    return [
        prism("left abutment", skewbacks["left"], depth),
        prism("right abutment", skewbacks["right"] + (far, 0.0), depth),
    ]


def _pier(
    name: str,
    at: float,
    width: float,
    height: float,
    count: int,
    ring: Ring,
    depth: float,
    unit_weight: float,
) -> tuple[list[Block], Array]:
    """Blocks of a pier about X = `at`, its springer last, and the edge of its top."""
    left, right = at - width / 2, at + width / 2
    y = (-depth / 2, depth / 2)
    blocks = pier(f"{name} block", (left, right), y, count, height / count, unit_weight)
    inward, up = np.abs(ring.outer[0] - ring.inner[0]).tolist()
    top = np.array([(left + inward, height + up), (right - inward, height + up)])
    if up > 1e-9 * width:
        ends = top[::-1] if np.ptp(top[:, 0]) > 1e-9 * width else top[:1]
        outline = np.array([(left, height), (right, height), *ends])
        blocks.append(prism(f"{name} springer", outline, depth, unit_weight))
    return blocks, top


def _ring(block: Block) -> int:
    """Number of the ring of a voussoir; 0 of another stone, and where there is one ring."""
    _, _, tail = block.name.partition(" ring ")
    return int(tail.split()[0]) if tail else 0
