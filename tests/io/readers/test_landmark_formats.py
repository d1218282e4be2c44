"""Landmark files of other programs, each in the exact layout that the program writes."""

import json

import numpy as np
import pytest

from tests.io.readers.landmark_layouts import (
    ARRAYS,
    FACE,
    MESH,
    SIZE,
    TEXTS,
    imglab,
    lines,
    openface_picture,
    openface_video,
    scheme_points,
    shares,
    triples,
)
from toongeo.io import (
    SCHEMES,
    ibug_points,
    read_landmark_file,
    read_landmark_frames,
    read_landmarks,
    write_landmarks,
)
from toongeo.io.landmarks.frontal_layout import frontal_layout
from toongeo.io.landmarks.landmark_schemes import scheme_of


@pytest.fixture
def written(tmp_path):
    def write(name, content):
        path = tmp_path / name
        if isinstance(content, str):
            path.write_bytes(content.encode())
        else:
            np.save(path, content)
        return path

    return write


@pytest.mark.parametrize("name", [*TEXTS, *ARRAYS])
def test_each_format_gives_the_68_points(written, name):
    content, scheme = (TEXTS | ARRAYS)[name]
    found = read_landmark_file(written(name, content), size=SIZE)
    assert found.scheme == scheme and found.points.shape == (68, 2)
    missing = {"ibug51": range(17), "ibug49": [*range(17), 60, 64]}.get(scheme, ())
    expected = FACE.copy()
    expected[list(missing)] = np.nan
    np.testing.assert_allclose(found.points, expected, atol=1e-6)
    assert name in found.message and scheme in found.message
    assert not found.points.flags.writeable
    np.testing.assert_array_equal(read_landmarks(written(name, content), size=SIZE, scheme=scheme), found.points)


@pytest.mark.parametrize("name", TEXTS)
@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_byte_order_marks_change_nothing(tmp_path, name, encoding):
    path = tmp_path / name
    path.write_bytes(
        TEXTS[name][0].replace("ISO-8859-1", encoding[:-4] if "sig" in encoding else encoding).encode(encoding)
    )
    np.testing.assert_allclose(read_landmarks(path, size=SIZE), read_landmarks_of(tmp_path, name), atol=1e-9)


def read_landmarks_of(folder, name):
    path = folder / f"plain_{name}"
    path.write_bytes(TEXTS[name][0].encode())
    return read_landmarks(path, size=SIZE)


@pytest.mark.parametrize("suffix", [".pts", ".txt", ".csv", ".npy", ".json", ".ljson"])
def test_what_is_written_is_read_back(tmp_path, suffix):
    points = FACE + np.random.default_rng(1).normal(size=(68, 2)) / 3
    points[[3, 60]] = np.nan
    path = tmp_path / f"face{suffix}"
    write_landmarks(path, points)
    np.testing.assert_array_equal(read_landmarks(path), points)
    assert read_landmark_file(path).scheme == "ibug68"


def test_ljson_has_the_layout_of_landmarker_io(tmp_path):
    points = FACE.copy()
    points[5] = np.nan
    write_landmarks(tmp_path / "a.ljson", points)
    document = json.loads((tmp_path / "a.ljson").read_text())
    assert document["version"] == 2 and document["landmarks"]["points"][5] == [None, None]
    assert document["landmarks"]["points"][0] == FACE[0, ::-1].tolist()
    assert sorted(k for label in document["labels"] for k in label["mask"]) == list(range(68))


def test_ljson_by_x_and_y_is_seen(written):
    document = {"version": 2, "labels": [], "landmarks": {"points": FACE.tolist(), "connectivity": []}}
    found = read_landmark_file(written("a.ljson", json.dumps(document)))
    np.testing.assert_array_equal(found.points, FACE)
    assert "as (x, y)" in found.message


