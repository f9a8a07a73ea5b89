"""A study over sampled parameters: quasi-random or random, kept in a file, in processes or on a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from inspect import signature
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from limitblocks.arrays import read_only
from limitblocks.errors import ModelError, path_of, refuse_no_function
from limitblocks.model import Model
from limitblocks.studies.pool import (
    FAILURES,
    INTERRUPTED,
    Analysis,
    Progress,
    analyse,
    checked_settings,
    checked_workers,
    failed,
    fits,
    in_order,
)
from limitblocks.studies.sample_result import SampledStudy
from limitblocks.studies.samples import Sampler, sampled_values
from limitblocks.studies.study_file import Row, ask_of_maker, head_of, keep, kept_rows

AT_ONCE = 64  # rows handed to the processes before the first is written


def study(
    maker: Callable[..., Model],
    parameters: Mapping[str, Any],
    n: int,
    *,
    sampler: Sampler = "sobol",
    seed: int = 0,
    analysis: Analysis = "bounds",
    file: str | Path | None = None,
    workers: int | None = 1,
    client: Any = None,
    indices: bool = False,
    progress: Progress | None = None,
    **settings: Any,
) -> SampledStudy:
    """Return load factors for sampled values of parameters, such as friction and unit weight.

    Parameters
    ----------
    maker : callable
        Gives the model of values: ``maker(friction=.6, height=3.)``. For processes and clusters it must be a
        function of a module.
    parameters : mapping
        Of each name an interval (low, high), or a frozen distribution of scipy.stats (anything with `ppf`).
    n : int
        Number of samples; of each matrix where `indices` are asked for.
    sampler : {"sobol", "latin hypercube", "halton", "random"}
        How the unit cube is filled, scipy.stats.qmc; a power of two suits "sobol".
    seed : int
        The same seed gives the same samples.
    analysis : {"bounds", "nonassociated"}
        Which load factor.
    file : path, optional
        A file of JSON lines to which every row is added when it is done. A study that was ended goes on where
        it stopped; a file of other parameters is refused. A maker that now makes another model of the first
        row is warned of, in the log: name a new file.
    workers : int or None
        Processes; 1 stays in this one, None takes one for each core. Pays where an analysis takes seconds.
    client : dask.distributed.Client, optional
        Cluster on which the analyses run, in place of processes.
    indices : bool
        Sample for Sobol indices (Saltelli et al. 2010): n (k + 2) analyses for k parameters, n a power of 2.
    progress : callable, optional
        Called with the number of analyses done and of all.
    **settings
        Further arguments of the analysis.

    Raises
    ------
    ModelError
        If a parameter, the sampler, a name, a setting or a number is wrong, or the file is of another study.
    """
    checked_settings(analysis, settings)
    checked_workers(workers)
    refuse_no_function(maker)
    store = path_of(file) if file is not None else None
    if store is not None and store.is_dir():
        raise ModelError(f"{store} is a folder; name a file in it")
    names, values = sampled_values(parameters, n, sampler, seed, indices)
    fits("the maker", signature(maker), (), parameters)
    head = head_of(parameters, values, sampler, seed, analysis, settings, indices)
    done = kept_rows(store, head)
    samples = [dict(zip(names, row, strict=True)) for row in values.tolist()]
    ask_of_maker(store, done, maker, samples)
    tasks = [(k, maker, sample, analysis, settings) for k, sample in enumerate(samples) if k not in done]
    try:
        for row in _answers(tasks, workers, client):
            done[row["row"]] = row
            keep(store, head, row)
            if progress:
                progress(len(done), len(values))
    except KeyboardInterrupt:
        if not done:
            raise
    undone = {"load_factor": np.nan, "mode": "", "error": INTERRUPTED}
    rows = [done.get(k, undone) for k in range(len(values))]
    return SampledStudy(
        analysis=analysis,
        names=names,
        values=read_only(values),
        load_factors=read_only(np.array([row["load_factor"] for row in rows], dtype=float)),
        modes=tuple(row["mode"] for row in rows),
        errors=tuple(row["error"] for row in rows),
        samples=n,
        indices=indices,
        remarks=tuple(row.get("remarks", "") for row in rows),
    )


def one_row(
    number: int,
    maker: Callable[..., Model],
    values: dict[str, float],
    analysis: Analysis,
    settings: dict[str, Any],
) -> Row:
    """Return the row of one sample; an error becomes a row."""
    from limitblocks.evidence.interface_states import interface_states

    mode, remarks, digest = "", "", ""
    try:
        model = maker(**values)
    except FAILURES as error:
        outcome = failed(error)
    else:
        outcome, digest = analyse(model, analysis, settings), model.digest
        if outcome.result is not None and not outcome.error:
            words = {
                part for state in interface_states(model, outcome.result).state for part in state.split("-")
            }
            mode, remarks = "-".join(sorted(words - {"stick"})), "; ".join(outcome.result.remarks)
    found = {"row": number, "load_factor": float(outcome.load_factor)}
    return found | {"mode": mode, "error": outcome.error, "remarks": remarks, "model": digest}


def _answers(tasks: Sequence[tuple[Any, ...]], workers: int | None, client: Any) -> Iterator[Row]:
    if client is not None:
        from importlib import import_module

        completed = import_module("dask.distributed").as_completed
        futures = [client.submit(one_row, *task, pure=False) for task in tasks]
        yield from (future.result() for future in completed(futures))
        return
    rest: Iterable[tuple[Any, ...]] = iter(tasks)
    while batch := list(islice(rest, AT_ONCE)):
        yield from in_order(one_row, batch, workers)
