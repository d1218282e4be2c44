import cv2
import numpy as np
import pytest

from toongeo.render import Fragments, interpolate, rasterize, uv_to_px


@pytest.fixture(params=["OpenCV", "z-buffer"], autouse=True)
def way(request, monkeypatch):
    """Every test holds with OpenCV's rasterizer and without it."""
    if request.param == "z-buffer":
        monkeypatch.delattr(cv2, "triangleRasterizeColor", raising=False)
    elif not hasattr(cv2, "triangleRasterizeColor"):
        pytest.skip("this OpenCV has no rasterizer")


def slow_reference(points, F, height, width, cull_back=False):
    """Nearest face per pixel in float64, and whether a rounding error may decide otherwise."""
    y, x = np.mgrid[:height, :width]
    ids, doubtful = np.full((height, width), -1), np.zeros((height, width), bool)
    best, second = np.full((height, width), -np.inf), np.full((height, width), -np.inf)
    for face, (a, b, c) in enumerate(points[F]):
        (ux, uy), (vx, vy), qx, qy = (b - a)[:2], (c - a)[:2], x - a[0], y - a[1]
        area = ux * vy - uy * vx
        if abs(area) < 1e-9 or (cull_back and area > 0.0):
            continue
        w1, w2 = (qx * vy - qy * vx) / area, (ux * qy - uy * qx) / area
        weights = np.stack([1.0 - w1 - w2, w1, w2])
        sides = np.array([np.hypot(*(v - u)[:2]) for u, v in ((b, c), (a, c), (a, b))])
        distance = (weights * (abs(area) / sides)[:, None, None]).min(axis=0)  # to an edge, < 0 outside
        doubtful |= np.abs(distance) < 5e-4
        inside = weights.min(axis=0) >= 0.0
        z = np.where(inside, np.tensordot([a[2], b[2], c[2]], weights, 1), -np.inf)
        second = np.maximum(second, np.minimum(best, z))
        ids[z > best] = face
        best = np.maximum(best, z)
    several = np.isfinite(second)
    doubtful[several] |= best[several] - second[several] < 1e-5 * np.ptp(points[:, 2])
    return ids, doubtful


def triangle_soup(rng, count, size, spread):
    middle = rng.uniform(-0.3 * size, 1.3 * size, (count, 1, 2))
    xy = middle + rng.normal(scale=spread, size=(count, 3, 2))
    z = rng.normal(scale=40.0, size=(count, 3, 1))
    return np.concatenate([xy, z], axis=2).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def grid(count, step, slope=0.0):
    y, x = np.mgrid[:count, :count] * float(step)
    points = np.column_stack([x.ravel(), y.ravel(), slope * (x + 0.3 * y).ravel()])
    index = np.arange(count * count).reshape(count, count)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return points, np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


@pytest.mark.parametrize("cull_back", [False, True])
@pytest.mark.parametrize(("spread", "count"), [(1.0, 3000), (6.0, 300), (40.0, 60), (400.0, 20)])
def test_agrees_with_a_slow_float64_reference(spread, count, cull_back):
    # interpenetrating triangles of both windings, some partly and some wholly outside
    height, width = 70, 100
    points, F = triangle_soup(np.random.default_rng(count), count, 100, spread)
    ids, doubtful = slow_reference(points, F, height, width, cull_back)
    found = rasterize(points, F, height, width, cull_back=cull_back).face_ids
    assert doubtful.mean() < 0.01
    assert (found[~doubtful] == ids[~doubtful]).all()
    assert (ids >= 0).mean() > 0.02


def test_agrees_with_the_reference_on_a_closed_mesh():
    # a dense sphere whose silhouette grazes many faces
    u, v = np.mgrid[:25, :48] * np.array([np.pi / 24, 2 * np.pi / 48])[:, None, None]
    points = np.stack([np.sin(u) * np.cos(v), np.cos(u), np.sin(u) * np.sin(v)], -1).reshape(-1, 3)
    index = np.arange(25 * 48).reshape(25, 48)
    a, b, c, d = index[:-1], np.roll(index, -1, 1)[:-1], np.roll(index, -1, 1)[1:], index[1:]
    F = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    turn = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]
    points = points @ turn * [33.3, 33.3, 80.0] + [40.2, 37.7, 0.0]
    ids, doubtful = slow_reference(points, F, 80, 80)
    found = rasterize(points, F, 80, 80).face_ids
    assert doubtful.mean() < 0.01
    assert (found[~doubtful] == ids[~doubtful]).all()


