"""Several pictures, one after the other or as one person, and what is reported."""

import json

import numpy as np
import pytest

from tests.conftest import PORTRAITS
from toongeo.app.cli import main
from toongeo.app.making.head_jobs import head_jobs
from toongeo.app.making.make_options import MakeOptions
from toongeo.app.making.same_person import same_person
from toongeo.caricature.align_caricature import align_caricature
from toongeo.io import read_image, read_landmarks, write_image, write_landmarks

PICTURE, POINTS = str(PORTRAITS / "moustache_man.png"), str(PORTRAITS / "moustache_man.pts")


@pytest.fixture
def stand_in(avatar, monkeypatch):
    """An avatar that is there already in place of each; what was asked for."""
    asked = []

    def make_avatar(img, points, **options):
        asked.append((img, points, options))
        return avatar

    monkeypatch.setattr("toongeo.app.make.make_avatar", make_avatar)
    monkeypatch.setattr("toongeo.app.make.held_out_errors", lambda *_, **__: {"inner51": 0.01})
    return asked


@pytest.fixture
def folder(tmp_path):
    """Two pictures with landmarks, and a wall."""
    pictures = tmp_path / "pictures"
    pictures.mkdir()
    for name in ("a", "c"):
        write_image(pictures / f"{name}.png", read_image(PICTURE))
        write_landmarks(pictures / f"{name}.pts", read_landmarks(POINTS))
    return pictures


def test_each_picture_becomes_a_head(folder, stand_in, tmp_path, capsys):
    out = tmp_path / "heads"
    assert main(["make", str(folder), "--landmarks", str(folder), "-o", str(out), "--sheet", str(out)]) == 0
    assert sorted(path.name for path in out.iterdir()) == ["a.glb", "a.png", "c.glb", "c.png"]
    assert (out / "a.glb").read_bytes()[:4] == b"glTF" and read_image(out / "a.png").shape[1] > 1000
    assert capsys.readouterr().out.count("wrote ") == 4
    np.testing.assert_array_equal(stand_in[0][1], stand_in[1][1])


def test_a_picture_that_fails_leaves_the_others(folder, stand_in, tmp_path, capsys):
    (folder / "c.png").write_bytes(b"no picture")
    out = tmp_path / "{name}.ply"
    assert main(["make", str(folder), "--landmarks", str(folder), "-o", str(out)]) == 2
    said = capsys.readouterr().err
    assert (tmp_path / "a.ply").exists() and not (tmp_path / "c.ply").exists()
    assert "c.png: " in said and "1 of 2 pictures gave no head" in said


def test_names_that_would_be_one_file(tmp_path, capsys):
    (tmp_path / "b").mkdir()
    for name in ("a.png", "a.jpg"):
        write_image(tmp_path / "b" / name, np.zeros((9, 9, 3), np.uint8))
    assert main(["make", str(tmp_path / "b"), "-o", str(tmp_path / "heads")]) == 2
    assert "would both become" in capsys.readouterr().err
    assert head_jobs([tmp_path / "a.png"], tmp_path / "{name}.glb")[0].output == tmp_path / "a.glb"


def test_options_reach_the_library(stand_in, tmp_path, monkeypatch):
    model = object()
    monkeypatch.setattr("toongeo.app.commands.make_command._model", lambda path: model)
    monkeypatch.setattr("toongeo.app.making.make_options.MakeOptions.check", lambda *_: None)
    out = ["-o", str(tmp_path / "a.ply"), "--landmarks", POINTS]
    more = ["--method", "caricature", "--rig", "caricature", "--model", "m.npz", "--style", "ink"]
    assert main(["make", PICTURE, *out, *more]) == 0
    ((_, _, options),) = stand_in
    assert (options["method"], options["rig"], options["model"]) == ("caricature", "caricature", model)
    assert options["style"] == "ink"


def test_styles_are_those_of_the_library():
    from toongeo.app.cli import _parser
    from toongeo.pipeline.stylize.style import STYLES

    make = next(action for action in _parser()._actions if action.choices and "make" in action.choices).choices["make"]
    (styles,) = (action.choices for action in make._actions if action.dest == "style")
    assert set(styles) == set(STYLES)


