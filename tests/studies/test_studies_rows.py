"""Rows of a sampled study: which of them count, and what its file says of them."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.studies import SampledStudy, sampled

ASK = {"friction": (0.2, 0.6)}


def block(friction):
    return lb.structures.block(lb.PointContact(friction), width=1.0, height=1.0)


def test_rows_for_indices_are_no_samples():
    """The first three of six are independent: of .1, .2, .3 the median is .2, and a third is below .15."""
    factors = np.array([0.1, 0.3, 0.2, 9.0, 9.0, 9.0])
    modes = ("hinge", "slide", "hinge", "slide", "slide", "slide")
    found = SampledStudy(
        "bounds", ("x",), factors[:, None], factors, modes, 6 * ("",), samples=3, indices=True
    )
    assert found.quantiles([0.5]) == pytest.approx([0.2])
    assert found.probability_below(0.15) == pytest.approx(1 / 3)
    assert found.mode_frequencies() == pytest.approx({"hinge": 2 / 3, "slide": 1 / 3})


def test_an_unlimited_load_is_one_when_it_is_read_again(tmp_path, monkeypatch):
    file = tmp_path / "study.jsonl"
    monkeypatch.setattr(
        sampled, "one_row", lambda k, *_: {"row": k, "load_factor": np.inf, "mode": "", "error": ""}
    )
    for _ in range(2):  # the second reads what the first wrote
        assert lb.study(block, ASK, 2, file=file).load_factors.tolist() == [np.inf, np.inf]


def test_a_file_of_other_settings_is_of_another_study(tmp_path):
    """A load factor within 1e-3 is not one within 1e-6."""
    file = tmp_path / "study.jsonl"
    lb.study(block, ASK, 2, file=file, tolerance=1e-3)
    with pytest.raises(lb.ModelError, match="is of another study: settings"):
        lb.study(block, ASK, 2, file=file, tolerance=1e-6)
