"""Damaged files of every mesh format: one clean error, or blocks; never anything else."""

import base64
import json
import os
import struct

import numpy as np
import pytest
from reading import fault, outcome, places
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.io.blocks import write_blocks

JOINT = lb.OrdunaLourenco(0.6)
COLUMN = lb.structures.column(JOINT, count=2, width=0.5, height=1.0, depth=0.5)
TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
SIDES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]


def written(folder, suffix):
    return write_blocks(COLUMN, folder / f"column{suffix}").read_bytes()


def binary_stl(triangles):
    records = np.zeros(len(triangles), [("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    records["c"] = triangles
    return bytes(80) + struct.pack("<I", len(triangles)) + records.tobytes()


def ascii_ply(vertices, faces):
    header = (
        f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
        f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_index\nend_header\n"
    )
    rows = [*vertices, *((len(face), *face) for face in faces)]
    return (header + "\n".join(" ".join(map(str, row)) for row in rows)).encode()


def parts_of(glb):
    length = struct.unpack("<I", glb[12:16])[0]
    return json.loads(glb[20 : 20 + length]), glb[28 + length :]


def gltf(glb):
    document, binary = parts_of(glb)
    document["buffers"][0]["uri"] = (
        "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    )
    return json.dumps(document).encode()


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A real file of every format and form, small."""
    folder = tmp_path_factory.mktemp("meshes")
    glb = written(folder, ".glb")
    corners = [[TETRAHEDRON[v] for v in side] for side in SIDES]
    return {
        "text.obj": written(folder, ".obj"),
        "text.stl": written(folder, ".stl"),
        "binary.stl": binary_stl(np.concatenate([corners, np.add(corners, 2.0)])),
        "text.ply": ascii_ply(TETRAHEDRON, SIDES),
        "binary.ply": written(folder, ".ply"),
        "binary.glb": glb,
        "text.gltf": gltf(glb),
    }


FORMS = ["text.obj", "text.stl", "binary.stl", "text.ply", "binary.ply", "binary.glb", "text.gltf"]
JUNK = [b"nan", b"-1", b"1e999", b"99999999999", b"\0", b"{", b" ", b"\n", b"0", b"\xff\xfe"]


def mutated(data, rng):
    """`data` with a few random changes: bits, words, cuts, repeats."""
    damaged = bytearray(data)
    for _ in range(rng.integers(1, 4)):
        a, b = sorted(rng.integers(0, len(damaged) + 1, 2).tolist())
        match rng.integers(0, 9):
            case 0 | 6 | 7:
                damaged[a : a + 1] = bytes([rng.integers(0, 256)])
            case 8:
                damaged[a : a + 1] = str(rng.integers(0, 10)).encode()
            case 1:
                damaged[a : a + 4] = struct.pack("<I", rng.choice([0, 1, 7, 2**31 - 1, 2**32 - 1]))
            case 2:
                damaged[a : min(b, a + 40)] = b""
            case 3:
                damaged[a:a] = JUNK[rng.integers(0, len(JUNK))]
            case 4:
                damaged[a:a] = damaged[a : min(b, a + 200)]
            case 5:
                damaged = damaged[: max(b, 1)]
    if damaged[:4] == b"glTF" and rng.integers(0, 4):  # a right length, so that the reader looks further
        damaged[8:12] = struct.pack("<I", len(damaged))
    return bytes(damaged) or b" "


@pytest.mark.parametrize("form", FORMS)
def test_damaged_file_gives_blocks_or_one_clean_error(form, files, tmp_path):
    rng = np.random.default_rng(20050101)
    path = tmp_path / form
    assert len(outcome_of(path, files[form]).blocks) >= 1  # sound before it is damaged
    for _ in range(int(os.environ.get("MUTATIONS", "200"))):
        imported = outcome_of(path, mutated(files[form], rng))
        assert isinstance(imported, str) or all(block.volume > 0.0 for block in imported.blocks)


def outcome_of(path, data):
    path.write_bytes(data)
    return outcome(path)


ODD = [None, -1, 0, 3, 1e9, 10**20, 1e308, "x", [], {}, True, [[0]], 5120, [1e300] * 3, [0] * 16, ["nan"] * 4]


def test_gltf_with_odd_values_gives_blocks_or_one_clean_error(files, tmp_path):
    sound = json.loads(files["text.gltf"])
    sound["nodes"][0] |= {"rotation": [0, 0, 0, 1], "scale": [1, 1, 1], "children": []}
    rng = np.random.default_rng(20050102)
    paths = list(places(sound))
    for _ in range(200):
        *steps, last = paths[rng.integers(len(paths))]
        document = part = json.loads(json.dumps(sound))
        for step in steps:
            part = part[step]
        part[last] = ODD[rng.integers(len(ODD))]
        imported = outcome_of(tmp_path / "odd.gltf", json.dumps(document).encode())
        assert isinstance(imported, str) or all(block.volume > 0.0 for block in imported.blocks)


def changed(data, old, new):
    assert old in data
    return data.replace(old, new, 1)


#: name: form, how the file is damaged, what the error says
DAMAGE = {
    "obj cut": ("text.obj", lambda d: d[:-30], "open"),
    "obj nan": ("text.obj", lambda d: changed(d, b"v 0.0", b"v nan"), "block 'base': vertex"),
    "obj word": ("text.obj", lambda d: changed(d, b"v 0.0", b"v O.O"), "cannot be read: could not convert"),
    "obj comma": ("text.obj", lambda d: changed(d, b"v 0.0", b"v 0,0"), "write 0.5, not 0,5"),
    "obj comma of a later number": (
        "text.obj",
        lambda d: changed(d, b" 0.0\n", b" 0,0\n"),
        "write 0.5, not 0,5",
    ),
    "obj vertex without numbers": (
        "text.obj",
        lambda d: changed(d, b"v 0.0", b"v\nv 0.0"),
        "'v' cannot be read: a vertex has three numbers",
    ),
    "obj vertex to come": ("text.obj", lambda d: changed(d, b"f 1 ", b"f 999 "), "vertex 999"),
    "obj without faces": ("text.obj", lambda _: b"v 0 0 0\nv 1 0 0\n", "no solid"),
    "obj garbage": ("text.obj", lambda _: bytes(range(256)) * 8, "not text"),
    "stl cut": ("text.stl", lambda d: d[: len(d) // 2], "not whole"),
    "stl nan": ("text.stl", lambda d: changed(d, b"vertex 0.0", b"vertex nan"), "numbers up to"),
    "stl word": ("text.stl", lambda d: changed(d, b"vertex 0.0", b"vertex O.O"), "'base'"),
    "stl of another count": (
        "binary.stl",
        lambda d: d[:80] + struct.pack("<I", 10**9) + d[84:],
        "1000000000",
    ),
    "stl cut binary": ("binary.stl", lambda d: d[:-1], "bytes for"),
    "stl nan binary": ("binary.stl", lambda d: d[:96] + struct.pack("<f", np.nan) + d[100:], "numbers up to"),
    "stl garbage": ("binary.stl", lambda _: bytes(range(256)) * 8, "no sound STL"),
    "ply of 10^9 vertices": (
        "text.ply",
        lambda d: changed(d, b"vertex 4", b"vertex 1000000000"),
        "1000000000",
    ),
    "ply of 10^9 faces": ("binary.ply", lambda d: changed(d, b"face 18", b"face 1000000000"), "1000000000"),
    "ply of 10^30 vertices": (
        "text.ply",
        lambda d: changed(d, b"vertex 4", b"vertex 1" + b"0" * 30),
        "header",
    ),
    "ply list of 10^9": ("text.ply", lambda d: changed(d, b"\n3 ", b"\n1000000000 "), "early"),
    "ply cut": ("binary.ply", lambda d: d[:-9], "early"),
    "ply cut in the header": ("binary.ply", lambda d: d[:50], "end_header"),
    "ply nan": ("text.ply", lambda d: changed(d, b"\n1 0 0", b"\nnan 0 0"), "numbers up to"),
    "ply word": ("text.ply", lambda d: changed(d, b"\n1 0 0", b"\none 0 0"), "values"),
    "ply vertex out of range": ("text.ply", lambda d: changed(d, b"3 0 2 1", b"3 0 2 9"), "run from 0 to 3"),
    "ply without faces": ("text.ply", lambda _: ascii_ply(TETRAHEDRON, []), "no solid"),
    "ply open": ("text.ply", lambda _: ascii_ply(TETRAHEDRON, SIDES[1:]), "the surface is open"),
    "ply non-manifold": (
        "text.ply",
        lambda _: ascii_ply([*TETRAHEDRON, (1, 1, 1)], [*SIDES, (0, 1, 4)]),
        "belong to 3 faces",
    ),
    "glb cut": ("binary.glb", lambda d: d[:-4], "not whole"),
    "glb of another length": ("binary.glb", lambda d: d[:8] + b"\xff" * 4 + d[12:], "4294967295"),
    "glb chunk of another length": ("binary.glb", lambda d: d[:12] + b"\xff" * 4 + d[16:], "4294967295"),
    "glb garbage": ("binary.glb", lambda _: b"glTF" + bytes(range(256)) * 8, "not whole"),
    "gltf of text": ("text.gltf", lambda _: b"a wall of ten stones", "is neither glTF (JSON) nor GLB"),
    "gltf of Latin text": ("text.gltf", lambda _: b"arc \xe9pais", "is neither glTF (JSON) nor GLB"),
    "gltf cut": ("text.gltf", lambda d: d[:-40], "not JSON"),
    "gltf of version 1": ("text.gltf", lambda d: changed(d, b'"2.0"', b'"1.0"'), "version"),
    "gltf far beyond its buffer": (
        "text.gltf",
        lambda d: changed(d, b'"count": 8', b'"count": 999999999'),
        "claims",
    ),
    "gltf that is JSON of another kind": ("text.gltf", lambda _: b"[1, 2]", "version is None"),
    "gltf with a loop of nodes": (
        "text.gltf",
        lambda d: changed(d, b'"nodes": [{', b'"nodes": [{"children": [0], '),
        "two parents",
    ),
    "gltf with a skin": ("text.gltf", lambda d: changed(d, b'"mesh": 1', b'"skin": 0, "mesh": 1'), "a skin"),
    "gltf in normalised integers": (
        "text.gltf",
        lambda d: changed(d, b'"count": 8', b'"normalized": true, "count": 8'),
        "normalised",
    ),
    "gltf that is compressed": (
        "text.gltf",
        lambda d: changed(d, b'"scene": 0', b'"extensionsRequired": ["EXT_meshopt_compression"], "scene": 0'),
        "EXT_meshopt_compression",
    ),
    "gltf beside another file": (
        "text.gltf",
        lambda d: changed(d, b'"uri": "data:', b'"uri": "../secret/data:'),
        "same folder",
    ),
}


@pytest.mark.parametrize("form", ["text.obj", "text.stl", "text.gltf"])
def test_text_may_begin_with_a_byte_order_mark(form, files, tmp_path):
    path = tmp_path / form
    path.write_bytes(b"\xef\xbb\xbf" + files[form])
    (tmp_path / "plain").mkdir()
    plain = tmp_path / "plain" / form
    plain.write_bytes(files[form])
    told = [[block.name for block in lb.files.read_blocks(file).blocks] for file in (path, plain)]
    assert told[0] == told[1]


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named_in_one_line(name, files, tmp_path):
    form, damage, said = DAMAGE[name]
    path = tmp_path / form
    path.write_bytes(damage(files[form]))
    assert said in fault(path)


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".ply", ".glb", ".gltf"])
def test_what_is_no_file_of_blocks_is_refused(suffix, tmp_path):
    folder = tmp_path / f"folder{suffix}"
    folder.mkdir()
    for path, said in (
        (folder, "is a folder; name a file in it"),
        (tmp_path / f"none{suffix}", "cannot be read"),
    ):
        with pytest.raises(lb.ModelError, match=said):
            lb.files.read_blocks(path)
    for data in (b"", b" \n"):
        assert "is empty" in outcome_of(tmp_path / f"empty{suffix}", data)


def test_unknown_suffix_names_the_formats(tmp_path):
    with pytest.raises(lb.ModelError, match=r"\.docx.*\.obj"):
        lb.files.read_blocks(tmp_path / "wall.docx")


def test_command_line_says_it_in_one_line_and_exits_with_2(tmp_path):
    path = tmp_path / "open.ply"
    path.write_bytes(ascii_ply(TETRAHEDRON, SIDES[1:]))
    options = ["--friction", "0.6", "--supports", "open", "--live", "1,0,0", "--unit-weight", "1"]
    result = CliRunner().invoke(app, ["import", str(path), *options])
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
