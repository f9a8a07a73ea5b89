import pytest
from plotted import corner, inked
from stones import model_of

import limitblocks as lb

UNIT = (1.0, 1.0, 1.0)


def with_findings():
    blocks = [
        lb.Block.box("ground", (6.0, 1.0, 1.0), (0, 0, -0.5)),
        lb.Block.box("sheet", (1.0, 1.0, 9e-4), (0, 0, 4.5e-4), 20e3),
        lb.Block.box("stone", UNIT, (0, 0, 0.5 + 9e-4), 20e3),
        lb.Block.box("beside", UNIT, (1.004, 0, 0.5), 20e3),
        lb.Block.box("far", UNIT, (2.7, 0, 5.0)),
    ]
    return model_of(blocks, ["ground", "far"], lb.PointContact(0.6))


@pytest.mark.parametrize("plane", ["xz", "3d"])
def test_each_kind_has_its_line_and_its_number(plane):
    ax = lb.plots.findings(with_findings(), plane=plane)
    _, labels = ax.get_legend_handles_labels()
    assert labels == ["near miss (2)", "block between (1)", "isolated (1)"]  # of stone and sheet
    assert inked(ax) > 0.05


def test_nothing_found_is_said():
    ax = lb.plots.findings(corner())
    assert ax.get_title().endswith("nothing found beside the interfaces with these tolerances")
    assert ax.get_legend() is None


def test_a_stone_that_hangs_is_marked_where_it_is():
    hung = [lb.Block.box("ceiling", (1, 1, 1), (0, 0, 1)), lb.Block.box("stone", (1, 1, 1), (0, 0, 0), 20e3)]
    ax = lb.plots.findings(model_of(hung, ["ceiling"], lb.PointContact(0.6)), plane="xz")
    (mark,) = [line for line in ax.lines if line.get_label() == "held by friction alone (1)"]
    assert mark.get_xydata().tolist() == [[0.0, 0.0]]
    assert "nothing found" not in ax.get_title()
