"""Rows of a joint of one's own that no analysis could use are refused with a sentence."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

import limitblocks as lb


@dataclass(frozen=True)
class Own:
    """OrdunaLourenco with other rows."""

    friction: float
    word: str

    def yield_rows(self, polygons, stress_unit=1.0):
        rows = lb.OrdunaLourenco(self.friction).yield_rows(polygons, stress_unit)
        if self.word == "free":  # torsion has no limit
            F, G = rows.F.copy(), rows.G.copy()
            F[:, :, 5] = G[:, :, 5] = 0.0
            return replace(rows, F=F, G=G)
        if self.word == "left out":
            rows = self.yield_rows_of("free", polygons)
            return replace(rows, F=rows.F[..., :5], G=rows.G[..., :5], resultants=rows.resultants[..., :5])
        if self.word == "short":
            return replace(rows, pivot=rows.pivot[:, 1:])
        return rows

    def yield_rows_of(self, word, polygons):
        return replace(self, word=word).yield_rows(polygons)


def pushed(word):
    return lb.structures.block(Own(0.3, word), width=1.0, height=1.0)


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("free", "no row of F that limits the generalised stress 5"),
        ("short", "has pivot of .* rows, expected"),
    ],
)
def test_rows_that_no_analysis_could_use_are_refused(word, said):
    with pytest.raises(lb.ModelError, match=said):
        lb.bounds(pushed(word))


@pytest.mark.parametrize("word", ["", "left out"])
def test_a_stress_that_is_left_out_is_zero(word):
    """A block that slides at the friction coefficient needs no torsion."""
    assert np.isclose(lb.bounds(pushed(word)).lower, 0.3, rtol=1e-7)
