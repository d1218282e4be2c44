"""What the editor's page is told."""

import base64
import io

import numpy as np
import pytest
from PIL import Image

from toongeo import fit_3dmm
from toongeo.app.editor.editor_session import EditorSession
from toongeo.app.editor.picture_list import PictureList
from toongeo.io import read_landmarks, write_image, write_landmarks


def asked(points):
    return [None if np.isnan(row[0]) else list(row) for row in np.asarray(points).tolist()]


def test_a_face_that_is_found(folder, truth, detector):
    opened = EditorSession(PictureList(folder), detector).answer("open", {"picture": 0})
    assert opened["source"] == "detected" and (opened["width"], opened["height"]) == (336, 400)
    np.testing.assert_array_equal(opened["points"], truth)
    assert opened["confidence"][0] == 0.25


@pytest.mark.parametrize("detector", [None, lambda img: None, "raises"])
def test_a_face_that_is_not_found_stands_in_the_middle(folder, detector):
    def raises(img):
        raise ValueError("img: no face")

    session = EditorSession(PictureList(folder), raises if detector == "raises" else detector)
    opened = session.answer("open", {"picture": 0})
    points = np.array(opened["points"])
    assert opened["source"] == "mean" and not any(opened["confidence"])
    assert (points > 0).all() and (points < [336, 400]).all()
    assert session.answer("detect", {"picture": 0}) == {"points": None}


def test_missing_points_of_a_file_have_places(folder, truth):
    gaps = truth.copy()
    gaps[:17] = np.nan
    write_landmarks(folder / "face.pts", gaps)
    opened = EditorSession(PictureList(folder)).answer("open", {"picture": 0})
    assert opened["source"] == "file" and opened["missing"] == [k < 17 for k in range(68)]
    np.testing.assert_array_equal(np.array(opened["points"])[17:], truth[17:])
    assert np.linalg.norm(np.array(opened["points"])[8] - truth[8]) < 60


def test_a_damaged_file_is_told(folder):
    (folder / "face.pts").write_text("points")
    opened = EditorSession(PictureList(folder)).answer("open", {"picture": 0})
    assert opened["source"] == "mean" and "face.pts" in opened["note"]


def test_the_fit_is_that_of_the_library(folder, truth, model):
    session = EditorSession(PictureList(folder))
    fit = fit_3dmm(session.pictures.picture(0), truth)
    answer = session.answer("fit", {"picture": 0, "points": asked(truth)})
    seen = np.frombuffer(base64.b64decode(answer["vertices"]), "<f4").reshape(-1, 3)
    np.testing.assert_allclose(seen[: len(model.mean), :2], fit.project(fit.vertices), atol=1e-3)
    assert answer["error"] == fit.report.rms_percent
    np.testing.assert_array_equal(answer["landmarks"], fit.project(fit.vertices[fit.landmark_vertices]))
    # The part that is nearest to the viewer has the largest z.
    assert seen[model.landmarks[30], 2] > seen[model.landmarks[[0, 16]], 2].max()


def test_the_mesh_has_the_vertices_of_the_fit(folder, truth):
    session = EditorSession(PictureList(folder))
    mesh = session.answer("mesh", {})
    faces = np.frombuffer(base64.b64decode(mesh["faces"]), "<u4")
    colours = np.frombuffer(base64.b64decode(mesh["colours"]), np.uint8)
    fit = session.answer("fit", {"picture": 0, "points": asked(truth)})
    assert faces.max() + 1 == len(colours) / 3 == len(base64.b64decode(fit["vertices"])) / 12


def test_saving_asks_before_it_replaces(folder, truth):
    write_landmarks(folder / "face.pts", truth)
    session = EditorSession(PictureList(folder))
    moved = truth + 1
    moved[5] = np.nan
    message = {"picture": 0, "points": asked(moved), "suffix": ".pts"}
    assert session.answer("save", message) == {"exists": "face.pts"}
    np.testing.assert_array_equal(read_landmarks(folder / "face.pts"), truth)
    assert session.answer("save", message | {"replace": True}) == {"file": "face.pts"}
    np.testing.assert_array_equal(read_landmarks(folder / "face.pts"), moved)
    assert session.answer("save", message) == {"file": "face.pts"}  # its own file
    assert session.answer("list", {}) == {"pictures": [{"name": "face.png", "done": True}]}


def test_a_large_picture_is_shown_smaller(tmp_path):
    write_image(tmp_path / "wide.png", np.zeros((10, 5000, 3), np.uint8))
    session = EditorSession(PictureList(tmp_path))
    assert Image.open(io.BytesIO(session.shown_picture(0))).size == (4096, 8)
    assert session.answer("open", {"picture": 0})["width"] == 5000


@pytest.mark.parametrize(
    ("question", "message", "error"),
    [
        ("delete", {}, "question: expected one of list, mesh, open, detect, place, fit, save, got 'delete'"),
        ("open", {"picture": 1}, "picture: expected a number below 1, got 1"),
        ("open", {"picture": True}, "picture: expected a number"),
        ("open", {}, "picture: expected a number below 1, got None"),
        ("fit", {"picture": 0}, "points: expected a list of 68 points"),
        ("fit", {"picture": 0, "points": [[0, 0]] * 68}, "landmarks: expected a face in pixels"),
        ("place", {"clicks": [None] * 68}, "clicks: expected at least one point"),
        ("save", {"picture": 0, "points": [[1, 2]] * 68, "suffix": "/../x.pts"}, "suffix|output"),
    ],
)
def test_questions_that_are_none(folder, question, message, error):
    with pytest.raises(ValueError, match=error):
        EditorSession(PictureList(folder)).answer(question, message)
