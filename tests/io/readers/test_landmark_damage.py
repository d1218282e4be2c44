"""Damaged, hostile and misunderstood landmark files: every one is refused by ValueError that names the file."""

import io
import json
import os
import random

import numpy as np
import pytest

from toongeo.io import read_landmark_file, read_landmarks, read_mesh_landmarks
from toongeo.io.readers.landmarks import file_contents

ROWS = [[float(k), float(k * k % 97)] for k in range(68)]
LJSON = {"version": 2, "labels": [], "landmarks": {"points": ROWS}}
XML = "<dataset><images><image file='a.jpg'><box top='1'>{}</box></image></images></dataset>"
PARTS = "".join(f"<part name='{k}' x='{x}' y='{y}'/>" for k, (x, y) in enumerate(ROWS))
OPENFACE = ["frame", "face_id", "timestamp", "confidence", "success", *(f"{a}_{k}" for a in "xy" for k in range(68))]
ROW = ["1", "0", "0.0", "0.9", "1", *(str(y) for x, y in ROWS), *(str(x) for x, y in ROWS)]


def npy(array, shape=None):
    stream = io.BytesIO()
    np.save(stream, array)
    content = stream.getvalue()
    if shape is not None:
        old = f"{array.shape}, }}".encode()
        new = f"{shape}, }}".encode()
        content = content.replace(old.ljust(len(new)), new.ljust(len(old)), 1)
    return content


def csv(*rows):
    return "\n".join(",".join(row) for row in rows)


WRONG = [
    ("a.pts", "version: 1\nn_points: 68\n{\n" + "1 2\n" * 67 + "1e9999999 1\n}", "infinity in row 67"),
    ("a.pts", "n_points: many\n{\n1 2\n}\n", "announces n_points: many, but holds 1"),
    ("a.pts", "{\n}\n", "none in"),
    ("a.txt", "1e9999999 1\n" * 68, "infinity in row 0"),
    ("a.txt", "9" * 5000 + " 1\n" + "1 2\n" * 67, "expected two numbers, got '999"),
    ("a.txt", " ".join(["1"] * 150) + "\n", "expected the points of a face, got 150 numbers in line 1"),
    ("a.txt", " ".join(["1"] * 195) + " a b\n", "expected the points of a face, got 195 numbers in line 1"),
    ("a.txt", "1 2 3 4 5\n" * 68, "expected two numbers, got '1 2 3 4 5' in line 1"),
    ("a.txt", "1 2 3\n1 2\n", "expected three numbers, got '1 2' in line 2"),
    ("a.txt", "1 2 3 4\n1 2\n", "expected four numbers, got '1 2' in line 2"),
    ("a.csv", csv(OPENFACE, ROW[:-1]), "expected 141 cells, got 140 in line 2"),
    ("a.csv", csv(OPENFACE, [*ROW[:-1], "1e"]), "expected a number, got '1e' in line 2"),
    ("a.csv", csv(OPENFACE[:-1], ROW[:-1]), "expected a column x and a column y of each point in .*, misses"),
    ("a.csv", csv([*OPENFACE[:5], "X_0", "Y_0"], ["1"] * 7), "OpenFace's, but without 2D landmarks x_0 ...: run"),
    ("a.csv", csv(OPENFACE, [*ROW[:4], "0", *ROW[5:]]), "expected a face, but there is none in"),
    ("a.csv", "x,y,z\n", "expected 68 points in iBUG order, got 0"),
    ("a.npy", npy(np.zeros((68, 2)), "(True, 2)"), "expected an .npy array of numbers, but .*shape is"),
    ("a.npy", npy(np.zeros((68, 2)), "(-68, 2)"), "expected an .npy array of numbers"),
    ("a.npy", npy(np.zeros((68, 2)), "(9999999999, 2)"), "expected an .npy array of numbers, but .* bytes follow"),
    ("a.npy", npy(np.zeros((68, 2)))[:-9], "expected an .npy array of numbers"),
    ("a.npy", npy(np.zeros((68, 2))).replace(b"NUMPY\x01", b"NUMPY\x03"), "version .3, 0. of the format is not known"),
    ("a.npy", npy(np.zeros((68, 2), [("x", float)])), "expected an .npy array of numbers, but .*: got "),
    ("a.npy", npy(np.empty((10_000_000, 0, 2))), r"expected shape \(68, 2\), .* got \(10000000, 0, 2\)"),
    ("a.npy", npy(np.zeros((68, 5))), r"expected shape \(68, 2\), .* got \(68, 5\)"),
    ("a.json", "[[1" + 400 * "0" + ", 2]" + 67 * ", [1, 2]" + "]", r"a list of 68 with \[10000.*\] at 0"),
    ("a.json", "[[1" + 5000 * "0" + ", 2]" + 67 * ", [1, 2]" + "]", "expected JSON"),
    ("a.json", "[[1e999, 2]" + 67 * ", [1, 2]" + "]", "infinity in row 0"),
    ("a.json", "[" * 100_000, "nested too deeply"),
    ("a.json", '{"a":' * 50_000, "nested too deeply"),
    ("a.json", "[" * 900 + "]" * 900, "expected 68 points|expected points|nested|a face"),
    ("a.json", json.dumps([[1, 2], [1, 2, 3]] * 34), "got a list of 68 with rows of different lengths"),
    ("a.json", json.dumps([["1", 2]] * 68), "expected points .* got a list of 68"),
    ("a.json", json.dumps([[True, 2]] * 68), "expected points .* got a list of 68"),
    ("a.json", json.dumps([[1, 2]] * 67 + [[1, 2, "3"]]), "expected points .* got a list of 68 with .*3.* at 67"),
    ("a.json", json.dumps({"x": [1, 2], "y": [1]}), "expected points .* got an object with 'x', 'y'"),
    ("a.json", json.dumps({"9" * 5: [1, 2]}), "expected points .* got an object"),
    ("a.json", json.dumps([[[1, 2]] * 68, [["a", 2]] * 68]), "expected points .* got a list of 2"),
    ("a.json", "5", "expected points .* got int"),
    ("a.json", "[]", "expected a face, but there is none"),
    ("a.json", json.dumps({"faceLandmarks": []}), "expected a face, but there is none"),
    ("a.json", json.dumps({"people": [{"face_keypoints_2d": 210 * [0]}]}), "all rows are NaN"),
    ("a.json", json.dumps([None] * 68), "expected points"),
    ("a.ljson", json.dumps(ROWS), 'expected "version" and'),
    ("a.ljson", json.dumps({"version": 2, "landmarks": {"points": 5}}), "in each group of"),
    ("a.ljson", json.dumps({"version": 3, "groups": {"a": 5}}), "in each group of"),
    ("a.ljson", json.dumps({"version": 3, "groups": 5}), "in each group of"),
    ("a.ljson", json.dumps({"version": 3, "groups": {}}), "in each group of"),
    (
        "a.ljson",
        json.dumps({"version": 1, "groups": [{"landmarks": [{"point": p}]} for p in ([1, 2], [1, 2, 3])]}),
        "as many coordinates in all groups",
    ),
    ("a.ljson", json.dumps({"version": 2, "landmarks": {"points": [[1, 2, 3]] * 68}}), "those of a mesh"),
    ("a.xml", "<dataset>", "expected XML, but in"),
    ("a.xml", "<?xml version='1.0' encoding='none'?><a/>", "expected XML, but in"),
    ("a.xml", "<dataset/>", "expected <image> with <box> and <part>"),
    ("a.xml", XML.format(""), "expected a face, but there is none"),
    ("a.xml", XML.format("<part name='left' x='1' y='2'/>"), "numbers as name, x and y of a part, got name='left'"),
    ("a.xml", XML.format("<part name='99999' x='1' y='2'/>"), "expected numbers as name, x and y of a part"),
    ("a.xml", XML.format("<part name='1' x='one' y='2'/>"), "expected numbers as name, x and y of a part"),
    ("a.xml", "<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>", "expected XML without entities of its own"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "content", "message"), WRONG)
