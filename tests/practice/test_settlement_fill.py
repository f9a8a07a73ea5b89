"""Fill beside and above a support that settles: what rests on it stays as it was."""

import pytest

import limitblocks as lb
from limitblocks.practice import passive_fill, reinforced, settlement


@pytest.mark.parametrize("ledge", [0.0, 0.3])
def test_fill_does_not_rest_on_the_support_because_it_settles(ledge):
    """The lintel and 0.6 m of fill on it turn about the inner edge of the left pier.

    The ground of the right pier is wider than the pier, and its ledge slopes or not: fill does not act on
    supports, and its earth pressure on the ledge none either.
    """
    outline = [(0.75, -0.5), (2.5, -0.5), (2.5, -ledge), (1.25, 0.0), (0.75, 0.0)]
    stones = [
        lb.Block.box("left ground", (2.0, 1.0, 0.2), (-1.5, 0.0, -0.1)),
        lb.Block.prism("right ground", outline, (-0.5, 0.5)),
        lb.Block.box("left", (0.5, 1.0, 2.0), (-1.0, 0.0, 1.0), 20e3),
        lb.Block.box("right", (0.5, 1.0, 2.0), (1.0, 0.0, 1.0), 20e3),
        lb.Block.box("lintel", (2.5, 1.0, 0.4), (0.0, 0.0, 2.2), 24e3),
    ]
    dead = lb.self_weight() + lb.loads.fill(18e3, level=3.0, earth_pressure=0.4)
    interfaces = lb.find_interfaces(stones, lb.PointContact(0.6))
    live = lb.mass_proportional((1, 0, 0))
    portal = lb.Model(stones, ["left ground", "right ground"], interfaces, dead, live)
    on_lintel = 24e3 * 2.5 * 0.4 + 18e3 * 2.5 * 0.6
    expected = 20e3 + on_lintel * 0.75 / 2.0
    down = settlement(portal, "right ground", (0, 0, -1))
    assert down.lower == pytest.approx(expected, rel=1e-6)
    assert down.nonassociated == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("order", [("wall", "floor"), ("floor", "wall")])
def test_passive_fill_stays_at_rest_as_a_support_moves(order):
    """A stone on a floor without friction, pushed by P against a wall, with fill of depth 1 on its slope.

    The fill takes K gamma / 2 per m of depth of the face, whichever support is said to hold it.
    """
    outline = [(-2.0, 0.0), (0.0, 0.0), (0.0, 1.0), (-1.0, 2.0), (-2.0, 2.0)]
    stones = [
        lb.Block.box("floor", (6.0, 1.0, 0.2), (-1.0, 0.0, -0.1)),
        lb.Block.box("wall", (0.5, 1.0, 0.8), (0.25, 0.0, 0.4)),
        lb.Block.prism("stone", outline, (-0.5, 0.5), 20e3),
    ]
    dead = lb.self_weight() + lb.loads.force("stone", (10e3, 0.0, 0.0), (-2.0, 0.0, 0.5))
    found = [one for one in lb.find_interfaces(stones, lb.PointContact(0.0)) if "stone" in one.name]
    model = lb.Model(stones, order, found, dead, lb.mass_proportional((1, 0, 0)))
    fill = passive_fill(model, 2.0, unit_weight=16e3, coefficient=0.5)
    assert fill[0].interface.block_j == order[0]
    own = settlement(reinforced(model, *fill), "wall", (1, 0, 0))
    assert own.lower == pytest.approx(10e3 - 0.5 * 16e3 / 2.0, rel=1e-6)
    assert own.nonassociated == pytest.approx(10e3 - 0.5 * 16e3 / 2.0, rel=1e-6)


def test_fill_above_a_support_that_overhangs_stays_on_the_stone_below():
    """A lintel of 3 m on .2 m at both ends: from the outer end on it follows, N (3 - .2) = W (1.5 - .2).

    The support that sinks has a roof over its end; fill does not rest on supports, nor as one settles.
    """
    outline = [
        (2.8, -0.5),
        (3.5, -0.5),
        (3.5, 0.6),
        (2.5, 0.6),
        (2.5, 0.5),
        (3.1, 0.5),
        (3.1, 0.0),
        (2.8, 0.0),
    ]
    stones = [
        lb.Block.box("left", (0.5, 1.0, 0.5), (-0.05, 0.0, -0.25)),
        lb.Block.prism("right", outline, (-0.5, 0.5)),
        lb.Block.box("lintel", (3.0, 1.0, 0.4), (1.5, 0.0, 0.2), 24e3),
    ]
    dead = lb.self_weight() + lb.loads.fill(18e3, level=1.0)
    interfaces = lb.find_interfaces(stones, lb.PointContact(0.6))
    model = lb.Model(stones, ["left", "right"], interfaces, dead, lb.mass_proportional((1, 0, 0)))
    expected = (24e3 * 3.0 * 0.4 + 18e3 * 3.0 * 0.6) * 1.3 / 2.8
    down = settlement(model, "right", (0, 0, -1))
    assert [down.lower, down.nonassociated] == pytest.approx([expected, expected], rel=1e-6)
