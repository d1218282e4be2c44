"""Meshes of GLBs as other programs write them: against a tetrahedron whose place is known."""

import base64
import io
import json
import struct

import numpy as np
import pytest
from PIL import Image

from toongeo.io import read_mesh

V = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]], np.float32)
F = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint16)
UV = np.array([[0, 0], [1, 0], [0, 1], [1, 1]], np.float32)
TYPES = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}


class Glb:
    """A file that is put together array by array."""

    def __init__(self):
        self.binary, self.views, self.accessors = b"", [], []

    def add(self, array, **more):
        """Index of an accessor; rows of integers are padded to four bytes."""
        array = np.asarray(array)
        columns = array.shape[1] if array.ndim == 2 else 1
        row = array.dtype.itemsize * columns
        wide = np.zeros((len(array), row + -row % 4 if array.ndim == 2 else row), np.uint8)
        wide[:, :row] = np.ascontiguousarray(array).view(np.uint8).reshape(len(array), row)
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": wide.size}
        self.views.append(view | ({"byteStride": wide.shape[1]} if array.ndim == 2 else {}))
        self.binary += wide.tobytes()
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3"}[columns]
        plain = {"componentType": TYPES[array.dtype.char], "count": len(array), "type": kind}
        self.accessors.append({"bufferView": len(self.views) - 1} | plain | more)
        return len(self.accessors) - 1

    def read(self, path, primitives, **more):
        document = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": len(self.binary)}],
            "bufferViews": self.views,
            "accessors": self.accessors,
            "meshes": [{"primitives": primitives}],
            "nodes": [{"mesh": 0}],
            "scenes": [{"nodes": [0]}],
        } | more
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        binary = self.binary + b"\0" * (-len(self.binary) % 4)
        head = struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(binary), len(text), b"JSON")
        path.write_bytes(head + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
        return read_mesh(path).meshes


@pytest.fixture
def glb():
    return Glb()


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.glb"


def primitive(glb, vertices=V, faces=F, **more):
    return {"attributes": {"POSITION": glb.add(vertices)}, "indices": glb.add(faces.ravel())} | more


def volume(mesh):
    return np.linalg.det(mesh.vertices[mesh.faces]).sum() / 6


@pytest.mark.parametrize("kind", ["b", "B", "h", "H"])
def test_normalized_integers_are_fractions(glb, path, kind):
    most = np.iinfo(kind).max
    given = glb.add(np.rint(V / 3 * most).astype(kind), normalized=True)
    uv = glb.add((UV * most).astype(kind), normalized=True)
    whole = {"attributes": {"POSITION": given, "TEXCOORD_0": uv}, "indices": glb.add(F.ravel())}
    (mesh,) = glb.read(path, [whole], nodes=[{"mesh": 0, "scale": [3, 3, 3]}])
    np.testing.assert_allclose(mesh.vertices, V, atol=3 / most)
    np.testing.assert_array_equal(mesh.uv, UV * [1, -1] + [0, 1])


def test_sparse_accessors_are_filled_in(glb, path):
    part = primitive(glb)
    where, what = glb.add(np.array([1], np.uint16)), glb.add(np.float32([[9, 0, 0]]))
    glb.accessors[0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": where, "componentType": 5123},
        "values": {"bufferView": what},
    }
    (mesh,) = glb.read(path, [part])
    np.testing.assert_array_equal(mesh.vertices, [V[0], [9, 0, 0], V[2], V[3]])


@pytest.mark.parametrize("turn", [0.0, 0.5])
def test_texture_coordinates_are_those_of_the_picture(glb, path, turn):
    """Of the second set, moved as KHR_texture_transform says: as three.js does it."""
    picture = io.BytesIO()
    Image.new("RGB", (2, 2), (255, 0, 0)).save(picture, "PNG")
    transform = {"offset": [0.25, 0.5], "scale": [2, 3], "rotation": turn}
    info = {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": transform}}
    part = primitive(glb, material=0)
    part["attributes"] |= {"TEXCOORD_0": glb.add(0 * UV), "TEXCOORD_1": glb.add(UV)}
    (mesh,) = glb.read(
        path,
        [part],
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": info}}],
        textures=[{"source": 0}],
        images=[{"uri": "data:image/png;base64," + base64.b64encode(picture.getvalue()).decode()}],
        extensionsRequired=["KHR_texture_transform"],
    )
    c, s = np.cos(turn), np.sin(turn)
    expected = np.column_stack([0.25 + 2 * c * UV[:, 0] + 3 * s * UV[:, 1], 0.5 - 2 * s * UV[:, 0] + 3 * c * UV[:, 1]])
    np.testing.assert_allclose(mesh.uv, expected * [1, -1] + [0, 1], atol=1e-6)
    assert mesh.texture.tolist() == [[[255, 0, 0]] * 2] * 2


@pytest.mark.parametrize(("mode", "order"), [(5, [0, 1, 2, 3, 3, 4]), (6, [0, 1, 3, 2, 4])])
def test_strips_and_fans(glb, path, mode, order):
    """A plane of four triangles at most, all of them seen from the same side."""
    plane = np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [-1, 0, 0]])
    (mesh,) = glb.read(path, [primitive(glb, plane, np.uint16(order)[None], mode=mode)])
    corners = mesh.vertices[mesh.faces]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] / 2
    assert len(mesh.faces) == {5: 2, 6: 3}[mode] and (area > 0).all()


