"""One bad block does not refuse the others: twisted faces, open shells, what was left out."""

import json
import re
from itertools import pairwise

import numpy as np
import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app

JOINT = lb.OrdunaLourenco(friction=0.6)
PUSH = lb.mass_proportional((1.0, 0.0, 0.0))


def obj(path, bodies):
    """Write (name, vertices, faces) as an OBJ file."""
    lines, first = [], 1
    for name, vertices, faces in bodies:
        lines += [f"o {name}", *(f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices).tolist())]
        lines += ["f " + " ".join(str(first + v) for v in face) for face in faces]
        first += len(vertices)
    path.write_text("\n".join(lines))
    return path


def box(name, at, *, lift=0.0, faces=6):
    block = lb.Block.box(name, (1.0, 1.0, 1.0), at)
    return name, block.vertices + [(0.0, 0.0, lift * (k == 7)) for k in range(8)], block.faces[:faces]


def test_an_open_footing_can_be_left_out_and_is_named_later(tmp_path):
    file = obj(
        tmp_path / "a.obj",
        [box("footing", (0, 0, -0.5), faces=5), box("a", (0, 0, 0.5)), box("b", (9, 0, 0))],
    )
    with pytest.raises(lb.ModelError) as raised:
        lb.files.read_blocks(file)
    first, second = raised.value.problems
    assert "1 of 3 blocks is bad; --skip-bad (skip_bad=True) leaves them out" in first
    assert "'footing': the surface is open" in second
    found = lb.files.read_blocks(file, skip_bad=True)
    assert [block.name for block in found.blocks] == ["a", "b"]
    assert found.left_out == ("footing",)
    assert any(note.startswith("left out: block 'footing'") for note in found.notes)
    with pytest.raises(lb.ModelError, match=r"left out when the file was read: footing; .* import it again"):
        lb.read(file, joint=JOINT, supports="b", live=PUSH, skip_bad=True)


def test_a_support_that_is_no_block_is_told_as_such(tmp_path):
    """The ground as one plane, as in many files of COMPAS: without it the lowest stone is free or fixed."""
    _, corners, faces = box("a", (0, 0, 0.5))
    plane = {"vertices": [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], "faces": [[0, 1, 2, 3]]}
    stone = {"vertices": corners.tolist(), "faces": [list(face) for face in faces]}
    file = tmp_path / "stack.json"
    file.write_text(json.dumps({"supports": {"ground": plane}, "stones": {"a": stone}}))
    said = "the file marks as supports what is no block: ground;"
    assert any(said in line for line in lb.files.look(file).warnings)
    found = lb.files.read_blocks(file, skip_bad=True)
    assert any(said in line for line in found.guesses)
    assert found.supports == ()


def test_a_file_of_bad_blocks_alone_is_refused_with_the_first_twenty(tmp_path):
    file = obj(tmp_path / "a.obj", [box(f"b{k}", (2 * k, 0, 0), faces=5) for k in range(50)])
    for skip in (False, True):
        with pytest.raises(lb.ModelError) as raised:
            lb.files.read_blocks(file, skip_bad=skip)
        assert len(raised.value.problems) == 21
        assert "and 30 more" in raised.value.problems[-1]
        assert "--skip-bad" not in str(raised.value)


def test_twisted_faces_are_refused_until_asked_for(tmp_path):
    file = obj(tmp_path / "a.obj", [box("a", (0.5, 0.5, 0.5), lift=0.05), box("b", (3, 0, 0))])
    with pytest.raises(lb.ModelError, match=r"'a'.*0.0125 m out .*--twisted triangulate or fit"):
        lb.files.read_blocks(file)
    block = lb.files.read_blocks(file, twisted="triangulate").blocks[0]
    assert block.volume == pytest.approx(1.0 + 0.5 * 0.05 / 3)
    fitted = lb.files.read_blocks(file, twisted="fit")
    assert len(fitted.blocks[0].faces) == 6
    assert "made plane: vertices moved by up to" in fitted.notes[0]
    with pytest.raises(lb.ModelError, match=r"twisted is 'bend'; expected one of refuse, triangulate, fit"):
        lb.files.read_blocks(file, twisted="bend")


def test_mostly_twisted_blocks_are_told_how_to_be_divided_first(tmp_path):
    twisted = [box(f"t{k}", (3 * k, 9, 0.5), lift=0.05) for k in range(2)]
    opened, good = [box(f"o{k}", (3 * k, 5, 0), faces=5) for k in range(2)], [box("g", (0, 0, 0))]

    def first(*bodies):
        with pytest.raises(lb.ModelError) as raised:
            lb.files.read_blocks(obj(tmp_path / "a.obj", bodies))
        return raised.value.problems[0].partition("a.obj: ")[2]

    divides = "--twisted triangulate (twisted='triangulate') divides these"
    skips = "--skip-bad (skip_bad=True) leaves"
    assert first(*twisted) == f"2 of 2 blocks are bad, by twisted faces; {divides}"
    assert (
        first(*twisted, *good)
        == f"2 of 3 blocks are bad, by twisted faces; {divides}; {skips} out what is bad"
    )
    assert first(*twisted, opened[0]).startswith("3 of 3 blocks are bad, 2 of them by twisted faces")
    assert first(*twisted, *opened, *good) == f"4 of 5 blocks are bad; {skips} them out"
    assert len(lb.files.read_blocks(tmp_path / "a.obj", twisted="triangulate", skip_bad=True).blocks) == 3


