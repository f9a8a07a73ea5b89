"""Vertices that no face has, far from the others, in formats that list vertices apart from faces."""

import json

import ezdxf
import pytest
from compas_documents import written

import limitblocks as lb
from limitblocks.io.formats.compas.writer import mesh

PLACE = (5e5, 4e6, 0.5)  # as of a survey in a national grid


def drawing(path, vertices, faces):
    made = ezdxf.new(units=0)
    body = made.modelspace().add_mesh()
    body.vertices, body.faces = vertices, faces
    made.saveas(path)


def ply(path, vertices, faces):
    head = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    head += [f"property double {axis}" for axis in "xyz"]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    rows = [" ".join(map(repr, vertex)) for vertex in vertices]
    rows += [" ".join(map(str, (len(face), *face))) for face in faces]
    path.write_text("\n".join([*head, *rows, ""]))


def compas(path, vertices, faces):
    data = mesh(lb.Block.box("stone", (1.0, 1.0, 1.0), PLACE))
    data["vertex"] = {str(k): dict(zip("xyz", vertex, strict=True)) for k, vertex in enumerate(vertices)}
    data["face"] = {str(k): list(face) for k, face in enumerate(faces)}
    written(path, json.loads(json.dumps({"dtype": "compas.datastructures/Mesh", "data": data})))


@pytest.mark.parametrize(("suffix", "write"), [(".dxf", drawing), (".ply", ply), (".json", compas)])
def test_a_spare_vertex_at_the_origin_does_not_change_the_unit(tmp_path, suffix, write):
    """A cube of 1 m in a file that states no unit: metres, as the cube is not larger than 300 m."""
    block = lb.Block.box("stone", (1.0, 1.0, 1.0), PLACE)
    path = tmp_path / f"a{suffix}"
    write(path, [*block.vertices.tolist(), [0.0, 0.0, 0.0]], block.faces)
    found = lb.files.read_blocks(path, unit_weight=2e4)
    assert found.guesses == ()
    assert [stone.weight for stone in found.blocks] == pytest.approx([2e4], rel=1e-6)
    assert found.blocks[0].centroid == pytest.approx(PLACE, rel=1e-9)


@pytest.mark.parametrize("spare", [False, True])
def test_a_spare_vertex_does_not_make_coordinates_coarse(tmp_path, spare):
    """A corner .1 m out of the top of 1 x 1 m, in a file of one decimal: no rounding, as that is a tenth."""
    block = lb.Block.box("stone", (1.0, 1.0, 1.0), (0.5, 0.5, 0.5))
    corners = [(x, y, z + 0.1 * (x + y + z == 3.0)) for x, y, z in block.vertices.tolist()]
    compas(tmp_path / "a.json", [*corners, *([(0.0, 0.0, 200.0)] * spare)], block.faces)
    with pytest.raises(lb.ModelError, match=r"twisted faces: 1 of 6, corners up to 0\.0249 m"):
        lb.files.read_blocks(tmp_path / "a.json")
