"""Landmark files: round trips bit for bit, and what is refused."""

import numpy as np
import pytest

from toongeo.io import read_landmarks, write_landmarks

SUFFIXES = [".pts", ".npy", ".csv", ".txt", ".json", ".ljson"]


@pytest.fixture
def landmarks():
    points = np.random.default_rng(0).uniform(-3, 2000, (68, 2))
    points[0] = 0.1, -0.1
    points[1] = 1e-17, 1 / 3
    points[2] = 5e-324, 1.7976931348623157e308
    return points


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("missing", [False, True])
def test_round_trip_is_exact(tmp_path, landmarks, suffix, missing):
    if missing:
        landmarks[5:9] = np.nan
    path = tmp_path / f"Gesicht ü 顔{suffix}"
    write_landmarks(path, landmarks)
    np.testing.assert_array_equal(read_landmarks(path), landmarks)
    assert read_landmarks(str(path)).dtype == np.float64


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_base(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    write_landmarks(path, np.arange(136.0).reshape(68, 2))
    other = suffix != ".pts"
    shifted = read_landmarks(path, one_based=other)
    np.testing.assert_array_equal(shifted, np.arange(136.0).reshape(68, 2) + (-1 if other else 1))


def test_pts_is_one_based_as_ibug_has_it(tmp_path):
    path = tmp_path / "a.pts"
    path.write_text("version: 1\nn_points:  68\n{\n" + "1.1 2.5\r\n" * 68 + "}\n")
    np.testing.assert_array_equal(read_landmarks(path), np.tile([0.1, 1.5], (68, 1)))
    write_landmarks(path, np.tile([0.1, 1.5], (68, 1)))
    assert path.read_text().splitlines()[3] == "1.1 2.5"


@pytest.mark.parametrize(
    "line",
    ["3 4", "3,4", " 3.0\t4e0 ", "3;4", "3, 4,"],
    ids=["space", "comma", "tab", "semicolon", "trailing"],
)
@pytest.mark.parametrize("heading", ["", "x,y\n", "x1 y1\n", "# a comment, 1 2\n\n", "\ufeff"])
def test_text_forms(tmp_path, line, heading):
    path = tmp_path / "a.TXT"
    path.write_text(heading + f"{line}\n" * 68, encoding="utf-8")
    np.testing.assert_array_equal(read_landmarks(path), np.tile([3.0, 4.0], (68, 1)))


def test_missing_row_may_come_first(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("nan,nan\n" + "3,4\n" * 67)
    assert np.isnan(read_landmarks(path)[0]).all()


def test_integers_in_npy(tmp_path):
    np.save(tmp_path / "a.npy", np.full((68, 2), 7, np.uint8))
    np.testing.assert_array_equal(read_landmarks(tmp_path / "a.npy", one_based=True), 6.0)


@pytest.mark.parametrize(
    ("count", "hint"),
    [
        (5, "mouth corners"),
        (67, ""),
    ],
)
def test_wrong_count_names_the_scheme(tmp_path, count, hint):
    path = tmp_path / "a.csv"
    path.write_text("1,2\n" * count)
    with pytest.raises(ValueError, match=rf"expected 68 points in iBUG order, got {count}.*{hint}"):
        read_landmarks(path)


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.zeros((68, 4)), r"\(68, 4\)"),
        (np.zeros(136), r"expected shape \(68, 2\),.* got \(136,\)"),
        (np.zeros((1, 1, 1, 68, 2)), r"got \(1, 1, 1, 68, 2\)"),
        (np.full((68, 2), np.nan), "all rows are NaN"),
        (np.full((68, 2), np.inf), "infinity in row 0"),
        (np.full((68, 2), [1, np.nan]), "row 0 in one only"),
        (np.full((68, 2), "a"), "expected numbers|array of numbers"),
        (np.full((68, 2), 1j), "expected numbers|array of numbers"),
        (np.ones((68, 2), bool), "expected numbers|array of numbers"),
        (np.empty((0, 2)), "got 0|got \\(0, 2\\)"),
    ],
)
def test_wrong_arrays(tmp_path, array, message):
    with pytest.raises(ValueError, match=message):
        write_landmarks(tmp_path / "out.pts", array)
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(ValueError, match=message) as info:
        read_landmarks(tmp_path / "a.npy")
    assert "a.npy" in str(info.value)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.npy"]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.pts", b"version: 1\nn_points: 68\n1 2\n", "around the points of a .pts file"),
        ("a.pts", b"version: 1\nn_points: 68\n{\n1 2\n}\n", "announces n_points: 68, but holds 1"),
        ("a.txt", b"1 2\n" * 5 + b"1 2 3\n" + b"1 2\n" * 62, "two numbers, got '1 2 3' in line 6"),
        ("a.txt", b"1 2\n" * 67 + b"1 x\n", "two numbers, got '1 x' in line 68"),
        ("a.csv", b"", "there are none in"),
        ("a.csv", b"\xff\xff\x00\x01", "expected text"),
        ("a.npy", b"", "expected an .npy array"),
        ("a.npy", b"1 2\n" * 68, "expected an .npy array"),
        ("a.dat", b"1 2\n" * 68, "expected .pts, .txt, .csv, .npy, .json, .ljson or .xml, got "),
    ],
)
def test_wrong_files(tmp_path, name, content, message):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(ValueError, match=message) as info:
        read_landmarks(path)
    assert str(path) in str(info.value)


def test_pickle_is_refused(tmp_path):
    np.save(tmp_path / "a.npy", np.array([{"a": 1}], dtype=object), allow_pickle=True)
    with pytest.raises(ValueError, match="expected an .npy array of numbers"):
        read_landmarks(tmp_path / "a.npy")


def test_unknown_suffix_and_places(tmp_path, landmarks):
    with pytest.raises(ValueError, match="expected .pts, .npy, .csv, .txt, .json or .ljson, got .*a.xml"):
        write_landmarks(tmp_path / "a.xml", landmarks)
    with pytest.raises(FileNotFoundError, match="none.pts"):
        read_landmarks(tmp_path / "none.pts")
    with pytest.raises(OSError, match="cannot write .*nowhere/a.pts"):
        write_landmarks(tmp_path / "nowhere" / "a.pts", landmarks)
