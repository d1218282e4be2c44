"""Eye landmarks onto segmented eyes."""

import cv2
import numpy as np
import pytest

from toongeo import FaceLabel, FaceParse, parse_face, snap_eyes
from toongeo.model.ibug68 import MIRROR, PARTS

EYES = {FaceLabel.EYE_RIGHT: PARTS["eye_right"], FaceLabel.EYE_LEFT: PARTS["eye_left"]}
OTHERS = np.setdiff1d(np.arange(68), np.concatenate(list(EYES.values())))
SHAPE = (240, 320)
RADII = np.array([32.0, 14.0])
CENTRES = {FaceLabel.EYE_RIGHT: np.array([100.0, 120.0]), FaceLabel.EYE_LEFT: np.array([220.0, 120.0])}


def ellipse(label, angles):
    return CENTRES[label] + RADII * np.column_stack([np.cos(angles), np.sin(angles)])


@pytest.fixture
def landmarks(rng):
    """Eyes on two ellipses; the other points anywhere."""
    points = rng.uniform(0, 200, (68, 2))
    for label, rows in EYES.items():
        points[rows] = ellipse(label, np.radians([180, 240, 300, 360, 60, 120]))
    return points


def segmented(confidence=1.0, **masks):
    labels = np.zeros(SHAPE, np.uint8)
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    for label, (cx, cy) in CENTRES.items():
        labels[((x - cx) / RADII[0]) ** 2 + ((y - cy) / RADII[1]) ** 2 <= 1] = label
    return FaceParse(labels, np.full(SHAPE, confidence))


def off(points):
    """Distance of the eyes' points from their ellipses, px, by a fine sampling."""
    fine = np.linspace(0, 2 * np.pi, 4000)
    return max(
        np.linalg.norm(points[rows][:, None] - ellipse(label, fine), axis=2).min(axis=1).max()
        for label, rows in EYES.items()
    )


def scaled(points, factor, shift=(0, 0)):
    moved = points.copy()
    for label, rows in EYES.items():
        moved[rows] = CENTRES[label] + factor * (points[rows] - CENTRES[label]) + shift
    return moved


@pytest.mark.parametrize("mode", ["arc", "nearest"])
@pytest.mark.parametrize(("factor", "shift"), [(0.5, (0, 0)), (1.3, (0, 0)), (1.0, (8, -5)), (0.7, (-5, 6))])
def test_points_come_to_lie_on_the_boundary(landmarks, mode, factor, shift):
    snapped = snap_eyes(scaled(landmarks, factor, shift), segmented(), mode=mode)
    assert off(snapped) < 0.6


@pytest.mark.parametrize(("factor", "shift"), [(0.5, (0, 0)), (1.3, (0, 0)), (1.0, (8, -5)), (0.7, (-5, 6))])
def test_by_arc_each_point_comes_back_to_its_own_place(landmarks, factor, shift):
    snapped = snap_eyes(scaled(landmarks, factor, shift), segmented())
    assert np.linalg.norm(snapped - landmarks, axis=1).max() < 2.5


def test_by_arc_is_better_than_nearest_for_shrunken_eyes(landmarks):
    shrunken = scaled(landmarks, 0.4)
    by_arc, nearest = (
        np.abs(snap_eyes(shrunken, segmented(), mode=mode) - landmarks).max() for mode in ("arc", "nearest")
    )
    assert by_arc < 0.3 * nearest


@pytest.mark.parametrize("mode", ["arc", "nearest"])
def test_other_landmarks_stay_bit_for_bit(landmarks, mode):
    snapped = snap_eyes(scaled(landmarks, 0.6), segmented(), mode=mode)
    np.testing.assert_array_equal(snapped[OTHERS], landmarks[OTHERS])


def test_lids_keep_their_order_and_do_not_cross(landmarks):
    snapped = snap_eyes(scaled(landmarks, 0.3, (6, 6)), segmented())
    for rows in EYES.values():
        upper, lower = snapped[rows[:4]], snapped[rows[[0, 5, 4, 3]]]
        assert (np.diff(upper[:, 0]) > 0).all() and (np.diff(lower[:, 0]) > 0).all()
        assert (upper[1:3, 1] < lower[1:3, 1]).all()


def test_the_nearest_point_is_the_foot_on_the_boundary(landmarks):
    """On a straight vertical border the nearest point keeps its row."""
    labels = np.zeros(SHAPE, np.uint8)
    labels[80:160, 80:130] = FaceLabel.EYE_RIGHT
    points = landmarks.copy()
    points[36:42] = np.array([[84, 110], [85, 115], [86, 120], [84, 125], [85, 130], [86, 135]])
    snapped = snap_eyes(points, FaceParse(labels, np.ones(SHAPE)), mode="nearest")
    np.testing.assert_allclose(snapped[36:42, 1], points[36:42, 1], atol=1e-6)
    np.testing.assert_allclose(snapped[36:42, 0], 79.5, atol=0.05)


