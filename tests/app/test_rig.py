"""``toongeo rig``: a mesh and its landmarks in, a GLB with 46 morph targets out."""

import json
from functools import partial

import numpy as np
import pytest
import trimesh

from toongeo.app.cli import main
from toongeo.geometry import nonrigid_register
from toongeo.io import Scene, SceneMesh, read_glb, read_mesh, write_glb, write_image, write_ply
from toongeo.io.scene import METRES
from toongeo.pipeline import rig_mesh
from toongeo.pipeline.rig.foreign import register_face


@pytest.fixture(scope="module")
def head(tmp_path_factory, model):
    """The front of the template as an OBJ in quads and other units, with texture coordinates; and its landmarks."""
    folder = tmp_path_factory.mktemp("head")
    quads = model.quads[model.region("face")[model.quads].all(1)]
    used, local = np.unique(quads, return_inverse=True)
    V = 0.01 * model.mean[used]
    lines = [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in V]
    lines += [f"vt {x:.6f} {y:.6f}" for x, y in (V[:, :2] + 1) / 2]
    lines += ["f " + " ".join(f"{i}/{i}" for i in quad) for quad in local.reshape(-1, 4) + 1]
    (folder / "head.obj").write_text("\n".join(lines))
    inside = np.isin(model.landmarks, used)
    entries = [int(np.searchsorted(used, v)) if i else None for v, i in zip(model.landmarks, inside, strict=True)]
    (folder / "head.json").write_text(json.dumps({"landmarks": entries}))
    points = [None if k is None else V[k].tolist() for k in entries]
    (folder / "points.json").write_text(json.dumps(points))
    write_image(folder / "skin.png", np.full((8, 8, 3), 200, np.uint8))
    return folder, V


@pytest.fixture(scope="module")
def other_files(head):
    """The same head in the other formats; the GLB in two meshes, the PLY and the GLB cut along seams."""
    folder, _ = head
    (obj,) = read_mesh(folder / "head.obj").meshes
    mesh = trimesh.Trimesh(obj.vertices, obj.faces, process=False)
    for kind in ("stl", "off"):
        mesh.export(folder / f"head.{kind}")
    left = obj.vertices[obj.faces].mean(1)[:, 0] > 0
    twice = np.vstack([obj.vertices, obj.vertices]).astype(np.float32)
    write_ply(
        folder / "head.ply", twice, np.where(left[:, None], obj.faces + len(obj.vertices), obj.faces), uv=twice[:, :2]
    )
    texture = np.arange(192, dtype=np.uint8).reshape(8, 8, 3)
    halves = []
    for name, side, color in (("left", left, (1.0, 0.5, 0.25)), ("right", ~left, (1.0, 1.0, 1.0))):
        used, faces = np.unique(obj.faces[side], return_inverse=True)
        look = {"uv": obj.uv[used], "texture": texture} if name == "right" else {"color": color}
        halves.append(SceneMesh(name, obj.vertices[used] / METRES, faces.reshape(-1, 3), **look))
    write_glb(folder / "head_in.glb", Scene(tuple(halves)))
    return {kind: folder / f"head.{kind}" for kind in ("obj", "stl", "off", "ply")} | {"glb": folder / "head_in.glb"}


@pytest.fixture
def quick(monkeypatch):
    """Registration in a tenth of the steps: the template's own front is found at once."""
    short = partial(nonrigid_register, stiffness=(0.03,), iterations=2)
    monkeypatch.setattr(register_face, "nonrigid_register", short)


def rigged(path, landmarks, out):
    """Positions, targets and triangles of each mesh of the GLB that the command writes."""
    assert main(["rig", str(path), "--landmarks", str(landmarks), "-o", str(out)]) == 0
    document = read_glb(out)
    found = {}
    for mesh in document.json["meshes"]:
        (primitive,) = mesh["primitives"]
        targets = np.stack([document.accessors[target["POSITION"]] for target in primitive["targets"]])
        positions = document.accessors[primitive["attributes"]["POSITION"]]
        found[mesh["name"]] = positions, targets, document.accessors[primitive["indices"]].reshape(-1, 3)
        assert mesh["extras"]["targetNames"][9] == document.json["meshes"][0]["extras"]["targetNames"][9]
    return found, document


def at_places(positions, targets):
    """Targets by the place of their vertex: one for all vertices in a place."""
    rounded = np.round(positions, 5) + 0.0
    places, first, inverse = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    np.testing.assert_allclose(targets, targets[:, first][:, inverse.ravel()], atol=5e-6)  # less is not stored
    return places, targets[:, first]


@pytest.fixture(scope="module")
def expected(head, other_files):
    """What the OBJ gives, by places."""
    folder, _ = head
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(register_face, "nonrigid_register", partial(nonrigid_register, stiffness=(0.03,), iterations=2))
        found, _ = rigged(other_files["obj"], folder / "points.json", folder / "from_obj.glb")
    return at_places(*found["head"][:2])


