"""Every structure through formats in turn: the same words and interfaces, and the same bounds."""

import struct
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.geometry.polygon import areas
from limitblocks.structures import EXAMPLES

JOINT = lb.PointContact(friction=0.7)
LIVE = lb.mass_proportional((0.6, 0.8, 0.0))
EXACT = [".obj", ".stl", ".ply", ".dxf", ".3dm", ".json"]
PRECISION = dict.fromkeys(EXACT, 1e-9) | {".glb": 1e-6}  # glTF is single precision by its standard
NAMES = list(EXAMPLES)


def through(model, file):
    """The model of the blocks alone, written and read; supports are where they were."""
    held = np.array([block.centroid for block in model.blocks if block.name in model.supports])

    def supported(block):
        return np.abs(held - block.centroid).max(axis=1).min() < 1e-4

    lb.files.write_blocks(model, file)
    return lb.read(file, joint=JOINT, supports=supported, unit_weight=20e3, live=LIVE)


def in_turn(k, suffixes, count):
    """Of all formats those whose turn it is at structure k: every seventh goes through the same."""
    return [suffixes[(count * k + j) % len(suffixes)] for j in range(count)]


@cache
def structure(name):
    """The structure, and all the interfaces that its blocks have."""
    model = EXAMPLES[name](JOINT)
    return model, lb.find_interfaces(model.blocks, JOINT)


def same_interfaces(blocks, before, tolerance):
    """The interfaces found between `blocks` are those from before, in their order, by place and area."""
    after = lb.find_interfaces(blocks, JOINT)
    assert len(after) == len(before)
    totals = [sum(areas(interface.polygon) for interface in found) for found in (before, after)]
    assert totals[1] == pytest.approx(totals[0], rel=tolerance)
    places = [np.array([interface.centroid for interface in found]) for found in (before, after)]
    assert np.abs(places[1] - places[0]).max() <= 10 * tolerance * np.abs(places[0]).max()


@pytest.mark.parametrize(
    ("name", "suffix"),
    [(name, one) for k, name in enumerate(NAMES) for one in in_turn(k, list(PRECISION), 3)],
)
def test_words_and_interfaces_survive(tmp_path, name, suffix):
    model, interfaces = structure(name)
    found = lb.files.read_blocks(lb.files.write_blocks(model, tmp_path / f"structure{suffix}"))
    if suffix == ".ply":  # has no names
        assert found.blocks[1].name == "structure 2"
    else:
        assert [block.name for block in found.blocks] == [block.name for block in model.blocks]
        assert found.notes == ()
    if suffix in (".dxf", ".3dm", ".json"):
        assert found.supports == model.supports
        assert [block.layer for block in found.blocks] == [
            block.layer or ("support" if block.name in model.supports else "block") for block in model.blocks
        ]
    same_interfaces(found.blocks, interfaces, PRECISION[suffix])


@pytest.mark.parametrize("name", ["wall", "arch", "barrel_vault"])
def test_binary_stl_without_names_is_told_apart_where_blocks_touch(name, tmp_path):
    model, interfaces = structure(name)
    text = lb.files.write_blocks(model, tmp_path / "text.stl")
    corners = np.array(
        [line.split()[1:] for line in text.read_text().splitlines() if "vertex" in line], float
    )
    records = np.zeros(len(corners) // 3, [("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    records["c"] = corners.reshape(-1, 3, 3)
    path = tmp_path / "binary.stl"
    path.write_bytes(b"solid".ljust(80) + struct.pack("<I", len(records)) + records.tobytes())
    same_interfaces(lb.files.read_blocks(path).blocks, interfaces, 1e-6)


@pytest.mark.parametrize("k", range(len(NAMES)), ids=NAMES)
def test_bounds_survive(tmp_path, k):
    """Each structure through one of the formats, in turn; a two-leaf wall has left out some interfaces."""
    own, interfaces = structure(NAMES[k])
    model = replace(own, interfaces=interfaces, dead=lb.self_weight(), live=LIVE)
    again = through(model, tmp_path / f"structure{EXACT[k % len(EXACT)]}")
    before, after = lb.bounds(model), lb.bounds(again)
    assert after.lower == pytest.approx(before.lower, abs=1e-6)
    assert after.upper == pytest.approx(before.upper, abs=1e-6)
