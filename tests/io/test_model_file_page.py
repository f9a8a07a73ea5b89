"""The joints of docs/model-file.md that are no contacts: its examples have the load factors it states."""

import json
import re
from pathlib import Path

import pytest

import limitblocks as lb
from limitblocks.io.registry import JOINTS

PAGE = (Path(__file__).parents[2] / "docs" / "model-file.md").read_text(encoding="utf-8")
SECTION = PAGE[PAGE.index("### Ties") : PAGE.index("## Materials")]
WHOLE, *PARTS = re.findall(r"```json\n(.*?)```", SECTION, flags=re.DOTALL)
MU, F, W = 0.3, 4e3, 40e3


def load_factors(document, tmp_path):
    file = tmp_path / "model.json"
    file.write_text(json.dumps(document))
    found = lb.bounds(lb.read(file))
    return found.lower, found.upper


@pytest.mark.parametrize(
    ("kind", "part", "place", "expected"),
    [
        ("Tie", "", 2, MU + F / W),
        ("Dowel", PARTS[0], 1, MU + F / W),
        ("Backfill", PARTS[1], 1, MU + F / W),
        ("Guide", PARTS[2], 0, F / W),
    ],
)
def test_an_example_of_each_joint(kind, part, place, expected, tmp_path):
    document, other = json.loads(WHOLE), json.loads(f"{{{part}}}")
    document["joints"] |= other.get("joints", {})
    document["interfaces"][place : place + 1] = other.get("interfaces", [])
    assert kind in {joint["type"] for joint in document["joints"].values()}
    assert load_factors(document, tmp_path) == pytest.approx((expected, expected), rel=1e-6)


def test_without_the_tie_the_block_slides_at_its_friction(tmp_path):
    document = json.loads(WHOLE)
    del document["interfaces"][1]
    assert load_factors(document, tmp_path) == pytest.approx((MU, MU), rel=1e-6)


def test_every_joint_is_described_with_its_parameters():
    for name, kind in JOINTS.items():
        row = re.search(rf"^\| `{name}` \|.*$", SECTION, flags=re.MULTILINE)
        if hasattr(kind, "word"):  # no contact
            assert [key for key in kind.__dataclass_fields__ if f"`{key}`" not in row[0]] == [
                key for key in ("length", "prestress") if name == "Backfill"
            ]
