"""Contacts that a mechanism in space fits together at first order alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures
from limitblocks.practice.advance import moved_until_contact
from limitblocks.practice.displaced import assembly_of


def test_a_step_is_not_cut_where_contacts_fit_at_first_order() -> None:
    """Its own contacts leave 7e-8 m on the way: closing them moved blocks by 9 mm, and cut it to 9.4e-6 m."""
    corner = structures.EXAMPLES["corner"](lb.PointContact(0.8))
    model = replace(corner, live=lb.mass_proportional((0.0, -1.0, 0.0)))
    rates = lb.nonassociated(model, confirm=False).displacement_rates
    asked = 6e-4 * rates / np.abs(rates[:, :3]).max()
    found = moved_until_contact(assembly_of(model), asked)
    assert found is not None
    first, last = (np.stack([b.centroid for b in one.blocks]) for one in (model, found[0].model))
    assert np.abs(last - first).max() == pytest.approx(6e-4, rel=1e-2)
