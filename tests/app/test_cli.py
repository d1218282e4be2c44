import importlib
import subprocess
import sys

import numpy as np
import pytest

from tests.conftest import PORTRAITS
from toongeo.app.cli import main
from toongeo.io import read_image, read_landmarks, write_image
from toongeo.protocols import LandmarkDetection

PICTURE, POINTS = PORTRAITS / "blue_girl.png", PORTRAITS / "blue_girl.pts"


def test_make_writes_what_it_says(tmp_path, capsys):
    out = tmp_path / "girl.glb"
    assert main(["make", str(PICTURE), "--landmarks", str(POINTS), "-o", str(out)]) == 0
    assert out.read_bytes()[:4] == b"glTF"
    printed = capsys.readouterr().out
    assert str(out) in printed and "self-intersect" in printed and "inner51" in printed


def test_make_finds_the_landmarks_itself(tmp_path, capsys):
    out = tmp_path / "girl.ply"
    assert main(["make", str(PICTURE), "-o", str(out), "--texture-size", "64"]) == 0
    assert "landmarks found: face" in capsys.readouterr().out
    assert out.stat().st_size > 1e5


def test_landmarks_that_are_not_sure_need_a_word(tmp_path, capsys, monkeypatch):
    points = np.random.default_rng(0).uniform(0, 60, (68, 2))
    doubtful = LandmarkDetection(points, np.full(68, 0.3), 0.9)
    monkeypatch.setattr("toongeo.app.landmark_source.detect_landmarks", lambda img, face: doubtful)
    arguments = ["make", str(PICTURE), "-o", str(tmp_path / "girl.glb")]
    assert main(arguments) == 3
    said = capsys.readouterr().err
    assert (
        "not sure (face 90 %, points 30 %, the picture 0 %)" in said
        and "toongeo landmarks" in said
        and "--accept" in said
    )
    assert main([*arguments, "--accept"]) == 2  # goes on, to a fit that such points have not
    assert "landmarks" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_landmarks_that_the_picture_does_not_bear_out_need_a_word_too(tmp_path, capsys, monkeypatch):
    """However sure the detector is."""
    aside = LandmarkDetection(read_landmarks(POINTS) + [60, 40], np.full(68, 0.95), 0.99)
    monkeypatch.setattr("toongeo.app.landmark_source.detect_landmarks", lambda img, face: aside)
    assert main(["make", str(PICTURE), "-o", str(tmp_path / "girl.glb")]) == 3
    assert "not sure (face 99 %, points 95 %, the picture" in capsys.readouterr().err


def test_a_picture_without_a_face_is_refused(tmp_path, capsys):
    write_image(tmp_path / "wall.png", np.full((80, 90, 3), 120, np.uint8))
    assert main(["make", str(tmp_path / "wall.png"), "-o", str(tmp_path / "wall.glb")]) == 2
    assert "no face was found" in capsys.readouterr().err
    assert main(["make", str(PICTURE), "-o", str(tmp_path / "girl.glb"), "--face", "7"]) == 2
    assert "found in the picture" in capsys.readouterr().err


def test_noise_is_a_number_or_auto(tmp_path, capsys):
    arguments = ["make", str(PICTURE), "--landmarks", str(POINTS), "-o", str(tmp_path / "girl.glb"), "--noise"]
    assert main([*arguments, "-0.1"]) == 2
    assert "--noise: expected 'auto' or a number >= 0" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main([*arguments, "some"])
    assert "--noise" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_make_crops_snaps_and_refines(tmp_path, capsys):
    whole, face = tmp_path / "whole.ply", tmp_path / "face.ply"
    arguments = ["make", str(PICTURE), "--landmarks", str(POINTS), "--texture-size", "64"]
    assert main([*arguments, "-o", str(whole)]) == 0
    before = capsys.readouterr().out
    assert main([*arguments, "-o", str(face), "--crop", "face", "--snap", "--photometric"]) == 0
    after = capsys.readouterr().out
    assert face.stat().st_size < 0.8 * whole.stat().st_size
    inner = [next(line for line in text.splitlines() if line.startswith("inner51")) for text in (before, after)]
    assert inner[0] != inner[1]  # another fit, to other eye points


def test_make_writes_a_vrm_with_its_author_and_a_small_glb(tmp_path, avatar, monkeypatch):
    from toongeo.io import read_glb

    monkeypatch.setattr("toongeo.app.make.make_avatar", lambda *_, **__: avatar)
    arguments = ["make", str(PICTURE), "--landmarks", str(POINTS), "--texture-size", "64"]
    assert main([*arguments, "-o", str(tmp_path / "a.vrm"), "--author", "Ada", "--author", "Bob"]) == 0
    meta = read_glb(tmp_path / "a.vrm").json["extensions"]["VRMC_vrm"]["meta"]
    assert meta["authors"] == ["Ada", "Bob"]
    small = ["--quantize", "--names", "arkit", "--texture", "none", "--no-unlit"]
    assert main([*arguments, "-o", str(tmp_path / "a.glb"), *small]) == 0
    document = read_glb(tmp_path / "a.glb").json
    assert len(document["meshes"][0]["extras"]["targetNames"]) == 52 and "images" not in document
    assert document["extensionsUsed"] == ["KHR_mesh_quantization", "KHR_materials_specular"]


def test_make_takes_a_hair_mask_or_no_hair(tmp_path, capsys, monkeypatch):
    module = importlib.import_module("toongeo.app.make")
    asked = []

    def stop(*_, **options):
        asked.append((options["hair"], options["hair_mask"]))
        raise ValueError("enough")

    monkeypatch.setattr(module, "make_avatar", stop)
    command = ["make", str(PICTURE), "--landmarks", str(POINTS), "-o", str(tmp_path / "a.glb")]
    mask = tmp_path / "mask.png"
    hair = np.zeros(read_image(PICTURE).shape[:2], np.uint8)
    hair[:100] = 255
    write_image(mask, hair)
    for more in ([], ["--no-hair"], ["--hair-mask", str(mask)]):
        assert main([*command, *more]) == 2
    assert asked == [(True, None), (False, None), (True, mask)]


