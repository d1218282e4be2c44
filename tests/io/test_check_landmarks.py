"""The check refuses every usual mistake on every face at hand, and refuses no face."""

from pathlib import Path

import numpy as np
import pytest

from toongeo.io import check_landmarks, read_image, read_landmarks
from toongeo.io.landmarks.frontal_layout import frontal_layout

PORTRAITS = sorted((Path(__file__).parents[2] / "examples" / "portraits").glob("*.pts"))
RNG_ORDER = np.random.default_rng(0).permutation(68)
SHAPE = (900, 700)


@pytest.fixture(params=PORTRAITS, ids=lambda path: path.stem)
def face(request):
    """A real face, moved to (350, 450)."""
    points = read_landmarks(request.param)
    return (points - points.mean(axis=0)) * 200 / np.linalg.norm(points[45] - points[36]) + [350, 450]


def rolled(points, degrees):
    a = np.radians(degrees)
    centre = points.mean(axis=0)
    return (points - centre) @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]) + centre


def exchanged(points):
    return points[frontal_layout().mirror]


def test_portraits_pass_in_their_pictures():
    assert PORTRAITS
    for path in PORTRAITS:
        assert check_landmarks(read_landmarks(path), read_image(path.with_suffix(".png")).shape) == []


def test_photographs_and_strong_caricatures_pass(shared):
    paths = [*shared.glob("data/caricatures/*.txt"), *shared.glob("data/portraits/*.pts")]
    assert paths
    for path in paths:
        image = next(path.with_suffix(s) for s in (".jpg", ".png") if path.with_suffix(s).exists())
        points = read_landmarks(path)
        assert check_landmarks(points, read_image(image).shape) == []
        with pytest.raises(ValueError, match="left and right are mirrored"):
            check_landmarks(exchanged(points))
        for degrees in (-60, -30, 30, 60):
            assert check_landmarks(rolled(points, degrees)) == []


def test_layout_is_the_symmetrised_mean_of_the_portraits():
    layout = frontal_layout()
    np.testing.assert_array_equal(layout.points[layout.mirror] * [-1, 1], layout.points)
    np.testing.assert_array_equal(layout.mirror[layout.mirror], np.arange(68))
    shapes = [read_landmarks(path) for path in PORTRAITS]
    shapes = [(s - s.mean(0)) / np.linalg.norm(s - s.mean(0)) for s in shapes]
    mean = layout.points / np.linalg.norm(layout.points)
    turned = []
    for shape in (*shapes, *(exchanged(s) * [-1, 1] for s in shapes)):
        u, _, vt = np.linalg.svd(shape.T @ mean)
        turned.append(shape @ u @ vt)
    again = np.mean(turned, axis=0)
    again *= np.linalg.norm(layout.points) / np.linalg.norm(again)
    np.testing.assert_allclose(again, layout.points, atol=1e-4)


@pytest.mark.parametrize("degrees", range(-60, 61, 15))
@pytest.mark.parametrize("squeeze", [(1, 1), (0.6, 1), (1, 0.6)])
def test_rolled_and_distorted_faces_pass(face, degrees, squeeze):
    centre = face.mean(axis=0)
    assert check_landmarks(rolled((face - centre) * squeeze + centre, degrees), SHAPE) == []


@pytest.mark.parametrize("scale", [0.05, 1.0, 1e4])
def test_similarity_does_not_matter(face, scale):
    assert check_landmarks(scale * face + 17) == []


@pytest.mark.parametrize("degrees", [-30, 0, 30])
@pytest.mark.parametrize(
    ("mistake", "message"),
    [
        (exchanged, "left and right are mirrored"),
        (lambda p: p * [-1, 1] + [SHAPE[1] - 1, 0], "left and right are mirrored"),
        (lambda p: p * [1, -1] + [0, SHAPE[0] - 1], "y points up"),
        (lambda p: p * [1, -1], "y points up"),
        (lambda p: p[:, ::-1], r"the columns are \(y, x\); expected \(x, y\)"),
        (lambda p: [699, 899] - p[:, ::-1], r"\(y, x\) and run backwards"),
        (lambda p: p[RNG_ORDER], "do not form one .*another order"),
        (lambda p: np.roll(p, 17, axis=0), "do not form one|mirrored"),
        (lambda p: p + np.array([2000, 0]), "68 of 68 points lie outside the picture of 700 x 900 px"),
        (lambda p: p * 2.5, "lie outside the picture .*another picture or size"),
        (lambda p: np.vstack([[1e6, 1e6], p[1:]]), "farthest 0 at"),
        (lambda p: p / [700, 900], "not fractions of the picture"),
        (lambda p: 0 * p + 50, "the points span 0 x 0 px"),
        (lambda p: p @ [[1, 0.3], [0, 0]] + [0, 100], "all points lie on one line"),
        (lambda p: np.where(np.arange(68)[:, None] < 63, np.nan, p), "at least 6 points .* got 5"),
        (lambda p: np.full_like(p, np.nan), "all rows are NaN"),
        (lambda p: np.where(p == p[3], np.inf, p), "infinity in row 3"),
        (lambda p: p[17:], "got 51"),
        (lambda p: np.c_[p, p], r"got \(68, 4\)"),
    ],
)
def test_mistakes_are_refused(face, mistake, message, degrees):
    with pytest.raises(ValueError, match=message):
        check_landmarks(mistake(rolled(face, degrees)), SHAPE)