def test_a_drawn_head_is_told_by_its_drawing(stand_in, avatar, tmp_path, monkeypatch):
    """Held-out points and the sheet are those of what became a head, not of the photograph."""
    from types import SimpleNamespace

    drawing = SimpleNamespace(img=np.zeros((9, 9, 3), np.uint8), landmarks=np.arange(136.0).reshape(68, 2))
    styled = SimpleNamespace(
        **{name: getattr(avatar, name) for name in ("report", "rig", "face", "fit")}, style=drawing
    )
    styled.save = lambda *_, **__: None
    monkeypatch.setattr("toongeo.app.make.make_avatar", lambda *_, **__: styled)
    seen = []
    monkeypatch.setattr("toongeo.app.make.held_out_errors", lambda img, points, **_: seen.append((img, points)) or {})
    arguments = ["--landmarks", POINTS, "-o", str(tmp_path / "a.ply"), "--style", "toon"]
    assert main(["make", PICTURE, *arguments]) == 0
    assert seen == [(drawing.img, drawing.landmarks)]


@pytest.mark.parametrize(("method", "align"), [("cartoon", None), ("caricature", align_caricature)])
def test_held_out_points_are_foretold_by_the_method_that_made_the_head(stand_in, tmp_path, monkeypatch, method, align):
    seen = []
    monkeypatch.setattr("toongeo.app.make.held_out_errors", lambda *_, align, **__: seen.append(align) or {})
    arguments = ["--landmarks", POINTS, "-o", str(tmp_path / "a.ply"), "--method", method]
    assert main(["make", PICTURE, *arguments]) == 0
    assert seen == [align]


def test_json_is_all_that_is_printed(stand_in, tmp_path, capsys, avatar):
    arguments = ["make", PICTURE, "--landmarks", POINTS, "-o", str(tmp_path / "a.ply"), "--json"]
    assert main(arguments) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["output"] == str(tmp_path / "a.ply")
    assert report["landmark_error"]["coarse"] == avatar.report.coarse
    assert report["landmark_error"]["held_out"] == {"inner51": 0.01}
    assert report["landmark_error"]["aligned_is_forced"] is True
    assert report["lids_closed"][0] == avatar.rig.report.closure_left / 100
    assert set(report["seconds"]) == set(avatar.report.seconds) and report["photometric_residual"] is None


def test_the_report_says_what_is_forced(stand_in, tmp_path, capsys):
    assert main(["make", PICTURE, "--landmarks", POINTS, "-o", str(tmp_path / "a.ply")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("aligned:  forced") for line in lines)
    inner = next(line for line in lines if line.startswith("inner51"))
    assert inner.split()[3] == "1.00"  # what was held out, between what the model's face misses and what is forced
    for word in ("coarse:", "held out:", "lids:", "lips:"):
        assert any(line.startswith(word) for line in lines)
    assert max(map(len, lines[1:20])) < 60  # fits its tile of the sheet


def test_one_person_has_one_identity(artist, random_face, annotated):
    from toongeo.render import ScaledOrthographicCamera

    identity = 0.7 * np.random.default_rng(3).standard_normal(len(artist.identity))
    views = [ScaledOrthographicCamera.look(yaw=yaw) for yaw in (-20.0, 15.0)]
    points = [annotated(artist, view, identity) for view in views]
    img = np.zeros((512, 512, 3), np.uint8)
    first, second = same_person([img, img], points, MakeOptions(noise=0, model=artist))
    np.testing.assert_array_equal(first.identity, second.identity)
    assert first.camera.yaw < 0 < second.camera.yaw


def test_the_fits_of_one_person_are_used(folder, stand_in, tmp_path, monkeypatch):
    monkeypatch.setattr("toongeo.app.making.make_heads.same_person", lambda imgs, points, options: ("one", "two"))
    arguments = ["--landmarks", str(folder), "-o", str(tmp_path / "{name}.ply"), "--same-person"]
    assert main(["make", str(folder), *arguments]) == 0
    assert [options["fit"] for _, _, options in stand_in] == ["one", "two"]
