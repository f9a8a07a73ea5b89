"""Files that are too much, and names that no format was made for."""

import json
import resource
import subprocess
import sys
from contextlib import suppress

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.geometry.mend import mended
from limitblocks.io import strict_json
from limitblocks.io.documents import ModelDocument
from limitblocks.io.faults import validated
from limitblocks.io.formats.gltf import reader

HEAD = {"schema_version": 1, "supports": [], "joints": {}, "interfaces": [], "live": []}
READ = """
import sys
import limitblocks as lb
try:
    lb.read(sys.argv[1])
except lb.LimitBlocksError as error:
    print(error)
"""


def refusal(path, megabytes):
    """Return what reading a file says in an address space so much larger than that of an empty file."""

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (megabytes * 10**6,) * 2)

    done = subprocess.run(
        [sys.executable, "-c", READ, str(path)], capture_output=True, text=True, preexec_fn=limit, check=False
    )
    assert done.returncode == 0, done.stderr[-500:]
    return done.stdout


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are those of Linux")
@pytest.mark.parametrize(
    "body",
    [
        HEAD | {"blocks": [0] * 300_000},
        HEAD | {"blocks": [{"name": "a", "vertices": [0] * 300_000, "faces": []}]},
        HEAD | {"blocks": [], "supports": [0] * 300_000},
    ],
)
def test_a_megabyte_of_zeros_takes_no_gigabyte(tmp_path, body):
    """Each fault took 1.4 kB: 300 000 of them took 0.5 GB, beside 0.1 GB for all else."""
    path = tmp_path / "a.json"
    path.write_text(json.dumps(body))
    assert "expected" in refusal(path, 1000)  # address space: twice what is used


def test_faults_of_a_list_are_told_and_counted():
    blocks = [{"name": "a", "box": {"size": [1, 1, 1], "at": [0, 0, 0]}}] * 3 + [{"name": 3}, 0] * 50
    text = json.dumps(HEAD | {"blocks": blocks, "extra": 1})
    with pytest.raises(lb.ModelError) as raised:
        validated(ModelDocument, text, json.loads(text))
    lines = raised.value.problems
    assert lines[0] == "extra: unknown key"
    assert lines[1] == "blocks[3].name: expected a string, not 3"
    assert lines[2].startswith("blocks[4]: expected an object")
    assert lines[-1] == "and 81 more faults"  # 101 in all


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[" * 3_000_001, "lists and objects"),
        ("[" + "0," * 8_000_001 + "0]", "values"),
        ("{" + ",".join(f'"{k}":0' for k in range(250_001)) + "}", "an object has 250001 keys"),
    ],
)
def test_json_that_would_fill_the_memory(text, said):
    with pytest.raises(lb.ModelError, match=said):
        strict_json.parse(text)


def test_a_buffer_that_many_name_is_read_once(tmp_path, monkeypatch):
    read = []
    monkeypatch.setattr(reader, "read_bytes", lambda path: read.append(path) or b"\0" * 12)
    document = {"buffers": [{"uri": "a.bin", "byteLength": 12}] * 200 + [{"byteLength": 4}]}
    buffers = reader._buffers(document, b"own", tmp_path / "a.gltf")
    assert (len(read), len(buffers), buffers[-1]) == (1, 201, b"own")


@pytest.mark.parametrize("index", ["1e30", "99999999999999999999", "-1e300", "inf", "nan"])
def test_a_ply_index_beyond_all_integers(tmp_path, index):
    path = tmp_path / "a.ply"
    path.write_text(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        f"0 0 0 1 0 0 0 1 0\n3 0 1 {index}\n"
    )
    with pytest.raises(lb.ModelError):
        lb.files.read_blocks(path)


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian"])
def test_ply_faces_of_one_size_and_of_many_are_the_same(tmp_path, order):
    """Triangles alone are taken all at once; a quad among them, one by one."""
    box = lb.Block.box("a", (1.0, 2.0, 3.0), (0.0, 0.0, 0.0))
    files = []
    fans = [(f[0], f[n], f[n + 1]) for f in box.faces for n in (1, 2)]
    for k, faces in enumerate((fans, [*fans[2:], box.faces[0]])):
        flat = [[len(face), *face] for face in faces]
        head = (
            f"ply\nformat {order} 1.0\nelement vertex 8\nproperty double x\nproperty double y\n"
            f"property double z\nelement face {len(faces)}\nproperty list int int vertex_indices\n"
            "property int material\nend_header\n"
        ).encode()
        rows = [[*row, 7] for row in flat]
        if order == "ascii":
            text = [" ".join(map(repr, row)) for row in [*box.vertices.tolist(), *rows]]
            body = "\n".join(text).encode()
        else:
            body = box.vertices.astype("<f8").tobytes() + np.concatenate(rows).astype("<i4").tobytes()
        files.append(tmp_path / f"{k}.ply")
        files[-1].write_bytes(head + body)
    for file in files:
        assert lb.files.read_blocks(file).blocks[0].volume == pytest.approx(6.0)


def test_a_mesh_that_is_too_fine_is_refused_with_the_remedy():
    """More than 5000 facets that lie in no plane: a sphere of 100 x 60 quads."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 100, endpoint=False), np.linspace(0, np.pi, 62)[1:-1])
    ring = np.column_stack([(np.sin(v) * np.cos(u)).ravel(), (np.sin(v) * np.sin(u)).ravel()])
    points = np.column_stack([ring, np.cos(v).ravel()])
    faces = []
    for a in range(5900):
        b = a - a % 100 + (a + 1) % 100
        faces += [(a, a + 100, b + 100), (a, b + 100, b)]
    faces += [tuple(range(100)), tuple(range(5999, 5899, -1))]
    with pytest.raises(lb.errors.GeometryError, match=r"more than 5000 plane faces.*make the mesh coarser"):
        mended("scan", points, faces)


NAMES = [
    *("\\", "a\\", "stone\0x", "a" * 300, "half \udc80", "#5", "v 1 2 3", "endsolid", "o", "wände", "日本"),
    *('quo"te', "a/b:c*?", "line\nbreak", "100 %d", "^J", "=x", "  spaced  name ", "usemtl \\", "\x7f\x85"),
]


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".glb", ".dxf", ".3dm", ".json"])
def test_every_odd_name_is_read_again(tmp_path, suffix):
    blocks = [lb.Block.box(name, (1.0, 1.0, 1.0), (2.0 * k, 0.0, 0.0)) for k, name in enumerate(NAMES)]
    found = lb.files.read_blocks(lb.files.write_blocks(blocks, tmp_path / f"a{suffix}"))
    assert len(found.blocks) == len(NAMES)
    for block, given in zip(found.blocks, NAMES, strict=True):
        name = " ".join(given.split())
        for odd in ("\0", "\udc80", "\x7f"):
            name = name.replace(odd, "\ufffd")
        assert block.name == (name[:255] if suffix == ".dxf" else name)


ODD = ["a\0.obj", "a" * 300 + ".obj", "\udc80.obj", "a\0", "b" * 300 + ".json", "\udcff.json"]


@pytest.mark.parametrize("name", ODD)
def test_every_odd_file_name_is_one_error(tmp_path, name):
    box = lb.Block.box("a", (1.0, 1.0, 1.0), (0.0, 0.0, 0.0))
    for do in (lb.files.read_blocks, lb.read, lambda path: lb.files.write_blocks([box], path)):
        with suppress(lb.LimitBlocksError):  # some systems take half letters
            do(tmp_path / name)
