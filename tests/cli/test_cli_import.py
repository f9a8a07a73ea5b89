import numpy as np
import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app

OPTIONS = ("--friction", "0.6", "--live", "1,0,0", "--unit-weight", "20e3")


def run(*arguments):
    return CliRunner().invoke(app, ["import", *map(str, arguments)])


@pytest.fixture
def obj(tmp_path):
    """A block of 0.5 m by 1 m on a base, in mm."""
    boxes = [
        lb.Block.box("base", (2e3, 1e3, 200), (0, 0, -100)),
        lb.Block.box("block", (500, 500, 1e3), (0, 0, 500)),
    ]
    return lb.files.write_blocks(boxes, tmp_path / "two.obj")


def test_import_makes_a_model_file_that_can_be_analysed(obj, tmp_path):
    result = run(obj, *OPTIONS, "--supports", "base", "--units", "mm")
    assert result.exit_code == 0
    assert result.stderr.splitlines() == [
        "note: too few joints to tell how accurate the faces are; gap 0.68 mm, angle 0.01 rad, "
        "least width 0.68 mm",
        "note: nothing found beside the interfaces with these tolerances",
    ]
    model = lb.read(tmp_path / "two.json")
    assert "1 block, 1 support, 1 interface" in result.stdout
    assert model.blocks[1].volume == pytest.approx(0.25)
    # a block half as wide as high rocks before it slides
    assert lb.bounds(model).lower == pytest.approx(0.5, abs=1e-6)


def test_stones_that_all_lie_on_the_ground_are_no_likely_supports(tmp_path):
    """Two stones side by side, as two that interlock: which of them stays is for the user to say."""
    boxes = [lb.Block.box(name, (1, 1, 0.2), (x, 0, 0.1)) for name, x in (("left", 0), ("right", 1))]
    result = run(lb.files.write_blocks(boxes, tmp_path / "flat.obj"), *OPTIONS)
    assert result.exit_code == 2
    assert "which blocks do not move? give --supports; there are" in result.stderr


def test_output_is_not_overwritten_without_force(obj, tmp_path):
    output = tmp_path / "mine.json"
    output.write_text("mine")
    arguments = (obj, *OPTIONS, "--supports", "base", "--output", output)
    refused = run(*arguments)
    assert (refused.exit_code, output.read_text()) == (2, "mine")
    assert "exists" in refused.stderr
    assert run(*arguments, "--force").exit_code == 0
    assert lb.read(output).supports == ("base",)


def test_notes_and_contact_warnings_go_to_stderr(tmp_path):
    boxes = [
        lb.Block.box("base", (2, 1, 1), (0, 0, -0.5)),
        lb.Block.box("stone", (0.5, 1, 1), (-0.5, 0, 0.5)),
        lb.Block.box("stone", (0.5, 1, 1), (0.004, 0, 0.5)),
    ]
    result = run(lb.files.write_blocks(boxes, tmp_path / "gap.stl"), *OPTIONS, "--supports", "base")
    note, used, warning = result.stderr.splitlines()
    assert note == "note: 2 blocks are named 'stone'; all but the first got a number"
    assert used.startswith("note: too few joints to tell how accurate the faces are; gap 0.79 mm, ")
    assert warning.startswith("warning: ")
    assert "stone|stone 2" in warning
    wide = run(tmp_path / "gap.stl", *OPTIONS, "--supports", "base", "--gap", "0.01", "--force")
    assert "warning" not in wide.stderr
    assert "3 interfaces" in wide.stdout


def test_joints_drawn_open_are_told_with_the_option(tmp_path):
    """The distance, 10 mm, and the option that takes it; the advice works."""
    stones = [lb.Block.box("base", (2, 1, 1), (0, 0, -0.5))]
    stones += [lb.Block.box(f"{k}", (0.5, 0.5, 0.2), (0, 0, 0.11 + 0.21 * k)) for k in range(3)]
    file = lb.files.write_blocks(stones, tmp_path / "open.obj")
    refused = run(file, *OPTIONS, "--supports", "base")
    assert refused.exit_code == 2
    assert "4 blocks without any interface would touch with gap=0.05 (block lengths, " in refused.stderr
    assert "import --gap 0.05): are the joints drawn open?" in refused.stderr
    assert run(file, *OPTIONS, "--supports", "base", "--gap", "0.05").exit_code == 0


