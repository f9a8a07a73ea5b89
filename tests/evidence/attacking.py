"""How false claims are registered, and made from true ones."""

from dataclasses import dataclass

import numpy as np
from true_claims import changed, state_of, true

from limitblocks.problem import Mode

ATTACKS = {}


@dataclass(frozen=True)
class Attack:
    """A false claim: made by `make` as (model, claim), refused by exactly the residuals `names`."""

    make: object
    names: frozenset


def attack(*names, **variants):
    """Register what makes a false claim; one for each variant (a label and the arguments)."""

    def register(function):
        word = function.__name__.replace("_", " ")
        for label, arguments in variants.items() or [("", ())]:
            name = f"{word}, {label}" if label else word
            assert name not in ATTACKS
            ATTACKS[name] = Attack(lambda given=arguments: function(*given), frozenset(names))
        return function

    return register


def each(*names):
    """Variants: true claims by name."""
    return {name: (name,) for name in names}


def with_part(name, **change):
    """The true claim `name` with parts of its state changed by functions."""
    model, claim = true(name)
    state = state_of(model, claim)
    return model, changed(model, claim, **{part: f(getattr(state, part)) for part, f in change.items()})


def balanced(model, claim, load_factor):
    """The claim of another load factor with the stresses that balance it, the least change of them."""
    p, state = model.problem, state_of(model, claim)
    a = load_factor * p.units.live
    more = np.linalg.lstsq(p.C.T.toarray(), (a - state.load_factor) * p.live, rcond=None)[0]
    return changed(model, claim, load_factor=a, x=state.x + more)


def slip_of(model, interface, u):
    """Multipliers of the slip cone of one interface for the rates u."""
    p = model.problem
    y, rate = np.zeros(len(p.g)), p.C @ u
    rows = [k for k in np.flatnonzero(p.row_interface == interface) if p.row_mode[k] is Mode.SLIP]
    head, across = rows[0], rows[1:3]
    V = p.G[across].toarray()
    y[across] = -np.linalg.lstsq(V.T, rate, rcond=None)[0]
    y[head] = np.linalg.norm(y[across])
    return y


def rows_of(model, mode, interface):
    p = model.problem
    found = np.flatnonzero(p.row_interface == interface)
    return [k for k in found if p.row_mode[k] is mode]
