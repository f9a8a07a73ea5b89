"""Places where forces act, those of one kind together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from limitblocks.arrays import Array, Indices, in_blocks, owned, same_rows
from limitblocks.problem.limit_problem import LimitProblem
from limitblocks.problem.places import places
from limitblocks.problem.plane.rounding import AGREE, size_of


@dataclass(frozen=True, eq=False)
class Place:
    """K places of one kind: `c` stresses each, `linear` rows and then `cones` of one size each.

    Attributes
    ----------
    columns : Indices, shape (K, c)
        Their generalised stresses.
    rows : Indices, shape (K, r)
        Their rows: linear ones, then those of each cone.
    linear : int
        Number of linear rows.
    cones : tuple of int
        Sizes of the cones.
    ends : Indices, shape (K, 2)
        Free blocks at both ends, -1 for a support.
    strain : Array, shape (K, 2, c, 6)
        Strain rates per rate of the block at each end.
    middle : Array, shape (K, 2, c, 6)
        Their mean over the places of the interface.
    sort : Indices, shape (K,)
        Equal for places with the same rows.
    F, G : Array, shape (q, r, c)
        Yield rows and plastic potential of each sort, in the force of the interface.
    g : Array, shape (q, r)
        Constant terms, in the same.
    """

    columns: Indices
    rows: Indices
    linear: int
    cones: tuple[int, ...]
    ends: Indices
    strain: Array
    middle: Array
    sort: Indices
    F: Array
    G: Array
    g: Array

    @cached_property
    def members(self) -> tuple[slice, ...]:
        """Rows of each linear row and each cone."""
        sizes = (1,) * self.linear + self.cones
        first = np.concatenate([[0], np.cumsum(sizes)]).tolist()
        return tuple(slice(a, b) for a, b in pairwise(first))


def kinds_of(problem: LimitProblem, strain: Array) -> Iterator[Place]:
    """The places of a problem, those of one kind together; `strain` (s, 2, 6) as in :class:`Place`."""
    of_member, of_stress = places(problem)
    of_row = of_member[problem.cones.member]
    count = int(max(of_member.max(initial=-1), of_stress.max(initial=-1))) + 1
    columns, column = owned(of_stress, count)
    rows, _ = owned(of_row, count)
    mix = np.cos(column**2 + 1.0)  # numbers without a pattern: unlike rows differ
    mixed = np.stack([problem.F @ mix, problem.G @ mix, problem.g]) * problem.units.row
    for its, linear, cones in _alike(problem, of_member, of_stress, count):
        c, r = int((of_stress == its[0]).sum()), linear + sum(cones)
        own, its_rows = columns[its, :c], rows[its, :r]
        values = mixed[:, its_rows].swapaxes(0, 1).reshape(len(its), -1)
        size = size_of(values)
        one, sort = same_rows(np.concatenate([values / size, np.log2(size)], axis=1), AGREE)
        few = its_rows[one].ravel()
        first, unit = np.arange(len(few)) * c, problem.units.row[its_rows[one]]
        at = strain[own[:, None], [[0], [1]]]
        yield Place(
            columns=own,
            rows=its_rows,
            linear=linear,
            cones=cones,
            ends=problem.ends[problem.stress_interface[own[:, 0]]],
            strain=at,
            middle=_means(at, problem.stress_interface[own[:, 0]]),
            sort=sort,
            F=in_blocks(problem.F[few], first, column, (len(one), r, c)) * unit[..., None],
            G=in_blocks(problem.G[few], first, column, (len(one), r, c)) * unit[..., None],
            g=problem.g[its_rows[one]] * unit,
        )


def _means(values: Array, of: Indices) -> Array:
    """Mean of values (K, ...) over all of the same number in `of` (K,), at each of them."""
    count = np.bincount(of)
    if count.max() == 1:
        return values
    total = np.zeros((len(count), *values.shape[1:]))
    np.add.at(total, of, values)
    return np.asarray(total[of] / count[of].reshape(-1, *[1] * (values.ndim - 1)))


def _alike(
    problem: LimitProblem, of_member: Indices, of_stress: Indices, count: int
) -> Iterator[tuple[Indices, int, tuple[int, ...]]]:
    """Places with the same numbers of stresses, of linear rows, and of cones of each size; these two."""
    cones = problem.cones
    size = np.bincount(cones.member, minlength=cones.degree)
    size[: cones.linear] = 0  # a cone of one row is none
    kinds = np.unique(size[cones.linear :]).tolist()
    numbers = [np.bincount(of_stress, minlength=count)]
    numbers += [np.bincount(of_member[size == kind], minlength=count) for kind in (0, *kinds)]
    of_kind = np.ravel_multi_index(numbers, [int(number.max()) + 1 for number in numbers])
    for kind in np.unique(of_kind).tolist():
        its = np.flatnonzero(of_kind == kind)
        linear, *its_cones = (int(number[its[0]]) for number in numbers[1:])
        yield its, linear, tuple(size for size, k in zip(kinds, its_cones, strict=True) for _ in range(k))
