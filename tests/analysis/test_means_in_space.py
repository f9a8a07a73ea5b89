"""Vaults in space, pushed along no plane of symmetry: the further means that close them."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures

PUSH = (float(np.cos(0.3)), float(np.sin(0.3)), 0.0)


@pytest.mark.parametrize(
    ("joint", "courses", "stones"),
    [(lb.OrdunaLourenco(0.8), 6, 9), (lb.PointContact(0.6), 6, 9)],
    ids=["paper", "point contact"],
)
def test_a_large_barrier_closes_domes_that_the_first_means_leave_open(joint, courses, stones):
    """Without it rounds, increments and the outer loop follow, and leave them open, too."""
    dome = structures.dome(joint, radius=3.0, thickness=0.4, courses=courses, stones=stones)
    model = replace(dome, live=lb.mass_proportional(PUSH))
    found = lb.nonassociated(model)
    assert lb.check_mcp(model, found).passed
    assert 0.0 < found.load_factor <= found.associated * (1 + 1e-8)
    assert found.how.startswith("tracked path, barrier 3 (large barrier)")
    assert any("a large barrier led to this solution" in said for said in found.remarks)