def test_the_width_of_an_open_joint_in_a_notch_is_that_between_its_faces(tmp_path):
    """A stone 0.1 m high, 10 mm above the floor of a channel 0.5 m deep: beside it, the channel is higher."""
    outline = [(-1, 0), (1, 0), (1, 1), (0.5, 1), (0.5, 0.5), (-0.5, 0.5), (-0.5, 1), (-1, 1)]
    stones = [
        lb.Block.prism("channel", outline, (0.0, 1.0)),
        lb.Block.box("stone", (0.6, 1.0, 0.1), (0.0, 0.5, 0.51 + 0.05)),
    ]
    file = lb.files.write_blocks(stones, tmp_path / "notch.obj")
    refused = run(file, *OPTIONS, "--supports", "channel")
    assert refused.exit_code == 2
    assert "are the joints drawn open? They are typically 10 mm wide" in refused.stderr


def test_one_bed_drawn_open_is_told_with_the_option(tmp_path):
    """Two piles that touch within, 20 mm apart: nothing is isolated, the upper one floats."""
    stones = [lb.Block.box("base", (2, 1, 1), (0, 0, -0.5))]
    heights = (0.1, 0.3, 0.52, 0.72)
    stones += [lb.Block.box(f"{k}", (0.5, 0.5, 0.2), (0, 0, z)) for k, z in enumerate(heights)]
    file = lb.files.write_blocks(stones, tmp_path / "bed.obj")
    refused = run(file, *OPTIONS, "--supports", "base")
    assert refused.exit_code == 2
    assert "error: 1|2 would touch with gap=0.1 (block lengths, " in refused.stderr
    assert "import --gap 0.1): are these joints drawn open? They are typically 20 mm wide" in refused.stderr
    assert run(file, *OPTIONS, "--supports", "base", "--gap", "0.1").exit_code == 0


def test_noisy_meshes_are_refused_and_healed(tmp_path):
    rng = np.random.default_rng(1)
    clean = lb.structures.corner(lb.OrdunaLourenco(0.6), length=2.4, return_length=2.4, courses=4)
    stones = [
        lb.Block(b.name, b.vertices + rng.uniform(-3e-3, 3e-3, b.vertices.shape), b.triangles.tolist())
        for b in clean.blocks
    ]
    file = lb.files.write_blocks(stones, tmp_path / "scan.obj")
    options = ["--friction", "0.6", "--live", "1,0,0", "--unit-weight", "20e3", "--supports", "base"]
    refused = run(file, *options)
    assert refused.exit_code == 2
    assert "import --heal" in refused.stderr
    healed = run(file, *options, "--heal")
    assert healed.exit_code == 0
    assert "vertices moved by up to" in healed.stderr
    model = lb.read(tmp_path / "scan.json")
    assert model.tolerances.gap > 1e-2
    assert lb.bounds(model).lower == pytest.approx(lb.bounds(clean).lower, rel=1e-2)


