"""The curve of a load path as lines for an SVG."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from limitblocks.analysis.results import LoadPath
from limitblocks.arrays import Array
from limitblocks.model import Model

WIDTH, HEIGHT = 1000.0, 360.0  # user units of the SVG
LEFT, RIGHT, TOP, BOTTOM = 110.0, 30.0, 20.0, 60.0
AXES = "XYZ"


class Tick(NamedTuple):
    """Place along an axis in user units, and its number."""

    place: float
    text: str


class Curve(NamedTuple):
    """Curve in user units of a 1000 by 360 view box: labels, SVG path, dots with their text, ticks."""

    title: str
    x_label: str
    y_label: str
    line: str
    dots: tuple[tuple[float, float, str], ...]
    x_ticks: tuple[Tick, ...]
    y_ticks: tuple[Tick, ...]


def path_curve(model: Model, path: LoadPath) -> Curve | None:
    """Return the load factor against the displacement that grows most, or against the step if none does."""
    if len(path.steps) < 2:
        return None
    moved = np.abs(path.steps[-1].displacements[:, :3])
    if moved.max(initial=0.0) > 0.0:
        block, component = divmod(int(moved.argmax()), 3)
        x, loads = path.curve(block, component)
        label = f"displacement of {model.blocks[block].name} along {AXES[component]}, m"
    else:
        x, loads = np.arange(float(len(path.steps))), path.curve(0, 0)[1]
        label = "step"
    x_low, x_high = _range(x)
    y_low, y_high = _range(loads)
    across = LEFT + (x - x_low) / (x_high - x_low) * (WIDTH - LEFT - RIGHT)
    up = HEIGHT - BOTTOM - (loads - y_low) / (y_high - y_low) * (HEIGHT - TOP - BOTTOM)
    places = list(zip(across.round(1).tolist(), up.round(1).tolist(), strict=True))
    said = (f"step {k}: load factor {value:.6g}" for k, value in enumerate(loads))
    return Curve(
        title=f"Load factor against {label.removesuffix(', m')}",
        x_label=label,
        y_label="load factor",
        line="M" + " ".join(f"{a:g},{b:g}" for a, b in places),
        dots=tuple((a, b, text) for (a, b), text in zip(places, said, strict=True)),
        x_ticks=_ticks(x_low, x_high, LEFT, WIDTH - RIGHT),
        y_ticks=_ticks(y_low, y_high, HEIGHT - BOTTOM, TOP),
    )


def _range(values: Array) -> tuple[float, float]:
    low, high = min(0.0, float(values.min())), max(0.0, float(values.max()))
    return (low, high) if high > low else (low, low + 1.0)


def _ticks(low: float, high: float, start: float, end: float) -> tuple[Tick, ...]:
    """Ticks at round numbers, four to ten of them."""
    size = 10.0 ** np.floor(np.log10((high - low) / 2.0))
    step = next(size * share for share in (0.2, 0.5, 1.0, 2.0) if (high - low) / (size * share) <= 10.0)
    numbers = step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1)
    places = start + (numbers - low) / (high - low) * (end - start)
    return tuple(
        Tick(round(place, 1), f"{number:g}")
        for place, number in zip(places.tolist(), (numbers.round(12) + 0.0).tolist(), strict=True)
    )
