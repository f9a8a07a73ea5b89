"""What an answer remarks is said by all that is made of it."""

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks import studies
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
    return model_of(blocks, ["ground"], joint, DIAGONAL)


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


def test_ranges_and_sensitivities_of_a_crushed_pier(pier):
    limits = lb.bounds(pier)
    (said,) = limits.remarks
    sensitive = lb.sensitivities(pier, limits)
    ranged = lb.load_factor_range(pier, paths=1, mechanisms=0)
    for found in (sensitive, ranged):
        assert said in found.remarks
        assert said in str(found)
        assert said[1:] in " ".join(lb.report(pier, found).text.split())


def leaning(b):
    """A square column of side 1 whose load F acts at (b, b), crushed to a tenth of its strength."""
    joint, F = lb.OrdunaLourenco(0.9, compressive_strength=1e6), 1e5
    blocks = [lb.Block.box("ground", (3, 3, 1), (0, 0, -0.5)), lb.Block.box("column", (1, 1, 2), (0, 0, 1))]
    dead = lb.loads.force("column", (0, 0, -F), (b, b, 2))
    live = lb.loads.force("column", (1, 0, 0), (0, 0, 1))
    return lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, joint), dead, live)


def test_standing_beyond_the_stress_block_is_said():
    """Eq. (39) lets F act at (1 - n) / 2, the triangle of the stress block at 1 / 2 - sqrt(2 n) / 3."""
    n = 0.1
    exact, own = 0.5 - np.sqrt(2 * n) / 3, (1 - n) / 2
    inside, beyond = lb.stability(leaning(exact - 1e-3)), lb.stability(leaning(own - 1e-3))
    assert inside.stands
    assert not inside.remarks
    assert beyond.stands
    assert f"{(own - 1e-3) / exact:.2f} times the moment" in str(beyond)
    assert beyond.remarks[0][1:] in " ".join(lb.report(leaning(own - 1e-3), beyond).text.split())
    farthest = studies.maximum(leaning, 0.0, 0.49)
    assert farthest.value == pytest.approx(own, abs=1e-5)
    assert f"{own / exact:.2f} times the moment" in str(farthest)
