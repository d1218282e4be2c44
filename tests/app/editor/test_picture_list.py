"""Which pictures are edited, and where their landmarks go."""

import os
import shutil

import numpy as np
import pytest

from toongeo.app.editor.picture_list import FORMATS, PictureList
from toongeo.io import read_landmarks, write_landmarks

IMG = np.zeros((400, 336, 3), np.uint8)


def test_a_picture_without_landmarks(folder, truth):
    pictures = PictureList(folder / "face.png")
    assert len(pictures) == 1 and pictures.name(0) == "face.png" and not pictures.is_done(0)
    assert pictures.landmarks(0, IMG) is None and pictures.target(0) == folder / "face.pts"
    assert not pictures.would_replace(0, ".pts")
    assert pictures.save(0, truth, ".pts") == folder / "face.pts"
    assert pictures.is_done(0) and not pictures.would_replace(0, ".pts")  # its own file
    np.testing.assert_array_equal(read_landmarks(folder / "face.pts"), truth)


@pytest.mark.parametrize("suffix", FORMATS)
def test_the_format_of_a_file_stays(folder, truth, suffix):
    write_landmarks(folder / f"face{suffix}", truth)
    pictures = PictureList(folder)
    assert pictures.is_done(0) and pictures.target(0).suffix == suffix and pictures.would_replace(0, suffix)
    np.testing.assert_array_equal(pictures.landmarks(0, IMG), truth)


def test_what_was_saved_is_read_again_though_another_file_is_there(folder, truth):
    write_landmarks(folder / "face.pts", truth)
    pictures = PictureList(folder)
    pictures.save(0, truth + 5, ".csv")
    np.testing.assert_array_equal(pictures.landmarks(0, IMG), truth + 5)
    assert pictures.target(0).suffix == ".csv"


def test_named_files_of_one_picture(folder, truth):
    other = folder / "start.txt"
    write_landmarks(other, truth)
    pictures = PictureList(folder / "face.png", other, folder / "result.json")
    np.testing.assert_array_equal(pictures.landmarks(0, IMG), truth)
    assert pictures.target(0) == folder / "result.json" and pictures.target(0, ".csv") == folder / "result.csv"
    pictures.save(0, truth + 1, ".json")
    np.testing.assert_array_equal(pictures.landmarks(0, IMG), truth + 1)
    np.testing.assert_array_equal(read_landmarks(other), truth)


def test_files_of_several_faces_and_shares_of_the_picture(folder, truth):
    shares = (truth + 0.5) / [336, 400]
    np.save(folder / "start.npy", [shares, shares + 0.01])
    pictures = PictureList(folder / "face.png", folder / "start.npy", face=1)
    np.testing.assert_allclose(pictures.landmarks(0, IMG), truth + [3.36, 4], atol=1e-9)
    pictures.save(0, truth, ".pts")
    np.testing.assert_array_equal(pictures.landmarks(0, IMG), truth)


def test_a_folder_in_order(folder):
    for name in ("b.JPG", "a.webp", "notes.md", "z.pts"):
        shutil.copy(folder / "face.png", folder / name)
    pictures = PictureList(folder)
    assert [pictures.name(k) for k in range(len(pictures))] == ["a.webp", "b.JPG", "face.png"]


def test_never_over_the_picture(folder, truth):
    picture = folder / "face.png"
    before = picture.read_bytes()
    os.link(picture, folder / "face.pts")
    with pytest.raises(ValueError, match=r"output: expected no file that is read, but .*face.pts is the picture"):
        PictureList(picture).save(0, truth, ".pts")
    with pytest.raises(ValueError, match="is the picture"):
        PictureList(picture, output=folder / "face.pts")
    with pytest.raises(
        ValueError, match="output: expected one of .pts, .json, .csv, .txt, .npy, .ljson, got .*face.png"
    ):
        PictureList(picture, output=picture)
    with pytest.raises(ValueError, match="output: expected one of"):
        PictureList(picture).save(0, truth, ".png")
    assert picture.read_bytes() == before


def test_what_is_no_picture(folder, truth):
    with pytest.raises(OSError, match="nowhere"):
        PictureList(folder / "nowhere.png")
    (folder / "empty").mkdir()
    with pytest.raises(ValueError, match=r"path: expected pictures \(.*\), got none in"):
        PictureList(folder / "empty")
    with pytest.raises(ValueError, match="path: expected one picture to go with a file of landmarks, got the folder"):
        PictureList(folder, output=folder / "a.pts")
    (folder / "text.png").write_text("no picture")
    with pytest.raises(ValueError, match="path: expected a picture"):
        PictureList(folder / "text.png")
    with pytest.raises(OSError, match=r"start\.pts"):
        PictureList(folder / "face.png", folder / "start.pts")
