"""Landmarks of a mesh as JSON."""

import json

import numpy as np
import pytest

from toongeo.io import read_mesh_landmarks

V = np.arange(300.0).reshape(100, 3)


def write(path, content):
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def test_vertices_points_and_missing_ones(tmp_path):
    entries = [3, [1.5, 2, -3], None, *range(65)]
    expected = np.vstack([V[3], [1.5, 2, -3], [np.nan] * 3, V[:65]])
    for content in (entries, {"landmarks": entries, "author": "someone"}):
        found = read_mesh_landmarks(write(tmp_path / "a.json", content), V)
        np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{", "path: expected JSON"),
        ("\ufeff?", "path: expected JSON"),
        (list(range(67)), "path: expected a list of 68 entries .* got 67 entries"),
        ({"points": []}, "path: expected a list of 68 entries .* got NoneType"),
        (5, "path: expected a list of 68 entries .* got int"),
        ([100] * 68, r"landmark 0 in .*: expected a vertex in 0\.\.99, got 100"),
        ([0] * 67 + [-1], r"landmark 67 in .*: expected a vertex in 0\.\.99, got -1"),
        ([[1, 2]] * 68, r"landmark 0 in .*: expected a vertex, \[x, y, z\] or null, got \[1, 2\]"),
        ([[1, 2, "3"]] * 68, "landmark 0 in .*: expected a vertex"),
        ('[' + '[1, 2, NaN], ' * 67 + '0]', "landmark 0 in .*: expected a vertex"),
        ([True] * 68, "landmark 0 in .*: expected a vertex"),
        ([1.5] * 68, "landmark 0 in .*: expected a vertex"),
    ],
)  # fmt: skip
def test_other_forms_are_refused(tmp_path, content, message):
    with pytest.raises(ValueError, match=message):
        read_mesh_landmarks(write(tmp_path / "a.json", content), V)


def test_a_missing_file_is_an_os_error(tmp_path):
    with pytest.raises(OSError, match="none"):
        read_mesh_landmarks(tmp_path / "none.json", V)


PLACES = V[:68] / 7 - 3
POINTS = PLACES.tolist()


def picked(points, names=None, active=None):
    rows = "".join(
        f' <point active="{active[k] if active else 1}" x="{x}" y="{y}" z="{z}" name="{names[k] if names else k}"/>\n'
        for k, (x, y, z) in enumerate(points)
    )
    head = '<DocumentData>\n  <DateTime time="11:02:44" date="2024-05-06"/>\n  <DataFileName name="head.obj"/>\n'
    return f"<!DOCTYPE PickedPoints>\n<PickedPoints>\n{head}</DocumentData>\n{rows}</PickedPoints>\n"


FORMS = {
    "floats.json": ([float(k) for k in range(68)], V[:68]),
    "points.json": (POINTS, PLACES),
    "objects.json": ([{"x": x, "y": y, "z": z} for x, y, z in POINTS], PLACES),
    "landmarker.json": (
        {"version": 3, "groups": {"LJSON": {"labels": [], "landmarks": {"points": POINTS, "connectivity": []}}}},
        PLACES,
    ),
    "landmarker2.ljson": ({"version": 2, "labels": [], "landmarks": {"points": POINTS, "connectivity": []}}, PLACES),
    "landmarker1.ljson": (
        {"version": 1, "groups": [{"label": "a", "landmarks": [{"point": point} for point in POINTS]}]},
        PLACES,
    ),
    "own.json": ({"version": 1, "landmarks": list(range(68))}, V[:68]),
    "meshlab.pp": (picked(POINTS), PLACES),
    "one_based.pp": (picked(POINTS, [str(k + 1) for k in range(68)]), PLACES),
    "turned.pp": (picked(POINTS[::-1], [str(k) for k in range(67, -1, -1)]), PLACES),
    "named.pp": (picked(POINTS, [f"point {k}" for k in range(68)]), PLACES),
    "savetxt.txt": ("\n".join(f"{k:.18e}" for k in range(68)), V[:68]),
    "points.txt": ("# a comment\n" + "\n".join(" ".join(map(str, point)) for point in POINTS), PLACES),
    "points.csv": ("x,y,z\n" + "\n".join(",".join(map(str, point)) for point in POINTS), PLACES),
}


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_forms_of_other_programs(tmp_path, name, encoding):
    content, expected = FORMS[name]
    path = tmp_path / name
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding=encoding)
    np.testing.assert_allclose(read_mesh_landmarks(path, V), expected, rtol=1e-12)


def test_missing_landmarks_of_other_programs(tmp_path):
    expected = PLACES.copy()
    expected[3] = np.nan
    rows = [None if k == 3 else point for k, point in enumerate(POINTS)]
    nulls = [point or [None] * 3 for point in rows]
    for name, content in {
        "a.ljson": {"version": 2, "labels": [], "landmarks": {"points": nulls}},
        "a.pp": picked(POINTS, active=[int(k != 3) for k in range(68)]),
        "a.csv": "\n".join("nan,nan,nan" if k == 3 else ",".join(map(str, point)) for k, point in enumerate(POINTS)),
    }.items():
        found = read_mesh_landmarks(write(tmp_path / name, content), V)
        np.testing.assert_allclose(found, expected, rtol=1e-12, err_msg=name)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.obj", "", "path: expected .json, .ljson, .pp, .txt or .csv, got "),
        ("a.json", "[" * 100_000, "nested too deeply"),
        ("a.json", [None] * 68, "expected at least one landmark in .*, but all are missing"),
        ("a.json", [10**400] * 68, "landmark 0 in .*: expected a vertex"),
        ("a.json", [1e300] * 68, r"landmark 0 in .*: expected a vertex in 0\.\.99, got 1e\+300"),
        ("a.json", [[1, 2, 10**400]] * 68, "landmark 0 in .*: expected a vertex"),
        ("a.json", [{"x": 1}] * 68, "landmark 0 in .*: expected a vertex"),
        ("a.ljson", {"version": 2, "landmarks": {"points": [[1, 2]] * 68}}, "landmark 0 in .*: expected a vertex"),
        ("a.pp", "<PickedPoints/>", "expected <point> of MeshLab"),
        (
            "a.pp",
            '<PickedPoints><point x="1" y="2" z="q"/></PickedPoints>',
            "numbers as x, y and z of a point in line",
        ),
        ("a.pp", picked(POINTS[:5]), "got 5 entries"),
        ("a.pp", picked(POINTS).replace("Points>", 'Points [<!ENTITY a "b">]>', 1), "without entities"),
        ("a.txt", "1 2\n" * 68, "landmark 0 in .*: expected a vertex"),
        ("a.txt", "a\nb\n" * 34, "got 67 entries"),
    ],
)
def test_what_is_wrong_with_them_is_said(tmp_path, name, content, message):
    path = write(tmp_path / name, content)
    with pytest.raises(ValueError, match=message) as info:
        read_mesh_landmarks(path, V)
    assert str(path) in str(info.value)
