"""The paths that are tried one after the other until one ends at a solution."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.errors import refuse_kind, sequence_of
from limitblocks.joints.base import checked_count


class Means(NamedTuple):
    """A path to try.

    Attributes
    ----------
    barrier : Barrier
    seed : int
        Of the weights of the rows, >= 0; 0: all are equal.
    budget : int
        Factorisations that the path may take.
    patience : int, optional
        The path is given up where theta does not fall to a third in so many factorisations.
    """

    barrier: Barrier
    seed: int
    budget: int
    patience: int | None = None


def checked_means(given: Sequence[Means]) -> tuple[Means, ...]:
    """Return the paths to try as a tuple; ModelError where one of their numbers is none."""
    means = sequence_of("means", given, Means)
    for one in means:
        refuse_kind(one.barrier, Barrier, "barrier of means")
        checked_count("seed of means", one.seed, 0)
        checked_count("budget of means", one.budget, 0)
        if one.patience is not None:
            checked_count("patience of means", one.patience, 1)
    return means


# Floor of the compliance with a larger barrier: what is left of it is an error of the flow at the end. Of the
# 12 rows of both lists of scripts/convergence that come to this path it closes all, with the floor of the
# small barrier, 1e-6, ten.
LOW = 1e-10

# The small barrier is the load path. Where it winds the compliance fades before the barrier (power 2), which
# cuts most folds; then the barrier is ten times as large, which leads to another solution, mostly at a higher
# load factor; then, in space, rounds of the fixed point, which close one of 16 first paths left open; then
# increments of the load path, and the outer loop of frozen friction from the permanent loads: of 17 random
# models of 1,000, weights decades apart, that all else left open these close eight and three.
# Of 79 first paths of 140 factorisations or more, patience gives up 51 of the 57 that do not close in 300,
# and two of the 22 that do, which the next path takes to the same load factor.
# In a plane increments come before: for a wall of Argiento et al. (.26) they give .266, larger barriers .293.
# Of the two lists of scripts/convergence, 278 cases, 12 come to .3. With the weights of seed 2 it
# closes all, as it does with those of 1 and with .2 or .5; with those of 3 and 4 all but one.
MEANS = (
    Means(Barrier(), 1, 300, 100),
    Means(Barrier(0.02, 2.0), 1, 300, 150),
    Means(Barrier(0.3, 2.0, LOW), 2, 800),
)
# In a plane or one half points cost little. Of 35 halves of the gallery's models of 16 to 84 blocks the path
# with power 2 closes 35 with equal weights, 34 with those of seed 1 and 35 with those of seed 2, at about the
# same cost; with equal ones a square vault is the same along both sides.
REDUCED_MEANS = (
    MEANS[0]._replace(patience=None),
    MEANS[1]._replace(patience=None, seed=0),
    MEANS[2],
)
# Of models of some hundred blocks in space, and of one half of them: the path with a small barrier bends at
# each row that starts to yield; it is followed as far as pays, and rounds of the fixed point close it. A
# barrier of 3 has fewer folds, and fewer still with equal weights and less of it where joints open: of 35
# halves of 8 to 42 blocks such a path takes 2,289 factorisations together, with random weights 2,367 to
# 2,573, with the whole of it where joints open 2,515, with both 2,569 to 2,752; a dome of 289 (no crushing,
# three pushes), which it closes, then stays open. It goes on, without compliance, to where rounds close it,
# which take a few tries on the way, or to where it is a solution as it is. The last closes a groin vault of
# 292 (point contacts, along), which winds with equal weights.
LARGE_MEANS = (
    Means(Barrier(), 1, 100),
    Means(Barrier(3.0, 2.0, 1e-12, 0.3), 0, 6000, 2000),
    Means(Barrier(3.0, 2.0, 1e-12, 0.3), 2, 4000, 2000),
)
# Of smaller models in space, pushed along no plane of symmetry, the three first leave vaults and domes open:
# 14 of 38 of 70 to 100 stones, of random weights, all of which that path closes. Rounds, increments and the
# outer loop close none of three domes of 46 to 56 stones, in three times the time.
SPATIAL_MEANS = (*MEANS, LARGE_MEANS[1]._replace(budget=3000, patience=1000))
# Beyond 300 blocks in space the last path is one of 3 with the whole of it where joints open, and without
# compliance: so towers of 504 pushed diagonally and a house of 505 (point contacts, out) close.
LARGEST_MEANS = (LARGE_MEANS[0], Means(Barrier(3.0, 2.0, 1e-12), 1, 4000))
# In a plane: of 14 walls of some 600 to 2,000 blocks, both joints, a barrier of 3 closes 12 in 222 to 847
# factorisations; two without crushing are left at 1.0 and 1.2e-8, which a round closes. One of 0.2 takes
# 1.0 to 3.1 times as many on those of up to 1,008 blocks, and ends 0.2 to 0.7 % lower; a small one does not
# close them in 2,500, and increments take 35 times their bounds.
LARGE_PLANAR_MEANS = (
    Means(Barrier(), 1, 100),
    Means(Barrier(3.0, 2.0, LOW), 1, 1500),
)
# With a flow that can give power, from the solution that twists about the centroid: a solution that gives
# power at an interface is none, and another seed leads to another one.
TURNED_MEANS = tuple(
    Means(barrier, seed, 200)
    for barrier in (Barrier(), Barrier(0.1, 2.0), Barrier(1.0, 2.0), Barrier(3.0, 1.0))
    for seed in (0, 1)
)
# Epsilon of Table 5 along the path, of the force of an interface: paths from the permanent loads wind where
# it is smaller; those that start near a solution end too far from the printed form where it is larger.
SOFTENING, TURNED_SOFTENING = 1e-3, 1e-6
