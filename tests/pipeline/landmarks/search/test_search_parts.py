import numpy as np
import pytest

from toongeo.pipeline.landmarks.search.cascade import Cascade, CascadeStage
from toongeo.pipeline.landmarks.search.detector_file import (
    detector_arrays,
    packed_axes,
    read_detector,
    shipped_detector,
    unpacked_axes,
)
from toongeo.pipeline.landmarks.search.face_boxes import BoxTemplates, face_boxes
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX, RADIUS_PX, face_crop, point_descriptors
from toongeo.pipeline.landmarks.search.flat_look import flat_look
from toongeo.pipeline.landmarks.search.frames import (
    applied,
    box_matrix,
    box_of,
    composed,
    inverse,
    similarity_onto,
)
from toongeo.pipeline.landmarks.search.orientation_maps import DIRECTIONS, orientation_maps
from toongeo.pipeline.landmarks.search.passes import face_patch, run_passes
from toongeo.pipeline.landmarks.search.photo_share import photo_share
from toongeo.pipeline.landmarks.search.template_residuals import template_residuals


def turn(degrees, scale, shift):
    c, s = scale * np.cos(np.radians(degrees)), scale * np.sin(np.radians(degrees))
    return np.array([[c, -s, shift[0]], [s, c, shift[1]]])


def test_similarity_onto_is_exact_and_undone_by_its_inverse(rng):
    points, matrix = rng.normal(size=(68, 2)), turn(33, 1.7, (4, -9))
    found = similarity_onto(points, applied(matrix, points))
    np.testing.assert_allclose(found, matrix, atol=1e-12)
    np.testing.assert_allclose(composed(inverse(found), found), turn(0, 1, (0, 0)), atol=1e-12)


def test_similarity_onto_is_the_least_squares_one(rng):
    points, targets = rng.normal(size=(20, 2)), rng.normal(size=(20, 2))
    best = ((applied(similarity_onto(points, targets), points) - targets) ** 2).sum()
    for step in np.eye(4):
        other = similarity_onto(points, targets) + 1e-3 * np.array(
            [[step[0], -step[1], step[2]], [step[1], step[0], step[3]]]
        )
        assert ((applied(other, points) - targets) ** 2).sum() > best


def test_a_box_comes_to_the_middle_of_the_crop_with_its_radius(rng):
    points = rng.normal(size=(68, 2)) * 30 + 200
    seen = applied(box_matrix(box_of(points), CROP_PX, RADIUS_PX), points)
    np.testing.assert_allclose(box_of(seen), [CROP_PX / 2, CROP_PX / 2, RADIUS_PX])


@pytest.mark.parametrize("k", range(DIRECTIONS))
def test_a_ramp_counts_for_its_direction_alone(k):
    angle = 2 * np.pi * k / DIRECTIONS
    y, x = np.mgrid[:32, :32]
    ramp = np.clip(128 + 3 * ((x - 16) * np.cos(angle) + (y - 16) * np.sin(angle)), 0, 255).astype(np.uint8)
    strength = np.concatenate(orientation_maps(ramp, 4, 0.8), axis=2)[4, 4]
    assert 5.5 < strength[k] < 6.5  # twice the 3 grey levels a px
    assert np.delete(strength, k).max() < 0.8


def test_orientation_maps_of_a_turned_picture_are_turned(rng):
    grey = rng.integers(0, 255, (32, 32), dtype=np.uint8)
    here, there = (
        np.concatenate(orientation_maps(np.ascontiguousarray(g), 4, 0.8), axis=2) for g in (grey, np.rot90(grey))
    )
    # Counter-clockwise in the picture, where y points down: directions go back by a quarter.
    np.testing.assert_allclose(there, np.roll(np.rot90(here), -2, axis=2), atol=1e-3)


def test_orientation_maps_do_not_depend_on_addresses(rng):
    grey = rng.integers(0, 255, (160, 160), dtype=np.uint8)
    kept, seen = [], set()
    for k in range(20):
        kept.append(np.empty(k * 37 + 1, np.uint8))  # moves what is allocated next
        kept.append(np.concatenate(orientation_maps(grey, 2, 0.8), axis=2))
        seen.add(kept[-1].tobytes())
    assert len(seen) == 1