def test_pixel_centres_are_integers():
    around = np.array([[-0.4, -0.3], [0.4, -0.3], [0.0, 0.5]])
    for column, row in [(0, 0), (3, 2), (6, 4)]:
        ids = rasterize(around + np.array([column, row]), [[0, 1, 2]], 5, 7).face_ids
        assert np.argwhere(ids == 0).tolist() == [[row, column]]
    between = around * 0.9 + 0.5
    assert (rasterize(between + 2.0, [[0, 1, 2]], 5, 7).face_ids == -1).all()


@pytest.mark.parametrize("slope", [0.0, 0.7])
@pytest.mark.parametrize(("count", "step"), [(30, 1), (20, 3), (40, 7), (60, 5), (30, 7.5), (50, 1 / 3)])
def test_no_cracks_where_edges_run_through_pixel_centres(count, step, slope):
    points, F = grid(count, step, slope)
    size = int((count - 1) * step + 1e-9) + 1
    assert rasterize(points, F, size, size).mask.all()


def test_barycentrics_reproduce_the_pixel():
    rng = np.random.default_rng(3)
    points, F = triangle_soup(rng, 200, 60, 15.0)
    fragments = rasterize(points, F, 60, 60)
    weights = fragments.barycentrics
    assert (weights >= 0.0).all()
    np.testing.assert_allclose(weights.sum(axis=2), fragments.mask, atol=1e-6)
    place = interpolate(fragments, F, points[:, :2])
    y, x = np.nonzero(fragments.mask)
    np.testing.assert_allclose(place[y, x], np.column_stack([x, y]), atol=2e-4)


def test_nearer_means_larger_depth_and_the_lower_row_wins_a_tie():
    points = np.array([[0, 0, 1.0], [9, 0, 1], [0, 9, 1], [0, 0, 2], [9, 0, 2], [0, 9, 2]])
    assert rasterize(points, [[0, 1, 2], [3, 4, 5]], 4, 4).face_ids[1, 1] == 1
    assert rasterize(points, [[3, 4, 5], [0, 1, 2]], 4, 4).face_ids[1, 1] == 0
    assert rasterize(points[:, :2], [[3, 4, 5], [0, 1, 2]], 4, 4).face_ids[1, 1] == 0


def test_depth_is_linear_where_planes_cross():
    # two planes that cross at x = 20: perspective depth would move the line
    points = np.array([[-1, -1, 0.0], [41, -1, 42], [41, 9, 42], [-1, 9, 0]])
    crossing = points * [1, 1, -1] + [0, 0, 41.0]
    F = np.array([[0, 1, 2], [0, 2, 3]])
    ids = rasterize(np.vstack([points, crossing]), np.vstack([F, F + 4]), 8, 40).face_ids
    assert (ids[:, :19] >= 2).all()
    assert (ids[:, 20:] < 2).all()


@pytest.mark.parametrize("factor", [1e-4, 1e4])
def test_depth_unit_does_not_matter(factor):
    points, F = triangle_soup(np.random.default_rng(4), 80, 40, 12.0)
    scaled = points * [1.0, 1.0, factor]
    same = rasterize(points, F, 40, 40).face_ids == rasterize(scaled, F, 40, 40).face_ids
    assert same.mean() > 0.999


def test_shift_by_whole_pixels_shifts_the_picture():
    points, F = triangle_soup(np.random.default_rng(5), 50, 40, 8.0)
    whole = rasterize(points, F, 64, 64).face_ids
    part = rasterize(points - [10, 20, 0], F, 40, 50).face_ids
    assert (whole[20:60, 10:60] == part).mean() > 0.999


def test_culling_drops_clockwise_faces():
    points = np.array([[0.0, 0.0], [0.0, 8.0], [8.0, 0.0]])  # counter-clockwise as seen, y down
    assert rasterize(points, [[0, 1, 2]], 4, 4, cull_back=True).mask.any()
    assert not rasterize(points, [[0, 2, 1]], 4, 4, cull_back=True).mask.any()
    assert rasterize(points, [[0, 2, 1]], 4, 4).mask.any()