def test_several_primitives_lines_and_none_named(glb, path):
    plain = {"attributes": {"POSITION": glb.add(V[F.ravel()])}}
    meshes = glb.read(path, [primitive(glb, mode=1), primitive(glb), plain])
    assert [mesh.name for mesh in meshes] == ["mesh", "mesh_1"]
    np.testing.assert_allclose([volume(mesh) for mesh in meshes], 1)


@pytest.mark.parametrize(
    ("nodes", "expected"),
    [
        ([{"mesh": 0, "scale": [-1, 1, 1]}], V * [-1, 1, 1]),
        ([{"children": [1], "scale": [2, 2, 2]}, {"mesh": 0, "translation": [1, 0, 0]}], 2 * (V + [1, 0, 0])),
        ([{"mesh": 0, "rotation": [-(0.5**0.5), 0, 0, 0.5**0.5]}], V[:, [0, 2, 1]] * [1, 1, -1]),
        ([{"mesh": 0, "matrix": [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]}], V[:, [0, 2, 1]] * [1, 1, -1]),
    ],
)
@pytest.mark.parametrize("scenes", [[{"nodes": [0]}], []])
def test_places_of_nodes(glb, path, nodes, expected, scenes):
    (mesh,) = glb.read(path, [primitive(glb)], nodes=nodes, scenes=scenes)
    np.testing.assert_allclose(mesh.vertices, expected, atol=1e-6)
    assert volume(mesh) > 0  # outside is outside still


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"extensionsRequired": ["KHR_texture_basisu"]}, "requires KHR_texture_basisu"),
        ({"nodes": [{"mesh": 0, "children": [0]}]}, "node 0 hangs below itself"),
        ({"nodes": [{"mesh": 0, "scale": [1, 0, 1]}]}, "is scaled to nothing"),
        ({"nodes": [{"mesh": 0, "name": 7}]}, "a name is 7"),
    ],
)
def test_what_cannot_be_shown_is_refused(glb, path, more, message):
    with pytest.raises(ValueError, match=rf"path: expected a .*{message}"):
        glb.read(path, [primitive(glb)], **more)


def test_a_mesh_that_is_shown_ever_again_is_refused(glb, path):
    many = np.zeros((20000, 3), np.uint16)
    nodes = [{"mesh": 0} for _ in range(1200)]
    with pytest.raises(ValueError, match="it shows more than 20000000 vertices and triangles"):
        glb.read(path, [primitive(glb, faces=many)], nodes=nodes, scenes=[{"nodes": list(range(1200))}])