def test_descriptors_are_bounded_and_nothing_where_nothing_is():
    grey = np.full((CROP_PX, CROP_PX), 77, np.uint8)
    points = np.full((3, 2), 80.0)
    assert not point_descriptors(grey, points, 10, (1, 2)).any()
    grey[:, 80:] = 200
    rows = point_descriptors(grey, points, 10, (1, 2))
    assert rows.shape == (3, 136) and (np.linalg.norm(rows, axis=1) < 1).all() and rows.max() > 0.1


def test_a_cascade_that_does_nothing_returns_the_mean_shape(rng):
    shape = rng.normal(size=(68, 2)) * 20 + 80
    still = CascadeStage(
        9.0, (1.0, 2.0), np.zeros((68, 136)), np.zeros((68, 136, 3)), np.zeros((68 * 3 + 4 + 1, 136), np.float32)
    )
    cascade = Cascade(shape, np.zeros((136, 4), np.float32), (still, still))
    start = turn(20, 0.8, (5, 5))
    grey = rng.integers(0, 255, (200, 200), dtype=np.uint8)
    np.testing.assert_allclose(applied(start, cascade.run(grey, start)), shape, atol=1e-9)


def test_passes_of_a_mirrored_picture_are_mirrored(render):
    import cv2

    from toongeo.model.ibug68 import MIRROR

    truth, cascade = render(0), shipped_detector().cascade
    grey = cv2.cvtColor(truth.picture, cv2.COLOR_RGB2GRAY)
    here = run_passes(grey, truth.landmarks, cascade)
    flipped = truth.landmarks[MIRROR] * [-1, 1] + [grey.shape[1] - 1, 0]
    there = run_passes(np.ascontiguousarray(grey[:, ::-1]), flipped, cascade)
    np.testing.assert_allclose(there.points[MIRROR] * [-1, 1] + [grey.shape[1] - 1, 0], here.points, atol=1e-6)
    np.testing.assert_allclose(there.spread[MIRROR], here.spread, atol=1e-6)


def test_a_patch_shows_the_same_points(rng):
    import cv2

    grey = cv2.GaussianBlur(rng.integers(0, 255, (400, 300), dtype=np.uint8), (0, 0), 8)
    patch = face_patch(grey, np.array([150.0, 220.0, 90.0]))
    points = rng.uniform([100, 170], [200, 270], (50, 2))
    there = np.rint(applied(patch.matrix, points)).astype(int)
    back = np.rint(applied(inverse(patch.matrix), there.astype(float))).astype(int)
    difference = grey[back[:, 1], back[:, 0]].astype(float) - patch.grey[there[:, 1], there[:, 0]]
    assert np.abs(difference).max() < 4
    assert face_crop(patch.grey, turn(0, 1, (0, 0))).shape == (CROP_PX, CROP_PX)


def test_boxes_go_to_what_the_template_looks_like(rng):
    from toongeo.pipeline.landmarks.search.face_boxes import WINDOW_PX, box_descriptor

    pattern = rng.integers(0, 255, (12, 12), dtype=np.uint8).repeat(8, 0).repeat(8, 1)
    row = box_descriptor(pattern)
    templates = BoxTemplates((row - row.mean())[None], np.zeros(1, np.float32))
    grey = np.full((240, 240), 128, np.uint8)
    grey[96:192, 64:160] = pattern
    best = face_boxes(grey, templates, 3)[0]
    np.testing.assert_allclose(best[:2], [64 + WINDOW_PX / 2, 96 + WINDOW_PX / 2], atol=8)
    assert abs(np.log(best[2] / 26)) < 0.2


def test_the_template_fits_its_own_faces_and_no_others(model, rng):
    from toongeo.render import ScaledOrthographicCamera

    face = model.vertices(model.prior.mean + 0.5 * rng.normal(size=81))[model.landmarks]
    seen = ScaledOrthographicCamera.look(yaw=25.0, roll=10.0).project(face)
    assert template_residuals(seen).shape == (51,) and np.sqrt((template_residuals(seen) ** 2).mean()) < 0.03
    noisy = seen + rng.normal(0, 0.2 * box_of(seen)[2], (68, 2))
    assert np.sqrt((template_residuals(noisy) ** 2).mean()) > 0.08