WRONG = {
    "support": (("--supports", "bas"), "'bas' is neither a block nor a layer; did you mean 'base'?"),
    "units": (("--supports", "base", "--units", "km"), "'km'"),
    "joint": (("--supports", "base", "--joint", "Glue"), "'--joint': 'Glue' is no joint"),
    "slip": (("--supports", "base", "--slip", "round"), "'round' is not one of 'exact'"),
    "slip of points": (
        ("--supports", "base", "--joint", "point-contact", "--slip", "paper"),
        "--slip is 'paper', but",
    ),
    "live": (
        ("--supports", "base", "--live", "1;0;0"),
        "'--live' / '--direction': '1;0;0': expected 3 numbers, X,Y,Z",
    ),
    "live of two": (("--supports", "base", "--live", "1,0"), "'1,0': expected 3"),
    "unit weight": (("--supports", "base", "--unit-weight", "heavy"), "LAYER=NUMBER"),
    "layer": (("--supports", "base", "--unit-weight", "brick=1"), "LAYER=NUMBER each"),
    "gap": (("--supports", "base", "--gap", "-1"), "gap is -1.0"),
    "friction": (("--supports", "base", "--friction", "-1"), "friction is -1.0"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_options_are_said_by_name_and_value(name, obj, tmp_path):
    options, said = WRONG[name]
    result = run(obj, *OPTIONS, *options)
    assert result.exit_code == 2
    assert "Traceback" not in result.stderr
    assert said in result.stderr
    assert not (tmp_path / "two.json").exists()


def test_a_layer_with_two_unit_weights_is_refused(obj):
    options = ("--friction", "0.6", "--live", "1,0,0", "--supports", "base")
    result = run(obj, *options, "--unit-weight", "block=2e4", "--unit-weight", "block=1e4")
    assert result.exit_code == 2
    assert "--unit-weight is 'block=2e4 block=1e4'; layer 'block' has several, give it one" in result.stderr


def test_slip_of_the_joint(obj, tmp_path):
    for options, slip in (((), "exact"), (("--slip", "paper"), "paper")):
        assert run(obj, *OPTIONS, "--supports", "base", *options, "--force").exit_code == 0
        assert lb.read(tmp_path / "two.json").interfaces[0].joint == lb.OrdunaLourenco(0.6, slip=slip)


def test_unit_weights_by_layer(tmp_path):
    arch = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=0.8, voussoirs=7)
    path = lb.files.write_blocks(arch, tmp_path / "arch.glb")
    options = (
        "--friction",
        "0.6",
        "--live",
        "1,0,0",
        "--unit-weight",
        "block=20e3",
        "--unit-weight",
        "support=0",
    )
    assert run(path, *options, "--supports", "support", "--joint", "point-contact").exit_code == 0
    model = lb.read(tmp_path / "arch.json")
    assert {block.unit_weight for block in model.free_blocks} == {20e3}
    assert type(model.interfaces[0].joint).__name__ == "PointContact"


def test_an_elevation_is_read_by_its_layers(tmp_path):
    """The frame of a sheet is an outline, too: it would be a block that all others lie in."""
    ezdxf = pytest.importorskip("ezdxf")
    drawing, sheet = ezdxf.new(units=6), tmp_path / "sheet.dxf"
    for layer, (x, z), (w, h) in (
        ("STONES", (0, 0), (1, 0.2)),
        ("STONES", (0.25, 0.2), (0.5, 1)),
        ("FRAME", (-1, -1), (3, 3)),
    ):
        corners = [(x, z), (x + w, z), (x + w, z + h), (x, z + h)]
        drawing.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
    drawing.saveas(sheet)
    options = (*OPTIONS, "--thickness", "1", "--supports", "z<0.3")
    assert "overlap" in run(sheet, *options).stderr
    assert run(sheet, *options, "--layers", "STONES").exit_code == 0
    assert lb.bounds(lb.read(tmp_path / "sheet.json")).upper == pytest.approx(0.5, abs=1e-6)  # b / h
    wrong = run(sheet, *OPTIONS, "--supports", "z<0.3", "--layers", "STONES", "--force")
    assert (wrong.exit_code, wrong.stderr) == (
        2,
        "error: --layers is of DXF elevations: give --thickness, too\n",
    )
    looked = CliRunner().invoke(app, ["look", str(sheet), "--thickness", "1", "--layers", "STONES"])
    assert "--thickness 1 --layers STONES" in looked.stdout
    with pytest.raises(lb.ModelError, match="give thickness"):
        lb.files.look(sheet, layers="STONES")