def test_missing_points(written):
    holed = FACE.copy()
    holed[[0, 20]] = np.nan
    rows = [None if x != x else [x, y] for x, y in holed.tolist()]
    cases = {
        "a.json": json.dumps(rows),
        "b.json": json.dumps([point or [None, None] for point in rows]),
        "c.json": json.dumps({str(k): point for k, point in enumerate(rows) if point}),
        "d.json": json.dumps(holed.tolist()),  # NaN, as Python writes it
        "a.ljson": json.dumps(
            {"version": 2, "labels": [], "landmarks": {"points": [p[::-1] if p else [None, None] for p in rows]}}
        ),
        "a.csv": "x,y\n" + lines(holed, "{},{}").replace("nan", ""),
        "b.csv": "x,y\n" + lines(holed, "{},{}").replace("nan", "NA"),
        "a.txt": lines(holed).replace("nan", "-1.#IND"),
        "b.txt": lines(holed).replace("nan", "-nan(ind)"),
        "a.xml": imglab([[holed]]),
        "coco.json": json.dumps({"annotations": [{"face_kpts": triples(np.nan_to_num(holed)), "image_id": 1}]}).replace(
            "0.0, 0.0, 0.9", "0, 0, 0"
        ),
        "a.npy": np.c_[np.nan_to_num(holed), np.isfinite(holed[:, 0])],
    }
    for name, content in cases.items():
        np.testing.assert_array_equal(read_landmarks(written(name, content)), holed, err_msg=name)


def test_faces_and_frames_are_chosen(written):
    faces = [FACE, FACE + 7, FACE + 11]
    several = {
        "a.npy": np.stack(faces),
        "a.json": json.dumps([face.tolist() for face in faces]),
        "people.json": json.dumps(
            {"people": [{"face_keypoints_2d": triples(np.vstack([face, face[:2]]))} for face in faces]}
        ),
        "a.csv": openface_picture(faces),
        "a.xml": imglab([faces]),
        "video.csv": openface_video([(1, k, 1, face) for k, face in enumerate(faces)]),
        "a.ljson": json.dumps(
            {
                "version": 3,
                "groups": {str(k): {"landmarks": {"points": f[:, ::-1].tolist()}} for k, f in enumerate(faces)},
            }
        ),
    }
    for name, content in several.items():
        path = written(name, content)
        for k, face in enumerate(faces):
            found = read_landmark_file(path, face=k)
            np.testing.assert_allclose(found.points, face, atol=1e-3, err_msg=name)
            assert (found.face, found.faces, found.frames) == (k, 3, 1) and f"face {k} of 3" in found.message
        with pytest.raises(ValueError, match=rf"face: expected 0\.\.2 for .*{name}, got 3"):
            read_landmarks(path, face=3)
    annotations = [{"image_id": 1 + (k > 0), "face_kpts": triples(face)} for k, face in enumerate(faces)]
    coco = written("coco.json", json.dumps({"images": [{"id": 1}], "annotations": [{"image_id": 1}, *annotations]}))
    np.testing.assert_array_equal(read_landmarks(coco), FACE)
    np.testing.assert_array_equal(read_landmarks(coco, frame=1, face=1), FACE + 11)
    # The first frame has no face.
    video = {
        "a.xml": imglab([[], [FACE], [FACE + 7, FACE + 11]]),
        "v.csv": openface_video([(1, 0, 0, FACE * 0), (2, 0, 1, FACE), (3, 0, 1, FACE + 7), (3, 1, 1, FACE + 11)]),
        "v.json": json.dumps([[], [FACE.tolist()], [(FACE + 7).tolist(), (FACE + 11).tolist()]]),
        "take.json": json.dumps(
            {"frames": [{"faces": face} for face in ([], [FACE.tolist()], (np.stack(faces[1:])).tolist())]}
        ),
        "mm.json": json.dumps(
            {
                "instance_info": [
                    {"instances": [{"keypoints": f.tolist()} for f in some]} for some in ([], faces[:1], faces[1:])
                ]
            }
        ),
    }
    for name, content in video.items():
        path = written(name, content)
        found = read_landmark_file(path)
        np.testing.assert_allclose(found.points, FACE, atol=1e-3, err_msg=name)
        assert (found.frame, found.frames, found.faces) == (1, 3, 1), name
        np.testing.assert_allclose(read_landmarks(path, frame=2, face=1), FACE + 11, atol=1e-3, err_msg=name)
        with pytest.raises(ValueError, match="frame: expected one with a face, but 0 has none in"):
            read_landmarks(path, frame=0)
        with pytest.raises(ValueError, match=r"frame: expected 0\.\.2 for .*, got -1"):
            read_landmarks(path, frame=-1)


