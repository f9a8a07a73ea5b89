"""What each interface does at collapse: sticks, slides, twists, hinges, crushes or opens. numpy only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array, read_only
from limitblocks.errors import LimitBlocksError
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.relative_rates import MOVING, largest_rate, relative_rates
from limitblocks.evidence.utilisation import utilisation
from limitblocks.geometry import Interface
from limitblocks.joints import Dowel, Guide, Tie
from limitblocks.model import Model, checked_model, refuse_other
from limitblocks.problem import LimitProblem, Mode
from limitblocks.shown import Tabular, counted, many

LOADED = 1e-6  # of the units of an interface: forces and moments below it count as none


class Collapse(Protocol):
    """A stress state with a mechanism: what Bounds, Nonassociated and the end of a LoadPath have."""

    @property
    def stress_resultants(self) -> Array:
        """(V1, V2, N, M1, M2, T) of each interface, shape (m, 6)."""

    @property
    def generalised_stresses(self) -> Array:
        """What the joints' rows act on, shape (s,)."""

    @property
    def displacement_rates(self) -> Array:
        """Mechanism, shape (n, 6)."""

    @property
    def flow_multipliers(self) -> Array:
        """Flow multiplier of each row, shape (R,)."""

    @property
    def digest(self) -> str:
        """SHA-256 of the model."""


