"""Which stage is the answer: the converged one even after a peak, else the best of those near collapse."""

import numpy as np
import pytest

from limitblocks.analysis.nonassociated.loop import best_of
from limitblocks.analysis.nonassociated.stage import Stage, State
from limitblocks.evidence.residuals import Residual, Residuals


def stage(load_factor, residual, kind="step"):
    state = State(load_factor, np.zeros(0), np.zeros(0), np.zeros(0))
    return Stage(state, Residuals((Residual("flow", residual, ""),)), 1.0, kind, 1, 0)


@pytest.mark.parametrize("kind", ["step", "jump", "fixed point"])
def test_a_converged_state_below_an_earlier_peak_is_the_answer(kind):
    met = [stage(1.0, 0.1), stage(0.5, 1e-9, kind)]
    assert best_of(met, 1e-6) is met[1]


def test_without_convergence_an_early_elastic_state_is_not_the_best():
    met = [stage(0.1, 1e-3), stage(0.95, 1e-1), stage(1.0, 2e-1)]
    assert best_of(met, 1e-6) is met[1]


def test_nothing_met_is_nothing():
    assert best_of([], 1e-6) is None
