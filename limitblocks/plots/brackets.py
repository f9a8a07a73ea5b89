"""The load factors of one model as bars."""

from __future__ import annotations

from typing import Any

import numpy as np

from limitblocks.errors import LimitBlocksError
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.results import Nonassociated
from limitblocks.plots.style import BLACK, BLUE, ORANGE, PALE, SKY, VERMILION, curve_axes, plain, room

COLOURS = {
    "frictionless": PALE,
    "non-associated": BLUE,
    "load path": SKY,
    "associated, static": ORANGE,
    "associated, kinematic": VERMILION,
    "associated": ORANGE,
}
_LIMITS = [name for name in COLOURS if name not in ("non-associated", "load path")]


def bracket(*results: Bounds | Nonassociated | LoadPath, ax: Any = None) -> Any:
    """Draw the load factors of one model as bars: frictionless, non-associated, load path, associated.

    Parameters
    ----------
    *results : Bounds, Nonassociated or LoadPath
        Of one model, each a bar. A non-associated result and a load path bring the frictionless and the
        associated value; the first is "not claimed" where one of them does not claim it, and what was read
        from a file counts where nothing was computed.
    ax : Axes, optional
        Where to draw.

    Raises
    ------
    LimitBlocksError
        If there is no result, one is of another kind, or they belong to different models.
    """
    if not results:
        raise LimitBlocksError("no result given; expected those of bounds, nonassociated and load_path")
    values: dict[str, float] = {}
    kinds: dict[str, str] = {}
    digests = set()
    for result in sorted(results, key=lambda one: bool(getattr(one, "from_file", False))):
        one = _load_factors(result)
        if np.isnan(one.get("frictionless", 0.0)):  # a lower end of all results drawn, or of none
            values.pop("frictionless", None)
        for kind, value in one.items():
            name = kind if kind in _LIMITS else _named(kind, result, value, values)
            kinds[name] = kind
            values.setdefault(name, value)
        digests.add(getattr(result, "collapse", result).digest)
    if len(digests) > 1:
        raise LimitBlocksError("the results belong to different models; compare results of one")
    order = sorted(values, key=lambda name: list(COLOURS).index(kinds[name]))
    ax = curve_axes(ax, size=(room(), 0.9 + 0.42 * len(order)))
    numbers = np.array([values[name] for name in order])
    finite = np.isfinite(numbers)
    longest = float(np.abs(numbers[finite]).max(initial=0.0)) or 1.0
    drawn = np.where(finite, numbers, np.where(np.isposinf(numbers), 1.25 * longest, 0.0))
    ax.barh(
        order,
        drawn,
        height=0.6,
        color=[COLOURS[kinds[name]] for name in order],
        edgecolor=BLACK,
        linewidth=0.6,
    )
    for k, (number, end) in enumerate(zip(numbers.tolist(), drawn.tolist(), strict=True)):
        said = f"{number:.4g}" if np.isfinite(number) else "unlimited" if number > 0 else "not claimed"
        ax.annotate(
            said, (max(end, 0.0), k), (4, 0), textcoords="offset points", va="center", fontsize="small"
        )
    ax.invert_yaxis()
    ax.margins(x=0.18)
    ax.set_xlabel("load factor (–)")
    plain(ax)
    return ax


def _named(kind: str, result: Any, value: float, known: dict[str, float]) -> str:
    """Name of the bar of a solution: with its dilatancy, and a number where another one has that name."""
    dilatancy = getattr(result, "collapse", result).dilatancy
    name = f"{kind}, dilatancy {dilatancy:g}" if dilatancy else kind
    names = [name, *(f"{name} ({k})" for k in range(2, len(known) + 3))]
    return next(one for one in names if one not in known or known[one] == value)


def _load_factors(result: Any) -> dict[str, float]:
    if isinstance(result, Bounds):
        if result.gap < 1e-3:
            return {"associated": result.lower}
        return {"associated, static": result.lower, "associated, kinematic": result.upper}
    end = result.collapse if isinstance(result, LoadPath) else result
    if not isinstance(end, Nonassociated):
        raise LimitBlocksError(
            f"{type(result).__name__} given; expected results of bounds, nonassociated or load_path"
        )
    name = "load path" if isinstance(result, LoadPath) else "non-associated"
    return {"frictionless": end.frictionless, name: end.load_factor, "associated": end.associated}