def test_mistakes_are_seen_with_points_missing(face):
    for rows in (slice(0, 17), slice(17, 48), slice(36, 68)):
        points = face.copy()
        points[rows] = np.nan
        assert check_landmarks(points, SHAPE) == []
        with pytest.raises(ValueError, match="left and right are mirrored"):
            check_landmarks(exchanged(points), SHAPE)


@pytest.mark.parametrize("part", ["brows", "nostrils", "eyes", "outer lips", "inner lips"])
def test_a_part_with_its_sides_exchanged_is_doubted(face, part):
    rows = [name == part for name in frontal_layout().parts]
    face[rows] = exchanged(face)[rows]
    assert f"landmarks of the {part}: left and right seem to be exchanged" in check_landmarks(face)


@pytest.mark.parametrize("degrees", [-40, 0, 40])
@pytest.mark.parametrize(
    ("first", "last"), [(17, 21), (22, 26), (27, 30), (49, 53), (48, 54), (55, 59), (61, 63), (60, 64), (65, 67)]
)
def test_one_row_backwards_is_named(face, first, last, degrees):
    points = rolled(face, degrees)
    points[first : last + 1] = points[first : last + 1][::-1]
    named = {48: "points 49-53", 60: "points 61-63"}.get(first, f"points {first}-{last}")
    (doubt,) = check_landmarks(points)
    assert f"{named} run backwards" in doubt


@pytest.mark.parametrize(
    ("ring", "name"),
    [((36, 41, 40, 39, 38, 37), "right eye"), ((42, 47, 46, 45, 44, 43), "left eye")]
    + [((48, *range(59, 48, -1)), "outer lips")],
)
def test_a_ring_the_other_way_round_is_named(face, ring, name):
    face[sorted(ring)] = face[list(ring)]
    assert f"landmarks of the {name}: upper and lower points seem to be exchanged" in check_landmarks(face)


def test_halves_exchanged_are_named(face):
    """The blocks of the two brows and eyes, which keep their inner order, and the halves of the mouth."""
    for part, order in {
        "brows": [*range(22, 27), *range(17, 22)],
        "eyes": [*range(42, 48), *range(36, 42)],
        "outer lips": [54, 53, 52, 51, 50, 49, 48, 59, 58, 57, 56, 55],
    }.items():
        points = face.copy()
        points[sorted(order)] = face[order]
        assert f"landmarks of the {part}: left and right seem to be exchanged" in check_landmarks(points)


def test_a_jaw_with_its_sides_exchanged_is_refused(face):
    """It holds so much of the spread that no face is left, or a left-handed one."""
    with pytest.raises(ValueError, match="mirrored|y points up|do not form one"):
        check_landmarks(np.concatenate([face[16::-1], face[17:]]))


def test_places_that_are_doubted(face):
    low, high = face.min(axis=0), face.max(axis=0)
    size = tuple(np.ceil(high - low)[::-1].astype(int) + 5)
    assert "1 not subtracted" in check_landmarks(face - high + [size[1] - 0.5, size[0] - 1], size)[0]
    assert "1 subtracted twice" in check_landmarks(face - low - [0.5, 0], [*size, 3])[0]
    assert "landmarks lie outside the picture" in check_landmarks(face - low - [0, 3], size)[0]
    moved = np.where(np.isin(np.arange(68), [60, 61, 62])[:, None], 0.0, face)
    assert "3 landmarks lie at (0, 0): a missing point must be a row of NaN" in check_landmarks(moved)
    assert "the face is turned by" in check_landmarks(rolled(face, 170))[0]


@pytest.mark.parametrize("yaw", [-90, -75, -60, -45, -30, 0, 30, 45, 60, 75, 90])
def test_turned_heads_are_not_refused(yaw):
    """The layout bent over a head; the misfit may raise a doubt from 45 degrees on."""
    x, y = frontal_layout().points.T
    depth = np.where(np.arange(68) < 17, -0.75 * (x / x.max()) ** 2, 0.05 - 0.2 * x**2)
    depth[27:31] = 0.1, 0.15, 0.22, 0.28
    a = np.radians(yaw)
    points = 300 * np.c_[np.cos(a) * x + np.sin(a) * depth, y] + 450
    doubts = check_landmarks(points, (900, 900))
    assert abs(yaw) > 45 or doubts == []


def test_wrong_image_shape(face):
    with pytest.raises(ValueError, match=r"image_shape: expected \(H, W\) .* got \(0, 5\)"):
        check_landmarks(face, (0, 5))


def test_points_of_the_midline_alone_fix_no_pose(face):
    midline = np.full((68, 2), np.nan)
    rows = [27, 28, 29, 30, 33, 51, 57, 62, 66, 8]
    midline[rows] = face[rows]
    with pytest.raises(ValueError, match="landmarks: expected a face, but all points lie on one line"):
        check_landmarks(midline, SHAPE)


def test_rows_of_different_lengths_are_named():
    with pytest.raises(ValueError, match="landmarks: expected 68 rows of x and y, got rows of different lengths"):
        check_landmarks([[1.0, 2.0]] * 67 + [[1.0]])