def test_a_face_through_all_frames(written):
    faces = [FACE, FACE + 7, FACE + 11]
    nobody = np.full((68, 2), np.nan)
    takes = {
        "a.csv": (openface_video([(2, 0, 1, FACE), (3, 0, 0, FACE), (4, 0, 1, FACE + 7), (4, 1, 1, FACE + 11)]), 3),
        "a.xml": (imglab([[FACE], [], faces[1:]]), 3),
        "a.json": (json.dumps([[FACE.tolist()], [], [face.tolist() for face in faces[1:]]]), 3),
    }
    for name, (content, count) in takes.items():
        path = written(name, content)
        found = read_landmark_frames(path)
        np.testing.assert_allclose(found, [FACE, nobody, FACE + 7], atol=1e-3, err_msg=name)
        assert len(found) == count
        np.testing.assert_allclose(read_landmark_frames(path, face=1)[2], FACE + 11, atol=1e-3)
        with pytest.raises(
            ValueError, match=rf"face: expected one that is in .*{name}, but 2 is in none of its 3 frames"
        ):
            read_landmark_frames(path, face=2)
    meshes = np.stack([shares(MESH), shares(MESH + 3)])
    found = read_landmark_frames(written("a.npy", meshes), size=SIZE)
    np.testing.assert_allclose(found, [FACE, FACE + 3], atol=1e-9)
    with pytest.raises(ValueError, match="face: expected an integer >= 0, got -1"):
        read_landmark_frames(written("a.npy", meshes), size=SIZE, face=-1)


def test_shares_of_the_picture_need_its_size(written):
    path = written("a.npy", shares(MESH))
    with pytest.raises(ValueError, match="size: landmarks in .*a.npy are shares of the picture; expected its"):
        read_landmarks(path)
    picture = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    np.testing.assert_allclose(read_landmarks(path, size=picture), FACE, atol=1e-9)
    assert "shares of a picture of 640 x 480 px" in read_landmark_file(path, size=picture).message
    for size, message in (
        ((0, 5), r"size: expected \(width, height\) > 0 px, got \(0, 5\)"),
        ((1, 2, 3), r"size: expected \(width, height\) px or a picture, got \(1, 2, 3\)"),
        ("ab", r"size: expected \(width, height\) px or a picture, got 'ab'"),
        ((np.inf, 5), r"size: expected \(width, height\) px or a picture"),
    ):
        with pytest.raises(ValueError, match=message):
            read_landmarks(path, size=size)
    # Points in pixels need none, and do not mind one.
    np.testing.assert_array_equal(read_landmarks(written("b.npy", MESH), size=SIZE), FACE)


def test_tables_take_points_where_the_layouts_have_them():
    """Mirroring a face in a scheme of its own, after the published pairs, is mirroring the 68."""
    mirror = frontal_layout().mirror
    pairs = {  # of WFLW's and LaPa's annotations, and of SenseTime's picture
        "wflw98": [*range(32, -1, -1), *range(46, 41, -1), *range(50, 46, -1), *range(37, 32, -1), *range(41, 37, -1)]
        + [*range(51, 55), *range(59, 54, -1), 72, 71, 70, 69, 68, 75, 74, 73, 64, 63, 62, 61, 60, 67, 66, 65]
        + [*range(82, 75, -1), *range(87, 82, -1), *range(92, 87, -1), *range(95, 92, -1), 97, 96],
        "lapa106": [*range(32, -1, -1), *range(46, 41, -1), *range(50, 46, -1), *range(37, 32, -1), *range(41, 37, -1)]
        + [*range(51, 55), *range(65, 54, -1), 79, 78, 77, 76, 75, 82, 81, 80, 83, 70, 69, 68, 67, 66, 73, 72, 71, 74]
        + [*range(90, 83, -1), *range(95, 90, -1), *range(100, 95, -1), *range(103, 100, -1), 105, 104],
        "sensetime106": [*range(32, -1, -1), *range(42, 32, -1), *range(43, 47), *range(51, 46, -1), 61, 60, 59, 58]
        + [63, 62, 55, 54, 53, 52, 57, 56, *range(71, 63, -1), 75, 76, 77, 72, 73, 74, 79, 78, 81, 80, 83, 82]
        + [*range(90, 83, -1), *range(95, 90, -1), *range(100, 95, -1), *range(103, 100, -1), 105, 104],
    }
    for scheme, swap in pairs.items():
        assert sorted(swap) == list(range(SCHEMES[scheme][0]))
        points = np.random.default_rng(2).normal(size=(len(swap), 2))
        np.testing.assert_allclose(ibug_points(points[swap], scheme), ibug_points(points, scheme)[mirror])


