import numpy as np
import pytest

import limitblocks as lb
from limitblocks.joints import Material, Materials, weaker

GRANITE = lb.OrdunaLourenco(0.7, compressive_strength=20e6, cohesion=1e5)
LIMESTONE = lb.OrdunaLourenco(0.6, cohesion=2e5)
BOXES = [
    lb.Block.box(name, (1, 1, 1), (0, 0, k)).labelled(unit_weight=None, layer=layer, material="")
    for k, (name, layer) in enumerate([("ground", "BASE"), ("a", "WALL"), ("b", "WALL"), ("key", "TOP")])
]
TABLE = Materials(
    {
        "ground": Material(blocks=["layer:BASE"]),
        "limestone": Material(22e3, LIMESTONE, ["key"]),
        "granite": Material(26e3, GRANITE, ["layer:*"]),
    }
)


def test_blocks_get_the_first_material_that_picks_them():
    blocks, warnings = TABLE.on(BOXES)
    assert [block.material for block in blocks] == ["ground", "granite", "granite", "limestone"]
    assert [block.unit_weight for block in blocks] == [None, 26e3, 26e3, 22e3]
    assert [block.layer for block in blocks] == ["BASE", "WALL", "WALL", "TOP"]
    assert warnings == ()


def test_joints_between_two_materials():
    """Of one material its own; ground has none; two joints: the least of each number."""
    (ground, a, b, key), _ = TABLE.on(BOXES)
    assert TABLE.between(a, b) == GRANITE
    assert TABLE.between(ground, a) == TABLE.between(a, ground) == GRANITE
    assert TABLE.between(ground, ground) is None
    mixed = lb.OrdunaLourenco(0.6, compressive_strength=20e6, cohesion=1e5)
    assert TABLE.between(key, a) == TABLE.between(a, key) == mixed
    assert TABLE.words("granite", "limestone") == (
        "granite|limestone: the weaker of both, friction 0.6 (limestone), "
        "compressive strength 2e+07 (granite), cohesion 100000 (granite)"
    )


def test_interfaces_get_the_joint_of_their_materials():
    blocks, _ = TABLE.on(BOXES)
    found = lb.find_interfaces(blocks, TABLE.between)
    assert [(one.name, one.joint.friction) for one in found] == [
        ("ground|a", 0.7), ("a|b", 0.7), ("b|key", 0.6)
    ]  # fmt: skip


@pytest.mark.parametrize("order", [("granite", "limestone"), ("limestone", "granite")])
def test_a_given_pair_is_taken(order):
    given = lb.PointContact(0.3)
    table = Materials(TABLE.materials, {order: given})
    (_, a, _, key), _ = table.on(BOXES)
    assert table.between(a, key) == table.between(key, a) == given
    assert "as given for the pair" in table.words("granite", "limestone")


def test_the_weaker_of_two_is_not_above_either():
    """Utilisation of any stress resultants is at least that of each joint, without cohesion or tension."""
    a = lb.OrdunaLourenco(0.7, compressive_strength=5e6)
    b = lb.OrdunaLourenco(0.5, compressive_strength=8e6)
    joint = weaker(a, b)
    assert joint == lb.OrdunaLourenco(0.5, compressive_strength=5e6)
    face = lb.joints.interface([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]], joint)
    for Q in ([3e5, 0, -1e6, 0, 0, 0], [1e5, 1e5, -3e6, 4e5, 0, 1e4], [0, 0, -1e6, 1e5, 3e5, 5e4]):
        assert joint.utilisation(face, Q) >= max(a.utilisation(face, Q), b.utilisation(face, Q)) - 1e-12


def test_joints_that_have_no_weaker_one_ask_for_the_pair():
    for other, said in (
        (lb.PointContact(0.6), "joints are OrdunaLourenco and PointContact; give their joint as a pair"),
        (lb.OrdunaLourenco(0.6, slip="paper"), "slip is 'exact' and 'paper'; give their joint as a pair"),
    ):
        table = Materials({"x": Material(1.0, GRANITE, ["a"]), "y": Material(1.0, other, ["*"])})
        (first, second, *_), _ = table.on(BOXES[1:])
        with pytest.raises(lb.ModelError) as caught:
            table.between(first, second)
        assert str(caught.value) == f"between 'x' and 'y': {said}"


def test_patterns_in_vain_are_told():
    everything = Material(1.0, GRANITE, ["*"])
    for first, said in (
        (
            Material(blocks=["layer:QUOIN"]),
            "material 'x': pattern 'layer:QUOIN' matches no layer; there are ",
        ),
        (Material(), "material 'x': no block has a layer or material of this name"),
    ):
        _, (warning,) = Materials({"x": first, "all": everything}).on(BOXES)
        assert warning.startswith(said)
    _, (warning,) = Materials({"all": everything, "x": Material(blocks=["key"])}).on(BOXES)
    assert warning == "material 'x': 'key' picks only blocks of materials before it"


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"unit_weight": -1.0}, "unit weight is -1.0, expected a finite number >= 0"),
        ({"unit_weight": np.inf}, "unit weight is inf"),
        ({"blocks": "wall"}, "blocks are 'wall', expected a list"),
        ({"blocks": [1]}, r"blocks are \[1\], expected a list"),
    ],
)
def test_wrong_materials_are_told(settings, said):
    with pytest.raises(lb.ModelError, match=said):
        Material(**settings)


def test_wrong_tables_are_told():
    with pytest.raises(lb.ModelError, match="no material"):
        Materials({})
    with pytest.raises(lb.ModelError, match=r"pair names material 'granit', .*; did you mean 'granite'"):
        Materials(TABLE.materials, {("granit", "limestone"): GRANITE})
    with pytest.raises(lb.ModelError, match="1 block has no material of the table; among them layers 'BASE'"):
        Materials({"x": Material(1.0, GRANITE, ["layer:WALL", "key"])}).on(BOXES)
    heavy = [block.labelled(unit_weight=20e3, layer=block.layer, material="") for block in BOXES]
    with pytest.raises(
        lb.ModelError, match=r"material 'granite' has unit weight 26000 .* 'a' has 20000; leave"
    ):
        TABLE.on(heavy)
    same, _ = Materials({"x": Material(20e3, GRANITE, ["*"])}).on(heavy)
    assert {block.unit_weight for block in same} == {20e3}
