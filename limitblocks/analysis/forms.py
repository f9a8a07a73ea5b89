"""Forms of the programs of the bounds: in stresses, or in rates alone where the joints let multipliers go.

A contact point has as many stresses as rows that matter: F^T y = -C u then says what y is, and the
kinematic program is left with rates alone; its dual is the stress state. Other joints have more rows than
stresses: for them the static program is the smallest. Figures: docs/solvers.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import cvxpy as cp
import numpy as np
from scipy import sparse

from limitblocks.analysis.programs import Program, map_in_cone
from limitblocks.analysis.scales import Scaled, with_rates_near_one
from limitblocks.arrays import Array, Indices
from limitblocks.problem import Cones, LimitProblem, State, in_units


@dataclass(frozen=True, eq=False)
class Stresses:
    """The static programs; rates and multipliers are their duals."""

    problem: Scaled
    patience: ClassVar[int] = 4  # of the polish: duals follow the flow rule as far as the solver has it
    planar: bool = False
    refined: bool = False  # Clarabel's own equations: a fifth to a quarter slower, and surer

    @property
    def equations(self) -> Mapping[str, object]:
        """Settings of Clarabel's linear equations.

        Pivots of stresses may vanish: its own replacement of those alone disturbs least, in a plane by a
        larger number than its own. Not so where as many rows as stresses act on each joint of a plane.
        """
        if self.refined:
            return {}
        square = self.planar and self.problem.F.shape[0] == self.problem.F.shape[1]
        return {
            "static_regularization_constant": 1e-8 if square else 1e-14,
            "dynamic_regularization_delta": 1e-6 if self.planar else 2e-7,
            "iterative_refinement_enable": False,
        }

    def within(self, loads: Array, most: float = np.inf, room: Array | None = None) -> Program:
        """Largest t <= 1 of stresses that carry loads with F x + g - t room in K. Variable: t and x.

        The `room` (R,) is the `margin` unless given. The rows are at most `most` in the mean.
        """
        p, s = self.problem, self.problem.C.shape[0]
        v, first = cp.Variable(1 + s), np.eye(1, 1 + s)
        balance = sparse.hstack([sparse.csc_array((len(loads), 1)), p.C.T], format="csr")[self.balanced]
        lost = p.margin if room is None else room
        rows = sparse.hstack([sparse.csr_array(-lost[:, None]), p.F], format="csr")
        inside = map_in_cone(rows, v, p.cones, p.g if p.g.any() else None)
        bounded = [sparse.csr_array(-first) @ v + np.ones(1) >= 0.0]
        if np.isfinite(most):
            one = p.cones.identity
            left = np.array([most * p.cones.degree - one @ p.g])
            bounded.append(sparse.csr_array(-np.append(0.0, one @ p.F)[None]) @ v + left >= 0.0)
        constraints = [balance @ v == loads[self.balanced], *bounded, *inside]
        return Program(cp.Problem(cp.Minimize(-first[0] @ v), constraints), (v,))

    def carrying(self) -> Program:
        """Joints that can be strictly within yield under the dead loads: t_i = 1, the others 0.

        Largest sum of t_i <= 1 of stresses that carry k times the dead loads, k >= 1, with F x + k g - t room
        in K (Freund, Roundy & Todd 1985, Identifying the set of always-active constraints in a system of
        linear inequalities by a single linear program). Variable: k, t (m,) and x.
        """
        p, loads = self.problem, self.problem.dead[self.balanced]
        m, rows = len(p.problem.interfaces), np.arange(len(p.g))
        lost = sparse.csr_array((-p.margin, (rows, p.problem.row_interface)), (len(rows), m))
        A = sparse.hstack([sparse.csr_array(p.g[:, None]), lost, p.F], format="csr")
        free = [sparse.csr_array((len(loads), m)), p.C.T]
        balance = sparse.hstack([sparse.csr_array(-loads[:, None]), free[0], free[1][self.balanced]])
        v = cp.Variable(A.shape[1])
        first = sparse.eye_array(1 + m, A.shape[1], format="csr")  # k and t
        least = first @ v + np.append(-1.0, np.zeros(m)) >= 0.0
        most = -first[1:] @ v + np.ones(m) >= 0.0
        cost = np.append(0.0, np.ones(m)) @ first
        constraints = [sparse.csr_array(balance) @ v == 0.0 * loads, least, most, *map_in_cone(A, v, p.cones)]
        return Program(cp.Problem(cp.Minimize(-cost @ v), constraints), (v,))

    def opening(self, amount: Array) -> Program:
        """The same of mechanisms that open joints by t_i of the `amount` (R,). Variable: t (m,), u and y."""
        p, (R, m) = self.problem, (len(self.problem.g), len(self.problem.problem.interfaces))
        lost = sparse.csr_array((-amount, (np.arange(R), p.problem.row_interface)), (R, m))
        flow = sparse.hstack([sparse.csr_array((p.C.shape[0], m)), p.C, p.F.T], format="csr")
        rows = sparse.hstack([lost, sparse.csr_array((R, p.C.shape[1])), sparse.eye_array(R)], format="csr")
        v = cp.Variable(flow.shape[1])
        t = sparse.eye_array(m, flow.shape[1], format="csr")
        ends = [t @ v >= 0.0, -t @ v + np.ones(m) >= 0.0]
        constraints = [flow @ v == np.zeros(p.C.shape[0]), *ends, *map_in_cone(rows, v, p.cones)]
        return Program(cp.Problem(cp.Minimize(-(np.ones(m) @ t) @ v), constraints), (v,))

    @cached_property
    def balanced(self) -> Indices:
        """Equations of equilibrium with any number in them: rates out of a plane have none."""
        p = self.problem
        moved = np.bincount(p.C.indices, minlength=len(p.dead)) > 0
        return np.flatnonzero(moved | (p.dead != 0.0) | (p.live != 0.0))

    def limit(self) -> Program:
        """Largest load factor in equilibrium within the yield set. Variable: load factor and x."""
        p, equations = self.problem, self.balanced
        s, F, pushed = p.C.shape[0], p.F, np.flatnonzero(p.live)
        v, least = cp.Variable(1 + s), -np.eye(1, 1 + s)[0]
        data, equation = np.append(-p.live[pushed], p.C.data), np.append(pushed, p.C.indices)
        start = np.concatenate([[0], len(pushed) + p.C.indptr])  # columns of C^T are the rows of C
        place = np.zeros(len(p.dead), dtype=np.int32)
        place[equations] = np.arange(len(equations))
        columns: Any = (data, place[equation], start)
        balance = sparse.csc_array(columns, shape=(len(equations), 1 + s)) @ v == p.dead[equations]
        rows = sparse.csr_array((F.data, F.indices + 1, F.indptr), shape=(len(p.g), 1 + s))
        inside = map_in_cone(rows, v, p.cones, p.g if p.g.any() else None)
        return Program(cp.Problem(cp.Minimize(least @ v), [balance, *inside]), (v,))

    def limit_state(self, v: Array, w: Array) -> State:
        """The state of a solution of `limit` and its duals."""
        u, count = np.zeros(len(self.problem.dead)), len(self.balanced)
        u[self.balanced] = -w[:count]
        return State(float(v[0]), v[1:], u, w[count:])


@dataclass(frozen=True, eq=False)
class Rates:
    """The kinematic programs without multipliers; stresses are their duals."""

    problem: Scaled
    kept: Indices  # rows of F that matter, shape (s,)
    dropped: Indices  # rows that the head of a cone among them implies
    head: Indices  # of that cone, shape (dropped,)
    patience: ClassVar[int] = 1  # where one step fails, as on facades, the others do
    # B has full rank: what Clarabel adds to the pivots, 1e-8 by default, only stalls facades
    equations: ClassVar[Mapping[str, object]] = {
        "static_regularization_constant": 1e-11,
        "iterative_refinement_enable": False,
    }

    @cached_property
    def entry(self) -> tuple[Indices, Array]:
        """Stress that each kept row acts on, and its factor, shapes (s,)."""
        rows = self.problem.F[self.kept]
        return np.asarray(rows.indices, dtype=np.int64), np.asarray(rows.data)

    @cached_property
    def B(self) -> sparse.csr_array:
        """Multipliers of the kept rows as a function of the rates, shape (s, 6 n)."""
        stress, factor = self.entry
        return in_units(self.problem.C[stress], -1.0 / factor, np.ones(len(self.problem.dead)))

    @cached_property
    def cones(self) -> Cones:
        """K of the kept rows."""
        cones = self.problem.cones
        return Cones(cones.linear - len(self.dropped), cones.second_order)

    def limit(self) -> Program:
        """Least load factor over all mechanisms. Variable: u."""
        p, u = self.problem, cp.Variable(self.B.shape[1])
        constraints = [p.live @ u == 1, *map_in_cone(self.B, u, self.cones)]
        return Program(cp.Problem(cp.Minimize(-p.dead @ u), constraints), (u,))

    def limit_state(self, u: Array, w: Array) -> State:
        """The state of a solution of `limit` and its duals."""
        return State(-float(w[0]), self.stresses(w[1:]), u, self.multipliers(u))

    def multipliers(self, u: Array) -> Array:
        """Multipliers that follow the rates: dropped rows take half of what their cone has.

        Taken from the head, which acts on the same stress, it leaves both within K.
        """
        p = self.problem
        y = np.zeros(p.F.shape[0])
        y[self.kept] = self.B @ u
        if len(self.dropped):
            room = np.zeros_like(y)
            room[p.cones.heads] = p.cones.margin(y)
            half = np.maximum(room[self.head], 0.0) / 2.0
            y[self.head] -= half
            y[self.dropped] = half / self.leverage
        return y

    @cached_property
    def leverage(self) -> Array:
        """Multiplier of its head that does what that of a dropped row does."""
        F = self.problem.F  # one entry in each row
        return np.asarray(F[self.dropped].data / F[self.head].data)

    def stresses(self, rows: Array) -> Array:
        """Stresses of the kept rows (s,)."""
        stress, factor = self.entry
        x = np.empty(len(stress))
        x[stress] = rows / factor
        return x


def form_of(problem: LimitProblem) -> Stresses | Rates:
    """Return the form in which a problem is solved fastest."""
    own = with_rates_near_one(problem)
    return without_multipliers(own) or Stresses(own)


def without_multipliers(problem: Scaled) -> Rates | None:
    """Return the form in rates, or None where the flow rule leaves multipliers free.

    Every row must act on one stress, every stress in one row, but for linear rows that the head of a cone
    implies: t >= ||z|| of the cone asks for t >= 0.
    """
    cones, F = problem.cones, problem.F
    if problem.g.any() or (np.diff(F.indptr) != 1).any():
        return None
    stress, linear = F.indices, cones.linear
    heads = np.full(F.shape[1], -1)
    heads[stress[cones.heads[linear:]]] = cones.heads[linear:]
    head = heads[stress[:linear]]
    implied = (head >= 0) & (F.data[:linear] * F.data[head] > 0.0)
    kept = np.append(np.flatnonzero(~implied), np.arange(linear, F.shape[0]))
    if (np.bincount(stress[kept], minlength=F.shape[1]) != 1).any():
        return None
    return Rates(problem, kept, np.flatnonzero(implied), head[implied])
