"""What a joint says of an interface: its yield set and flow as conic rows (F, g, G, K)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from numbers import Real
from typing import Any, Protocol, TypeGuard, runtime_checkable

import numpy as np

from limitblocks.arrays import Array, as_typed
from limitblocks.errors import ModelError
from limitblocks.geometry import Interface
from limitblocks.written import tagged

RESULTANTS = ("V1", "V2", "N", "M1", "M2", "T")
#: Names of strengths, Pa, by which partial factors and displaced structures find them in a joint.
STRENGTHS = ("cohesion", "tensile_strength", "compressive_strength")
_SQUARE = np.array([[(0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)]])  # m


@dataclass(frozen=True, eq=False)
class YieldRows:
    """Yield sets of m interfaces of one shape of polygon, F x + g in K, and their flow.

    x are the s generalised stresses of an interface and Q = `resultants` x its stress resultants; for
    the paper's model x = Q. Rows come as `linear` rows of the nonnegative orthant and then second-order
    cones (t, z), t >= ||z||, of the sizes `cones`. All rows are forces. The flow is
    dx = -G(Q)^T y, y in K*, where the twisting part of G may turn about (e1, e2), where N acts (Table 5).

    Attributes
    ----------
    F, G : Array, shape (m, r, s)
        Yield rows (minus the gradient of the paper's yield functions) and rows of the plastic potential
        for zero dilatancy.
    g : Array, shape (m, r)
        Constant terms: cohesion and strength; zero for a dry joint of infinite strength.
    pivot : Array, shape (m, r)
        Normal rotation rate per unit multiplier that a row turns about (e1, e2); zero for other rows.
    half_sides : Array, shape (m, 2)
        Largest |e1|, |e2| for the pivot: the half sides of a rectangle.
    resultants : Array, shape (m, 6, s)
        Q = resultants x.
    linear : int
        Number of rows in the nonnegative orthant.
    cones : tuple of int
        Sizes of the second-order cones that follow; they add up to r - linear.
    modes : tuple of Mode or str
        Failure mode of each row; see :class:`limitblocks.results.Mode`.
    friction : float
        Friction coefficient: the dilatancy (tangent of its angle) at which the flow becomes associated.
    """

    F: Array
    g: Array
    G: Array
    pivot: Array
    half_sides: Array
    resultants: Array
    linear: int
    cones: tuple[int, ...]
    modes: Sequence[str]
    friction: float


@runtime_checkable
class Joint(Protocol):
    """What an interface can carry. Joints are frozen, hashable settings."""

    @property
    def friction(self) -> float:
        """Friction coefficient."""

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return the rows for polygons of shape (m, n, 2), given in any unit of length.

        `stress_unit` (Pa) is unit of force / unit of length squared; strengths are divided by it.
        """


def joint_of(interface: Interface) -> Joint:
    """Return the joint of `interface`, or raise ModelError if it is none."""
    if not _is_joint(interface.joint):
        raise ModelError(
            f"interface {interface.name}: joint is {interface.joint!r}, "
            "expected a joint such as OrdunaLourenco(friction=0.6)"
        )
    return interface.joint


def refuse_nameless_strength(joint: Joint, who: str) -> None:
    """Raise ModelError where `joint`, of one's own, has a strength under a name that is none of STRENGTHS."""
    known = is_dataclass(joint) and not isinstance(joint, type)
    for one in fields(joint) if known else ():  # type: ignore[arg-type] # as `known` says
        value = getattr(joint, one.name)
        if one.name not in (*STRENGTHS, "friction") and isinstance(value, float):
            half = replace(joint, **{one.name: value / 2.0})  # type: ignore[type-var] # as `known` says
            if not np.array_equal(joint.yield_rows(_SQUARE).g, half.yield_rows(_SQUARE).g):
                raise ModelError(
                    f"{joint}: {who} would leave {one.name} as it is, a strength; name it "
                    f"{', '.join(STRENGTHS[:-1])} or {STRENGTHS[-1]}"
                )


def joints_of(interfaces: Iterable[Interface]) -> tuple[dict[int, str], dict[str, Any]]:
    """Return the name of each joint by its identity, and equal joints once, as documents, by name."""
    own = {id(interface.joint): interface for interface in interfaces}
    joint = {key: joint_of(interface) for key, interface in own.items()}
    name = {each: f"joint {k + 1}" for k, each in enumerate(dict.fromkeys(joint.values()))}
    return {key: name[each] for key, each in joint.items()}, {name[each]: tagged(each) for each in name}


def _is_joint(joint: object) -> TypeGuard[Joint]:
    # as isinstance does, a hundred times faster than Python 3.11's: thousands of interfaces ask
    return hasattr(joint, "friction") and callable(getattr(joint, "yield_rows", None))


def friction_words(friction: float) -> str:
    """Return a friction coefficient as text, with its angle."""
    return (
        f"friction coefficient {friction:g} ({np.degrees(np.arctan(friction)):.1f} degrees)"
        if friction
        else "no friction"
    )


def strength_words(cohesion: float, tensile: float, compressive: float | None) -> str:
    """Return the strengths of a joint, Pa, as text."""
    parts = [f"cohesion {stress_words(cohesion)}"] if cohesion else []
    parts.append(f"tensile strength {stress_words(tensile)}" if tensile else "no tension")
    limit = "no limit of compression"
    parts.append(limit if compressive is None else f"compressive strength {stress_words(compressive)}")
    return ", ".join(parts)


def stress_words(stress: float) -> str:
    """Return a stress, Pa, as text."""
    return f"{stress / 1e6:.4g} MPa" if stress >= 1e5 else f"{stress / 1e3:.4g} kPa"


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def checked_friction(friction: float) -> float:
    """Return `friction` as a float if it is a finite number >= 0, else raise ModelError."""
    if not (_is_number(friction) and 0.0 <= friction < np.inf):
        raise ModelError(f"friction is {as_typed(friction)}, expected a finite coefficient >= 0")
    return float(friction)


def checked_stress(word: str, stress: float, positive: bool = False, unlimited: bool = False) -> None:
    """Raise ModelError unless `stress`, Pa, is a finite number >= 0, or > 0 if it must be `positive`.

    `unlimited`: None stands for no limit, which the message says.
    """
    if not (_is_number(stress) and np.isfinite(stress) and stress >= 0.0) or (positive and not stress):
        least = ("> 0" if positive else ">= 0") + "; None stands for no limit" * unlimited
        raise ModelError(f"{word} is {as_typed(stress)} Pa, expected a finite stress {least}")


def checked_choice(word: str, choice: str, choices: tuple[str, ...]) -> None:
    """Raise ModelError unless `choice` is one of `choices`."""
    if choice not in choices:
        raise ModelError(f"{word} is {choice!r}, expected one of {', '.join(map(repr, choices))}")


def checked_count(word: str, count: object, least: int) -> None:
    """Raise ModelError unless `count` is a whole number of at least `least`."""
    whole = isinstance(count, int | np.integer) and not isinstance(count, bool)
    if not (whole and count >= least):  # type: ignore[operator] # whole
        raise ModelError(f"{word} is {count!r}, expected a whole number of at least {least}")
