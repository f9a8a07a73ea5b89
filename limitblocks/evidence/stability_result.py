"""Result of the question whether a structure stands under its dead loads."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import few
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.residuals import Residual, Residuals, largest_of, residual, static_residuals
from limitblocks.problem import Flow, State
from limitblocks.shown import Result, kept

TOLERANCE = 1e-6  # largest residual of stresses that arise, and of a mechanism


class Standing(Enum):
    """Whether a structure stands under its dead loads; the text is for the user."""

    STANDS = "stands: the dead loads, put on unstressed blocks, bring about stresses that carry them"
    SELF_STRESS = "stands only by self-stress: stresses that carry the dead loads exist, but do not arise"
    FALLS = "falls: no stresses within the yield surface carry the dead loads"


@dataclass(frozen=True, eq=False, repr=False)
class Stability(Result):
    """Whether a structure stands under its dead loads, with the states that prove it.

    Attributes
    ----------
    kind : Standing
        The answer.
    margin : float
        How far every yield function of every interface can be lowered, in the largest dead force on a
        block that the interface is tied to, before no stresses carry the dead loads; at most 1; negative
        where it falls. Static theorem: the flow rule is of no account.
    blocks : tuple of str
        Free blocks that fall, or that slide through where nobody wedges them; none where it stands.
    stress_resultants : Array, shape (m, 6), optional
        (V1, V2, N, M1, M2, T) of each interface, local axes, N and N m, that carry the dead loads with the
        largest margin; none where it falls.
    generalised_stresses : Array, shape (s,), optional
        What the joints' rows act on in that state, N and N m.
    arising : Array, shape (m, 6), optional
        Stress resultants that arise when the dead loads are put on unstressed blocks with joints of one
        small compliance per area and zero dilatancy; where it stands.
    displacement_rates : Array, shape (n, 6), optional
        Mechanism where it falls, or slides through: rates of each block of the model at its centroid, global
        axes, m and rad, the largest 1 m; zero for supports.
    residuals : Residuals
        Recomputed without the solver. Of the states: equilibrium and yield, and flow and complementarity of
        the one that arises. Of the mechanism: flow and multipliers, over the work of the dead loads on it
        less what the joints take up.
    digest : str
        SHA-256 of the model.
    remarks : tuple of str
        What to know of the stresses of largest margin.
    """

    kind: Standing
    margin: float
    blocks: tuple[str, ...]
    stress_resultants: Array | None
    generalised_stresses: Array | None
    arising: Array | None
    displacement_rates: Array | None
    residuals: Residuals
    digest: str
    remarks: tuple[str, ...] = ()

    @property
    def stands(self) -> bool:
        """Whether it stands without being wedged."""
        return self.kind is Standing.STANDS

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each residual."""
        return self.residuals.rows()

    def __str__(self) -> str:
        moving = f"; {few(self.blocks)} would move" if self.blocks else ""
        worst = self.residuals.worst
        return self._line(
            f"{self.kind.value}{moving}; margin {self.margin:.3g}, worst residual {worst.value:.1e} "
            f"({worst.name})",
            *self.remarks,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and text."""
        return {
            "analysis": "stability",
            "kind": self.kind.name.lower().replace("_", "-"),
            "stands": self.stands,
            "meaning": self.kind.value,
            **kept(self, "margin", "blocks", "residuals"),
            "residual_details": self.residuals.details(),
            **kept(self, "stress_resultants", "generalised_stresses", "arising", "displacement_rates"),
            **kept(self, "remarks", "digest"),
        }


def arising_residuals(flow: Flow, weights: Array, state: State) -> tuple[Residual, ...]:
    """Residuals of the stresses that arise on unstressed joints of compliance `weights`.

    W x = C u + G^T y, dead = C^T x, F x + g in K, y in K*, (F x + g) o y = 0; strains and multipliers are
    measured by the power of the interface's own force over that of the dead loads.
    """
    p, measure = flow.problem, Measure(flow.problem, state)
    strains = weights * state.x - p.C @ state.u - flow.matrix(state.x).T @ state.y
    power, k = float(p.dead @ state.u), p.member_interface
    at = [p.interfaces[i] for i in k]
    negative = np.minimum(p.cones.margin(state.y), 0.0) / p.units.row[p.cones.heads] * measure.interface[k]
    product = p.cones.norm(p.cones.product(p.F @ state.x + p.g, state.y))
    slip, over = largest_of(p, strains) * measure.interface, "over the work of the dead loads"
    residuals = (
        *static_residuals(p, 0.0, state.x),
        residual("flow", slip, f"strains of the joints, {over}", power, p.interfaces),
        residual("multipliers", negative, f"negative flow multiplier, {over}", power, at),
        residual("complementarity", product, f"yield function times multiplier, {over}", power, at),
    )
    return tuple(Residual(f"arising {r.name}", r.value, r.meaning, r.where) for r in residuals)


def mechanism_residuals(flow: Flow, loads: Array, state: State) -> tuple[Residual, ...]:
    """Residuals of a mechanism on which loads do more work than the joints take up, over the surplus."""
    p = flow.problem
    surplus, k = float(loads @ state.u - p.g @ state.y), p.member_interface
    strains = largest_of(p, p.C @ state.u + flow.matrix(state.x).T @ state.y)
    negative, at = np.minimum(p.cones.margin(state.y), 0.0), [p.interfaces[i] for i in k]
    over = "work of the unit of force over the surplus work"
    return (
        residual("mechanism flow", strains, f"flow rule, {over}", surplus, p.interfaces),
        residual("mechanism multipliers", negative, f"negative multiplier, {over}", surplus, at),
    )
