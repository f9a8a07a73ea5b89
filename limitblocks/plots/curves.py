"""Load factors as curves: convergence, load path, direction of the push."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from limitblocks.errors import LimitBlocksError, ModelError, refuse_kind
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model, checked_model, refuse_other
from limitblocks.plots.style import (
    BLACK,
    BLUE,
    CYCLE,
    PALE,
    VERMILION,
    columns,
    curve_axes,
    legend_below,
    plain,
)

COMPONENTS: Mapping[str, int] = {"X": 0, "Y": 1, "Z": 2, "rX": 3, "rY": 4, "rZ": 5}
KINDS = {
    "permanent loads": "D",
    "start": "D",
    "step": "o",
    "before snap": "v",
    "unstable": "x",
    "after snap": "^",
    "polish": "*",
}
WORDS = {"polish": "collapse"}  # of a legend, where the kind of a step is a word of ours
FLOOR = 1e-16  # residuals below it are drawn at it: the logarithm of zero


def convergence(result: Nonassociated | LoadPath, ax: Any = None) -> Any:
    """Draw the residuals of each step on a logarithmic scale, and the load factor beside them.

    Of a tracked path: theta, what is left of compliance and barrier, and the residuals of its end.

    Parameters
    ----------
    result : Nonassociated or LoadPath
        With its history.
    ax : Axes, optional
        Where to draw; the load factor is on a second vertical axis to the right.

    Raises
    ------
    LimitBlocksError
        If the result has no history.
    """
    end = result.collapse if isinstance(result, LoadPath) else result
    history = getattr(end, "history", ())
    if not history:
        raise LimitBlocksError(f"this {type(result).__name__} has no history to draw")
    ax = curve_axes(ax)
    steps = np.arange(1, len(history) + 1)
    names = list(dict.fromkeys(name for one in history for name in one.residuals))
    colours = [colour for colour in CYCLE if colour != BLACK]
    styles = [(colour, marker) for marker in (".-", "x--", "+:") for colour in colours]
    for name, (colour, marker) in zip(names, styles, strict=False):
        values = [max(one.residuals.get(name, np.nan), FLOOR) for one in history]
        ax.semilogy(steps, values, marker, color=colour, linewidth=1.0, markersize=4.0, label=name)
    ax.axhline(end.tolerance, color=PALE, linestyle=":", label="tolerance")
    ax.set(xlabel="stage (–)", ylabel="residual (–)")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    right = ax.twinx()
    loads = [one.load_factor for one in history]
    right.plot(steps, loads, "s-", color=BLACK, markersize=3.0, linewidth=1.4, label="load factor")
    right.set_ylabel("load factor (–)")
    ax.spines["top"].set_visible(False)
    right.spines["top"].set_visible(False)
    handles = [*ax.get_legend_handles_labels()[0], *right.get_legend_handles_labels()[0]]
    legend_below(ax, handles=handles, ncols=columns(ax, [one.get_label() for one in handles]))
    return ax


def load_path(
    model: Model, path: LoadPath, block: str | None = None, component: str | None = None, ax: Any = None
) -> Any:
    """Draw the load factor against a displacement of one block, from the permanent loads to collapse.

    Folds are marked by triangles; a broken line leads across a snap.

    Parameters
    ----------
    model : Model
        The structure.
    path : LoadPath
        Of this model.
    block : str, optional
        Name of the block; the one that moves most unless given.
    component : {"X", "Y", "Z", "rX", "rY", "rZ"}, optional
        Displacement of its centroid, m, or rotation, rad; that which grows most unless given.
    ax : Axes, optional
        Where to draw.

    Raises
    ------
    LimitBlocksError
        If the path belongs to another model, or the block or the component is unknown.
    """
    checked_model(model)
    refuse_kind(path, LoadPath, "path")
    refuse_other(model, path)
    names = [one.name for one in model.blocks]
    k, axis = _measured(path, names, block, component)
    x, loads = path.curve(k, axis)
    ax = curve_axes(ax)
    snaps = [(k, k + 1) for k, step in enumerate(path.steps[1:]) if step.kind == "after snap"]
    across = [pair for pair in snaps if path.steps[pair[0]].kind == "before snap"]
    for before, after in across:
        ax.plot(x[[before, after]], loads[[before, after]], "--", color=PALE, linewidth=1.2)
    breaks = [after for _, after in across]
    ax.plot(np.insert(x, breaks, np.nan), np.insert(loads, breaks, np.nan), "-", color=BLUE, linewidth=1.4)
    for kind in dict.fromkeys(step.kind for step in path.steps):
        these = [step.kind == kind for step in path.steps]
        size = 11.0 if kind == "polish" else 4.5
        style = {
            "color": BLUE if kind in ("permanent loads", "start", "step") else VERMILION,
            "markersize": size,
        }
        style |= {"label": WORDS.get(kind, kind), "linestyle": "none"}
        ax.plot(x[these], loads[these], KINDS.get(kind, "o"), **style)
    word = "displacement of {} along {} (m)" if axis < 3 else "rotation of {} about {} (rad)"
    ax.set_xlabel(word.format(names[k], "XYZ"[axis % 3]) + ",\nfor the compliance of the joints")
    ax.set_ylabel("load factor (–)")
    legend_below(ax, inches=0.65, ncols=columns(ax, ax.get_legend_handles_labels()[1]))
    plain(ax)
    return ax


def _measured(path: LoadPath, names: list[str], block: str | None, component: str | None) -> tuple[int, int]:
    """Positions of the block and of the component that are given, or move most."""
    if block is not None and block not in names:
        raise ModelError(f"block {block!r} is not a block of the model")
    if component is not None and component not in COMPONENTS:
        raise ModelError(f"component is {component!r}, expected one of {', '.join(COMPONENTS)}")
    moved = np.abs(path.steps[-1].displacements)
    axes = [COMPONENTS[component]] if component else [0, 1, 2]
    rows = [names.index(block)] if block else list(range(len(names)))
    row, column = np.unravel_index(int(moved[np.ix_(rows, axes)].argmax()), (len(rows), len(axes)))
    return rows[int(row)], axes[int(column)]


def polar(directions: Any, load_factors: Any = None, ax: Any = None, *, label: str | None = None) -> Any:
    """Draw the load factor against the direction of the push.

    Parameters
    ----------
    directions : study or array_like, shape (k,)
        Angles, rad, counter-clockwise from X; or a study with the fields `angles` and `load_factors`. Those
        that are not finite, of a vertical push, are left out.
    load_factors : array_like, shape (k,), optional
        Not with a study. Infinite and undefined ones are left out.
    ax : Axes, optional
        Polar axes.
    label : str, optional
        In the legend.

    Raises
    ------
    LimitBlocksError
        If `ax` is not polar, or there are not as many angles as load factors.
    """
    if load_factors is None:
        missing = [name for name in ("angles", "load_factors") if not hasattr(directions, name)]
        if missing:
            raise LimitBlocksError(
                f"{type(directions).__name__} has no {missing[0]}; give angles and load factors"
            )
        directions, load_factors = directions.angles, directions.load_factors
    angles, values = (np.asarray(each, dtype=float) for each in (directions, load_factors))
    if angles.shape != values.shape or angles.ndim != 1 or not np.isfinite(angles).any():
        raise LimitBlocksError(
            f"angles have shape {angles.shape} and load factors {values.shape}; "
            "expected (k,) both and at least one angle that is finite"
        )
    order = np.argsort(angles)[: np.isfinite(angles).sum()]  # a vertical push has no angle
    angles, values = angles[order], np.where(np.isfinite(values[order]), values[order], np.nan)
    steps = np.diff(angles, append=angles[0] + 2 * np.pi)
    if steps[-1] <= 1.5 * steps[:-1].max(initial=0.0):  # all around: close the curve
        angles, values = np.append(angles, angles[0] + 2 * np.pi), np.append(values, values[0])
    ax = curve_axes(ax, "polar")
    (line,) = ax.plot(angles, values, ".-", color=CYCLE[len(ax.lines) % len(CYCLE)], label=label)
    ax.fill(angles, np.nan_to_num(values), color=line.get_color(), alpha=0.1, linewidth=0)
    ax.set_rlim(0.0, max(ax.get_rmax(), 1.08 * float(np.nan_to_num(values).max())))
    ax.set_rlabel_position(112.5)
    ax.tick_params(axis="x", pad=8)
    ax.set_title("load factor (–) by direction of the push", fontsize="small", pad=14)
    ticks = [f"{degrees}°" for degrees in range(0, 360, 45)]
    ticks[0], ticks[2] = "0° (X)", "90° (Y)"
    ax.set_xticks(np.radians(range(0, 360, 45)), ticks)
    ax.yaxis.set_major_locator(MaxNLocator(5, prune="lower"))
    if label is not None:
        ax.legend(frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.05, 1.05))
    return ax