def test_a_trimesh_gets_the_same_targets(head, other_files, expected, quick):
    folder, _ = head
    points = np.array([[np.nan] * 3 if p is None else p for p in json.loads((folder / "points.json").read_text())])
    mesh = trimesh.load(other_files["off"], process=False)
    rig = rig_mesh(mesh, None, points)
    assert rig.neutral is not mesh.vertices
    places, targets = at_places(rig.neutral.astype(np.float32), rig.deltas)
    np.testing.assert_allclose(places, expected[0], atol=2e-5)
    np.testing.assert_allclose(targets, expected[1], atol=1e-3 * np.abs(expected[1]).max())


@pytest.mark.parametrize("kind", ["stl", "off", "ply", "glb"])
def test_every_format_gets_the_targets_of_the_same_surface(head, other_files, expected, quick, kind):
    folder, _ = head
    found, document = rigged(other_files[kind], folder / "points.json", folder / f"from_{kind}.glb")
    given = read_mesh(other_files[kind]).meshes
    assert list(found) == (["left", "right"] if kind == "glb" else ["head"])
    for mesh, (positions, _, faces) in zip(given, found.values(), strict=True):  # as it came
        unused = np.setdiff1d(np.arange(len(mesh.vertices)), mesh.faces)
        np.testing.assert_allclose(positions, np.delete(mesh.vertices, unused, axis=0), atol=1e-6)
        np.testing.assert_allclose(positions[faces], mesh.vertices[mesh.faces], atol=1e-6)
    places, targets = at_places(
        np.concatenate([positions for positions, _, _ in found.values()]),
        np.concatenate([targets for _, targets, _ in found.values()], axis=1),
    )
    np.testing.assert_allclose(places, expected[0], atol=2e-5)
    # The files hold float32, and the surfaces are triangulated alike: the motion is the same within a thousandth of it.
    largest = np.abs(expected[1]).max()
    assert largest > 0.05
    np.testing.assert_allclose(targets, expected[1], atol=1e-3 * largest)
    if kind == "glb":
        assert len(document.images) == 1
        look = [material["pbrMetallicRoughness"] for material in document.json["materials"]]
        assert "baseColorTexture" in look[1] and "baseColorTexture" not in look[0]
        np.testing.assert_allclose(look[0]["baseColorFactor"], [1, 0.214, 0.051, 1], atol=3e-3)


def test_a_head_gets_its_targets(head, capsys):
    folder, V = head
    out = folder / "head.glb"
    arguments = ["rig", str(folder / "head.obj"), "--landmarks", str(folder / "head.json"), "-o", str(out)]
    assert main([*arguments, "--texture", str(folder / "skin.png")]) == 0
    document = read_glb(out)
    mesh = document.json["meshes"][0]
    assert len(mesh["extras"]["targetNames"]) == 46 and "jawOpen" in mesh["extras"]["targetNames"]
    primitive = mesh["primitives"][0]
    assert len(primitive["targets"]) == 46 and "TEXCOORD_0" in primitive["attributes"] and len(document.images) == 1
    positions = document.accessors[primitive["attributes"]["POSITION"]]
    np.testing.assert_allclose(positions.min(0), V.min(0), atol=1e-6)  # the numbers of the OBJ
    np.testing.assert_allclose(positions.max(0), V.max(0), atol=1e-6)
    printed = capsys.readouterr().out
    assert "46 expressions" in printed and str(out) in printed


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mesh": "none.obj"}, "none.obj"),
        ({"mesh": "head.fbx"}, "MESH: expected a name that ends in .obj, .ply, .stl, .off, .glb, got"),
        ({"mesh": "skin.ply"}, "MESH: expected a mesh file, but"),
        ({"-o": "head.fbx"}, "output: expected a name that ends in .glb"),
        ({"-o": "no/folder/head.glb"}, "output: no folder"),
        ({"--landmarks": "skin.png"}, "--landmarks: expected .json, .ljson, .pp, .txt or .csv"),
        ({"mesh": "bare.obj", "--texture": "skin.png"}, "texture: expected a mesh with texture coordinates"),
        ({"mesh": "bare.obj"}, "expected a vertex in 0..2"),
    ],
)
def test_bad_input_is_one_line(head, capsys, change, message):
    folder, _ = head
    (folder / "skin.ply").write_bytes((folder / "skin.png").read_bytes())
    (folder / "bare.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    files = {"mesh": "head.obj", "--landmarks": "head.json", "-o": "head.glb", **change}
    arguments = ["rig", str(folder / files.pop("mesh"))]
    for option, name in files.items():
        arguments += [option, str(folder / name)]
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1
