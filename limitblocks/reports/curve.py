"""Load path and convergence as curves for an SVG."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing.sheet import WIDTH, Dot, Group, Label, Shape, Sheet
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.results import Iteration
from limitblocks.model import Model

HEIGHT = 360.0  # user units of the SVG
LEFT, RIGHT, TOP, BOTTOM = 110.0, 30.0, 20.0, 60.0
AXES = "XYZ"
COMPLIANT = ", for the compliance of the joints"
SNAPPING = ("before snap", "unstable", "after snap")
Ticks = Sequence[tuple[float, str]]


class Tick(NamedTuple):
    """Place along an axis in user units, and its number."""

    place: float
    text: str


class Curve(NamedTuple):
    """Curve in user units of a 1000 by 360 view box: title, caption, labels, SVG path, dots, ticks."""

    title: str
    caption: str
    x_label: str
    y_label: str
    line: str
    dots: tuple[tuple[float, float, str], ...]
    x_ticks: tuple[Tick, ...]
    y_ticks: tuple[Tick, ...]

    def sheet(self) -> Sheet:
        """Return the curve as a drawing."""
        right, foot, turn = WIDTH - RIGHT, HEIGHT - BOTTOM, (LEFT + WIDTH - RIGHT) / 2
        level = [f"M{LEFT:g},{tick.place:g} {right:g},{tick.place:g}" for tick in self.y_ticks]
        upright = [f"M{tick.place:g},{TOP:g} {tick.place:g},{foot:g}" for tick in self.x_ticks]
        labels = [Label(tick.place, foot + 22.0, tick.text) for tick in self.x_ticks]
        labels += [Label(LEFT - 10.0, tick.place + 5.0, tick.text, "end") for tick in self.y_ticks]
        labels += [Label(turn, foot + 50.0, self.x_label)]
        labels += [Label(24.0, (TOP + foot) / 2, self.y_label, upwards=True)]
        text = f"Line through {len(self.dots)} dots, from {self.dots[0][2]}, to {self.dots[-1][2]}."
        groups = (
            Group("grid", "", tuple(map(Shape, (*level, *upright)))),
            Group("line", "", (Shape(self.line),)),
        )
        dots = tuple(Dot(*dot) for dot in self.dots)
        return Sheet("curve", self.title, text, HEIGHT, groups, tuple(labels), dots)


def path_curve(model: Model, path: LoadPath) -> Curve | None:
    """Return the load factor against the displacement that grows most, or against the step if none does."""
    if len(path.steps) < 2:
        return None
    moved = np.abs(path.steps[-1].displacements[:, :3])
    if moved.max(initial=0.0) > 0.0:
        block, component = divmod(int(moved.argmax()), 3)
        x, loads = path.curve(block, component)
        label = f"displacement of {model.blocks[block].name} along {AXES[component]}, m{COMPLIANT}"
    else:
        x, loads = np.arange(float(len(path.steps))), path.curve(0, 0)[1]
        label = "step"
    title = f"Load factor against {label.removesuffix(f', m{COMPLIANT}')}"
    kinds = [f", {step.kind}" if step.kind in SNAPPING else "" for step in path.steps]
    said = [f"step {k}{kinds[k]}: load factor {value:.6g}" for k, value in enumerate(loads)]
    caption = (
        "a dot a step. Where no stiffness of the joints was given the sizes of displacements are relative."
    )
    words = (title, f"{title}, {caption}", label, "load factor")
    return line_curve(words, (x, loads), said, float(label == "step"))


def line_curve(
    words: tuple[str, str, str, str], values: tuple[Array, Array], said: Sequence[str], least: float = 0.0
) -> Curve:
    """Return a line through values x and y, round numbers at its axes, those of x at least `least` apart.

    It has a gap where y is NaN. The axis of y has zero, that of x only where it is among the values.

    `words` are title, caption and what the axes show, `said` a text a dot.
    """
    x, y = values
    return _curve(words, values, said, (_numbers(*_range(x), least), _numbers(*_range(y, 0.0))))


def convergence_curve(history: Sequence[Iteration]) -> Curve | None:
    """Return theta of each point of a tracked path, or the largest residual of each step, by decades."""
    tracked = any(stage.kind == "path" for stage in history)
    rounds = bool(history) and history[0].kind == "fixed point"
    worst = [max(stage.residuals.values(), default=np.nan) for stage in history]
    shown = [k for k, value in enumerate(worst) if np.isfinite(value) and value > 0.0]
    if len(shown) < 2:
        return None
    x, y = np.array(shown, dtype=float) + 1.0, np.log10([worst[k] for k in shown])
    said = [f"stage {k + 1}, {history[k].kind}: {_what(history[k])} {worst[k]:.1e}" for k in shown]
    low, high = float(np.floor(y.min())), float(np.ceil(y.max()))
    every = max(1, int(np.ceil((high - low) / 8)))
    decades = np.arange(low, max(high, low + 1.0) + 1.0, every)
    decades = decades if decades[-1] >= high else np.append(decades, decades[-1] + every)
    y_ticks = [(value, f"1e{value:.0f}") for value in decades.tolist()]
    title = (
        "Theta along the path, and the residual of its end" if tracked else "Largest residual of each step"
    )
    what = "Theta is what is left of compliance and barrier" if tracked else "The last one is the collapse"
    words = (
        title,
        f"{title}, from the {'associated state' if rounds else 'permanent loads'} on. {what}.",
        "stage",
        "theta" if tracked else "residual",
    )
    return _curve(words, (x, y), said, (_numbers(*_range(x, 0.0), 1.0), y_ticks))


def _what(stage: Iteration) -> str:
    return "theta" if stage.kind == "path" else "largest residual"


def _curve(
    words: tuple[str, str, str, str],
    values: tuple[Array, Array],
    said: Sequence[str],
    ticks: tuple[Ticks, Ticks],
) -> Curve:
    """Draw values through ticks; the first and the last tick, or a value beyond, end an axis."""
    x_places, x_ticks = _axis(values[0], ticks[0], LEFT, WIDTH - RIGHT)
    y_places, y_ticks = _axis(values[1], ticks[1], HEIGHT - BOTTOM, TOP)
    places = list(zip(x_places, y_places, strict=True))
    return Curve(
        *words,
        line=_line(places),
        dots=tuple((a, b, text) for (a, b), text in zip(places, said, strict=True) if isfinite(b)),
        x_ticks=x_ticks,
        y_ticks=y_ticks,
    )


def _line(places: Sequence[tuple[float, float]]) -> str:
    """Path through places, with a gap where y is NaN."""
    known = [isfinite(b) for _, b in places]
    starts = [" " if before else "M" for before in (False, *known)]
    return "".join(
        f"{start}{a:g},{b:g}" for start, (a, b), here in zip(starts, places, known, strict=False) if here
    )


def _axis(values: Array, ticks: Ticks, start: float, end: float) -> tuple[list[float], tuple[Tick, ...]]:
    """Places of values and ticks along an axis from `start` to `end`."""
    numbers = np.array([number for number, _ in ticks])
    low = min(float(np.nanmin(values)), numbers.min())
    high = max(float(np.nanmax(values)), numbers.max())
    places = start + (values - low) / (high - low) * (end - start)
    marks = (start + (numbers - low) / (high - low) * (end - start)).round(1).tolist()
    shown = zip(marks, ticks, strict=True)
    return places.round(1).tolist(), tuple(Tick(mark, text) for mark, (_, text) in shown)


def _range(values: Array, *among: float) -> tuple[float, float]:
    every = np.append(values, among)
    low, high = float(np.nanmin(every)), float(np.nanmax(every))
    return (low, high) if high > low else (low, low + 1.0)


def _numbers(low: float, high: float, least: float = 0.0) -> Ticks:
    """Round numbers at least `least` apart, four to ten of them if they can be, with their text."""
    size = 10.0 ** np.floor(np.log10((high - low) / 2.0))
    step = next(size * share for share in (0.2, 0.5, 1.0, 2.0) if (high - low) / (size * share) <= 10.0)
    step = max(step, least)
    numbers = step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1)
    return [(number, f"{number:.12g}") for number in (numbers.round(12) + 0.0).tolist()]
