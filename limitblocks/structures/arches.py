"""Voussoir arches: circular, segmental, pointed, elliptical; on skewbacks or on piers; under fill."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.build import (
    HORIZONTAL,
    UNIT_WEIGHT,
    model_of,
    plain_numbers,
    prism,
    record,
    refuse_not_positive,
)
from limitblocks.structures.fills import Fill, fill_loads
from limitblocks.structures.piers import Piers, on_piers, pier_blocks_of
from limitblocks.structures.rings import Ring, Stereotomy, circular, elliptical, pointed, refuse_rise


@plain_numbers
def arch(
    joint: Joint,
    *,
    radius: float,
    thickness: float,
    voussoirs: int,
    embrace: float = np.pi,
    stereotomy: Stereotomy = "radial",
    facets: int | None = None,
    piers: Piers | None = None,
    fill: Fill | None = None,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return a circular arch of equal voussoirs on two supports or piers, in the plane X, Z.

    The corners of the voussoirs lie on the circles of radius +- thickness / 2; their edges are straight.

    Parameters
    ----------
    joint : Joint
        Joint of all interfaces, the springings included.
    radius : float
        To the centreline, m.
    thickness : float
        m, less than twice the radius.
    voussoirs : int
        Number of voussoirs, named from `voussoir 1` at the left (-X) springing.
    embrace : float
        Angle between the springings, rad; pi, the default and the largest, is a semicircle.
    stereotomy : "radial" or "vertical"
        Direction of the joints between voussoirs. Joints at the springings are radial in either case.
    facets : int, optional
        Number of straight sides of the extrados of a voussoir; left out, one, and with vertical joints as
        many as make none longer than the voussoirs are: the extrados beyond the last vertical joint belongs
        to one voussoir, however many there are. The intrados has one, so that voussoirs are convex.
    piers : Piers, optional
        (width, blocks, block_height); an arch whose springings slope has a skewback stone on each. Without
        piers the arch springs from two supports.
    fill : Fill, optional
        Height above the crown, m, unit weight, N/m3, horizontal over vertical pressure, and the part of its
        weight that joins the live load.
    depth : float
        Dimension along Y, m.
    unit_weight : float
        N/m3.
    direction : sequence of float
        Direction of the live load, which is the weight.
    """
    ring = circular(radius, thickness, voussoirs, embrace, stereotomy, facets)
    name = f"arch of {voussoirs} voussoirs"
    return _arch(joint, ring, piers, fill, depth, unit_weight, direction, name)


@plain_numbers
def segmental_arch(
    joint: Joint,
    *,
    span: float,
    rise: float,
    thickness: float,
    voussoirs: int,
    stereotomy: Stereotomy = "radial",
    facets: int | None = None,
    piers: Piers | None = None,
    fill: Fill | None = None,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return the circular arch of a given span and rise, both of its centreline, m; see :func:`arch`.

    `rise` is at most half the `span`: radius (span^2 / 4 + rise^2) / (2 rise), embrace 4 atan(2 rise / span).
    """
    refuse_rise(rise, span, "span", "; see pointed_arch")
    radius, embrace = (span**2 / 4 + rise**2) / (2 * rise), 4 * np.arctan(2 * rise / span)
    ring = circular(radius, thickness, voussoirs, embrace, stereotomy, facets)
    return _arch(joint, ring, piers, fill, depth, unit_weight, direction, "segmental arch")


@plain_numbers
def pointed_arch(
    joint: Joint,
    *,
    span: float,
    rise: float,
    thickness: float,
    voussoirs: int,
    stereotomy: Stereotomy = "radial",
    facets: int | None = None,
    piers: Piers | None = None,
    fill: Fill | None = None,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return an arch about two centres on the springing line, with a joint at its apex; see :func:`arch`.

    Parameters
    ----------
    span, rise : float
        Of the centreline, m; the rise is more than half the span. The centres lie (rise^2 - span^2 / 4) /
        span beyond the middle: at the opposite springings, an equilateral arch, for rise = sqrt(3) / 2 span.
    voussoirs : int
        An even number: half of them at either side.
    joint, thickness, stereotomy, facets, piers, fill, depth, unit_weight, direction
        As for :func:`arch`.
    """
    ring = pointed(span, rise, thickness, voussoirs, stereotomy, facets)
    return _arch(joint, ring, piers, fill, depth, unit_weight, direction, "pointed arch")


@plain_numbers
def elliptical_arch(
    joint: Joint,
    *,
    span: float,
    rise: float,
    thickness: float,
    voussoirs: int,
    stereotomy: Stereotomy = "radial",
    facets: int | None = None,
    piers: Piers | None = None,
    fill: Fill | None = None,
    depth: float = 1.0,
    unit_weight: float = UNIT_WEIGHT,
    direction: Sequence[float] = HORIZONTAL,
) -> Model:
    """Return half an ellipse of constant thickness, flat (rise < span / 2) or raised; see :func:`arch`.

    `span` and `rise` are those of the centreline, m. Joints are perpendicular to it, at equal distances along
    it; intrados and extrados are its parallels.
    """
    ring = elliptical(span, rise, thickness, voussoirs, stereotomy, facets)
    return _arch(joint, ring, piers, fill, depth, unit_weight, direction, "elliptical arch")


def _arch(
    joint: Joint,
    ring: Ring,
    piers: Piers | None,
    fill: Fill | None,
    depth: float,
    unit_weight: float,
    direction: Sequence[float],
    name: str,
) -> Model:
    """The model of a ring with its piers and fill."""
    refuse_not_positive(depth=depth)
    if piers is None:
        below: list[Block] = []
        supports = [prism(f"{side} support", outline, depth) for side, outline in ring.skewbacks().items()]
        ledges: list[tuple[str, Array]] = []
    else:
        piers = record(Piers, piers)
        ring = on_piers(ring, piers)
        below, supports, ledges = pier_blocks_of(ring, piers, depth, unit_weight)
    blocks = [
        prism(f"voussoir {k + 1}", outline, depth, unit_weight) for k, outline in enumerate(ring.voussoirs())
    ]
    tops = [(block.name, top) for block, top in zip(blocks, ring.extrados, strict=True)]
    extra = fill_loads(fill, [*tops, *ledges], depth, direction)
    return model_of([*below, *blocks], supports, joint, direction, name, extra)
