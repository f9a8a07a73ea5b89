"""Joints and loads in the words of an engineer."""

import pytest

import limitblocks as lb
from limitblocks import loads
from limitblocks.reports.words import assumed, joint_words, laid_on, load_words

JOINTS = {
    "friction coefficient 0.6 (31.0 degrees), no tension, no limit of compression, shear and torsion by the "
    "paper's octagon": lb.OrdunaLourenco(0.6, slip="paper"),
    "friction coefficient 0.5 (26.6 degrees), cohesion 50 kPa, tensile strength 20 kPa, compressive strength "
    "3 MPa, shear and torsion by Coulomb's circle": lb.OrdunaLourenco(
        0.5, 3e6, cohesion=5e4, tensile_strength=2e4
    ),
    "friction coefficient 1 (45.0 degrees), no tension, no limit of compression, shear and torsion by a "
    "polygon of 12 sides within Coulomb's circle": lb.OrdunaLourenco(1.0, slip="inner", sides=12),
    "no friction, no tension, no limit of compression, forces at the corners of each contact area": (
        lb.PointContact(0.0)
    ),
    "friction coefficient 1 (45.0 degrees) by an outer polygon of 6 sides, no tension, no limit of "
    "compression, 3 forces on each side of each contact area": lb.PointContact(1.0, 3, "outer", 6),
    "friction coefficient 1 (45.0 degrees), no tension, no limit of compression, torsion by the exact limit "
    "surface from within, safe": lb.joints.ExactTorsion(1.0),
}
LOADS = {
    "the weight of every block, downwards": lb.self_weight(),
    "the weight of every block, along -Y": lb.mass_proportional((0, -2, 0)),
    "0.5 × the weight of every block, along (0.6, 0.8, 0)": 0.5 * lb.mass_proportional((3, 4, 0)),
    "a force (1.5, 0, -2) kN on block 'a' at (0, 0, 1) m": loads.force("a", (1500, 0, -2000), (0, 0, 1)),
    "a moment (0, 0, 3) kN m on block 'a'": loads.moment("a", (0, 0, 3e3)),
    "a pressure of 5 kPa plus 10 kN/m³ times the depth below Z = 2 m on the face facing (0, 1, 0) of block "
    "'a'": loads.pressure("a", 5e3, facing=(0, 1, 0), unit_weight=1e4, level=2.0),
    "fill of 18 kN/m³ up to Z = 3 m on all blocks, coefficient of horizontal earth pressure 0.3 on faces "
    "that slope, none on upright ones": loads.fill(18e3, 3.0, earth_pressure=0.3),
    "fill of 18 kN/m³ up to Z = 3 m on block 'a', beyond (0, 1) m in plan along -X": loads.fill(
        18e3, 3.0, blocks="a", beyond=(0, 1), towards=(-2, 0, 0)
    ),
    "a force (0, 0, -10) kN on top of the structure at (1, 2) m in plan": loads.top_force(
        (0, 0, -1e4), (1, 2)
    ),
    "a line load (0, 0, -7) kN/m on top of the structure, from (0, 0) m to (1, 0) m in plan": loads.line_load(
        (0, 0, -7e3), (0, 0), (1, 0)
    ),
}


@pytest.mark.parametrize("words", JOINTS)
def test_a_joint_in_words(words):
    assert joint_words(JOINTS[words]) == words
    sentences = assumed(JOINTS[words])
    assert len(sentences) > 2
    assert all(sentence[0].isupper() and sentence.endswith(".") for sentence in sentences)


@pytest.mark.parametrize("words", LOADS)
def test_a_load_in_words(words):
    assert load_words(LOADS[words]) == [words]


def test_an_added_mass_in_words():
    mass = loads.added_mass("floor", (0, 0, 3), weight=12e3)
    words = load_words(lb.mass_proportional((1, 0, 0), [mass]))
    assert words[1] == "a mass that weighs 12 kN, fixed to block 'floor' at (0, 0, 3) m, along +X"


SMALL = {"span": 4.0, "rise": 1.0, "thickness": 0.4, "voussoirs": 12}


@pytest.mark.parametrize("make", [lb.structures.segmental_arch, lb.structures.arch_bridge])
def test_the_inertia_of_fill_is_one_line(make):
    bridge = make(lb.PointContact(0.7), **SMALL, fill=lb.structures.Fill(0.5, 18e3, inertia=0.5))
    weights, inertia = load_words(bridge.live, laid_on(bridge))
    assert weights == "the weight of every block, along +X"
    assert inertia.startswith("12 forces on 12 blocks, ")
    assert inertia.endswith(
        " kN along +X: 0.5 × what weighs on them in the dead load, as the inertia of fill"
    )
    name = bridge.free_blocks[0].name
    pushed = bridge.live + lb.loads.force(
        name, (1e3, 0.0, 0.0), (0.0, 0.0, 0.0)
    )  # more than half of its fill
    assert load_words(pushed, laid_on(bridge))[1].endswith(" kN along +X")


def test_what_a_joint_assumes_depends_on_its_settings():
    circle, octagon = (" ".join(assumed(lb.OrdunaLourenco(0.6, slip=slip))) for slip in ("exact", "paper"))
    assert "8.2 %" in octagon
    assert "8.2 %" not in circle
    crushing = " ".join(assumed(lb.OrdunaLourenco(0.6, 3e6)))
    assert "do not crush" in circle
    assert "do not crush" not in crushing


class Somebody:
    """A joint of somebody else.

    With more to say.
    """

    friction = 0.3

    def __repr__(self):
        return "Somebody(0.3)"


def test_somebody_elses_joint_is_named_by_its_settings_and_its_first_sentence():
    assert joint_words(Somebody()) == "Somebody(0.3)"
    assert assumed(Somebody()) == ("A joint of somebody else.",)
