"""What an answer remarks is said by all that is made of it."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice import (
    CapacityCurve,
    CapacityPoint,
    Control,
    Deck,
    PartialFactors,
    Spectrum,
    Vehicle,
    Verification,
    adequacy,
    least_ties,
    tie,
    verification,
    worst_position,
)

SHARE = 0.2
DIAGONAL = (np.sqrt(0.5), np.sqrt(0.5), 0.0)


@pytest.fixture(scope="module")
def pier():
    """A square pier whose base is crushed to a fifth by its weight, pushed along its diagonal."""
    joint = lb.OrdunaLourenco(0.9, compressive_strength=20e3 * 4.0 / SHARE)
    ground = lb.Block.box("ground", (6, 6, 0.4), (0, 0, -0.2))
    blocks = [ground, lb.Block.box("pier", (1, 1, 4), (0, 0, 2), 20e3)]
    contacts = lb.find_interfaces(blocks, joint)
    return lb.Model(blocks, ["ground"], contacts, lb.self_weight(), lb.mass_proportional(DIAGONAL))


def begun(pier):
    """A capacity curve of one point."""
    answer = lb.nonassociated(pier)
    point = CapacityPoint(0.0, answer.load_factor, 0.0, pier, answer, ())
    control = Control("pier", np.array([0.5, 0.5, 4.0]), np.array(DIAGONAL))
    return CapacityCurve((point,), control, None, "stopped")


@pytest.mark.parametrize(
    "made",
    [
        lambda pier: adequacy(pier, PartialFactors(1.0, 1.5, 1.0)),
        begun,
        lambda pier: least_ties(
            pier, [tie("pier", (0, 0, 3.9), "ground", (-9, -9, 3.9), area=1e-3, strength=1e8)], 0.3
        ),
        lambda pier: verification(pier, lb.nonassociated(pier), Spectrum(1.0, 1.2, 2.5, 0.5), q=2.0),
    ],
)
def test_a_moment_beyond_the_stress_block_is_said(pier, made):
    """Eq. (39) has 1 - n along the diagonal, the triangle of the stress block 1 - 2/3 sqrt(2 n)."""
    found = made(pier)
    over = (1 - SHARE) / (1 - 2 / 3 * np.sqrt(2 * SHARE))
    said = f"carries {over:.2f} times the moment of the exact stress block"
    assert any(said in one for one in found.remarks)
    assert said in str(found) or isinstance(found, Verification)  # whose line has the checks alone
    assert said in " ".join(lb.report(pier, found).text.split())


def test_a_vehicle_on_a_crushed_pier(pier):
    """Beside the middle: the moment is about one edge and the corner, beyond the stress block."""
    found = worst_position(pier, Vehicle((1e4,), contact=0.1), Deck(4.0, y=0.3), (0.1, 0.45), positions=3)
    assert found.bounds.remarks
    assert found.bounds.remarks[0] in str(found)
    text = " ".join(lb.report(pier, found).text.split())
    assert found.bounds.remarks[0][1:] in text