def test_an_atlas_is_rasterized_by_the_same_function():
    uv = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    F = [[0, 1, 2], [0, 2, 3]]
    fragments = rasterize(uv_to_px(uv, 6, 9), F, 6, 9)
    assert fragments.mask.all()
    found = interpolate(fragments, F, uv)
    row, column = np.mgrid[:6, :9]
    np.testing.assert_allclose(found[..., 0], (column + 0.5) / 9, atol=1e-6)
    np.testing.assert_allclose(found[..., 1], 1.0 - (row + 0.5) / 6, atol=1e-6)


def test_nothing_to_draw():
    nothing = rasterize(np.zeros((0, 2)), np.zeros((0, 3), int), 3, 5)
    assert (nothing.face_ids == -1).all() and nothing.barycentrics.shape == (3, 5, 3)
    assert not nothing.barycentrics.any()
    assert not rasterize([[0, 0], [1, 1]], [], 3, 5).mask.any()
    degenerate = rasterize([[0, 0], [1, 1], [2, 2]], [[0, 1, 2], [1, 1, 1], [0, 1, 1]], 3, 3)
    assert not degenerate.mask.any()
    outside = rasterize([[-9, -9], [-5, -9], [-9, -5]], [[0, 1, 2]], 3, 3)
    assert not outside.mask.any()


def test_unused_points_may_be_anything():
    points = [[0, 0, 0], [9, 0, 0], [0, 9, 0], [np.nan, np.inf, 1e30]]
    assert rasterize(points, [[0, 1, 2]], 3, 3).mask.all()


def test_one_triangle_around_the_whole_picture():
    fragments = rasterize([[-1e5, -1e5], [3e5, -1e5], [-1e5, 3e5]], [[0, 1, 2]], 50, 40)
    assert fragments.mask.all()


def test_second_run_is_bit_identical_and_arguments_are_left_alone():
    points, F = triangle_soup(np.random.default_rng(6), 300, 60, 9.0)
    before = points.copy(), F.copy()
    first, second = rasterize(points, F, 60, 60), rasterize(points, F, 60, 60)
    assert first.face_ids.tobytes() == second.face_ids.tobytes()
    assert first.barycentrics.tobytes() == second.barycentrics.tobytes()
    assert (points == before[0]).all() and np.array_equal(F, before[1])
    with pytest.raises(ValueError, match="read-only"):
        first.face_ids[0, 0] = 3


TRIANGLE = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]])


@pytest.mark.parametrize(
    ("points", "F", "height", "width", "message"),
    [
        (np.zeros((3, 4)), [[0, 1, 2]], 4, 4, "points_px: expected shape"),
        (TRIANGLE, [[0, 1]], 4, 4, r"F: expected integers of shape \(m, 3\)"),
        (TRIANGLE, [[0.0, 1.0, 2.0]], 4, 4, "F: expected integers"),
        (TRIANGLE, [[0, 1, 3]], 4, 4, r"F: expected indices in \[0, 3\), got 0 to 3"),
        (TRIANGLE, [[0, 1, -1]], 4, 4, r"F: expected indices in \[0, 3\), got -1 to 1"),
        (TRIANGLE, [[0, 1, 2]], 0, 4, "height, width: expected a positive size"),
        (TRIANGLE * [1, np.nan], [[0, 1, 2]], 4, 4, "points_px: expected finite points"),
        (TRIANGLE * 1e9, [[0, 1, 2]], 4, 4, r"points_px: expected finite points within 2\*\*20 px"),
        (np.array([[0, 0, 0], [4, 0, np.inf], [0, 4, 0]]), [[0, 1, 2]], 4, 4, "points_px: expected finite"),
    ],
)
def test_bad_input(points, F, height, width, message):
    with pytest.raises(ValueError, match=message):
        rasterize(points, F, height, width)


def test_too_many_faces():
    F = np.broadcast_to(np.array([[0, 1, 2]]), (2**24 + 1, 3))
    with pytest.raises(ValueError, match="F: expected at most 16777216 faces"):
        rasterize(TRIANGLE, F, 4, 4)


def test_bad_fragments():
    with pytest.raises(ValueError, match="barycentrics: expected shape"):
        Fragments(np.zeros((2, 2), np.int32), np.zeros((2, 3, 3), np.float32))
