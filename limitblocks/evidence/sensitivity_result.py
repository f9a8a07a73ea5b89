"""Result of the sensitivities: derivatives of the load factor by the data of a model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array
from limitblocks.shown import Result, kept, many

ROUNDING = 1e-9  # of the load factor: a change that is none


@dataclass(frozen=True, eq=False)
class LoadPosition:
    """Derivative of the load factor by the point at which a load acts.

    Attributes
    ----------
    load : str
        "dead" or "live".
    term : int
        Position of the load among the terms of that sum.
    block : str
        Block it acts on.
    gradient : Array, shape (3,)
        Per m, global axes.
    """

    load: str
    term: int
    block: str
    gradient: Array


@dataclass(frozen=True)
class Influence:
    """What one datum does: the `elasticity` is the change of the load factor per relative change of it.

    `kind` is "friction" of an interface or "unit weight" of a block, `name` says of which one.
    """

    kind: str
    name: str
    elasticity: float

    def __str__(self) -> str:
        return f"{self.kind} of {self.name}: {self.elasticity:+.3g} per unit of relative change"


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivities(Result):
    """Derivatives of the associated load factor by the data of a model, without solving again.

    Attributes
    ----------
    load_factor : float
        Load factor they belong to, the lower bound.
    friction : Array, shape (m,)
        By the friction coefficient of each interface; NaN for joints without friction.
    cohesion, compressive_strength, tensile_strength : Array, shape (m,)
        By the strengths of each interface, 1/Pa; NaN where its joint has none, or it is zero.
    unit_weight : Array, shape (n,)
        By the unit weight of each block of the model, m3/N; zero for supports.
    positions : tuple of LoadPosition
        By the points at which loads act.
    weights, frictions : Array, shapes (n,) and (m,)
        Unit weights, N/m3, and friction coefficients of the model, for `governing`.
    unique : bool
        Whether the mechanism is the only one, also of those within 1e-5 of yield, so that derivatives by
        weights and loads are two-sided; without it none need be.
    agreed : ndarray of bool, shape (m,)
        Whether all stress states of the load factor agree on the derivative by the friction of the interface,
        so that it is two-sided if the mechanism is unique.
    blocks, interfaces : tuple of str
        Names.
    digest : str
        SHA-256 of the model.
    remarks : tuple of str
        What to know of the load factor that they are derivatives of.
    """

    load_factor: float
    friction: Array
    cohesion: Array
    compressive_strength: Array
    tensile_strength: Array
    unit_weight: Array
    positions: tuple[LoadPosition, ...]
    weights: Array
    frictions: Array
    unique: bool
    agreed: npt.NDArray[np.bool_]
    blocks: tuple[str, ...]
    interfaces: tuple[str, ...]
    digest: str
    remarks: tuple[str, ...] = ()

    @property
    def of_interfaces(self) -> Array:
        """Change of the load factor per relative change of the friction of each interface, shape (m,)."""
        return np.asarray(np.nan_to_num(self.friction * self.frictions))

    @property
    def of_blocks(self) -> Array:
        """Change of the load factor per relative change of the unit weight of each block, shape (n,)."""
        return np.asarray(self.unit_weight * self.weights)

    def governing(self, n: int = 10) -> tuple[Influence, ...]:
        """Return at most `n` joints and stones whose friction or unit weight matters most, the largest first.

        Those whose share is rounding, below 1e-9 of the load factor, are left out.
        """
        least = ROUNDING * abs(self.load_factor)
        return tuple(one for one in self._influences()[:n] if abs(one.elasticity) > least)

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each joint and stone, the one that matters most first."""
        return [
            {"kind": one.kind, "name": one.name, "elasticity": one.elasticity} for one in self._influences()
        ]

    def _influences(self) -> list[Influence]:
        """All of them, the largest first; a joint in pieces, which share its name, is one."""
        frictions: dict[str, float] = {}
        for name, share in zip(self.interfaces, self.of_interfaces.tolist(), strict=True):
            frictions[name] = frictions.get(name, 0.0) + share
        weights = zip(self.blocks, self.of_blocks.tolist(), strict=True)
        found = [Influence("friction", *pair) for pair in frictions.items()]
        found += [Influence("unit weight", *pair) for pair in weights]
        return sorted(found, key=lambda one: -abs(one.elasticity))

    def __str__(self) -> str:
        first = "; ".join(map(str, self.governing(3))) or "no friction or unit weight changes it"
        sides = "" if self.unique else "; the mechanism is not unique, derivatives may be one-sided"
        if self.unique and not self.agreed.all():
            sides = f"; by the friction of {many(int((~self.agreed).sum()), 'joint')} it may be one-sided"
        return self._line(
            f"sensitivities of load factor {self.load_factor:.6g}: {first}{sides}", *self.remarks
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the derivatives as plain numbers (None where there is none), lists and text."""
        names = ("friction", "cohesion", "compressive_strength", "tensile_strength", "unit_weight")
        numbers = {name: _plain(getattr(self, name)) for name in names}
        return {
            "analysis": "sensitivities",
            "load_factor": self.load_factor,
            **numbers,
            "weights": self.weights.tolist(),
            "frictions": _plain(self.frictions),
            **kept(self, "positions", "unique", "agreed", "blocks", "interfaces", "remarks", "digest"),
        }


def _plain(values: Array) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