def test_twist_within_the_digits_of_the_file_is_taken(tmp_path):
    """A stone of 5 mm with corners to 0.05 mm is twisted by up to its last digit; one of 5 m is not."""
    base = lb.Block.box("a", (0.05, 0.05, 0.05), (0.025, 0.025, 0.025))
    vertices = np.round(base.vertices + [(0.0, 0.0, 3e-4 * (k == 7)) for k in range(8)] + 1e-4, 4)
    assert 3e-4 / 4 > 1e-3 * 0.05  # twisted by more than a block may be
    found = lb.files.read_blocks(obj(tmp_path / "a.obj", [("a", vertices, base.faces)]))
    assert "divided into triangles, as the file is good to about 0.05 mm there" in found.notes[0]
    vertices[0] += 1.2345678e-9  # the same stone, drawn with more digits
    with pytest.raises(lb.ModelError, match="twisted"):
        lb.files.read_blocks(obj(tmp_path / "b.obj", [("a", vertices, base.faces)]))


def test_twist_within_the_accuracy_of_the_joints_is_taken(tmp_path):
    """A wall whose corners are off at random: its joints show it, and twisted quads are no surprise then."""
    rng = np.random.default_rng(2)
    stones = [
        lb.Block.box(f"{i} {j}", (0.4, 0.3, 0.2), (0.4 * i, 0.0, 0.2 * j)) for i in range(4) for j in range(4)
    ]
    noisy = [(s.name, s.vertices + 1e-3 * rng.uniform(-1.0, 1.0, s.vertices.shape), s.faces) for s in stones]
    found = lb.files.read_blocks(obj(tmp_path / "a.obj", noisy))
    assert len(found.blocks) == 16
    said = [note for note in found.notes if "twisted" in note]
    assert said
    assert all("as the file is good to about" in note for note in said)
    with pytest.raises(lb.ModelError, match="twisted"):
        lb.files.read_blocks(tmp_path / "a.obj", twisted="refuse")
    bad = [("far", *box("far", (9.5, 0.5, 0.5), lift=0.1)[1:])]
    with pytest.raises(lb.ModelError, match="1 of 17 blocks is bad"):  # one that is twisted by far more
        lb.files.read_blocks(obj(tmp_path / "b.obj", noisy + bad))


def test_from_the_shell(tmp_path):
    file = obj(
        tmp_path / "a.obj",
        [box("base", (0, 0, -0.5)), box("open", (3, 0, 0), faces=5), box("a", (0, 0, 0.5), lift=0.1)],
    )
    given = ["import", str(file), "--friction", "0.6", "--live", "1,0,0", "--unit-weight", "20e3"]
    run = CliRunner()
    refused = run.invoke(app, [*given, "--supports", "base"])
    assert refused.exit_code == 2
    assert "--skip-bad" in refused.stderr
    assert "--twisted triangulate" in refused.stderr
    done = run.invoke(app, [*given, "--supports", "base", "--skip-bad", "--twisted", "triangulate"])
    assert done.exit_code == 0, done.stderr
    assert "note: left out: block 'open'" in done.stderr
    assert "divided into triangles" in done.stderr


def test_look_tells_the_remedy_where_all_faces_are_twisted_and_takes_it(tmp_path):
    file = obj(tmp_path / "a.obj", [box(f"b{k}", (3 * k, 0, 0.5), lift=0.1) for k in range(3)])
    with pytest.raises(lb.ModelError) as raised:
        lb.files.look(file)
    assert "3 of 3 blocks are bad, by twisted faces; --twisted triangulate" in raised.value.problems[0]
    done = CliRunner().invoke(app, ["look", str(file), "--twisted", "triangulate"], env={"COLUMNS": "200"})
    assert done.exit_code == 0, done.output
    assert re.search(r"Blocks +3\b", done.output)
    assert f"Next: limitblocks import {file} --twisted triangulate" in done.output


def test_look_names_the_mending_without_which_import_refuses(tmp_path):
    """Faces off by 1 mm: its next command, taken literally, was refused."""
    random = np.random.default_rng(1)
    wall = lb.structures.wall(lb.PointContact(0.6), length=1.6, courses=2)
    bodies = [
        (
            block.name.replace(" ", "_"),
            block.vertices + 1e-3 * random.uniform(-1.0, 1.0, block.vertices.shape),
            [(face[0], *two) for face in block.faces for two in pairwise(face[1:])],
        )
        for block in wall.blocks
    ]
    file = obj(tmp_path / "rough.obj", bodies)
    said = CliRunner().invoke(app, ["look", str(file)], env={"COLUMNS": "200"}).output
    (words,) = (line.split()[2:] for line in said.splitlines() if line.startswith("Next: "))
    assert "--heal" in words
    assert CliRunner().invoke(app, words).exit_code == 0
    refused = CliRunner().invoke(app, [*(word for word in words if word != "--heal"), "--force"])
    assert "import --heal" in refused.stderr
