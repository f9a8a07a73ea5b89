"""What contact detection saw beside the interfaces, in facts, in the report and on the command line."""

import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.reports.facts import facts

UNIT = (1, 1, 1)
NO_INTERFACE = "no interface between blocks that"
SEEN = {
    "near": ((1.005, 0, 0.5), f"{NO_INTERFACE} nearly touch: left|near (gap 0.005 m"),
    "deep": ((0.8, 0, 0.5), "blocks 'left' and 'deep' overlap by 0.2 m3, 0.2 m deep"),
    "thin": ((0.9995, 0, 1.5), "contacts left out because they are too small: left|thin (0.0005 m2"),
    "touching": ((1, 0, 0.5), f"{NO_INTERFACE} touch: left|touching"),
    "alone": ((9, 0, 0.5), "blocks without any interface: alone"),
}


def model_with(name, at):
    blocks = [lb.Block.box("ground", (4, 1, 1), (0, 0, -0.5)), lb.Block.box("left", UNIT, (0, 0, 0.5), 1e3)]
    interfaces = lb.find_interfaces(blocks, lb.PointContact(0.5))
    blocks.append(lb.Block.box(name, UNIT, at))
    live = lb.mass_proportional((1, 0, 0))
    return lb.Model(blocks, ["ground", name], interfaces, lb.self_weight(), live)


@pytest.mark.parametrize("case", SEEN)
def test_diagnostics_are_shown(case, tmp_path):
    at, line = SEEN[case]
    model = model_with(case, at)
    assert any(warning.startswith(line) for warning in facts(model)["warnings"])
    shown = CliRunner().invoke(app, ["info", str(model.save(tmp_path / "model.json"))])
    assert shown.exit_code == 0
    assert f"warning: {line}" in shown.output
    page = lb.report(model, lb.bounds(model)).save(tmp_path / "report.html").read_text(encoding="utf-8")
    assert line.split("(")[0].replace("'", "&#39;") in page
