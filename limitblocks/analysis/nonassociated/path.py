"""A solution of Eqs (54)-(59) at the end of one path, followed through its folds by arclength."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.analysis.nonassociated.path_equations import (
    Barrier, Equations, Linear, Path, Point, negative, residuals, theta_slope,
)
from limitblocks.analysis.nonassociated.path_layout import Layout
from limitblocks.analysis.nonassociated.path_metric import inner, spread, room
from limitblocks.analysis.nonassociated.polish import defect, polish
from limitblocks.arrays import Array
from limitblocks.problem import Flow, State

SPREAD = 0.7
WIDE = np.log(5.0)  # of the products about their targets
FLOW = 0.05  # of theta: the flow residual of a point near the path
BOUNDARY = 0.95
FIRST = 0.3
LEAST = 1e-8
CUT = 0.35
CORRECTORS = 5
CLOSED = 1e-9
TRIED = 1e-5  # theta from which on the end game is tried, at each decade
LAST = 1e-11


@dataclass
class Info:
    how: str = ""
    factorisations: int = 0
    folds: int = 0
    steps: int = 0
    failures: int = 0
    theta: float = 1.0
    residual: float = np.inf
    message: str = ""
    trace: list = None


class Lost(Exception):
    pass


def weights_of(flow: Flow, seed: int) -> Array:
    cones = flow.problem.cones
    w = np.exp(np.random.default_rng(seed).uniform(-SPREAD, SPREAD, cones.degree))
    return w[cones.member] * cones.identity


def begin(flow, x0, weights, barrier, seed, layout):
    p = flow.problem
    u = np.zeros(p.C.shape[1])
    flexibility = np.zeros((layout.interfaces, layout.stresses.shape[1], layout.stresses.shape[1])) + layout.padding
    k = np.arange(flexibility.shape[1])
    flexibility[:, k, k] += layout.per_interface(1.0 / weights)
    C = layout.compatibility
    K = layout.condensed(np.swapaxes(C, 1, 2) @ flexibility @ C)
    from scipy.sparse import linalg
    w = linalg.splu(K).solve(np.append(np.zeros_like(u), 1.0))
    # unit work of the unit load: -K u + a live = 0, live.u = 1 -> a = 1/(live K^-1 live)
    rho0 = float(w[-1])
    return Path(flow, layout, barrier, weights_of(flow, seed), rho0 * weights, x0, np.zeros_like(x0))


def centred(path: Path, info) -> Point:
    p = path.flow.problem
    cones = p.cones
    rows = p.F @ path.x0 + p.g
    push = np.maximum(0.0, 0.1 - cones.margin(rows))
    s = rows + push[cones.member] * cones.identity
    y = path.barrier.size * inverse_of(cones, s)
    y *= 1.0
    z = Point(path.x0, np.zeros(p.C.shape[1]), 0.0, s, y, 1.0)
    for _ in range(60):
        R = residuals(path, z)
        size = max(np.abs(R.flow).max() / FLOW, np.abs(R.balance).max(), abs(R.work), np.abs(R.slack).max())
        if size < 1e-9 and spread(cones, z.s, z.y, path.target(1.0)) < WIDE:
            return z
        info.factorisations += 1
        d = Linear(path, z).solve(negative(R))
        t = min(1.0, 0.9 * room(cones, z, d))
        z = z.moved(t, d)
    raise Lost("not centred")


def inverse_of(cones, s):
    found = 1.0 / np.where(s == 0, 1, s)
    for index in cones.groups:
        v = s[index].copy()
        det = v[:, 0] ** 2 - (v[:, 1:] ** 2).sum(axis=1)
        v[:, 1:] *= -1
        found[index] = v / det[:, None]
    return found


def merit(path, z, R=None):
    R = residuals(path, z) if R is None else R
    return max(spread(path.flow.problem.cones, z.s, z.y, path.target(z.theta)) / WIDE, float(np.abs(R.flow).max()) / (FLOW * z.theta))


def track(flow: Flow, x0: Array, weights: Array, *, barrier=Barrier(), seed=0, budget=800, progress=None, keep=None):
    info = Info(trace=[])
    layout = Layout(flow.problem)
    cones = flow.problem.cones
    best = None
    try:
        path = begin(flow, x0, weights, barrier, seed, layout)
        z = centred(path, info)
    except (Lost, RuntimeError, np.linalg.LinAlgError) as e:
        info.message = f"start {e}"
        return None, info
    h, orientation, last_sign = FIRST, None, None
    base = None  # last accepted point, its tangent and h
    correctors = 0
    tried = TRIED
    state = None

    def back():
        nonlocal h, z, correctors
        h *= CUT
        info.failures += 1
        if base is None or h < LEAST:
            raise Lost("steps too short")
        z0, c, T = base
        z = predicted(cones, z0, c, T, h)
        correctors = 0

    try:
        while True:
            if info.factorisations >= budget:
                raise Lost("budget")
            R = residuals(path, z)
            m = merit(path, z, R)
            if not np.isfinite(m) or (m > 1.0 and correctors >= CORRECTORS):
                back(); continue
            try:
                info.factorisations += 1
                L = Linear(path, z)
                v = L.solve(negative(R))
                t = L.solve(negative(theta_slope(path, z)))
            except (RuntimeError, np.linalg.LinAlgError, ValueError):
                back(); continue
            t = replace(t, theta=1.0)
            norm = np.sqrt(inner(cones, z, t, t))
            if not np.isfinite(norm) or norm == 0 or L.sign == 0:
                back(); continue
            if orientation is None:
                orientation = -L.sign
            T = scaled(t, orientation * L.sign / norm)
            c = v.moved(-inner(cones, z, v, T), T)
            if m > 1.0:  # correct
                correctors += 1
                ok = False
                tt = min(1.0, BOUNDARY * room(cones, z, c))
                for _ in range(6):
                    zn = z.moved(tt, c)
                    mn = merit(path, zn)
                    if mn < (1 - 0.1 * tt) * m or mn <= 1.0:
                        ok = True; break
                    tt *= 0.5
                if not ok:
                    back(); continue
                z = zn
                continue
            # accepted
            info.steps += 1
            if last_sign is not None and L.sign != last_sign:
                info.folds += 1
            last_sign = L.sign
            if base is not None:
                h = h * 2 if correctors <= 1 else h
            info.theta = z.theta
            info.trace.append((z.theta, z.load_factor, L.sign, correctors, h))
            if progress: progress(info, z)
            if z.theta > 1.2:
                raise Lost("returned")
            if z.theta < tried:
                tried = z.theta / 10
                state = State(z.load_factor, z.x, z.u, z.y)
                state = polish(flow, state)
                info.residual = defect(flow, state)
                if best is None or info.residual < defect(flow, best): best = state
                if info.residual < CLOSED:
                    info.message = "closed"
                    return state, info
                if z.theta < LAST:
                    raise Lost("end")
            if z.theta ** barrier.power <= barrier.floor:
                move = path.rho(z.theta) * path.elastic * (z.x - path.x0) / z.theta
                path = replace(path, x0=z.x, carried=path.carried - move)
            base = (z, c, T)
            z = predicted(cones, z, c, T, h)
            correctors = 0
    except Lost as e:
        info.message = str(e)
        if best is None:
            best = polish(flow, State(z.load_factor, z.x, z.u, z.y))
        info.residual = defect(flow, best)
        return best, info


def scaled(d: Point, k: float) -> Point:
    return Point(k * d.x, k * d.u, k * d.load_factor, k * d.s, k * d.y, k * d.theta)


def predicted(cones, z, c, T, h):
    t = min(1.0, 0.5 * room(cones, z, c))
    z = z.moved(t, c)
    return z.moved(min(h, BOUNDARY * room(cones, z, T)), T)
