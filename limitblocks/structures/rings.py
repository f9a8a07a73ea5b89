"""Rings of voussoirs: the curve of the centreline, the joints across it, the outlines between them.

Points are (x, z) about the middle of the springing line of a full arch, m. Angles are those of the normal of
the centreline from the vertical, clockwise: 0 at the crown, -pi/2 at the left (-X) springing.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.structures.build import refuse, refuse_fewer, refuse_not_positive

Stereotomy = Literal["radial", "vertical"]
#: Least rise of a circular arch over its span: for a flatter one the radius leaves no digits to the stones.
FLATTEST = 1e-6


class Profile(NamedTuple):
    """Centreline of an arch: a quarter of an ellipse at either side, each moved outwards from the middle.

    `half_axes` along X and Z and `shift` towards the other side, m; a circle with a shift is a pointed arch.
    """

    half_axes: tuple[float, float]
    shift: float = 0.0

    def points(self, angles: Array, offset: float = 0.0) -> Array:
        """Return points (n, 2) at `offset` outside the centreline, on its normals at `angles` (n,)."""
        normal = np.column_stack([np.sin(angles), np.cos(angles)])
        a = np.array(self.half_axes)
        size = np.linalg.norm(a * normal, axis=1)[:, None]
        ellipse = a**2 / size * normal + offset * normal
        ellipse[:, 0] -= self.shift * np.sign(angles)
        return np.asarray(ellipse)

    def apex(self, offset: float = 0.0) -> float:
        """Angle at which the right half of a pointed arch meets the left one; 0 if it is not pointed."""
        return float(np.arcsin(self.shift / (self.half_axes[0] + offset)))

    def joint_angles(self, voussoirs: int, springing: float, thickness: float) -> Array:
        """Return the angles (n + 1,) of joints at equal distances along the centreline.

        Those of a pointed arch are at equal distances along the intrados, so that none crosses the apex.
        """
        if self.shift:
            half = np.linspace(-springing, -self.apex(-thickness / 2), voussoirs // 2 + 1)
            return np.concatenate([half, -half[-2::-1]])
        a, b = self.half_axes
        if a == b:
            return np.linspace(-springing, springing, voussoirs + 1)
        fine = np.linspace(-springing, springing, 20001)
        radius = (a * b) ** 2 / np.hypot(a * np.sin(fine), b * np.cos(fine)) ** 3
        length = np.concatenate([[0.0], np.cumsum((radius[1:] + radius[:-1]) / 2)])
        return np.interp(np.linspace(0.0, length[-1], voussoirs + 1), length, fine)

    def angles_at(self, x: Array, sides: Array, offset: float) -> Array:
        """Return the angles at which the curve at `offset` has the abscissae `x`; `sides` +-1 or 0 (n,)."""
        low, high = np.zeros(len(x)), np.full(len(x), np.pi / 2)
        for _ in range(60):  # bisection to the last digit
            middle = (low + high) / 2
            beyond = sides * self.points(sides * middle, offset)[:, 0] > sides * x
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        return np.asarray(sides * (low + high) / 2)


class Ring(NamedTuple):
    """Ring of voussoirs with straight edges.

    `inner` and `outer` (n + 1, 2) are the ends of the joints; `extrados` (n, facets + 1, 2) are the
    corners of each voussoir along the extrados, from left to right, the ends of its joints included.
    """

    inner: Array
    outer: Array
    extrados: Array

    @classmethod
    def of(
        cls,
        profile: Profile,
        thickness: float,
        voussoirs: int,
        springing: float,
        stereotomy: Stereotomy,
        facets: int | None,
    ) -> Ring:
        """Return the ring about a centreline, or raise ModelError naming what makes it impossible."""
        _refuse_ring(voussoirs, stereotomy, 1 if facets is None else facets)
        half = thickness / 2
        inside = profile.joint_angles(voussoirs, springing, thickness)
        outside = inside.copy()
        if profile.shift:  # the joint at the apex is vertical
            outside[voussoirs // 2] = -profile.apex(half)
        inner = profile.points(inside, -half)
        if stereotomy == "vertical":
            at = slice(1, -1)
            outside[at] = profile.angles_at(inner[at, 0], np.sign(inside[at]), half)
        ends = np.column_stack([outside[:-1], outside[1:]])
        if profile.shift:
            ends[voussoirs // 2, 0] *= -1.0  # the right half begins at the apex, too
        if facets is None:
            facets = _sides(ends, inside) if stereotomy == "vertical" else 1
        between = np.linspace(ends[:, 0], ends[:, 1], facets + 1, axis=1)
        extrados = profile.points(between.ravel(), half).reshape(voussoirs, facets + 1, 2)
        return cls(inner, np.vstack([extrados[:, 0], extrados[-1:, -1]]), extrados)

    def raised(self, height: float) -> Ring:
        """Return the ring moved up by `height`, m."""
        return Ring(*(np.add(points, (0.0, height)) for points in self))

    def voussoirs(self) -> list[Array]:
        """Return the outlines from the left springing to the right, (facets + 3, 2) each."""
        feet = zip(self.inner, self.inner[1:], strict=False)
        return [np.array([*foot, *top[::-1]]) for foot, top in zip(feet, self.extrados, strict=True)]

    def skewbacks(self) -> dict[str, Array]:
        """Return the outlines of supports below the left and the right springing, (4, 2) each."""
        across = self.outer[0] - self.inner[0]
        below = np.array([across[1], -across[0]])  # tangent at the left springing, downwards
        below *= -np.sign(below[1])
        left = np.array([self.outer[0] + below, self.inner[0] + below, self.inner[0], self.outer[0]])
        return {"left": left, "right": left[::-1] * (-1.0, 1.0)}


def circular(
    radius: float,
    thickness: float,
    voussoirs: int,
    embrace: float,
    stereotomy: Stereotomy = "radial",
    facets: int | None = None,
) -> Ring:
    """Return the ring about an arc of a circle; `embrace` is the angle between its springings, rad."""
    refuse_not_positive(radius=radius, thickness=thickness, embrace=embrace)
    problems = []
    if thickness >= 2 * radius:
        problems.append(f"thickness is {thickness!r}, expected less than twice the radius {radius!r}")
    if embrace > np.pi:
        problems.append(f"embrace is {embrace!r}, expected an angle up to pi (a semicircle) in rad")
    refuse(problems)
    return Ring.of(Profile((radius, radius)), thickness, voussoirs, embrace / 2, stereotomy, facets)


def refuse_rise(rise: float, span: float, what: str, instead: str = "") -> None:
    """Raise ModelError unless a circular arch over a span can have this rise, m."""
    refuse_not_positive(span=span, rise=rise)
    if rise > span / 2:
        refuse([f"rise is {rise!r}, expected at most half the {what} {span!r}{instead}"])
    if rise < FLATTEST * span:
        refuse([f"rise is {rise!r}, expected at least {FLATTEST:g} of the {what} {span!r}"])


def pointed(
    span: float, rise: float, thickness: float, voussoirs: int, stereotomy: Stereotomy, facets: int | None
) -> Ring:
    """Return the ring about two arcs from the springing line that meet at `rise` over half the `span`."""
    refuse_not_positive(span=span, rise=rise, thickness=thickness)
    problems = []
    if rise <= span / 2:
        problems.append(f"rise is {rise!r}, expected more than half the span {span!r}; else it is no point")
    if voussoirs % 2:
        problems.append(f"voussoirs is {voussoirs!r}, expected an even number: there is a joint at the apex")
    if thickness >= span:
        problems.append(f"thickness is {thickness!r}, expected less than the span {span!r}")
    refuse(problems)
    shift = (rise**2 - span**2 / 4) / span
    radius = span / 2 + shift
    return Ring.of(Profile((radius, radius), shift), thickness, voussoirs, np.pi / 2, stereotomy, facets)


def elliptical(
    span: float, rise: float, thickness: float, voussoirs: int, stereotomy: Stereotomy, facets: int | None
) -> Ring:
    """Return the ring about half an ellipse."""
    refuse_not_positive(span=span, rise=rise, thickness=thickness)
    a, b = span / 2, rise
    least = min(a, b) ** 2 / max(a, b)
    if thickness >= 2 * least:
        refuse([f"thickness is {thickness!r}, expected less than {2 * least:g} m, twice the least radius of "
                "curvature of the centreline"])  # fmt: skip
    return Ring.of(Profile((a, b)), thickness, voussoirs, np.pi / 2, stereotomy, facets)


def _sides(ends: Array, joints: Array) -> int:
    """Return how many sides of an extrados between angles `ends` (n, 2) are no wider than the voussoirs."""
    return int(np.ceil(np.ptp(ends, axis=1).max() / np.diff(joints).max()))


def _refuse_ring(voussoirs: int, stereotomy: str, facets: int) -> None:
    refuse_fewer(2, voussoirs=voussoirs)
    refuse_fewer(1, facets=facets)
    if stereotomy not in ("radial", "vertical"):
        refuse([f"stereotomy is {stereotomy!r}, expected 'radial' or 'vertical'"])
