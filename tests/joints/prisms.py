"""Stones with a foot of any outline, and the page that says how far off their strengths are."""

from pathlib import Path

from stones import model_of

import limitblocks as lb

DOCS = (Path(__file__).parents[2] / "docs/choosing-a-joint.md").read_text(encoding="utf-8")


def prism(outline, height):
    """A stone with a foot of any outline on the ground."""
    foot = lb.Block.prism("foot", outline, (0.0, height), 20e3, along="z")
    return [lb.Block.box("ground", (20.0, 20.0, 1.0), (0.0, 0.0, -0.5)), foot]


def pushed(blocks, joint, direction):
    return model_of(blocks, ["ground"], joint, (*direction, 0.0))
