import numpy as np
import pytest

import limitblocks as lb
from limitblocks.geometry import select

BLOCKS = [
    lb.Block.box("ground", (4, 1, 0.2), (0, 0, -0.1)),
    *(
        lb.Block.box(name, (0.5, 1.0, 0.5), (0, 0, 0.25 + 0.5 * k)).labelled(
            unit_weight=None, layer=layer, material=material
        )
        for k, (name, layer, material) in enumerate(
            [("pier 1", "WALL", "granite"), ("pier 2", "WALL", "brick"), ("cap[1]", "TOP::north", "brick")]
        )
    ),
]
FOUND = {
    "ground": ["ground"],
    "WALL": ["pier 1", "pier 2"],
    "layer:WALL": ["pier 1", "pier 2"],
    "layer:TOP*": ["cap[1]"],
    "name:pier ?": ["pier 1", "pier 2"],
    "material:brick": ["pier 2", "cap[1]"],
    "pier*": ["pier 1", "pier 2"],
    "cap[1]": ["cap[1]"],  # the name itself, not the pattern
    "z<0.05": ["ground"],
    "z <= 0.5": ["ground", "pier 1"],
    "z>0.5": ["pier 2", "cap[1]"],
    "x<-1": [],
}


@pytest.mark.parametrize("text", FOUND)
def test_blocks_by_text(text):
    if FOUND[text]:
        assert list(select(BLOCKS, text)) == FOUND[text]
        assert list(select(BLOCKS, [text, "ground"])) == list(dict.fromkeys(["ground", *FOUND[text]]))
    else:
        with pytest.raises(lb.ModelError, match="matches no block"):
            select(BLOCKS, text)


def test_blocks_by_function():
    assert select(BLOCKS, lambda block: block.volume > 0.5) == ("ground",)
    with pytest.raises(lb.ModelError, match="true for none of 4 blocks"):
        select(BLOCKS, lambda block: block.volume > 5.0)


NOTHING = {
    "layer:wall": "support 'layer:wall' matches no layer; did you mean 'WALL'?; there are layers 'WALL' (2)",
    "grund": "support 'grund' is neither a block nor a layer; did you mean 'ground'?; there are layers ",
    "q*": "support 'q*' matches no name and no layer; there are layers 'WALL' (2), 'TOP::north' (1); ",
    "z<-0.1": "support 'z<-0.1' matches no block: tops along z (m): 'ground' 0, 'pier 1' 0.5, 'pier 2' 1",
    "z<1e": "'z<1e' has no number",
    "": "support '' is neither a block nor a layer",
}


@pytest.mark.parametrize("text", NOTHING)
def test_what_matches_nothing_is_told_with_what_there_is(text):
    with pytest.raises(lb.ModelError) as caught:
        select(BLOCKS, text, "support")
    assert NOTHING[text] in str(caught.value)


def test_a_labelled_block_is_the_same_body():
    block = lb.Block.box("a", (1, 2, 3), (0, 0, 0), unit_weight=1.0)
    other = block.labelled(unit_weight=2.0, layer="L", material="M")
    assert (other.layer, other.material, other.unit_weight, other.volume) == ("L", "M", 2.0, block.volume)
    assert (block.layer, block.unit_weight) == ("", 1.0)
    for wrong in ({"layer": None}, {"material": 3}):
        with pytest.raises(lb.ModelError, match="text is needed"):
            block.labelled(**({"unit_weight": None, "layer": "", "material": ""} | wrong))


def test_rounding_of_a_height_hides_no_block():
    """0.2 * 3 is 0.6000000000000001."""
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    courses = [lb.Block.prism(str(k), square, (0.2 * k, 0.2 * (k + 1)), along="z") for k in range(4)]
    assert select(courses, "z<0.6") == ("0", "1", "2")
    assert select(courses, "z<0.599999") == ("0", "1")
    moved = [block.moved(-np.eye(3)[[1, 0, 2]], (0, 0, 0)) for block in courses]
    assert select(moved, "z>-0.6") == ("0", "1", "2")