def test_wrong_files_are_refused_by_name(tmp_path, name, content, message):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ValueError, match=message) as info:
        read_landmarks(path)
    assert str(path) in str(info.value) and len(str(info.value)) < 500 + len(str(path))


def test_devices_pipes_folders_and_large_files(tmp_path, monkeypatch):
    for name in ("a.pts", "a.npy"):
        os.mkfifo(tmp_path / name)
        with pytest.raises(ValueError, match=f"path: expected a file, but .*{name} is a device or a pipe"):
            read_landmarks(tmp_path / name)
    for suffix in ("json", "npy", "csv", "xml"):
        (tmp_path / f"folder.{suffix}").mkdir()
        with pytest.raises(OSError, match=f"folder.{suffix}"):
            read_landmarks(tmp_path / f"folder.{suffix}")
        with pytest.raises(FileNotFoundError, match="nothing"):
            read_landmarks(tmp_path / f"nothing.{suffix}")
    (tmp_path / "a.txt").write_text("1 2\n" * 68)
    monkeypatch.setattr(file_contents, "_MOST_LINES", 60)
    with pytest.raises(ValueError, match="path: expected at most 60 lines, but .*a.txt has more"):
        read_landmarks(tmp_path / "a.txt")
    monkeypatch.setattr(file_contents, "_MOST_JSON_MB", 0)
    (tmp_path / "a.json").write_text("[]")
    with pytest.raises(ValueError, match="path: expected a file of at most 0 MB, but .*a.json is larger"):
        read_landmarks(tmp_path / "a.json")


