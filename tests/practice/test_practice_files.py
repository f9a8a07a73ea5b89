"""Results of practice that lack a part, as files may: named, whatever is then asked of them."""

import json
from dataclasses import fields

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice import Repair, SettlementCurve, Verification, WorstPosition, capacity_curve

BLOCK = lb.structures.block(lb.PointContact(0.7), width=0.3, height=1.2)


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    curve = capacity_curve(BLOCK, steps=2, largest=1e-3)
    return json.loads(curve.save(tmp_path_factory.mktemp("kept") / "curve.json").read_text("utf-8"))


def read(document, tmp_path):
    (file := tmp_path / "curve.json").write_text(json.dumps(document), "utf-8")
    return lb.read_result(file, BLOCK)


def test_a_curve_without_points(kept, tmp_path):
    with pytest.raises(lb.ModelError, match="a capacity curve without points"):
        read(kept | {"points": []}, tmp_path)


def test_a_curve_whose_first_point_presses_across_a_gap(kept, tmp_path):
    kept["points"][0]["across"] = ["base|block 1 presses across a gap of 1 mm"]
    curve = read(kept, tmp_path)
    assert curve.proven_to == 0.0
    assert "beyond 0 m joints press across their gaps" in str(curve)


@pytest.mark.parametrize(
    ("kind", "parts", "said"),
    [
        (SettlementCurve, {"points": ()}, "a settlement until collapse without points"),
        (Verification, {"quantities": ()}, "a verification without a0*"),
        (Repair, {"amounts": np.ones(2), "candidates": ("tie",)}, "2 amounts of 1 candidate"),
        (
            WorstPosition,
            {"positions": np.ones(2), "load_factors": np.ones(1)},
            "1 load factor of 2 positions",
        ),
    ],
)
def test_a_part_that_is_missing_is_named(kind, parts, said):
    with pytest.raises(lb.ModelError) as caught:
        kind(**{one.name: parts.get(one.name) for one in fields(kind)})
    assert str(caught.value).startswith(said)
