"""The parts that parsing is made of."""

import cv2
import numpy as np
import pytest

from toongeo.model.ibug68 import MIRROR
from toongeo.pipeline.parse.colour_share import colour_codes, colour_share
from toongeo.pipeline.parse.cut_out import cut_out
from toongeo.pipeline.parse.lids.find_lids import candidate_probabilities, find_lids, lid_weights
from toongeo.pipeline.parse.lids.lid_candidates import ARC, lid_candidates, lid_contour
from toongeo.pipeline.parse.lids.lid_features import lid_features
from toongeo.pipeline.parse.lids.lid_patch import CHANNELS, eye_points, lid_patch, lid_unit
from toongeo.pipeline.parse.lids.refine_lids import refine_lids
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.parse.skin_surface import colour_mode, skin_surface
from toongeo.pipeline.parse.working_view import working_view

LIDS = np.array([[10.0, 50], [30, 40], [50, 40], [70, 50], [50, 58], [30, 58]])


def circle(radius, n=32, centre=(60.0, 60.0)):
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return np.array(centre) + radius * np.column_stack([-np.cos(angle), -np.sin(angle)])


def test_a_grown_point_is_a_disc():
    point = np.zeros((41, 41), bool)
    point[20, 20] = True
    y, x = np.mgrid[:41, :41] - 20
    away = np.hypot(x, y)
    disc = grown(point, 10)
    assert disc[away < 9.5].all() and not disc[away > 10.5].any()
    np.testing.assert_array_equal(grown(disc, -3), ~grown(~disc, 3))
    assert not grown(np.zeros((5, 5), bool), 3).any()


def test_a_filled_polygon_covers_its_area():
    square = np.array([[10, 10], [30, 10], [30, 20], [10, 20]])
    assert filled((40, 40), square).sum() == 21 * 11


def test_the_commonest_colour_wins(rng):
    colours = np.vstack([rng.normal([60, 10, 20], 1, (300, 3)), rng.normal([20, 0, 0], 1, (200, 3))])
    np.testing.assert_allclose(colour_mode(colours), [60, 10, 20], atol=0.3)


def test_a_skin_surface_follows_shading_and_overlooks_what_is_not_skin():
    y, x = np.mgrid[-1:1:61j, -1:1:61j]
    truth = np.stack([60 + 6 * x - 4 * y + 3 * x * y, 15 + 2 * y * y, 20 - 2 * x], axis=2)
    lab = truth.copy()
    lab[25:40, 20:45] = [95, 0, 0]
    lab[25:40, 28:36] = [10, 0, 0]
    surface = skin_surface(lab, np.array([60.0, 15, 20]), np.ones((61, 61), bool))
    assert np.abs(surface.colour - truth).max() < 3.0 and np.abs(surface.colour - truth).mean() < 0.8
    assert surface.spread == 4.0


def test_shares_of_colours_are_those_of_the_part():
    img = np.zeros((4, 4, 3), np.uint8)
    img[:, 2:] = 200
    codes = colour_codes(img)
    part = np.zeros((4, 4), bool)
    part[:, 2:] = True
    share = colour_share(codes, part)
    assert share[0, 2] > 0.1 and share[0, 0] < 1e-9
    assert not colour_share(codes, np.zeros((4, 4), bool)).any()


def test_a_cut_keeps_to_what_is_known(rng):
    img = np.full((60, 60, 3), 220, np.uint8)
    img[15:45, 15:45] = (180, 90, 60)
    img = np.clip(img + rng.integers(-4, 5, img.shape), 0, 255).astype(np.uint8)
    truth = np.zeros((60, 60), bool)
    truth[15:45, 15:45] = True
    sure, never = np.zeros((2, 60, 60), bool)
    sure[25:35, 25:35] = True
    np.testing.assert_array_equal(cut_out(img, sure=sure, likely=grown(truth, 4), never=never), truth)
    never[:, :30] = True
    cut = cut_out(img, sure=sure, likely=grown(truth, 4), never=never)
    assert not cut[:, :30].any() and cut[15:45, 30:45].all()


def test_a_cut_without_another_side_is_what_was_likely():
    everything = np.ones((9, 9), bool)
    found = cut_out(np.zeros((9, 9, 3), np.uint8), sure=~everything, likely=everything, never=~everything)
    np.testing.assert_array_equal(found, everything)


def test_a_working_view_maps_the_corners_of_its_crop(rng):
    img = rng.integers(0, 255, (300, 500, 3), dtype=np.uint8)
    view = working_view(img, np.array([[200.0, 100], [300, 250]]), 100.0)
    rows, columns = view.window()
    (x, y), (width, height) = view.corner, view.size
    assert (rows, columns) == (slice(y, y + height), slice(x, x + width))
    ends = view.place(np.array([[x - 0.5, y - 0.5], [x + width - 0.5, y + height - 0.5]]))
    np.testing.assert_allclose(ends, [[-0.5, -0.5], np.array(view.pixels.shape[1::-1]) - 0.5], atol=1e-9)
    np.testing.assert_allclose(view.factors, 100 / 150, atol=0.01)