def test_parts_go_on_by_themselves(render):
    """Each part from its own points: what the others are does not matter, and points off their places come nearer."""
    import cv2

    truth, cascade = render(0), shipped_detector().cascade
    grey = cv2.cvtColor(truth.picture, cv2.COLOR_RGB2GRAY)
    nose = next(part.rows for part in cascade.parts if 30 in part.rows)
    moved = truth.landmarks.copy()
    moved[nose] += [4.0, 3.0]
    refined = cascade.refined(grey, moved)
    np.testing.assert_array_equal(
        np.delete(refined, nose, axis=0), np.delete(cascade.refined(grey, truth.landmarks), nose, axis=0)
    )
    assert np.linalg.norm(refined[nose] - truth.landmarks[nose], axis=1).mean() < 3.5
    np.testing.assert_array_equal(moved[nose] - truth.landmarks[nose], np.tile([4.0, 3.0], (9, 1)))


def test_parts_for_photographs_have_their_share(render):
    """Between the two sets the points go straight; what only one set has is its own at every share."""
    import cv2

    truth, cascade = render(0), shipped_detector().cascade
    grey = cv2.cvtColor(truth.picture, cv2.COLOR_RGB2GRAY)
    none, half, whole = (cascade.refined(grey, truth.landmarks, share) for share in (0.0, 0.5, 1.0))
    np.testing.assert_allclose(half, (none + whole) / 2, atol=1e-9)
    assert np.abs(none - whole)[17:].max() > 0.1
    np.testing.assert_array_equal(none[:17], whole[:17])


def test_figures_look_unlike_people(render):
    """Of which the parts for photographs keep away."""
    import sys
    from pathlib import Path

    import cv2

    sys.path.insert(0, str(Path(__file__).parents[4] / "data_templates" / "build"))
    from figures import random_figure

    parts = shipped_detector()

    def share(picture, points):
        grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
        look = parts.verifier.look(grey, points, parts.cascade)
        assert look.face > -0.5
        return photo_share(flat_look(grey, points, parts.cascade.shape), look.figure)

    people = [share(one.picture, one.landmarks) for one in (render(k, "person", "photo") for k in range(6))]
    figures = [random_figure(np.random.default_rng([5, k])) for k in range(6)]
    figures = [share(one.picture.astype(np.uint8), one.landmarks) for one in figures]
    assert np.median(people) > 0.5 and np.median(figures) < 0.1


def test_the_verifier_tells_points_from_others(render):
    import cv2

    parts = shipped_detector()
    for k in range(4):
        one = render(k)
        grey = cv2.cvtColor(one.picture, cv2.COLOR_RGB2GRAY)
        own, aside = (parts.verifier.look(grey, one.landmarks + off, parts.cascade).face for off in (0.0, 25.0))
        assert own > 0 > aside


def test_axes_are_packed_to_bytes_and_back(rng):
    axes = np.linalg.qr(rng.normal(size=(5, 136, 40)))[0].astype(np.float32)
    packed, units = packed_axes(axes)
    again = unpacked_axes(packed, units)
    assert packed.dtype == units.dtype == np.int8
    assert np.linalg.norm(again - axes) < 0.02 * np.linalg.norm(axes)
    np.testing.assert_array_equal(packed_axes(again)[0], packed)
    np.testing.assert_array_equal(unpacked_axes(*packed_axes(again)), again)
    assert not unpacked_axes(*packed_axes(np.zeros_like(axes))).any()


def test_lines_between_flat_colours_look_flat_whatever_their_contrast(rng):
    import cv2

    points = rng.normal(CROP_PX / 2, 27, (68, 2))
    lines = np.full((CROP_PX, CROP_PX), 90, np.uint8)
    cv2.circle(lines, (80, 80), 40, 200, 2)
    drawn, grain = (flat_look(grey, points, points) for grey in (lines, rng.integers(0, 255, lines.shape, np.uint8)))
    assert drawn > 0.85 and 0.1 < grain < 0.3
    assert flat_look(lines // 2, points, points) == pytest.approx(drawn, abs=0.02)
    assert flat_look(np.full_like(lines, 7), points, points) == 1.0


def test_the_detector_travels_through_its_file(tmp_path):
    parts = shipped_detector()
    np.savez_compressed(tmp_path / "detector.npz", **detector_arrays(parts))
    again = read_detector(tmp_path / "detector.npz")
    for name, array in detector_arrays(parts).items():
        np.testing.assert_array_equal(detector_arrays(again)[name], array, err_msg=name)


def test_the_shipped_detector_is_small():
    from toongeo.model.data_path import data_path

    assert data_path("data_templates/landmark_detector.npz").stat().st_size < 12e6
