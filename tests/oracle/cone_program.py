"""Conic programs in 50- to 150-digit arithmetic: no scale of the data can hide behind rounding.

    max alpha   s.t.   B f + alpha live = - dead,   f in K

K is a product of cones x0 >= ||(x1, x2)||. Homogeneous self-dual embedding, Nesterov-Todd scaling, Mehrotra's
predictor and corrector; written for small, dense programs (some 50 rows) and in `decimal` of the standard
library, so that it shares neither a solver nor a floating-point format with the library it judges.
"""

from dataclasses import dataclass
from decimal import Decimal, DecimalException, getcontext, localcontext

import numpy as np

DIGITS = (50, 150)  # the second where the first are not enough: normal matrices square the spread of the data
CLOSE = Decimal("1e-14")  # relative gap and residuals asked of a solution; doubles of the data have 16 digits
SURE = Decimal("1e-18")  # residual of a certificate of infeasibility, its objective being one
STEPS = 150
ZERO, ONE, TWO = Decimal(0), Decimal(1), Decimal(2)
FLIP = np.array([ONE, -ONE, -ONE], dtype=object)

exact = np.vectorize(lambda value: Decimal(float(value)), otypes=[object])
root = np.vectorize(Decimal.sqrt, otypes=[object])


@dataclass(frozen=True)
class Answer:
    """Status "optimal", "infeasible" (no alpha), "unbounded" or "undecided"; numbers are Decimals."""

    status: str
    value: Decimal | None = None
    doubt: Decimal | None = None
    forces: np.ndarray | None = None
    rates: np.ndarray | None = None
    steps: int = 0


def inner(a, b):
    """Cone by cone (x0 y0 - x1 y1 - x2 y2)."""
    return a[:, 0] * b[:, 0] - a[:, 1] * b[:, 1] - a[:, 2] * b[:, 2]


def jordan(a, b):
    """Cone by cone (a.b, a0 b1 + b0 a1)."""
    head = (a * b).sum(axis=1)
    return np.column_stack([head, a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:]])


def jordan_solve(a, b):
    """Cone by cone the x with jordan(a, x) = b."""
    head = inner(a, b) / inner(a, a)
    return np.column_stack([head, (b[:, 1:] - head[:, None] * a[:, 1:]) / a[:, :1]])


class Scaling:
    """Symmetric W with W x = W^-1 s, cone by cone."""

    def __init__(self, x, s):
        x_norm, s_norm = root(inner(x, x)), root(inner(s, s))
        a, b = s / s_norm[:, None], FLIP * x / x_norm[:, None]
        w = (a + b) / root(2 * (ONE + (a * b * FLIP).sum(axis=1)))[:, None]
        self.w, self.size = w, root(s_norm / x_norm)

    def times(self, v, sign=ONE):
        """W v, or W^-1 v for sign -1."""
        w0, w1 = self.w[:, 0], sign * self.w[:, 1:]
        along = (w1 * v[:, 1:]).sum(axis=1)
        tail = v[:, 1:] + (v[:, 0] + along / (ONE + w0))[:, None] * w1
        size = self.size if sign > 0 else ONE / self.size
        return size[:, None] * np.column_stack([w0 * v[:, 0] + along, tail])

    def inverse_squares(self):
        """W^-2 as matrices (p, 3, 3)."""
        v = FLIP * self.w
        matrices = TWO * v[:, :, None] * v[:, None, :]
        for k in range(3):
            matrices[:, k, k] -= FLIP[k]
        return matrices / (self.size**2)[:, None, None]


def cholesky(M):
    """Lower factor; a pivot lost to rounding becomes huge, so that its unknown is zero."""
    M, n = M.copy(), len(M)
    least = M.diagonal() * Decimal(10) ** (5 - getcontext().prec)
    for k in range(n):
        pivot = M[k, k] if M[k, k] > least[k] else Decimal("1e200")
        M[k:, k] = M[k:, k] / pivot.sqrt()
        M[k, k] = pivot.sqrt()
        column = M[k + 1 :, k]
        rows = np.flatnonzero(column != 0) + k + 1
        M[np.ix_(rows, rows)] -= np.outer(M[rows, k], M[rows, k])
    return M


def solve(L, right):
    """Solve L L^T x = right for the columns of `right`."""
    x = right.copy()
    for k in range(len(L)):
        x[k] = x[k] / L[k, k]
        x[k + 1 :] -= np.outer(L[k + 1 :, k], x[k])
    for k in reversed(range(len(L))):
        x[k] = (x[k] - L[k + 1 :, k] @ x[k + 1 :]) / L[k, k]
    return x


def longest(x, d):
    """Largest step (at most one) from x along d within the cones."""
    step = ONE
    for a, b, c, x0, d0 in zip(inner(d, d), inner(x, d), inner(x, x), x[:, 0], d[:, 0], strict=True):
        discriminant = b * b - a * c
        if discriminant > 0:
            # smallest positive root of a t^2 + 2 b t + c, written without cancellation
            q = -(b + (discriminant.sqrt() if b >= 0 else -discriminant.sqrt()))
            for top, bottom in ((q, a), (c, q)):
                if bottom != 0 and 0 < top / bottom < step:
                    step = top / bottom
        if d0 < 0 and -x0 / d0 < step:
            step = -x0 / d0
    return step


def maximise(groups, rows, dead, live):
    """Solve the program of this module.

    `groups` are pairs (row numbers, matrix (len(row numbers), 3 p)): columns of B, three to a cone, that meet
    the same few of the `rows`.
    """
    answer = Answer("undecided")
    for digits in DIGITS:
        with localcontext() as context:
            context.prec = digits
            try:
                answer = _Embedding(groups, rows, dead, live).run()
            except DecimalException:  # a cone left by rounding
                continue
        if answer.status != "undecided":
            break
    return answer


