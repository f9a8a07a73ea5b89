"""Studies of a series of models: push directions, places of a load, values of a parameter."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array, read_only, reals_if_any
from limitblocks.errors import ModelError, refuse_no_function
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import compass, top_force, turned, unit_vector
from limitblocks.model import Model, checked_model
from limitblocks.practice.partial_factors import with_live
from limitblocks.studies.pool import FAILURES, Analysis, Outcome, Progress, analyse_all, failed
from limitblocks.studies.results import ANSWER, Directions, MovingLoad, Sweep
from limitblocks.studies.rows import refuse_column


def directions(
    model: Model,
    directions: int | npt.ArrayLike = 16,
    *,
    live: Callable[[tuple[float, float, float]], Load] | None = None,
    analysis: Analysis = "bounds",
    workers: int | None = 1,
    progress: Progress | None = None,
    **settings: Any,
) -> Directions:
    """Return the load factor for each direction of the live load.

    The least of them is not the least of all directions: a push square to an edge that lies half way between
    two of n directions has cos(180 / n degrees) times what they have. ``between`` of the result is a proven
    bound for all directions between; without dilatancy there is none.

    Parameters
    ----------
    model : Model
        The structure; its live load is turned into each direction.
    directions : int or array_like, shape (n, 3)
        Number of directions equally spaced in plan (:func:`limitblocks.loads.compass`), or vectors of any
        length.
    live : callable, optional
        Gives the live load of a direction (a unit vector); needed where the model's live load is not
        mass-proportional. In a design model it is multiplied by gamma_Q.
    analysis : {"bounds", "nonassociated"}
        Which load factor.
    workers : int or None
        Processes; 1 stays in this one, None takes one for each core. The results are the same.
    progress : callable, optional
        Called with the number of analyses done and of all.
    **settings
        Further arguments of the analysis, such as `tolerance`.

    Raises
    ------
    ModelError
        If a direction is wrong, or the live load cannot be turned.
    """
    checked_model(model)
    given = (
        compass(directions)
        if isinstance(directions, int | np.integer)
        else _table(directions, 3, "directions")
    )
    units = [unit_vector(direction, "direction") for direction in given.tolist()]

    def pushed(direction: tuple[float, float, float]) -> Model:
        if live is None:
            return replace(model, live=turned(model.live, direction))
        return with_live(model, live(direction))

    if live is None:
        turned(model.live, (1.0, 0.0, 0.0))  # a live load that cannot be turned is no matter of one row
    models = _made(pushed, units)
    outcomes = analyse_all(models, analysis, settings, workers, progress)
    convex = live is None and analysis == "bounds"
    return Directions(*_columns(analysis, outcomes), directions=read_only(units), convex=convex)


def moving_load(
    model: Model,
    load: Sequence[float] | Callable[[tuple[float, float]], Load],
    positions: npt.ArrayLike,
    *,
    analysis: Analysis = "bounds",
    workers: int | None = 1,
    progress: Progress | None = None,
    **settings: Any,
) -> MovingLoad:
    """Return the load factor of a load at each of a series of places, and the worst of these places.

    Other places may have less; :func:`limitblocks.practice.worst_position` searches between them.

    Parameters
    ----------
    model : Model
        The structure; its live load is replaced by the moving one, in a design model times gamma_Q.
    load : sequence of float or callable
        Force (N, global axes) on top of the highest free block at the place, see
        :func:`limitblocks.loads.top_force`; or a function of the place that gives the load, such as several
        axles.
    positions : array_like, shape (n, 2)
        Places (x, y) in plan, m. At a place without a free block below, the row has an error.
    analysis, workers, progress, **settings
        As for :func:`directions`.

    Raises
    ------
    ModelError
        If the force or a place is not made of finite numbers.
    """
    checked_model(model)
    given = _table(positions, 2, "positions")
    places = [(x, y) for x, y in given.tolist()]
    at = load if callable(load) else (lambda place: top_force(load, place))
    if not callable(load):
        top_force(load, (0.0, 0.0))  # a wrong force is no matter of one row
    models = _made(lambda place: with_live(model, at(place)), places)
    outcomes = analyse_all(models, analysis, settings, workers, progress)
    return MovingLoad(*_columns(analysis, outcomes), positions=read_only(given))


def sweep(
    maker: Callable[[Any], Model],
    values: Iterable[Any],
    *,
    parameter: str = "value",
    analysis: Analysis = "bounds",
    workers: int | None = 1,
    progress: Progress | None = None,
    **settings: Any,
) -> Sweep:
    """Return the load factor of `maker(value)` for each value of a parameter.

    All models are made first, in this process. What `maker` cannot make becomes the error of its row: errors
    of limitblocks, of values and of arithmetic; others are raised.

    Parameters
    ----------
    maker : callable
        Gives the model of a value.
    values : iterable
        Of the parameter.
    parameter : str
        Its name, in tables.
    analysis, workers, progress, **settings
        As for :func:`directions`.

    Raises
    ------
    ModelError
        If there is no value, or `values` is no sequence, or the parameter has the name of a column.
    """
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise ModelError(f"values is {values!r}, expected a sequence of values of the parameter")
    refuse_column(parameter, ANSWER)
    given = tuple(values)
    if not given:
        raise ModelError("sweep: there are no values, expected at least one")
    outcomes = analyse_all(_made(maker, given), analysis, settings, workers, progress)
    return Sweep(*_columns(analysis, outcomes), parameter=parameter, values=given)


def _made(maker: Callable[[Any], Model], values: Iterable[Any]) -> list[Model | Outcome]:
    """The model of each value, or the outcome that there is none."""
    refuse_no_function(maker)
    made: list[Model | Outcome] = []
    for value in values:
        try:
            made.append(maker(value))
        except FAILURES as error:
            made.append(failed(error))
    return made


def _columns(analysis: str, outcomes: list[Outcome]) -> tuple[str, Array, tuple[Any, ...], tuple[str, ...]]:
    load_factors = read_only([outcome.load_factor for outcome in outcomes])
    return analysis, load_factors, tuple(o.result for o in outcomes), tuple(o.error for o in outcomes)


def _table(values: npt.ArrayLike, columns: int, word: str) -> Array:
    array = reals_if_any(values)
    if array.ndim != 2 or array.shape[1] != columns or not len(array) or not np.isfinite(array).all():
        raise ModelError(f"{word}: finite numbers of shape (n, {columns}) are needed, n at least 1")
    return array