def test_the_points_of_both_eyes_run_from_the_outer_corner_over_the_upper_lid():
    np.testing.assert_array_equal(eye_points("right"), [36, 37, 38, 39, 40, 41])
    np.testing.assert_array_equal(eye_points("left"), [45, 44, 43, 42, 47, 46])


def test_the_unit_is_the_distance_of_the_outer_corners_however_small_the_eyes(drawn_face):
    whole = lid_unit(drawn_face.landmarks)
    assert whole == pytest.approx(np.linalg.norm(drawn_face.landmarks[36] - drawn_face.landmarks[45]), rel=0.1)
    small = drawn_face.landmarks.copy()
    for rows in (slice(36, 42), slice(42, 48)):
        small[rows] = small[rows].mean(axis=0) + 0.3 * (small[rows] - small[rows].mean(axis=0))
    assert lid_unit(small) == pytest.approx(whole)


def test_a_patch_is_upright_and_mirrors_left_eyes(drawn_face):
    points = drawn_face.landmarks.copy()
    points[:, 0] = drawn_face.img.shape[1] - 1 - points[:, 0]
    left = lid_patch(drawn_face.img, drawn_face.landmarks, "left")
    right = lid_patch(np.ascontiguousarray(drawn_face.img[:, ::-1]), points[MIRROR], "right")
    assert left.channels.shape[2] == len(CHANNELS)
    np.testing.assert_allclose(left.lids, right.lids, atol=1e-9)
    assert np.abs(left.channels - right.channels).mean() < 0.01
    np.testing.assert_allclose(left.to_picture(left.lids), drawn_face.landmarks[eye_points("left")], atol=1e-9)


def test_a_turned_picture_gives_the_same_patch(drawn_face):
    turned = np.ascontiguousarray(np.rot90(drawn_face.img))
    points = np.column_stack([drawn_face.landmarks[:, 1], drawn_face.img.shape[1] - 1 - drawn_face.landmarks[:, 0]])
    one, other = lid_patch(drawn_face.img, drawn_face.landmarks, "right"), lid_patch(turned, points, "right")
    np.testing.assert_allclose(other.lids, one.lids, atol=1e-6)
    assert np.abs(one.channels - other.channels).mean() < 0.02


def test_a_contour_goes_through_the_corners():
    contour = lid_contour(LIDS)
    assert contour.shape == (2 * ARC, 2)
    np.testing.assert_allclose(contour[[0, ARC]], LIDS[[0, 3]], atol=1e-9)
    assert contour[1:ARC, 1].max() < 50 < contour[ARC + 1 :, 1].min()


def test_candidates_are_shifted_and_scaled_copies():
    contour = lid_contour(LIDS)
    candidates = lid_candidates(contour)
    still = (candidates.shifts == 0).all(axis=1) & (candidates.scales == 1).all(axis=1)
    assert still.sum() == 1
    np.testing.assert_allclose(candidates.contours[still][0], contour, atol=1e-9)
    middle = contour.mean(axis=0)
    rebuilt = middle + candidates.shifts[:, None] + candidates.scales[:, None] * (contour - middle)
    np.testing.assert_allclose(candidates.contours, rebuilt)


def test_every_weight_has_its_feature(drawn_face):
    patch = lid_patch(drawn_face.img, drawn_face.landmarks, "right")
    candidates = lid_candidates(lid_contour(patch.lids))
    features = lid_features(patch.channels, candidates)
    weights = lid_weights()
    assert tuple(features) == weights.names
    assert {value.shape for value in features.values()} == {(len(candidates.scales),)}
    likely = candidate_probabilities(patch, candidates, weights)
    assert likely.min() >= 0 and likely.sum() == pytest.approx(1)


def test_a_contour_is_refined_to_the_edge():
    y, x = np.mgrid[:121, :121]
    plane = (np.hypot(x - 60, y - 60) < 22).astype(np.float32)
    refined = refine_lids(cv2.GaussianBlur(plane, (0, 0), 1)[..., None], circle(20.0))
    assert np.abs(np.hypot(*(refined - 60).T) - 22).max() < 1.1


def test_without_an_edge_a_contour_stays():
    contour = circle(20.0)
    np.testing.assert_allclose(refine_lids(np.zeros((121, 121, 1), np.float32), contour), contour, atol=1e-9)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize(("factor", "shift"), [(0.6, (0.0, 0.0)), (1.0, (0.06, 0.05)), (1.0, (-0.07, 0.02))])
def test_lids_of_a_drawn_face_are_found_from_disturbed_landmarks(drawn_face, side, factor, shift):
    rows = eye_points(side)
    truth = drawn_face.landmarks[rows]
    unit = lid_unit(drawn_face.landmarks)
    given = drawn_face.landmarks.copy()
    given[rows] = truth.mean(axis=0) + factor * (truth - truth.mean(axis=0)) + np.array(shift) * unit

    def off(contour):
        polygon = truth.astype(np.float32)
        return np.mean([abs(cv2.pointPolygonTest(polygon, tuple(map(float, p)), True)) for p in contour])

    lids = find_lids(drawn_face.img, given, side)
    assert off(lids.contour) < 0.5 * off(lid_contour(given[rows]))
    assert 0 < lids.confidence <= 1