@pytest.mark.parametrize("mode", ["arc", "nearest"])
def test_missing_points_stay_missing(landmarks, mode):
    points = scaled(landmarks, 0.7)
    points[[37, 43, 46]] = np.nan
    snapped = snap_eyes(points, segmented(), mode=mode)
    np.testing.assert_array_equal(np.isnan(snapped), np.isnan(points))
    kept = np.isfinite(points[:, 0])
    points[:, 0], landmarks[~kept] = np.where(kept, points[:, 0], np.nan), ellipse(FaceLabel.EYE_RIGHT, np.zeros(1))
    fine = np.linspace(0, 2 * np.pi, 4000)
    for label, rows in EYES.items():
        found = snapped[rows[kept[rows]]]
        assert np.linalg.norm(found[:, None] - ellipse(label, fine), axis=2).min(axis=1).max() < 0.6


def test_an_eye_whose_points_are_all_missing_is_left_out(landmarks):
    points = scaled(landmarks, 0.7)
    points[42:48] = np.nan
    snapped = snap_eyes(points, segmented())
    assert np.isnan(snapped[42:48]).all()
    assert np.abs(snapped[36:42] - landmarks[36:42]).max() < 2.5


@pytest.mark.parametrize("mode", ["arc", "nearest"])
@pytest.mark.parametrize("fault", ["none", "far", "tiny", "huge", "ragged", "doubtful"])
def test_an_implausible_eye_moves_nothing(landmarks, mode, fault):
    labels = np.zeros(SHAPE, np.uint8)
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    eye = np.zeros(SHAPE, bool)
    if fault == "far":
        eye = np.hypot(x - 160, y - 30) < 20
    if fault == "tiny":
        eye = np.hypot(x - 100, y - 120) < 2
    if fault == "huge":
        eye = np.hypot(x - 100, y - 120) < 200
    if fault == "ragged":
        eye = (np.abs(x - 100) < 30) & (np.abs(y - 120) < 15) & ((x // 4) % 2 == 0) | (np.abs(x - 100) < 30) & (
            y == 120
        )
    if fault == "doubtful":
        eye = np.hypot(x - 100, y - 120) < 20
    labels[eye] = FaceLabel.EYE_RIGHT
    parse = FaceParse(labels, np.full(SHAPE, 0.05 if fault == "doubtful" else 1.0))
    points = scaled(landmarks, 0.9)
    np.testing.assert_array_equal(snap_eyes(points, parse, mode=mode), points)


def test_landmarks_in_one_place_stay(landmarks):
    points = landmarks.copy()
    points[36:42] = CENTRES[FaceLabel.EYE_RIGHT]
    np.testing.assert_array_equal(snap_eyes(points, segmented())[36:42], points[36:42])


def test_a_mirrored_picture_gives_mirrored_eyes(landmarks):
    points, parse = scaled(landmarks, 0.6, (4, -3)), segmented()
    labels = parse.labels[:, ::-1].copy()
    right, left = labels == FaceLabel.EYE_RIGHT, labels == FaceLabel.EYE_LEFT
    labels[right], labels[left] = FaceLabel.EYE_LEFT, FaceLabel.EYE_RIGHT

    def mirrored(rows):
        return (rows * [-1, 1] + [SHAPE[1] - 1, 0])[MIRROR]

    found = snap_eyes(mirrored(points), FaceParse(labels, parse.confidence))
    assert np.abs(mirrored(found) - snap_eyes(points, parse)).max() < 1.0


def test_a_turned_picture_gives_turned_eyes(landmarks):
    """A quarter turn; lids are told apart by the landmarks' order, not by the picture's axes."""
    points, parse = scaled(landmarks, 0.6, (4, -3)), segmented()
    turned = np.column_stack([points[:, 1], SHAPE[1] - 1 - points[:, 0]])
    rotated = FaceParse(np.rot90(parse.labels).copy(), np.rot90(parse.confidence).copy())
    found, expected = snap_eyes(turned, rotated), snap_eyes(points, parse)
    back = np.column_stack([SHAPE[1] - 1 - found[:, 1], found[:, 0]])
    assert np.abs(back - expected).max() < 1.0


@pytest.mark.parametrize("name", ["blue_girl", "moustache_man"])
@pytest.mark.parametrize(("factor", "shift"), [(0.6, 0.0), (1.0, 0.08), ([1.0, 0.65], 0.0)])
def test_disturbed_eyes_of_drawings_find_their_lids(cartoon, name, factor, shift):
    img, truth = cartoon(name)
    unit = np.linalg.norm(truth[36] - truth[45])
    given = truth.copy()
    for rows in EYES.values():
        middle = truth[rows].mean(axis=0)
        given[rows] = middle + np.array(factor) * (truth[rows] - middle) + [0.6 * shift * unit, -0.8 * shift * unit]
    snapped = snap_eyes(given, parse_face(img, given))

    def distance(points):
        eyes = [(truth[rows].astype(np.float32), points[rows]) for rows in EYES.values()]
        return np.mean([abs(cv2.pointPolygonTest(lids, point, True)) for lids, eye in eyes for point in eye])

    assert distance(snapped) < 0.4 * distance(given)


def test_bad_input_is_refused(landmarks):
    with pytest.raises(ValueError, match="landmarks: expected 68 points"):
        snap_eyes(landmarks[:51], segmented())
    with pytest.raises(ValueError, match="all rows are NaN"):
        snap_eyes(np.full((68, 2), np.nan), segmented())
    with pytest.raises(ValueError, match="mode: expected one of .* got 'linear'"):
        snap_eyes(landmarks, segmented(), mode="linear")
