"""Ties and dowels in reports: their forces, and their lines in the drawings."""

import pytest
from chapters import chapter
from facades import ARM, FLOOR, OWN, H, T, facade

import limitblocks as lb
from limitblocks.drawing.sheet import polylines
from limitblocks.practice import dowel, reinforced, tie
from limitblocks.reports.interfaces import relative_motion
from limitblocks.reports.pdf import pdf


def test_ties_and_dowels_have_their_force_and_their_line():
    """A tie of 8 kN yields, one on the other side goes slack; a dowel at the hinge carries what it can."""
    wall = facade()
    rods = [
        tie("wall", (0, 0, 4.5), "ground", (x, 0, 4.5), area=1e-4, strength=235e6, pull_out=8e3)
        for x in (-6.0, 6.0)
    ]
    joint = wall.interfaces[0]
    model = reinforced(wall, *rods, dowel(joint, joint.centroid, diameter=0.02, capacity=5e3))
    solved = lb.nonassociated(model)
    alpha = (OWN * T / 2 + FLOOR * ARM + 8e3 * 4.5) / (OWN * H / 2 + FLOOR * H)
    assert solved.load_factor == pytest.approx(alpha, rel=1e-6)  # .3123077
    made = lb.report(model, solved, title="Tied")
    (title,) = (one.title for one in made.document.chapters if one.title.startswith("Non-associated sol"))
    (table,) = (
        p for p in chapter(made, title).parts if getattr(p, "caption", "") == "Ties, dowels and passive fill"
    )
    held, slack, pinned = [[cell.text for cell in row] for row in table.rows]
    assert held[1:] == ["(0, 0, 4.5) to (-6, 0, 4.5)", "8", "8", "1.000", "yield"]
    assert slack[2:] == ["0", "8", "0.000", "slack"]
    assert pinned[1] == "(0, 0, 0)"
    assert pinned[3] == "5"
    assert float(pinned[4]) == pytest.approx(float(pinned[2]) / 5.0, abs=1e-3)
    views = next(p for p in chapter(made, "Model").parts if hasattr(p, "sheet"))
    lines = [group for group in views.sheet.groups if group.style == "tie-stick"]
    assert [len(group.shapes) for group in lines] == [2, 2, 2]  # both ties in front, side and plan
    front = [abs(ends[2] - ends[0]) for s in lines[0].shapes for ends, _ in polylines(s.path)]
    assert front[0] == pytest.approx(front[1])  # 6 m either way, at one scale
    assert views.legend[-1] == ("tie-stick", "tie, from anchor to anchor")
    (drawing,) = (
        p for p in chapter(made, title).parts if getattr(getattr(p, "sheet", 0), "style", "") == "mechanism"
    )
    drawn = [group for group in drawing.sheet.groups if group.style.startswith("tie-")]
    assert [group.style for group in drawn] == ["tie-yield", "tie-slack"]
    ends = [list(polylines(group.shapes[0].path)) for group in drawn]
    (left, _), (right, _) = ends[0][0], ends[1][0]
    assert left[:2] == right[:2]  # both anchors in the wall
    assert (left[2] - left[0]) * (right[2] - right[0]) < 0.0
    assert [word for _, word in drawing.legend][-2:] == ["tie: yield", "tie: slack"]
    assert pdf(made.document).startswith(b"%PDF")
    assert made.html.count('class="tie-yield"') == 2  # drawing and legend
    moves = relative_motion(model, solved.collapse.displacement_rates)
    turn = abs(solved.collapse.displacement_rates[1, 4])
    assert moves[1:3] == pytest.approx(turn * 4.5, rel=1e-6)


def test_both_forces_of_a_prestressed_tie_are_told():
    """A tie of 8 kN, .5 kN of it prestress, yields: N is what is beyond it, the force of the tie all."""
    wall = facade()
    rod = tie("wall", (0, 0, 4.5), "ground", (-6, 0, 4.5), area=1e-4, strength=80e6, prestress=5e2)
    model = reinforced(wall, rod)
    made = lb.report(model, lb.bounds(model))
    said = "N and utilisation of a prestressed tie are those beyond its prestress"
    shown, tied = [
        p
        for p in chapter(made, "Associated bounds").parts
        if getattr(p, "caption", "").startswith(("Interfaces that", "Ties,"))
    ]
    assert said in shown.caption
    (row,) = (row for row in shown.rows if row[0].text.startswith("tie"))
    beyond = dict(zip(shown.heads, row, strict=True))["N, kN"].text
    assert float(beyond) == pytest.approx(8.0 - 0.5)
    assert float(tied.rows[0][2].text) == pytest.approx(8.0)
    loose = reinforced(wall, tie("wall", (0, 0, 4.5), "ground", (-6, 0, 4.5), area=1e-4, strength=80e6))
    assert said not in lb.report(loose, lb.bounds(loose)).html