class _Embedding:
    def __init__(self, groups, rows, dead, live):
        self.groups = groups
        self.n, self.b, self.live = rows, -dead, live
        self.counts = [matrix.shape[1] // 3 for _, matrix in groups]
        p = sum(self.counts)
        self.x, self.s = (np.full((p, 3), ZERO, dtype=object) for _ in range(2))
        self.x[:, 0] = self.s[:, 0] = ONE
        self.y = np.full(rows, ZERO, dtype=object)
        self.alpha, self.tau, self.kappa = ZERO, ONE, ONE

    def forward(self, x):
        out, at = np.full(self.n, ZERO, dtype=object), 0
        for (row, matrix), count in zip(self.groups, self.counts, strict=True):
            out[row] += matrix @ x[at : at + count].ravel()
            at += count
        return out

    def backward(self, y):
        return np.concatenate([(y[row] @ matrix).reshape(-1, 3) for row, matrix in self.groups])

    def normal_matrix(self, squares):
        M, at = np.full((self.n, self.n), ZERO, dtype=object), 0
        for (row, matrix), count in zip(self.groups, self.counts, strict=True):
            parts = [
                matrix[:, 3 * k : 3 * k + 3] @ squares[at + k] @ matrix[:, 3 * k : 3 * k + 3].T
                for k in range(count)
            ]
            M[np.ix_(row, row)] += sum(parts)
            at += count
        return M

    def residuals(self):
        primal = self.forward(self.x) + self.alpha * self.live - self.tau * self.b
        dual = -self.backward(self.y) - self.s
        unit = -(self.live @ self.y) - self.tau  # live . y = -1
        gap = self.b @ self.y + self.alpha - self.kappa
        return primal, dual, unit, gap

    def run(self):
        for step in range(STEPS):
            residuals = self.residuals()
            answer = self.judged(*residuals, step)
            if answer is not None:
                return answer
            self.advance(*residuals)
        return Answer("undecided", steps=STEPS)

    def judged(self, primal, dual, unit, gap, steps):
        """The answer, if the present point proves one."""
        work, size = self.b @ self.y, max(abs(self.y))
        if self.kappa > self.tau:
            if max(abs(dual).max(), abs(self.live @ self.y)) < SURE * work:
                return Answer("infeasible", steps=steps)
            if abs(primal + self.tau * self.b).max() < SURE * self.alpha:
                return Answer("unbounded", steps=steps)
        if size == 0 or self.tau < SURE * self.kappa:
            return None
        alpha, upper = self.alpha / self.tau, -work / self.tau
        # what the residuals may be worth, and the gap between the two values, relative to the value
        worth = (
            abs(primal) @ abs(self.y) + (abs(dual) * self.x).sum() + abs(unit * self.alpha)
        ) / self.tau**2
        doubt = (abs(upper - alpha) + worth) / max(abs(alpha), Decimal("1e-12"))
        if doubt < CLOSE and abs(primal).max() / self.tau < CLOSE:
            return Answer("optimal", alpha, doubt, self.x / self.tau, self.y / self.tau, steps)
        return None

    def advance(self, primal, dual, unit, gap):
        scaling = Scaling(self.x, self.s)
        squares, middle = scaling.inverse_squares(), scaling.times(self.x)
        L = cholesky(self.normal_matrix(squares))
        fixed = solve(L, np.column_stack([self.live, self.b]))
        mu = ((self.x * self.s).sum() + self.tau * self.kappa) / (len(self.x) + 1)
        square = jordan(middle, middle)

        def direction(share, target, product):
            r1, r2, r3, r4 = (-share * r for r in (primal, dual, unit, gap))
            scaled = scaling.times(jordan_solve(middle, target), -ONE)
            pulled = np.einsum("pij,pj->pi", squares, r2)
            u = solve(L, (r1 - self.forward(pulled + scaled))[:, None])[:, 0]
            v, w = fixed.T
            # unknowns: rates of alpha and tau
            a11, a12, c1 = self.live @ v, -(self.live @ w) - ONE, r3 + self.live @ u
            a21 = -(self.b @ v) + ONE
            a22 = self.b @ w + self.kappa / self.tau
            c2 = r4 - self.b @ u + product / self.tau
            det = a11 * a22 - a12 * a21
            d_alpha, d_tau = (c1 * a22 - a12 * c2) / det, (a11 * c2 - c1 * a21) / det
            dy = u - v * d_alpha + w * d_tau
            ds = -self.backward(dy) - r2
            dx = scaled - np.einsum("pij,pj->pi", squares, ds)
            return dx, ds, dy, d_alpha, d_tau, (product - self.kappa * d_tau) / self.tau

        result = direction(ONE, -square, -self.tau * self.kappa)
        share = (ONE - self.step(result)) ** 3
        target = -square - jordan(scaling.times(result[0]), scaling.times(result[1], -ONE))
        target[:, 0] += share * mu
        product = share * mu - self.tau * self.kappa - result[4] * result[5]
        result = direction(ONE - share, target, product)
        step = self.step(result) * Decimal("0.99")
        steps = [step * part for part in result]
        self.x, self.s, self.y = self.x + steps[0], self.s + steps[1], self.y + steps[2]
        self.alpha += steps[3]
        self.tau += steps[4]
        self.kappa += steps[5]

    def step(self, result):
        step = min(longest(self.x, result[0]), longest(self.s, result[1]))
        for value, rate in ((self.tau, result[4]), (self.kappa, result[5])):
            if rate < 0:
                step = min(step, -value / rate)
        return step
