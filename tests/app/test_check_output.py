"""No command writes over a file that it reads, nor over one that its output did not name."""

import os
import shutil

import numpy as np
import pytest
from PIL import Image

from tests.conftest import PORTRAITS
from toongeo.app.cli import main


@pytest.fixture
def face(tmp_path, monkeypatch):
    """A picture and its landmarks in the working folder."""
    for suffix in (".png", ".pts"):
        shutil.copy(PORTRAITS / f"blue_girl{suffix}", tmp_path / f"face{suffix}")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def no_work(monkeypatch):
    """Fails if a command begins its work."""
    for name in ("make.make_avatar", "drive.load_avatar", "rig.rig_mesh", "demo.make", "bench.pair_sheets.make_avatar"):
        monkeypatch.setattr(f"toongeo.app.{name}", None)
    monkeypatch.setattr("toongeo.app.bench.tables.bench_folder", None)


def contents(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def refused(capsys, *arguments):
    """The one line on standard error of a command that is refused."""
    assert main([str(argument) for argument in arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    return line


MAKE = ("make", "face.png", "--landmarks", "face.pts", "--texture-size", "32")


@pytest.mark.parametrize(
    "output", [("face.obj",), ("faces", "--format", "obj-sequence"), (".", "--format", "obj-sequence")]
)
def test_the_picture_of_the_same_name_stays(face, avatar, output, monkeypatch):
    monkeypatch.setattr("toongeo.app.make.make_avatar", lambda *_, **__: avatar)
    before = contents(face)
    for _ in range(2):  # the same command works again
        assert main([*MAKE, "-o", *output]) == 0
        assert contents(face).items() > before.items()


LINKS = [("image", "itself")]  # a picture is known by what it holds, whatever its name
LINKS += [(source, link) for source in ("image", "landmarks") for link in ("symbolic", "hard", "folder", "relative")]


@pytest.mark.parametrize(("source", "link"), LINKS)
def test_an_output_that_is_read_is_refused_before_the_work(face, no_work, capsys, source, link):
    name = {"image": "face.png", "landmarks": "face.pts"}[source]
    image, output = "face.png", "out.glb"
    if link == "itself":
        image = (face / "face.png").rename(face / output).name
    elif link == "symbolic":
        (face / output).symlink_to(face / name)
    elif link == "hard":
        os.link(face / name, face / output)
    else:
        (face / "inner").mkdir()
        (face / "inner" / output).symlink_to(face / name)
        (face / "folder").symlink_to(face / "inner")
        output = "folder/out.glb" if link == "folder" else "inner/../inner/./out.glb"
    before = contents(face)
    line = refused(capsys, "make", image, *MAKE[2:], "-o", output)
    assert line.startswith("toongeo: --output: expected no file that is read, but ") and f" is the {source} " in line
    assert contents(face) == before


@pytest.mark.parametrize(
    ("picture", "output"),
    [
        ("face.mtl", ("face.obj",)),
        ("face_texture.png", ("face.obj",)),
        ("faces/face.mtl", ("faces", "--format", "obj-sequence")),
        ("faces/face_texture.png", ("faces", "--format", "obj-sequence")),
    ],
)
def test_files_beside_the_output_are_looked_at_before_the_work(face, no_work, capsys, picture, output):
    (face / "faces").mkdir()
    (face / "face.png").rename(face / picture)
    before = contents(face)
    line = refused(capsys, "make", picture, *MAKE[2:], "-o", *output)
    assert f"output: expected no file that is read, but {picture} is the image {picture}" in line
    shutil.copy(face / picture, face / "other.png")
    line = refused(capsys, "make", "other.png", *MAKE[2:], "-o", *output)
    assert f"{picture} is there already and was not written for" in line
    assert contents(face) == before | {(face / "other.png").relative_to(face): (face / "other.png").read_bytes()}


@pytest.mark.parametrize("option", ["avatar", "weights", "landmarks"])
def test_drive_keeps_what_it_reads(face, no_work, capsys, option):
    for name in ("avatar.glb", "take.npy", "other.npy"):
        (face / name).write_text(f"precious {name}")
    given = {"avatar": "avatar.glb", "weights": "take.npy", "landmarks": "take.npy"}[option]
    (face / "out.glb").symlink_to(given)
    source = "landmarks" if option == "landmarks" else "weights"
    line = refused(capsys, "drive", "avatar.glb", f"--{source}", "take.npy", "-o", "out.glb")
    assert f"but out.glb is the {option} {given}" in line
    line = refused(capsys, "drive", "avatar.glb", "--weights", "take.npy", "-o", "./avatar.glb")
    assert "but avatar.glb is the avatar avatar.glb" in line
    assert all((face / name).read_text() == f"precious {name}" for name in ("avatar.glb", "take.npy", "other.npy"))


@pytest.mark.parametrize(
    ("option", "name"), [("mesh", "head.obj"), ("landmarks", "head.json"), ("texture", "skin.png")]
)
def test_rig_keeps_what_it_reads(face, no_work, capsys, option, name):
    for each in ("head.obj", "head.json", "skin.png"):
        (face / each).write_text("precious")
    os.link(face / name, face / "out.glb")
    line = refused(capsys, "rig", "head.obj", "--landmarks", "head.json", "--texture", "skin.png", "-o", "out.glb")
    assert f"but out.glb is the {option} {name}" in line


@pytest.mark.parametrize("name", ["avatar.glb", "avatar.obj", "avatar.mtl", "avatar_texture.png", "contact-sheet.png"])
def test_demo_keeps_the_files_of_a_folder(face, no_work, capsys, name):
    (face / name).write_text("precious")
    before = contents(face)
    assert f"{name} is there already and was not written for" in refused(capsys, "demo", "-o", face)
    assert contents(face) == before


@pytest.mark.parametrize("table", ["table1", "table2", "table4", "caricature"])
def test_tables_keep_the_pictures_and_other_files(face, no_work, capsys, table):
    before = contents(face)
    line = refused(capsys, "bench", table, face, "-o", ".")
    assert line == "toongeo: --output: expected another folder than that of the pictures, got ."
    out = face / "out"
    out.mkdir()
    for suffix in (".csv", ".png"):
        (out / f"{table}{suffix}").write_text("x,y\n1,2\n")
        assert f"{table}{suffix} is there already and was not written for" in refused(
            capsys, "bench", table, face, "-o", out
        )
        (out / f"{table}{suffix}").unlink()
    assert contents(face) == before


@pytest.mark.parametrize("name", ["answers.csv", ".key.json", "pair-01.png"])
def test_pairs_replace_nothing(face, no_work, capsys, name):
    assert "expected another folder" in refused(capsys, "bench", "pairs", face, "-o", face)
    (face / "out").mkdir()
    (face / "out" / name).write_text("precious")
    assert f"{name} is there already; choose" in refused(capsys, "bench", "pairs", face, "-o", face / "out")
    assert (face / "out" / name).read_text() == "precious"


def test_a_table_replaces_an_earlier_one(tmp_path):
    from toongeo.app.bench.bench_table import BenchTable
    from toongeo.app.bench.save_table import save_table

    for value in (1.0, 2.0):
        values = {"ours": np.full((1, 1), value)}
        save_table(BenchTable("Title", ("a.png",), {"px": ("eyes",)}, values), "table1", tmp_path)
        assert repr(value) in (tmp_path / "table1.csv").read_text()
    with Image.open(tmp_path / "table1.png") as image:
        assert image.text["Comment"] == 'toongeo wrote this for "toongeo bench table1"'