def test_headers_of_python_2_warn_nobody(tmp_path):
    content = npy(np.array(ROWS)).replace(b"(68, 2), }  ", b"(68L, 2L), }")
    (tmp_path / "a.npy").write_bytes(content)
    np.testing.assert_array_equal(read_landmarks(tmp_path / "a.npy"), ROWS)


TOKENS = (
    *("NaN", "nan", "Infinity", "-Infinity", "1e9999999", "1e400", "-1e400", "1e-400", "-0", "-1", ".5", "5.", "+3"),
    *("0x10", "1_0", "1d5", "1,5", "٣", "9" * 20, "9" * 400, "9" * 5000, "null", "true", "false", "68", "\0", "\ufeff"),
    *("{}", "[]", "[[", "]", "}", "{", '"', "'", ",", ";", ":", "#", "\n", "[" * 3000, '{"a":' * 3000, " " * 5000),
    *("<", ">", "</box>", "&", "x", "y", "version", "landmarks", "groups", "points", "n_points:", "é"),
)
MESH_LJSON = {"version": 3, "groups": {"a": {"landmarks": {"points": [[1.0, 2, k] for k in range(68)]}}}}
BASES = {
    "a.pts": "version: 1\nn_points: 68\n{\n" + "".join(f"{x} {y}\n" for x, y in ROWS) + "}\n",
    "a.txt": "".join(f"{k} {x} {y}\n" for k, (x, y) in enumerate(ROWS)),
    "b.txt": " ".join(str(x) for row in ROWS for x in row),
    "a.csv": csv(OPENFACE, ROW, ROW),
    "b.csv": "index,x,y\n" + "".join(f"{k},{x},{y}\n" for k, (x, y) in enumerate(ROWS)),
    "a.json": json.dumps({"people": [{"face_keypoints_2d": [1.5] * 210}]}),
    "b.json": json.dumps({"faceLandmarks": [[{"x": x, "y": y, "z": 0} for x, y in ROWS]]}),
    "c.json": json.dumps({str(k): row for k, row in enumerate(ROWS)}),
    "a.ljson": json.dumps(LJSON),
    "a.xml": XML.format(PARTS),
}
MESH_BASES = {
    "m.json": json.dumps([1, 2.0, [0.5, 0, 1], None, {"x": 1, "y": 2, "z": 3}, *range(63)]),
    "m.ljson": json.dumps(MESH_LJSON),
    "m.pp": "<PickedPoints>"
    + "".join(f'<point x="{k}" y="1" z="2" active="1" name="{k}"/>' for k in range(68))
    + "</PickedPoints>",
    "m.txt": "".join(f"{k}.0\n" for k in range(68)),
}


def mutated(text, rng):
    """A few tokens inserted, pieces cut out, doubled or moved, or bytes changed."""
    content = text.encode()
    for _ in range(rng.choice((1, 1, 2, 4))):
        at, length = rng.randrange(len(content) + 1), rng.choice((0, 1, 2, 8, 64, 1000))
        piece = content[at : at + length]
        token = rng.choice(TOKENS).encode()
        content = rng.choice(
            (
                content[:at] + token + content[at + length :],
                content[:at] + token + content[at:],
                content[:at] + content[at + length :],
                content[:at] + piece + content[at:],
                content[:at] + bytes(rng.randrange(256) for _ in piece) + content[at + length :],
                content[:at],
            )
        )
    return content


@pytest.mark.parametrize("name", [*BASES, *MESH_BASES])
def test_mutated_files_are_read_or_refused(tmp_path, name):
    vertices = np.random.default_rng(0).normal(size=(100, 3))
    path, base = tmp_path / name, (BASES | MESH_BASES)[name]

    def read():
        if name in MESH_BASES:
            return read_mesh_landmarks(path, vertices)
        return read_landmark_file(path, size=(640, 480)).points

    path.write_text(base)
    assert np.isfinite(read()).any()
    refusals = []
    for seed in range(100):
        path.write_bytes(mutated(base, random.Random(seed)))
        try:
            points = read()
        except ValueError as error:
            refusals.append(str(error))
        else:
            assert len(points) == 68 and not np.isinf(points).any()
    assert refusals and all(str(path) in refusal for refusal in refusals)


def test_mutated_arrays_are_read_or_refused(tmp_path):
    path, base = tmp_path / "a.npy", npy(np.array(ROWS))
    head, refusals = base.index(b"\n"), []
    for seed in range(300):
        rng, content = random.Random(seed), bytearray(base)
        for _ in range(rng.choice((1, 1, 3))):
            content[rng.randrange(head if rng.random() < 0.8 else len(content))] = rng.choice(
                b"()[]{}',:TrueL0123456789<f|Oi\xff\0"
            )
        path.write_bytes(content)
        try:
            points = read_landmarks(path)
        except ValueError as error:
            refusals.append(str(error))
        else:
            assert points.shape == (68, 2) and not np.isinf(points).any()
    assert refusals and all(str(path) in refusal for refusal in refusals)
