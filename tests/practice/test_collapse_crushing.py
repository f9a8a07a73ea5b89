"""Settlement of what props a leaning wall whose toe crushes under a vertical tie: closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq

import limitblocks as lb
from limitblocks.practice import reinforced, settlement_to_collapse, tie

WIDTH, LEAN, HEIGHT, HEAD, AREA, ANCHOR = 0.5, 0.5, 3.0, 0.3, 1e-4, -3.0


def leaning(place, crushing, strength, prestress):
    """A wall that leans with the upper `HEAD` of its side on a smooth prop; a tie from (place, .3 m) down."""
    outline = [(0, 0), (WIDTH, 0), (WIDTH + LEAN, HEIGHT - HEAD), (WIDTH + LEAN, HEIGHT), (LEAN, HEIGHT)]
    blocks = [
        lb.Block.box("ground", (30, 1, 0.4), at=(0, 0, -0.2)),
        lb.Block.box("prop", (1, 1, 1), at=(WIDTH + LEAN + 0.5, 0, HEIGHT)),
        lb.Block.prism("wall", outline, (-0.5, 0.5), 18e3),
    ]
    bed, smooth = lb.OrdunaLourenco(0.6, compressive_strength=crushing), lb.PointContact(0.0)
    joints = lb.find_interfaces(blocks, lambda i, j: smooth if "prop" in (i.name, j.name) else bed)
    push = lb.mass_proportional((1, 0, 0))
    bare = lb.Model(blocks, ["ground", "prop"], joints, lb.self_weight(), push)
    ends = ("wall", (place, 0, 0.3), "ground", (place, 0, ANCHOR))
    return reinforced(bare, tie(*ends, area=AREA, strength=strength / AREA, prestress=prestress))


def by_hand(away, wall, place, crushing, strength, prestress):
    """Push on the prop at the upper corner of the wall that has turned about its toe, and where the tie is.

    The crushed toe, N / fc, turns about its inner edge: a tie beyond that yields, one before it is unloaded
    to its prestress, in between the edge is on its line. Moments about the middle of what is crushed.
    """
    turn = brentq(lambda t: LEAN * np.cos(t) + HEIGHT * np.sin(t) - LEAN - away, -1e-3, 1.0)
    turned, toe = (
        np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]),
        np.array([WIDTH, 0.0]),
    )
    at = wall.centroid[[0, 2]], (place, 0.3), (WIDTH + LEAN, HEIGHT)
    centre, end, top = (toe + turned @ (np.array(one) - toe) for one in at)
    way = np.array([place, ANCHOR]) - end
    along = way / np.linalg.norm(way)
    line = end[0] - along[0] / along[1] * end[1]  # where it meets the floor
    least, most = (wall.weight - tension * along[1] for tension in (prestress, strength))
    normal = float(np.clip(crushing * (WIDTH - line), least, most))
    pull, middle = (wall.weight - normal) / along[1] * along, WIDTH - normal / (2 * crushing)
    moment = wall.weight * (centre[0] - middle) + pull[0] * end[1] - pull[1] * (end[0] - middle)
    return moment / top[1], "yields" if normal == most else "unloaded" if normal == least else "between"


@pytest.mark.parametrize("without_dilatancy", [True, False])
@pytest.mark.parametrize(
    ("case", "states"),
    [
        ((0.3, 1e6, 3e3, 0.0), {"yields"}),
        ((0.45, 1e6, 8e3, 0.0), {"yields", "between", "unloaded"}),
        ((0.45, 3e5, 8e3, 4e3), {"unloaded"}),
    ],
)
def test_the_reaction_follows_statics_while_the_tie_passes_what_is_crushed(case, states, without_dilatancy):
    """It stopped where the line of the tie passes the inner edge of the crushed toe."""
    model = leaning(*case)
    way = settlement_to_collapse(
        model, "prop", (1, 0, 0), step=0.1, largest=0.7, without_dilatancy=without_dilatancy
    )
    assert way.ended == "the settlement 0.7 m is reached"
    expected, found = zip(*(by_hand(away, model.blocks[2], *case) for away in way.displacements), strict=True)
    assert way.reactions == pytest.approx(expected, rel=1e-8)
    assert set(found) == states
