"""Messages name what the user typed."""

import pytest

from tests.conftest import PORTRAITS
from toongeo.app.cli import main

PICTURE, POINTS = str(PORTRAITS / "blue_girl.png"), str(PORTRAITS / "blue_girl.pts")
OTHER = str(PORTRAITS / "astronaut.png")


@pytest.fixture(autouse=True)
def no_work(monkeypatch, tmp_path):
    """Fails if a command begins its work."""
    monkeypatch.setattr("toongeo.app.make.make_avatar", None)
    monkeypatch.setattr("toongeo.app.pictures.edit.ExpressionEditor", None)
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["-o", "a.fbx"], "--output: expected a name that ends in .glb"),
        (
            ["-o", "a.glb", "--author", "Ada"],
            "--author: no option of .glb, which has --crop, --quantize, --texture, --names",
        ),
        (["-o", "a.obj", "--no-unlit"], "--unlit: no option of .obj, which has --crop"),
        (["-o", "a.glb", "--texture-size", "0"], "--texture-size: expected an integer"),
        (["-o", "a.glb", "--noise", "-1"], "--noise: expected 'auto' or a number >= 0"),
        (["-o", "a.glb", "--hair-mask", OTHER], "--hair-mask: expected the picture's size"),
        (["-o", "a.glb", "--hair-mask", "none.png"], "none.png"),
        (["-o", "a.glb", "--model", "none.npz"], "none.npz: No such file or directory"),
        (["-o", "a.glb", "--model", PICTURE], "--model: expected a model in one of the formats"),
        (["-o", "a.glb", "--model", "broken.npz"], "--model: expected a model in one of the formats"),
        (["-o", "a.glb", "--model", "broken.bin"], "--model: landmarks: expected a table like ibug_to_sfm.txt"),
        (["-o", "folder.glb"], "--output: cannot write folder.glb: it is a folder"),
        (["-o", "none/a.glb"], "--output: no folder none to write a.glb to"),
        (["-o", "/proc/a.glb"], "--output: cannot write to the folder /proc: "),
        (["-o", "broken.npz", "--format", "obj-sequence"], "--output: expected a folder, got the file broken.npz"),
        (["-o", "a.glb", "--sheet", "a.tiff"], "--sheet: expected a name that ends in .png"),
        (["-o", "a.glb", "--sheet", "folder.png"], "--sheet: cannot write folder.png: it is a folder"),
        (["-o", "a.glb", "--sheet", PICTURE], "--sheet: expected no file that is read"),
        (["-o", "a.glb", "--same-person"], "--same-person: expected several pictures, got 1"),
        (["-o", "a.glb", "--landmarks", PICTURE], "--landmarks: expected .pts"),
        (["-o", "a.glb", "--landmarks", "folder.glb"], "--landmarks: expected a file for blue_girl.png"),
    ],
)
def test_make_refuses_before_the_work(more, message, tmp_path, capsys):
    for folder in ("folder.glb", "folder.png"):
        (tmp_path / folder).mkdir()
    for name in ("broken.npz", "broken.bin"):
        (tmp_path / name).write_bytes(b"nothing")
    before = sorted(tmp_path.rglob("*"))
    points = [] if "--landmarks" in more else ["--landmarks", POINTS]
    assert main(["make", PICTURE, *points, *more]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["-o", "a.glb"], "--output: expected a folder for several pictures, or a name with {name} in it"),
        (["-o", "heads", "--landmarks", POINTS], "--landmarks: expected a folder of files for several pictures"),
        (["-o", "heads", "--same-person", "--snap"], "--same-person: expected no --snap, --photometric or --style"),
        (["-o", "heads/{name}.fbx"], "--output: expected a name that ends in .glb"),
        (["-o", "heads", "--sheet", "sheet.png"], "--sheet: expected a folder for several pictures"),
        (["-o", "heads", "--sheet", "none/sheets"], "--sheet: no folder none/sheets"),
        (["-o", "heads/one.glb/{name}.glb"], "--output: no folder heads/one.glb"),
    ],
)
def test_several_pictures_are_refused_before_the_work(more, message, tmp_path, capsys):
    assert main(["make", PICTURE, OTHER, *more]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
    assert not list(tmp_path.iterdir())  # no folder for what is not made


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["-o", "a.glb", "--smile", "1"], "--output: expected a name that ends in .png"),
        (["-o", ".", "--smile", "1"], "--output: expected a name that ends in .png"),
        (["-o", "a.png"], "weights: expected an expression, such as --smile 0.5"),
        (["-o", "a.png", "--weights", "jawOpne=1"], "--weights: no expression 'jawOpne'"),
        (["-o", PICTURE, "--smile", "1"], "--output: expected no file that is read"),
    ],
)
def test_edit_refuses_before_the_work(more, message, capsys):
    assert main(["edit", PICTURE, "--landmarks", POINTS, *more]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line


@pytest.mark.parametrize(
    "arguments",
    [
        ["serve", "a.glb", "--port", "99999"],
        ["serve", "a.glb", "--port", "-1"],
        ["landmarks", "a.png", "--port", "80.5"],
        ["edit", "a.png", "-o", "b.png", "--smile", "much"],
        ["edit", "a.png", "-o", "b.png", "--weights", "jawOpen"],
        ["make", "a.png", "-o", "b.glb", "--noise", "nan"],
    ],
)
def test_numbers_that_cannot_be_are_refused_by_the_parser(arguments, capsys):
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    assert stop.value.code == 2
    line = capsys.readouterr().err.splitlines()[-1]
    assert f"argument {arguments[-2]}: expected " in line


def test_a_flag_that_was_not_given_is_not_blamed(tmp_path, capsys, monkeypatch):
    def fail(*_, **__):
        raise ValueError("landmarks: expected points that can be a face")

    monkeypatch.setattr("toongeo.app.make.make_avatar", fail)
    monkeypatch.setattr("toongeo.app.make.read_job", lambda *_: (None, None))
    assert main(["make", PICTURE, "-o", "a.glb"]) == 2
    assert capsys.readouterr().err.splitlines()[-1] == "toongeo: landmarks: expected points that can be a face"
    assert main(["make", PICTURE, "--landmarks", POINTS, "-o", "a.glb"]) == 2
    assert capsys.readouterr().err.splitlines()[-1] == "toongeo: --landmarks: expected points that can be a face"


def test_other_commands_name_their_arguments(tmp_path, capsys):
    (tmp_path / "pictures").mkdir()
    assert main(["landmarks", "pictures"]) == 2
    assert "PATH: expected pictures" in capsys.readouterr().err
    assert main(["bench", "table1", "none"]) == 2
    assert "FOLDER: expected a folder of pictures, got none" in capsys.readouterr().err
    assert main(["rig", "a.obj", "--landmarks", "a.json", "-o", "a.obj"]) == 2
    assert "--output: expected a name that ends in .glb, got a.obj" in capsys.readouterr().err
