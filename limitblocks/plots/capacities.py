"""Load factor against displacement until it is zero; reaction against settlement until it falls."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from limitblocks.errors import few, refuse_kind
from limitblocks.mechanics.loads.load import triple
from limitblocks.plots.style import BLUE, PALE, VERMILION, curve_axes, plain

if TYPE_CHECKING:  # it would load the solvers
    from limitblocks.practice import CapacityCurve, SettlementCurve


def capacity(curve: CapacityCurve, ax: Any = None) -> Any:
    """Draw the load factor against the displacement of the control point.

    Points at which a joint presses across a gap are hollow, the line to them broken: the load factor is then
    one of a structure whose gap is filled.

    Parameters
    ----------
    curve : CapacityCurve
        Of :func:`limitblocks.practice.capacity_curve`.
    ax : Axes, optional
        Where to draw.

    Raises
    ------
    ModelError
        If it is no capacity curve.
    """
    from limitblocks.practice import CapacityCurve

    refuse_kind(curve, CapacityCurve, "curve")
    ax = curve_axes(ax)
    x, loads = curve.displacements, curve.load_factors
    across = np.array([bool(point.across) for point in curve.points])
    first = int(across.argmax()) if across.any() else len(x)
    ax.axhline(0.0, color=PALE, linewidth=0.8)
    ax.plot(x[:first], loads[:first], "-", color=BLUE, linewidth=1.4)
    ax.plot(x[~across], loads[~across], "o", color=BLUE, markersize=4.5, label="no gap is pressed across")
    if across.any():
        ax.plot(x[max(first - 1, 0) :], loads[max(first - 1, 0) :], "--", color=VERMILION, linewidth=1.2)
        hollow: Any = {"linestyle": "none", "markerfacecolor": "white", "color": VERMILION}
        ax.plot(x[across], loads[across], "o", label="presses across a gap", **hollow)
        ax.legend(frameon=False, fontsize="small", loc="upper right")
    control = curve.control
    ax.set_xlabel(f"displacement of {control.block} along {triple(control.direction.tolist())} (m)")
    ax.set_ylabel("load factor (–)")
    plain(ax)
    return ax


def settlement(curve: SettlementCurve, ax: Any = None) -> Any:
    """Draw the reaction of a support against its settlement, to where the structure falls.

    Parameters
    ----------
    curve : SettlementCurve
        Of :func:`limitblocks.practice.settlement_to_collapse`.
    ax : Axes, optional
        Where to draw.

    Raises
    ------
    ModelError
        If it is not the way of a support that settles.
    """
    from limitblocks.practice import SettlementCurve

    refuse_kind(curve, SettlementCurve, "curve")
    ax = curve_axes(ax)
    x, across = curve.displacements, np.array([bool(point.across) for point in curve.points])
    for name, color, dash in (("lower", BLUE, "-"), ("upper", PALE, "--")):
        ax.plot(x, [getattr(one.found, name) / 1e3 for one in curve.points], dash, color=color, linewidth=1.4)
    ax.plot(x[~across], curve.reactions[~across] / 1e3, "o", color=BLUE, markersize=4.5)
    ax.plot(x[across], curve.reactions[across] / 1e3, "o", markerfacecolor="white", color=VERMILION)
    if curve.falls is not None:
        ax.axvline(curve.falls, color=VERMILION, linewidth=1.0)
        ax.annotate("falls", (curve.falls, curve.reactions.min() / 1e3), (-4, 0), textcoords="offset points",
                    ha="right", va="bottom", color=VERMILION)  # fmt: skip
    ax.set_xlabel(f"settlement of {few(curve.supports)} along {triple(curve.direction.tolist())} (m)")
    ax.set_ylabel("reaction (kN)")
    plain(ax)
    return ax
