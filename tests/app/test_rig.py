"""``toongeo rig``: an OBJ and its landmarks in, a GLB with 46 morph targets out."""

import json

import numpy as np
import pytest

from toongeo.app.cli import main
from toongeo.io import read_glb, write_image


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
    write_image(folder / "skin.png", np.full((8, 8, 3), 200, np.uint8))
    return folder, V


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
        ({"mesh": "head.ply"}, "mesh: expected a name that ends in .obj"),
        ({"-o": "head.fbx"}, "output: expected a name that ends in .glb"),
        ({"-o": "no/folder/head.glb"}, "output: no folder"),
        ({"--landmarks": "skin.png"}, "path: expected JSON"),
        ({"mesh": "bare.obj", "--texture": "skin.png"}, "texture: expected a mesh with texture coordinates"),
        ({"mesh": "bare.obj"}, "expected a vertex in 0..2"),
    ],
)
def test_bad_input_is_one_line(head, capsys, change, message):
    folder, _ = head
    (folder / "bare.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    files = {"mesh": "head.obj", "--landmarks": "head.json", "-o": "head.glb", **change}
    arguments = ["rig", str(folder / files.pop("mesh"))]
    for option, name in files.items():
        arguments += [option, str(folder / name)]
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1
