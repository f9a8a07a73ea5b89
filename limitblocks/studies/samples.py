"""Values of parameters: points of the unit cube, scaled to intervals or distributions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, get_args

import numpy as np
from scipy.stats import qmc

from limitblocks.arrays import Array, reals
from limitblocks.errors import ModelError
from limitblocks.joints.base import checked_choice, checked_count
from limitblocks.studies.rows import refuse_column
from limitblocks.studies.sample_result import ANSWER

Sampler = Literal["sobol", "latin hypercube", "halton", "random"]


def sampled_values(
    parameters: Mapping[str, Any], n: int, sampler: str, seed: int, indices: bool
) -> tuple[tuple[str, ...], Array]:
    """Return names and values (rows, k): the samples, or A, B and the k matrices with one column of B."""
    checked_choice("sampler", sampler, get_args(Sampler))
    checked_count("n", n, 2 if indices else 1)
    checked_count("seed", seed, 0)
    given: Any = parameters
    if not isinstance(given, Mapping) or not all(isinstance(name, str) for name in given):
        raise ModelError(f"parameters is {given!r}, expected intervals by name, {{'friction': (0.4, 0.7)}}")
    names, k = tuple(parameters), len(parameters)
    if not names:
        raise ModelError("a study needs at least one parameter")
    for name in names:
        refuse_column(name, ANSWER)
    if indices and n & (n - 1):
        raise ModelError(f"n is {n}, expected a power of two for Sobol indices")
    d = 2 * k if indices else k
    generator = np.random.default_rng(seed)
    kinds: dict[str, Callable[[], Array]] = {
        "sobol": lambda: _sobol(d, n, seed),
        "latin hypercube": lambda: qmc.LatinHypercube(d, rng=generator).random(n),
        "halton": lambda: qmc.Halton(d, rng=generator).random(n),
        "random": lambda: generator.random((n, d)),
    }
    unit = kinds[sampler]()
    if indices:
        A, B = unit[:, :k], unit[:, k:]
        mixed = [np.where(np.arange(k) == j, B, A) for j in range(k)]
        unit = np.concatenate([A, B, *mixed])
    columns = [_scaled(name, parameters[name], unit[:, j]) for j, name in enumerate(names)]
    return names, np.stack(columns, axis=1)


def _sobol(d: int, n: int, seed: int) -> Array:
    """The first n points of a scrambled Sobol sequence; the next power of two is drawn, as it is balanced."""
    drawn = qmc.Sobol(d, rng=np.random.default_rng(seed)).random_base2(int(np.ceil(np.log2(max(n, 2)))))
    return np.asarray(drawn[:n])


def _scaled(name: str, given: Any, unit: Array) -> Array:
    """Values of a parameter at quantiles."""
    if hasattr(given, "ppf"):
        values = np.asarray(given.ppf(unit), dtype=float)
    else:
        try:
            low, high = reals(given)
        except (TypeError, ValueError):
            low = high = np.nan
        if not low < high:
            raise ModelError(f"parameter {name!r} is {given!r}, expected (low, high) or a distribution")
        values = low + (high - low) * unit
    if not np.isfinite(values).all():
        raise ModelError(f"parameter {name!r}: its distribution gives values that are not finite")
    return values
