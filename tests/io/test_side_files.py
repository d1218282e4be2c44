"""Files beside an output replace nothing but what was written for the same output."""

import io
import os

import numpy as np
import pytest
from PIL import Image

from toongeo.io import write_obj, write_obj_sequence
from toongeo.io.side_files import check_side_files, marked_picture, side_mark


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def identity(path):
    """Which file it is, and what it holds: all but the time at which it was last looked at."""
    stat = path.lstat()
    return stat.st_ino, stat.st_mode, stat.st_size, stat.st_mtime_ns, path.is_symlink() and os.readlink(path)


def test_a_marked_picture_is_a_picture():
    img = np.random.default_rng(0).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    content = marked_picture(img, 'Gesicht "ü"\n.obj')
    with Image.open(io.BytesIO(content)) as image:
        np.testing.assert_array_equal(np.asarray(image), img)
        assert image.text["Comment"] == side_mark('Gesicht "ü"\n.obj')
    with Image.open(io.BytesIO(content)) as image:
        image.verify()  # the check sums of all chunks


@pytest.mark.parametrize("name", ["face.obj", "ü" * 120 + ".obj", 'a"b\nc.obj'])
def test_a_second_time_replaces_the_files(tmp_path, scene, name):
    write_obj(tmp_path / name, scene)
    first = contents(tmp_path)
    write_obj(tmp_path / name, scene)
    assert contents(tmp_path) == first and len(first) == 3


@pytest.mark.parametrize("name", ["face.mtl", "face_texture.png", "000_neutral.obj", "004_eyeLookUp.obj"])
@pytest.mark.parametrize("kind", ["text", "empty", "picture", "link", "other output", "pipe"])
def test_files_of_others_are_kept(tmp_path, scene, name, kind):
    target, folder = tmp_path / "target", tmp_path / "folder"
    folder.mkdir()
    if kind == "text":
        (folder / name).write_text("newmtl skin\n")
    elif kind == "empty":
        (folder / name).touch()
    elif kind == "picture":
        Image.new("RGB", (2, 2)).save(folder / name, "PNG")
    elif kind == "link":
        target.write_text("elsewhere")
        (folder / name).symlink_to(target)
    elif kind == "other output":
        (folder / name).write_text(f"# {side_mark('other.obj')}\n")
    elif not hasattr(os, "mkfifo"):
        pytest.skip("this system has no named pipes")
    else:
        os.mkfifo(folder / name)
    before = identity(folder / name)
    writers = [lambda: write_obj_sequence(folder, scene)]
    if "face" in name:
        writers.append(lambda: write_obj(folder / "face.obj", scene))
    for write in writers:
        with pytest.raises(FileExistsError, match=f"{name} is there already and was not written for "):
            write()
    assert [path.name for path in folder.iterdir()] == [name] and identity(folder / name) == before
    assert not target.exists() or target.read_text() == "elsewhere"


def test_an_obj_and_a_sequence_do_not_share_their_materials(tmp_path, scene):
    write_obj_sequence(tmp_path, scene)
    before = contents(tmp_path)
    with pytest.raises(FileExistsError, match=r"face_texture\.png is there already and was not written for face\.obj"):
        write_obj(tmp_path / "face.obj", scene)
    assert contents(tmp_path) == before
    write_obj(tmp_path / "000.obj", scene)  # names of its own


def test_pictures_of_the_user_stay(tmp_path, scene):
    names = ("face.png", "face_1.png", "face.jpg", "face_texture_1.png")
    for name in names:
        (tmp_path / name).write_text("precious")
    write_obj(tmp_path / "face.obj", scene)
    write_obj_sequence(tmp_path / "faces", scene)
    write_obj_sequence(tmp_path, scene, stem="x")
    assert {(tmp_path / name).read_text() for name in names} == {"precious"}


def test_a_mark_further_on_is_none(tmp_path):
    path = tmp_path / "a.mtl"
    path.write_text("#" * 5000 + side_mark("a.obj"))
    with pytest.raises(FileExistsError, match="a.mtl is there already"):
        check_side_files([path], "a.obj")