def test_an_option_that_the_format_has_not_is_refused_before_the_work(tmp_path, capsys, monkeypatch):
    arguments = ["make", str(PICTURE), "--landmarks", str(POINTS)]
    monkeypatch.setattr("toongeo.app.make.make_avatar", None)
    assert main([*arguments, "-o", str(tmp_path / "a.obj"), "--quantize"]) == 2
    assert "--quantize: no option of .obj, which has --crop" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "pxr", None)
    assert main([*arguments, "-o", str(tmp_path / "a.usdz")]) == 2
    assert 'pip install "usd-core>=24.11"' in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_demo_writes_its_files(tmp_path, capsys):
    assert main(["demo", "-o", str(tmp_path / "demo")]) == 0
    names = {path.name for path in (tmp_path / "demo").iterdir()}
    textures = {"avatar_texture.png", "avatar_texture_1.png"}  # of the head, and of its hair
    assert names == {"avatar.glb", "avatar.obj", "avatar.mtl", "contact-sheet.png"} | textures
    printed = capsys.readouterr().out
    assert all(name in printed for name in names)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([str(PICTURE.with_name("none.png")), "--landmarks", str(POINTS), "-o", "a.glb"], "none.png"),
        ([str(PICTURE), "--landmarks", str(PICTURE), "-o", "a.glb"], "expected .pts"),
        (
            [str(PICTURE), "--landmarks", str(POINTS), "-o", "a.fbx"],
            "--output: expected a name that ends in .glb",
        ),
        ([str(PICTURE), "--landmarks", str(POINTS), "-o", "no/such/folder/a.glb"], "no/such/folder"),
        ([str(PORTRAITS / "blue_girl.pts"), "--landmarks", str(POINTS), "-o", "a.glb"], "blue_girl.pts"),
        (
            [
                str(PICTURE),
                "--landmarks",
                str(PORTRAITS / "astronaut.pts"),
                "-o",
                "a.glb",
                "--texture-size",
                "0",
            ],
            "size",
        ),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["make", *arguments]) == 2
    error = [line for line in capsys.readouterr().err.splitlines() if line.startswith("toongeo: ")]
    assert len(error) == 1 and message in error[0]
    assert not list(tmp_path.iterdir())


def test_no_command_is_exit_code_2():
    with pytest.raises(SystemExit) as stop:
        main([])
    assert stop.value.code == 2


def test_the_module_runs_as_a_program():
    done = subprocess.run(
        [sys.executable, "-m", "toongeo", "--version"],
        capture_output=True,
        text=True,
        check=True,
        cwd=PORTRAITS.parents[1],
    )
    assert done.stdout.startswith("toongeo ")


def test_landmarks_opens_the_editor(tmp_path, monkeypatch, capsys):
    from toongeo.app.editor.editor_server import EditorServer

    def interrupt(server):
        raise KeyboardInterrupt

    monkeypatch.setattr(EditorServer, "serve_forever", interrupt)
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    assert main(["landmarks", str(PICTURE), "--landmarks", str(POINTS), "-o", str(tmp_path / "a.json")]) == 0
    address = capsys.readouterr().out.splitlines()[0].removeprefix("editor: ")
    assert opened == [address] and address.startswith("http://127.0.0.1:")
    assert main(["landmarks", str(PICTURE), "--no-open"]) == 0 and len(opened) == 1
    capsys.readouterr()
    assert main(["landmarks", str(PICTURE), "-o", str(PICTURE)]) == 2
    assert "output: expected one of" in capsys.readouterr().err
    assert main(["landmarks", str(PICTURE), "--face", "-1"]) == 2
    assert "face: expected 0 for the largest face" in capsys.readouterr().err


def test_make_takes_landmark_files_of_other_programs(tmp_path, capsys, monkeypatch):
    """By their number of points or by name, and shares of the picture by its size."""
    import numpy as np

    from toongeo.io import read_image, read_landmarks
    from toongeo.model.mediapipe478 import VERTICES

    landmarks, img = read_landmarks(POINTS), read_image(PICTURE)
    mesh = np.full((478, 3), 0.5)
    mesh[VERTICES, :2] = (landmarks + 0.5) / [img.shape[1], img.shape[0]]
    np.save(tmp_path / "mesh.npy", mesh)
    np.save(tmp_path / "two.npy", [landmarks + 9, landmarks])
    np.save(tmp_path / "inner.npy", landmarks[17:])
    given = []
    monkeypatch.setattr("toongeo.app.make.make_avatar", lambda img, points, **_: given.append(points))
    out = ["-o", str(tmp_path / "a.ply")]
    for name, scheme, face in (
        ("mesh", "auto", 0),
        ("mesh", "mediapipe478", 0),
        ("two", "auto", 1),
        ("inner", "auto", 0),
    ):
        points = str(tmp_path / f"{name}.npy")
        # The stand-in gives no avatar to save.
        assert main(["make", str(PICTURE), "--landmarks", points, "--scheme", scheme, "--face", str(face), *out]) == 1
        np.testing.assert_allclose(given.pop()[17:], landmarks[17:], atol=1e-9)
        assert f"{name}.npy: NumPy, " in capsys.readouterr().out
    assert main(["make", str(PICTURE), "--landmarks", points, "--scheme", "wflw98", *out]) == 2
    assert "inner.npy: expected shape (98, 2) px for scheme 'wflw98'" in capsys.readouterr().err