@dataclass(frozen=True, eq=False, repr=False)
class InterfaceStates(Tabular):
    """State of each of the m interfaces of a model, in its order.

    Attributes
    ----------
    names : tuple of str
        Names of the interfaces.
    state : tuple of str
        "stick", "open" (moves apart all over, without a force or moment), or what it does, joined by "-" in
        this order: "hinge" or "crush" (a hinge about a line within the interface, so that a part of it is
        pressed together), "slide", "twist". A twist about the centre of pressure does not slide. Of a tie
        or dowel: "yield" (it gives), "slack" (the ends of a tie approach), else "stick".
    active_modes : tuple of tuple of Mode
        Failure modes, in the joint's words, whose flow multipliers are not zero.
    centroid : Array, shape (m, 3)
        Global axes, m.
    strain_rates : Array, shape (m, 6)
        (ds1, ds2, dn, dth1, dth2, dthn) of block j relative to block i at the centroid, local axes, m and
        rad, in the scale of the mechanism; dn > 0 opens. Eqs (44)-(47).
    stress_resultants : Array, shape (m, 6)
        (V1, V2, N, M1, M2, T), local axes, N and N m; N <= 0 in compression. Of a prestressed tie N, and with
        it force and utilisation, is what is beyond the prestress, which is a dead load.
    centre_of_pressure : Array, shape (m, 3)
        Where the normal force acts, (e1, e2) = (-M2, M1) / N off the centroid; global axes, m. NaN without
        a normal force.
    force : Array, shape (m, 3)
        Force that block i exerts on block j, global axes, N; block i feels the opposite.
    utilisation : Array, shape (m,)
        How much of the strength is used, N held, or of the compressive or tensile strength by N itself, from
        0 to 1 on the yield surface; of point contacts that of the forces of the points which carry most.
        0 without a force or moment.
    """

    names: tuple[str, ...]
    state: tuple[str, ...]
    active_modes: tuple[tuple[Mode, ...], ...]
    centroid: Array
    strain_rates: Array
    stress_resultants: Array
    centre_of_pressure: Array
    force: Array
    utilisation: Array

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each interface: SI units, vectors by component."""
        parts = {
            "centroid_": (tuple("XYZ"), self.centroid),  # tells the pieces of an area apart
            "": (("V1", "V2", "N", "M1", "M2", "T"), self.stress_resultants),
            "force_": (tuple("XYZ"), self.force),
            "pressure_": (tuple("XYZ"), self.centre_of_pressure),
            "rate_": (("s1", "s2", "n", "th1", "th2", "thn"), self.strain_rates),
        }
        names = [f"{head}{name}" for head, (letters, _) in parts.items() for name in letters]
        values = np.hstack([array for _, array in parts.values()]).tolist()
        words = zip(self.names, self.state, self.utilisation.tolist(), self.active_modes, strict=True)
        return [
            {"interface": name, "state": state, "utilisation": used}
            | dict(zip(names, row, strict=True))
            | {"active_modes": ", ".join(map(str, modes))}
            for (name, state, used, modes), row in zip(words, values, strict=True)
        ]

    def __str__(self) -> str:
        said = ", ".join(f"{count} {word}" for word, count in counted(self.state).items())
        return f"states of {many(len(self.names), 'interface')}: {said}"


def interface_states(model: Model, result: Collapse | LoadPath) -> InterfaceStates:
    """Return what each interface of `model` does in the mechanism of `result`, and what it carries.

    A motion counts as such if it is at least 1e-3 of the largest displacement rate: sliding of the centre
    of pressure, rotations times the distance of the farthest corner.

    Parameters
    ----------
    model : Model
        The structure.
    result : Bounds, Nonassociated or LoadPath
        Of this model. A load path counts by its collapse.

    Raises
    ------
    LimitBlocksError
        If the result has no stress state and mechanism, or belongs to another model.
    """
    collapse = collapse_of(checked_model(model), result)
    problem = model.problem
    axes = np.stack([interface.axes for interface in model.interfaces])
    centroid = np.stack([interface.centroid for interface in model.interfaces])
    Q = collapse.stress_resultants
    least_force = LOADED * problem.units.interface_force
    loaded = np.linalg.norm(Q / problem.units.resultants.reshape(-1, 6), axis=1) > LOADED
    N = np.where(-Q[:, 2] > least_force, Q[:, 2], np.nan)
    e = np.stack([-Q[:, 4], Q[:, 3]], axis=1) / N[:, None]
    dq = relative_rates(model, collapse.displacement_rates)
    least = MOVING * largest_rate(model, collapse.displacement_rates)
    modes = _active_modes(problem, collapse.flow_multipliers, least)
    states = _states(model.interfaces, dq, e, modes, loaded, least)
    return InterfaceStates(
        names=problem.interfaces,
        state=states,
        active_modes=_with_largest(problem, collapse.flow_multipliers, modes, states),
        centroid=read_only(centroid),
        strain_rates=read_only(dq),
        stress_resultants=read_only(Q),
        centre_of_pressure=read_only(centroid + np.einsum("ma,mab->mb", e, axes[:, :2])),
        force=read_only(-np.einsum("ma,mab->mb", Q[:, :3], axes)),
        utilisation=read_only(np.where(loaded, utilisation(model, collapse.generalised_stresses), 0.0)),
    )


def collapse_of(model: Model, result: Collapse | LoadPath) -> Collapse:
    """Return the stress state and mechanism of `result`; LimitBlocksError unless it is one of `model`."""
    given: Any = result
    collapse: Collapse = getattr(given, "collapse", given)
    kind = type(result).__name__
    names = ("displacement_rates", "flow_multipliers")
    if any(getattr(collapse, name, None) is None for name in names) or not collapse.digest:
        raise LimitBlocksError(
            f"{kind} has no mechanism of a model that it names; expected the result of bounds, nonassociated "
            "or load_path"
        )
    refuse_other(model, given)
    return collapse


def _active_modes(problem: LimitProblem, multipliers: Array, least: float) -> tuple[tuple[Mode, ...], ...]:
    active: list[dict[Mode, None]] = [{} for _ in problem.interfaces]
    moving, opened = np.abs(multipliers) > least, np.zeros(len(multipliers), dtype=bool)
    for places in problem.cones.groups:  # a cone of friction opens by its head beyond what slides
        slides = np.array([problem.row_mode[k].slides for k in places[:, 0].tolist()], dtype=bool)
        head, sliding = multipliers[places[:, 0]], np.linalg.norm(multipliers[places[:, 1:]], axis=1)
        moving[places[:, 0]] = np.where(slides, sliding > least, moving[places[:, 0]])
        opened[places[:, 0]] = slides & (head - sliding > least)
    for row in np.flatnonzero(opened).tolist():
        active[problem.row_interface[row]][Mode.OPEN] = None
    for row in np.flatnonzero(moving).tolist():
        active[problem.row_interface[row]][problem.row_mode[row]] = None
    return tuple(tuple(modes) for modes in active)


def _with_largest(
    problem: LimitProblem, multipliers: Array, modes: tuple[tuple[Mode, ...], ...], states: tuple[str, ...]
) -> tuple[tuple[Mode, ...], ...]:
    """Modes; where none is and the corners are just seen to move, that of the largest multiplier."""
    rows = np.argsort(np.abs(multipliers), kind="stable")
    rows = rows[multipliers[rows] != 0.0]
    largest = np.full(len(modes), -1)
    largest[problem.row_interface[rows]] = rows  # the last of each interface stays
    return tuple(
        own or ((problem.row_mode[row],) if row >= 0 and state != "stick" else ())
        for own, row, state in zip(modes, largest.tolist(), states, strict=True)
    )


def _states(
    interfaces: Sequence[Interface],
    dq: Array,
    e: Array,
    modes: tuple[tuple[Mode, ...], ...],
    loaded: npt.NDArray[np.bool_],
    least: float,
) -> tuple[str, ...]:
    """Name the motion of each interface; `e` (m, 2) is NaN without a normal force."""
    lift = [dq[k, 2] + i.polygon @ (-dq[k, 4], dq[k, 3]) for k, i in enumerate(interfaces)]
    lowest, highest = np.array([(one.min(), one.max()) for one in lift]).T
    reach = np.array([np.linalg.norm(i.polygon, axis=1).max() for i in interfaces])
    about = np.nan_to_num(e)
    sliding = dq[:, :2] + dq[:, 5:] * np.stack([-about[:, 1], about[:, 0]], axis=1)
    hinging = np.array([any(mode.opens for mode in own) for own in modes])
    tied = np.array([isinstance(i.joint, Tie | Dowel | Guide) for i in interfaces])
    motions = {
        "hinge": ~tied & hinging & (highest - lowest > least) & (lowest >= -least),
        "crush": ~tied & (lowest < -least),
        "slide": ~tied & (np.linalg.norm(sliding, axis=1) > least),
        "twist": ~tied & (np.abs(dq[:, 5]) * reach > least),
        "slack": np.array([Mode.SLACK in own for own in modes]),
        "yield": np.array([Mode.YIELD in own for own in modes]),
    }
    opened = ~tied & (lowest > least) & ~loaded
    table = zip(opened.tolist(), *(motion.tolist() for motion in motions.values()), strict=True)
    return tuple(
        "open"
        if free
        else "-".join(word for word, moves in zip(motions, row, strict=True) if moves) or "stick"
        for free, *row in table
    )