@pytest.mark.parametrize("scheme", ["lapa106", "sensetime106", "insightface106"])
@pytest.mark.parametrize("degrees", [-50, 0, 50])
def test_of_the_orders_of_106_points_the_one_is_taken_that_forms_a_face(scheme, degrees):
    a = np.radians(degrees)
    points = scheme_points(scheme) @ [[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]
    assert scheme_of(points * [0.7, 1]) == scheme
    assert scheme_of(points * 0) in SCHEMES


def test_schemes_are_refused_by_name(written):
    path = written("a.npy", FACE)
    with pytest.raises(ValueError, match="scheme: expected 'auto' or one of 'ibug68', .*, got 'dlib'"):
        read_landmarks(path, scheme="dlib")
    with pytest.raises(ValueError, match=r"landmarks in .*a.npy: expected shape \(98, 2\) px for scheme 'wflw98', got"):
        read_landmarks(path, scheme="wflw98")
    with pytest.raises(ValueError, match="scheme: expected one of 'ibug68', .*, got 'auto'"):
        ibug_points(FACE, "auto")


def _comma(number):
    return f"{number:.3f}".replace(".", ",")


def _imglab_from_one():
    parts = "".join(f"<part name='{k}' x='{x:.3f}' y='{y:.3f}'/>" for k, (x, y) in enumerate(FACE, start=1))
    return f"<dataset><images><image file='a.jpg'><box>{parts}</box></image></images></dataset>"


_POINTS = {"points": FACE[:, ::-1].tolist(), "connectivity": [[0, 1]]}
_FOUND = {"image_id": 1, "face_kpts": np.column_stack([FACE, np.ones(68)]).ravel().tolist()}
_NOT_FOUND = {"image_id": 1, "face_valid": False, "face_kpts": 204 * [0]}
VARIATIONS = {
    "decimal commas.csv": "".join(f"{_comma(x)};{_comma(y)}\n" for x, y in FACE),
    "decimal commas.txt": "".join(f"{_comma(x)} {_comma(y)}\n" for x, y in FACE),
    "decimal commas.pts": "n_points: 68\n{\n" + "".join(f"{_comma(x + 1)} {_comma(y + 1)}\n" for x, y in FACE) + "}\n",
    "numbered.csv": "".join(f"{k};{_comma(x)};{_comma(y)}\n" for k, (x, y) in enumerate(FACE)),
    "quoted.csv": "".join(f'"{x:.3f}","{y:.3f}"\n' for x, y in FACE),
    "of R.csv": '"","x","y"\n' + "".join(f'"{k}",{x:.3f},{y:.3f}\n' for k, (x, y) in enumerate(FACE, start=1)),
    "y before x.csv": "y,x\n" + "".join(f"{y:.3f},{x:.3f}\n" for x, y in FACE),
    "OpenFace.txt": openface_video([(1, 0, 1, FACE)]),
    "from one.xml": _imglab_from_one(),
    "part of an ljson.json": json.dumps({"labels": [], "landmarks": _POINTS}),
    "the first is not valid.json": json.dumps({"images": [{"id": 1}], "annotations": [_NOT_FOUND, _FOUND]}),
}


@pytest.mark.parametrize("name", VARIATIONS)
def test_variations_that_programs_and_countries_have(written, name):
    np.testing.assert_allclose(read_landmarks(written(name, VARIATIONS[name])), FACE, atol=1e-6)


def test_faces_of_whole_numbers_in_a_line_are_no_decimal_commas(written):
    pairs = [f"{x:.0f},{y:.0f}" for x, y in FACE]
    for mark in " ;":
        found = read_landmarks(written("a.txt", mark.join(pairs) + "\n"))
        np.testing.assert_array_equal(found, FACE.round())


def test_points_at_minus_one_are_missing(written):
    points = FACE.copy()
    points[3:5] = -1
    for name, content in (("a.npy", points), ("a.json", json.dumps(points.tolist()))):
        np.testing.assert_array_equal(np.flatnonzero(np.isnan(read_landmarks(written(name, content))[:, 0])), [3, 4])
