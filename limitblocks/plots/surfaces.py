"""Interaction curves of one interface: sections of its yield set, and stress states on them."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import cross
from limitblocks.joints.base import RESULTANTS
from limitblocks.joints.interaction import shear_strength, torsion_bending, torsion_shear_curve
from limitblocks.joints.queries import Queries
from limitblocks.joints.torsion import as_region, torsion_constant
from limitblocks.plots.style import BLACK, CYCLE, curve_axes, inches, legend_below


def interaction(
    joint: Queries,
    interface: Interface,
    x: str = "V1",
    y: str = "T",
    *,
    N: float | None = None,
    stress_resultants: Any = None,
    exact: bool = False,
    label: str | None = None,
    directions: int = 90,
    ax: Any = None,
) -> Any:
    """Draw a section of the yield set of an interface: two stress resultants, the others zero.

    Without `N` everything is per |N|, which a dry joint of unlimited strength allows; curves over N need it.
    Call it again with the same `ax` to compare joints.

    Parameters
    ----------
    joint : OrdunaLourenco, ExactTorsion, PointContact, ...
        What the interface can carry; the joint of `interface` does not count.
    interface : Interface
        Its polygon counts.
    x, y : {"V1", "V2", "N", "M1", "M2", "T"}
        What runs to the right and up. With "N", the curve ends at the strength in compression or at `N`.
    N : float, optional
        Normal force, N, negative in compression; with "N" as `x` or `y` the largest one to draw.
    stress_resultants : array_like, shape (k, 6), optional
        Stress states to draw as points: (V1, V2, N, M1, M2, T), N and N m. For a dry joint of unlimited
        strength they are brought to `N` in proportion, or divided by |N|.
    exact : bool
        Dashed: the strength under uniform pressure, exact for V with T and for V1 with V2, on the effective
        area for M with T (Sections 3.1 and 3.2 of Orduña & Lourenço 2005); for polygons that are symmetric
        about both axes and joints without cohesion.
    label : str, optional
        Of the curve in the legend; the joint unless given.
    directions : int
        Number of rays along which the strength is found; each takes PointContact a linear program.
    ax : Axes, optional
        Where to draw.

    Returns
    -------
    Axes
        V and N in N, moments in N m; or without unit and in m where everything is per |N|.

    Raises
    ------
    ModelError
        If a name is unknown, N is not compressive or missing where it matters, a strength in the plane is
        unlimited, a stress state has another N, or no exact curve is known.
    """
    dry = not joint.yield_rows(interface.polygon[None]).g.any()
    _refuse(joint, x, y, N, dry)
    held = -1.0 if N is None else float(N)
    at = RESULTANTS.index(x), RESULTANTS.index(y)
    curve = (_with_normal_force if 2 in at else _around)(joint, interface, at, held, directions)
    new = ax is None
    ax = curve_axes(ax)
    if new:
        ax.set_prop_cycle(color=CYCLE)
    (line,) = ax.plot(*curve.T, label=label or repr(joint), zorder=2.0)
    ax.fill(*curve.T, color=line.get_color(), alpha=0.08, linewidth=0, zorder=1.0)
    if exact:
        across = _exact(joint, interface, (x, y), held)
        said = "uniform pressure, " + ("effective area" if "M" in x + y else "exact")
        ax.plot(*across.T, "--", color=BLACK, linewidth=1.0, label=said, zorder=2.0)
    if stress_resultants is not None:
        points = _points(stress_resultants, None if 2 in at else held, dry)[:, at]
        ax.plot(*points.T, "o", color=BLACK, markersize=4.0, label="stress states", zorder=3.0)
    ax.set(xlabel=_label(x, N is None), ylabel=_label(y, N is None))
    ax.axhline(0.0, color="0.8", linewidth=0.6, zorder=0.5)
    ax.axvline(0.0, color="0.8", linewidth=0.6, zorder=0.5)
    if (x[0] in "VN") == (y[0] in "VN"):
        ax.set_aspect("equal")
    ax.locator_params(nbins=6 if inches(ax) > 2.5 else 4)
    legend_below(ax)
    return ax


def _refuse(joint: Queries, x: str, y: str, N: float | None, dry: bool) -> None:
    """ModelError where the resultants are not two of them, or N is missing or no compression."""
    if x not in RESULTANTS or y not in RESULTANTS or x == y:
        raise ModelError(f"x, y are {x!r}, {y!r}; expected two of {', '.join(RESULTANTS)}")
    if N is None and "N" in (x, y):
        raise ModelError("N is missing: give the largest compressive force to draw, N < 0, in N")
    if N is None and not dry:
        raise ModelError(f"N is missing: {joint!r} has strengths in Pa, so that its yield set depends on N")
    if N is not None and not (np.isfinite(N) and N < 0.0):
        raise ModelError(f"N is {N!r}, expected a compressive force, N < 0, in N")


def _label(name: str, relative: bool) -> str:
    symbol = f"{name[0]}_{name[1]}" if len(name) == 2 else name
    force = name[0] in "VN"
    if relative:
        return f"${symbol} / |N|$ ({'–' if force else 'm'})"
    return f"${symbol}$ ({'N' if force else 'N m'})"


def _unit(k: int) -> Array:
    return np.asarray(np.eye(6)[k])


def _strength(joint: Queries, interface: Interface, direction: Array, given: Array) -> float:
    t: float = joint.strength(interface, direction, given)
    if np.isinf(t):
        names = [RESULTANTS[k] for k in np.flatnonzero(direction)]
        raise ModelError(f"{joint!r} carries {' and '.join(names)} without limit; there is no curve to draw")
    return t


def _around(joint: Queries, interface: Interface, at: tuple[int, int], N: float, directions: int) -> Array:
    """Closed curve (k, 2) around the state of N alone, by rays at even angles of the scaled axes."""
    given = N * _unit(2)
    strengths = np.array([_strength(joint, interface, _unit(k), given) or abs(N) for k in at])
    basis = strengths[:, None] * np.stack([_unit(k) for k in at])

    def on_curve(rays: Array) -> Array:
        t = [_strength(joint, interface, ray @ basis, given) for ray in rays]
        return np.asarray(np.array(t)[:, None] * rays)

    angles = 2.0 * np.pi * np.arange(directions) / directions
    points = on_curve(np.stack([np.cos(angles), np.sin(angles)], axis=1).round(15))  # on the axes, too
    points = np.concatenate([points, on_curve(_corners(points))])
    points = points[np.argsort(np.arctan2(points[:, 1], points[:, 0]))]
    return np.asarray(strengths * np.concatenate([points, points[:1]]))


def _corners(points: Array) -> Array:
    """Where the lines through the pairs of points before and after each side of a closed polygon meet."""
    before, start, end, after = (np.roll(points, k, axis=0) for k in (1, 0, -1, -2))
    a, b = start - before, after - end
    turn = cross(a, b)
    bent = np.abs(turn) > 1e-6 * np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    met = start + (cross(end - start, b) / np.where(bent, turn, 1.0))[:, None] * a
    return np.asarray(met[bent])


def _with_normal_force(
    joint: Queries, interface: Interface, at: tuple[int, int], N: float, directions: int
) -> Array:
    """Closed curve (k, 2) of the strength in both senses from the tensile strength to N or to crushing."""
    other = at[0] if at[1] == 2 else at[1]
    least = -min(joint.strength(interface, -_unit(2)), abs(N))
    most = joint.strength(interface, _unit(2))
    forces = np.linspace(least, most, max(directions // 2, 2))
    given = forces[:, None] * _unit(2)
    above, below = (
        np.array([_strength(joint, interface, sign * _unit(other), one) for one in given])
        for sign in (1.0, -1.0)
    )
    pairs = np.stack([np.r_[forces, forces[::-1]], np.r_[above, -below[::-1]]], axis=1)
    pairs = np.concatenate([pairs, pairs[:1]])
    return pairs if at[0] == 2 else pairs[:, ::-1]


def _exact(joint: Queries, interface: Interface, names: tuple[str, str], N: float) -> Array:
    polygon, friction = interface.polygon, float(joint.friction)  # type: ignore[attr-defined] # every joint has it
    shape = as_region(polygon)
    mirrored = [as_region(polygon * sign) for sign in ((-1.0, 1.0), (1.0, -1.0))]
    if any(shapely.symmetric_difference(shape, other).area > 1e-6 * shape.area for other in mirrored):
        raise ModelError("the exact curve needs a polygon that is symmetric about both of its axes")
    if getattr(joint, "cohesion", 0.0):
        raise ModelError("no exact curve is known with cohesion; it is that of Coulomb friction")
    V0 = float(shear_strength(friction, N))
    first, second = names
    if {first, second} == {"V1", "V2"}:
        angles = np.linspace(0.0, 2.0 * np.pi, 181)
        return V0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    other = first if second == "T" else second
    if "T" not in names or other == "N":
        raise ModelError(
            f"no exact curve is known for {first} with {second}; for V with T, V1 with V2, M with T"
        )
    if other[0] == "V":
        distances = np.r_[0.0, np.geomspace(1e-3, 1e3, 80) * np.sqrt(shape.area), np.inf]
        V, T = torsion_shear_curve(shape, (0.0, 1.0) if other == "V1" else (1.0, 0.0), distances)
        a, b = V * V0, T * V0 * torsion_constant(shape)
    else:
        half = np.abs(polygon[:, 1 if other == "M1" else 0]).max()
        a = np.linspace(0.0, 1.0, 80) * half * -N
        b = torsion_bending(polygon, friction, N, *((a, 0.0) if other == "M1" else (0.0, a)))
    quadrants = np.concatenate(
        [
            np.stack([s * a, t * b], axis=1)[::d]
            for s, t, d in ((1, 1, 1), (1, -1, -1), (-1, -1, 1), (-1, 1, -1))
        ]
    )
    return quadrants if second == "T" else quadrants[:, ::-1]


def _points(stress_resultants: Any, N: float | None, dry: bool) -> Array:
    Q = np.atleast_2d(np.asarray(stress_resultants, dtype=float))
    if Q.ndim != 2 or Q.shape[1] != 6 or not np.isfinite(Q).all():
        raise ModelError(f"stress_resultants have shape {Q.shape}, expected (k, 6) finite numbers")
    if N is None:
        return Q
    if not (Q[:, 2] < 0.0).all():
        raise ModelError(f"a stress state has N = {Q[:, 2].max():g} N; expected compression, N < 0")
    if dry:
        return np.asarray(Q * (N / Q[:, 2:3]))
    off = np.abs(Q[:, 2] - N)
    if not (off <= 1e-6 * abs(N)).all():
        raise ModelError(f"a stress state has N = {Q[off.argmax(), 2]:g} N, but the curve is for N = {N:g} N")
    return Q
