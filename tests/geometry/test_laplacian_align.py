"""Laplacian alignment, once and prefactored: every law is tested on both."""

import copy
import pickle

import numpy as np
import pytest

from toongeo.geometry.laplacian_align import laplacian_align
from toongeo.geometry.laplacian_aligner import LaplacianAligner
from toongeo.geometry.operators.cotangent_laplacian import cotangent_laplacian
from toongeo.geometry.operators.uniform_laplacian import uniform_laplacian

ANCHORS = np.array([3, 40, 77, 120, 200, 301])


def prefactored(V, F, anchors, targets, **options):
    return LaplacianAligner(V, F, anchors, **options).align(targets)


@pytest.fixture(params=[laplacian_align, prefactored], ids=["once", "prefactored"])
def align(request):
    return request.param


@pytest.fixture(params=["uniform", "cotangent"])
def laplacian(request):
    return request.param


@pytest.fixture
def targets(bumpy):
    return bumpy[0][ANCHORS] + np.random.default_rng(1).normal(0, 0.1, (len(ANCHORS), 3))


def dense_minimiser(V, F, anchors, targets, weight, laplacian):
    """Least squares on the stacked system of Eq. 10."""
    if laplacian == "uniform":
        L = uniform_laplacian(F, len(V)).toarray()
    else:
        C = cotangent_laplacian(V, F, clamp=1e-2).toarray()
        L = C / np.diag(C)[:, None]
    root = np.sqrt(np.broadcast_to(weight, len(anchors)))[:, None]
    A = np.concatenate([L, root * np.eye(len(V))[anchors]])
    return np.linalg.lstsq(A, np.concatenate([L @ V, root * targets]), rcond=None)[0]


@pytest.mark.parametrize("weight", [0.1, 1.0, 1e3, [0.5, 2, 1, 1e2, 3, 7]])
def test_is_the_dense_least_squares_solution(align, bumpy, targets, weight, laplacian):
    V, F = bumpy
    expected = dense_minimiser(V, F, ANCHORS, targets, weight, laplacian)
    result = align(V, F, ANCHORS, targets, weight=weight, laplacian=laplacian)
    np.testing.assert_allclose(result, expected, atol=1e-10)


@pytest.mark.parametrize("weight", [1e3, 1e6, 1e9, 1e12])
def test_heavy_anchors_are_reached_and_the_limit_is_interpolation(align, bumpy, targets, weight):
    V, F = bumpy
    L = uniform_laplacian(F, len(V)).toarray()
    free = np.setdiff1d(np.arange(len(V)), ANCHORS)
    limit = V.copy()
    limit[ANCHORS] = targets
    limit[free] += np.linalg.lstsq(L[:, free], -L[:, ANCHORS] @ (targets - V[ANCHORS]), rcond=None)[0]
    result = align(V, F, ANCHORS, targets, weight=weight)
    moved = np.abs(targets - V[ANCHORS]).max()
    assert np.abs(result[ANCHORS] - targets).max() < 0.5 * moved / weight + 1e-14
    assert np.abs(result - limit).max() < moved / weight + 1e-11


@pytest.mark.parametrize("weight", [1e-3, 1e3, 1e6])
def test_a_fine_mesh_is_well_conditioned(fine, laplacian, weight):
    V, F = fine
    rng = np.random.default_rng(4)
    anchors = rng.choice(len(V), 68, replace=False)
    t = np.array([100.0, -50, 20])
    aligner = LaplacianAligner(V, F, anchors, weight=weight, laplacian=laplacian)
    assert np.abs(aligner.align(V[anchors] + t) - V - t).max() < 1e-7
    targets = V[anchors] + rng.normal(0, 10, (68, 3))
    once = laplacian_align(V, F, anchors, targets, weight=weight, laplacian=laplacian)
    np.testing.assert_allclose(aligner.align(targets), once, rtol=0, atol=1e-7)
    if weight >= 1e3:
        displacement = np.linalg.norm(targets - V[anchors], axis=1).max()
        assert np.linalg.norm(once[anchors] - targets, axis=1).max() < displacement / weight


def test_targets_at_rest_change_nothing(align, bumpy, laplacian):
    V, F = bumpy
    np.testing.assert_array_equal(align(V, F, ANCHORS, V[ANCHORS], laplacian=laplacian), V)


@pytest.mark.parametrize("anchors", [ANCHORS, ANCHORS[:1]])
def test_translated_targets_translate_the_mesh(align, bumpy, anchors, laplacian):
    V, F = bumpy
    t = np.array([1.0, -2, 3])
    result = align(V, F, anchors, V[anchors] + t, laplacian=laplacian)
    np.testing.assert_allclose(result, V + t, atol=1e-9)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_follows_a_rigid_motion_and_scale_of_mesh_and_targets(align, bumpy, targets, rotation, laplacian, scale):
    V, F = bumpy
    t = np.array([5.0, 1, -2])
    expected = scale * (align(V, F, ANCHORS, targets, laplacian=laplacian) @ rotation.T + t)
    move = lambda X: scale * (X @ rotation.T + t)  # noqa: E731
    result = align(move(V), F, ANCHORS, move(targets), laplacian=laplacian)
    np.testing.assert_allclose(result, expected, rtol=0, atol=1e-9 * scale)


def test_closed_form_on_a_tetrahedron(align):
    # L = (4 I - J) / 3 and L^T L = (16 I - 4 J) / 9, so one anchor pair moved apart by +-d ends where
    # 16/9 x = weight (d - x).
    V = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    F = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    d, weight = np.array([0.0, 0, 0.5]), 4.0
    result = align(V, F, [0, 1], [V[0] + d, V[1] - d], weight=weight)
    x = weight * d / (16 / 9 + weight)
    np.testing.assert_allclose(result, V + np.array([x, -x, 0 * x, 0 * x]), atol=1e-14)


def test_a_component_without_an_anchor_stays(align, two_parts, laplacian):
    V, F = two_parts
    half = (len(V) - 1) // 2
    result = align(V, F, ANCHORS, V[ANCHORS] + 1.0, laplacian=laplacian)
    np.testing.assert_array_equal(result[half:], V[half:])
    assert np.abs(result[:half] - V[:half] - 1).max() < 1e-9


def test_a_lonely_vertex_follows_its_own_anchor(align, two_parts):
    V, F = two_parts
    weight = 3.0
    result = align(V, F, [3, len(V) - 1], [V[3], [0.0, 0, 0]], weight=weight)
    np.testing.assert_allclose(result[-1], 0, atol=1e-13)
    np.testing.assert_array_equal(result[:-1], V[:-1])


@pytest.mark.parametrize("missing", [[2], [0, 5], [0, 1, 2, 3, 4]])
@pytest.mark.parametrize("weight", [0.5, 1e3, 1e8])
def test_a_missing_target_is_as_if_it_had_no_anchor(align, bumpy, targets, missing, weight, laplacian):
    V, F = bumpy
    holes = targets.copy()
    holes[missing, 1] = np.nan
    kept = np.setdiff1d(np.arange(6), missing)
    expected = prefactored(V, F, ANCHORS[kept], targets[kept], weight=weight, laplacian=laplacian)
    result = align(V, F, ANCHORS, holes, weight=weight, laplacian=laplacian)
    np.testing.assert_allclose(result, expected, atol=2e-10)


def test_a_component_that_loses_its_anchors_stays(align, two_parts):
    V, F = two_parts
    half = (len(V) - 1) // 2
    targets = V[[3, 40, half + 5]] + 1.0
    targets[2] = np.nan
    result = align(V, F, [3, 40, half + 5], targets)
    np.testing.assert_array_equal(result[half:], V[half:])
    assert np.abs(result[:half] - V[:half]).min() > 0.5


def test_weight_zero_is_as_missing(align, bumpy, targets):
    V, F = bumpy
    expected = prefactored(V, F, ANCHORS[1:], targets[1:])
    result = align(V, F, ANCHORS, targets, weight=[0, 1e3, 1e3, 1e3, 1e3, 1e3])
    np.testing.assert_allclose(result, expected, atol=1e-10)


def test_a_repeated_anchor_counts_twice(align, bumpy, targets):
    V, F = bumpy
    twice = np.r_[ANCHORS, ANCHORS[2]]
    expected = prefactored(V, F, ANCHORS, targets, weight=[1, 1, 2, 1, 1, 1.0])
    result = align(V, F, twice, np.r_[targets, targets[2:3]], weight=1.0)
    np.testing.assert_allclose(result, expected, atol=1e-12)
    half_missing = align(V, F, twice, np.r_[targets, [[np.nan] * 3]], weight=1.0)
    np.testing.assert_allclose(half_missing, prefactored(V, F, ANCHORS, targets, weight=1.0), atol=1e-12)


def test_the_gradient_of_the_energy_vanishes(align, bumpy, targets):
    V, F = bumpy
    L, weight = uniform_laplacian(F, len(V)), 50.0
    x = align(V, F, ANCHORS, targets, weight=weight)
    gradient = L.T @ (L @ (x - V))
    gradient[ANCHORS] += weight * (x[ANCHORS] - targets)
    assert np.abs(gradient).max() < 1e-10


def test_degenerate_triangles_are_no_obstacle(align, bumpy, targets, laplacian):
    V, F = bumpy
    V = V.copy()
    V[F[10, 1]] = V[F[10, 0]]  # a whole edge collapses
    result = align(V, F, ANCHORS, targets, laplacian=laplacian)
    assert np.isfinite(result).all()
    assert np.abs(result[ANCHORS] - targets).max() < 1e-3


def test_another_rest_shape_of_the_same_topology(bumpy, sphere, targets):
    V, F = bumpy
    aligner = LaplacianAligner(V, F, ANCHORS)
    expected = LaplacianAligner(sphere[0], F, ANCHORS).align(targets)
    np.testing.assert_allclose(aligner.align(targets, V=sphere[0]), expected, atol=1e-14)
    np.testing.assert_array_equal(aligner(targets), aligner.align(targets))


def test_arguments_are_not_written_to(align, bumpy, targets):
    V, F = bumpy
    copies = [a.copy() for a in (V, F, ANCHORS, targets)]
    align(V, F, ANCHORS, targets)
    for before, after in zip(copies, (V, F, ANCHORS, targets), strict=True):
        np.testing.assert_array_equal(before, after)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"V": np.zeros((3, 2))}, r"V: expected real numbers of shape \(n, 3\)"),
        ({"V": np.full((386, 3), np.nan)}, "V: expected finite coordinates"),
        ({"F": [[0, 1, 386]]}, r"F: expected indices in 0\.\.385, got 386"),
        ({"anchors": [3, 386]}, r"anchors: expected vertex indices in 0\.\.385, got 386"),
        ({"anchors": [-1, 3]}, "anchors: expected vertex indices .* got -1"),
        ({"anchors": []}, r"anchors: expected integers of shape \(k,\), k >= 1"),
        ({"anchors": [[3, 4]]}, r"anchors: expected integers of shape \(k,\)"),
        ({"anchors": [3.0, 4.0]}, "anchors: expected integers"),
        ({"anchors": [3, 3]}, r"different ones for vertex 3 \(rows \[0, 1\]\)"),
        ({"weight": -1.0}, r"weight: expected numbers >= 0 \(infinity: met exactly\), got -1\.0"),
        ({"weight": [1.0, np.nan]}, r"weight: expected numbers >= 0 .*, got nan"),
        ({"weight": [1.0, 1, 1]}, r"weight: expected a number or shape \(2,\), got shape \(3,\)"),
        ({"weight": 0.0}, "weight: expected an anchor with a weight above 0"),
        ({"laplacian": "graph"}, "laplacian: expected 'uniform' or 'cotangent', got 'graph'"),
        ({"targets": np.zeros((3, 3))}, r"targets: expected shape \(2, 3\), a row an anchor, got \(3, 3\)"),
        ({"targets": np.full((2, 3), np.nan)}, "targets: expected at least one row without NaN"),
        ({"targets": [[0, 0, 0], [0, np.inf, 0]]}, "targets: expected finite or NaN .* row 1"),
    ],
)
def test_bad_input_is_named(align, bumpy, change, message):
    arguments = {"V": bumpy[0], "F": bumpy[1], "anchors": [3, 4], "targets": np.eye(3)[:2]} | change
    with pytest.raises(ValueError, match=message):
        align(**arguments)


def test_missing_targets_and_zero_weights_may_not_leave_nothing(align, bumpy):
    V, F = bumpy
    with pytest.raises(ValueError, match="weight: expected a target with a weight above 0"):
        align(V, F, [3, 4], [[np.nan] * 3, [0, 0, 0]], weight=[1.0, 0.0])


def test_the_rest_shape_is_checked(bumpy):
    V, F = bumpy
    aligner = LaplacianAligner(V, F, ANCHORS)
    with pytest.raises(ValueError, match=r"V: expected shape \(386, 3\) as at construction, got \(385, 3\)"):
        aligner.align(V[ANCHORS], V=V[1:])


def bar(n=24, w=3):
    """A closed box of n x w x w squares, each of side 1, along x."""
    corners = np.array([(x, y, z) for x in range(n + 1) for y in range(w + 1) for z in range(w + 1)])
    number = {tuple(c): i for i, c in enumerate(corners)}
    F = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        size = (n, w, w)
        for i in range(size[a]):
            for j in range(size[b]):
                for end in (0, size[axis]):
                    square = np.zeros((4, 3), int)
                    square[:, axis], square[:, a], square[:, b] = end, [i, i + 1, i + 1, i], [j, j, j + 1, j + 1]
                    p, q, r, s = (number[tuple(c)] for c in (square if end else square[::-1]))
                    F += [[p, q, r], [p, r, s]]
    used, local = np.unique(F, return_inverse=True)
    return corners[used].astype(float), local.reshape(-1, 3)


def edge_strain(V, F, moved):
    i, j = F.ravel(), np.roll(F, -1, axis=1).ravel()
    lengths = [np.linalg.norm(X[i] - X[j], axis=1) for X in (V, moved)]
    return np.abs(lengths[1] / lengths[0] - 1)


@pytest.mark.parametrize("weight", [np.inf, [np.inf, 1.0, np.inf, 5, 2, np.inf]])
def test_hard_anchors_are_met_exactly_and_the_soft_limit_tends_to_them(align, bumpy, targets, weight, laplacian):
    V, F = bumpy
    hard = np.isinf(np.broadcast_to(weight, 6))
    result = align(V, F, ANCHORS, targets, weight=weight, laplacian=laplacian)
    np.testing.assert_array_equal(result[ANCHORS[hard]], targets[hard])
    near = np.where(hard, 1e9, np.broadcast_to(weight, 6))
    np.testing.assert_allclose(result, align(V, F, ANCHORS, targets, weight=near, laplacian=laplacian), atol=1e-8)


@pytest.mark.parametrize("form", ["mask", "indices"])
def test_fixed_vertices_stay_bit_for_bit_and_are_anchors_at_rest(align, bumpy, targets, form, laplacian):
    V, F = bumpy
    still = np.array([7, 90, 91, 250])
    fixed = np.isin(np.arange(len(V)), still) if form == "mask" else still
    result = align(V, F, ANCHORS, targets, fixed=fixed, laplacian=laplacian)
    np.testing.assert_array_equal(result[still], V[still])
    weight = np.r_[np.full(6, 1e3), np.full(4, np.inf)]
    expected = align(V, F, np.r_[ANCHORS, still], np.r_[targets, V[still]], weight=weight, laplacian=laplacian)
    np.testing.assert_allclose(result, expected, atol=1e-10)


def test_fixed_vertices_hold_a_component_that_loses_its_anchor(align, two_parts):
    V, F = two_parts
    half = (len(V) - 1) // 2
    targets = np.array([V[3] + 1, [np.nan] * 3])
    result = align(V, F, [3, half + 5], targets, fixed=[half + 9])
    np.testing.assert_array_equal(result[half:], V[half:])


def test_a_bar_bends_where_plain_coordinates_shear(align, laplacian):
    """A right angle strains the sides by half their width over the radius, and no more than twice that is allowed."""
    V, F = bar()
    length, angle = V[:, 0].max(), np.pi / 2
    ends = [np.flatnonzero(V[:, 0] < 1.5), np.flatnonzero(V[:, 0] > length - 1.5)]
    radius = length / angle
    R = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    pivot = np.array([length, 1.5, 1.5])
    targets = (V[ends[1]] - pivot) @ R.T + [radius, radius + 1.5, 1.5]
    sheared, turned = (
        align_rotated(align, V, F, ends[1], targets, r, weight=np.inf, fixed=ends[0], laplacian=laplacian)
        for r in (0, 10)
    )
    np.testing.assert_array_equal(turned[ends[0]], V[ends[0]])
    np.testing.assert_array_equal(turned[ends[1]], targets)
    assert edge_strain(V, F, sheared).max() > 0.5
    assert edge_strain(V, F, turned).max() < 2 * 1.5 / radius
    again = align_rotated(align, V, F, ends[1], targets, 40, weight=np.inf, fixed=ends[0], laplacian=laplacian)
    np.testing.assert_allclose(again, turned, atol=1e-2)


def align_rotated(align, V, F, anchors, targets, rotations, **options):
    if align is prefactored:
        return LaplacianAligner(V, F, anchors, **options).align(targets, rotations=rotations)
    return align(V, F, anchors, targets, rotations=rotations, **options)


@pytest.mark.parametrize("weight", [1.0, 1e3, np.inf])
def test_turned_targets_turn_the_mesh(align, bumpy, rotation, weight, laplacian):
    V, F = bumpy
    moved = V @ rotation.T + [1, 2, 3]
    result = align_rotated(align, V, F, ANCHORS, moved[ANCHORS], 400, weight=weight, laplacian=laplacian)
    np.testing.assert_allclose(result, moved, atol=1e-6)


@pytest.mark.parametrize("weight", [0.5, 1e3, [np.inf, 1, 2, 3, 1, 1]])
def test_both_forms_agree_on_rotations(bumpy, targets, weight, laplacian):
    V, F = bumpy
    holes = targets.copy()
    holes[4] = np.nan
    options = {"weight": weight, "laplacian": laplacian, "fixed": [7, 8]}
    once, again = (align_rotated(f, V, F, ANCHORS, holes, 5, **options) for f in (laplacian_align, prefactored))
    np.testing.assert_allclose(once, again, atol=1e-9)


def test_rotations_follow_a_rigid_motion_and_scale(align, bumpy, targets, rotation, laplacian):
    V, F = bumpy
    move = lambda X: 3.0 * (X @ rotation.T + [5, 1, -2])  # noqa: E731
    expected = move(align_rotated(align, V, F, ANCHORS, targets, 4, laplacian=laplacian))
    result = align_rotated(align, move(V), F, ANCHORS, move(targets), 4, laplacian=laplacian)
    np.testing.assert_allclose(result, expected, rtol=0, atol=1e-8)


def test_a_loose_part_follows_rigidly(align, two_parts, rotation):
    V, F = two_parts
    half = (len(V) - 1) // 2
    every = np.arange(half)
    moved = V @ rotation.T + [1, 2, 3]
    result = align(V, F, every, moved[:half], weight=np.inf, loose="follow")
    np.testing.assert_allclose(result[:-1], moved[:-1], atol=1e-7)  # the last vertex has but one next to it
    shifted = align(V, F, [3], V[[3]] + [4, 5, 6], loose="follow")
    np.testing.assert_allclose(shifted, V + [4, 5, 6], atol=1e-7)


def test_what_is_fixed_does_not_follow(align, two_parts):
    V, F = two_parts
    half = (len(V) - 1) // 2
    result = align(V, F, [3], V[[3]] + 1, fixed=[half + 2, len(V) - 1], loose="follow")
    np.testing.assert_array_equal(result[half:], V[half:])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"fixed": [386]}, r"fixed: expected vertex indices in 0\.\.385, got 386"),
        ({"fixed": [0.5]}, r"fixed: expected a mask \(386,\) or vertex indices \(k,\), got float64 \(1,\)"),
        ({"fixed": np.ones(5, bool)}, r"fixed: expected a mask \(386,\) .* got bool \(5,\)"),
        ({"fixed": [2, 4]}, "fixed: expected no anchor among the fixed vertices, got 4"),
        ({"loose": "drop"}, "loose: expected 'stay' or 'follow', got 'drop'"),
    ],
)
def test_bad_options_are_named(align, bumpy, change, message):
    with pytest.raises(ValueError, match=message):
        align(bumpy[0], bumpy[1], [3, 4], np.eye(3)[:2], **change)


@pytest.mark.parametrize("rotations", [-1, 2.0, True])
def test_rotations_are_counted(align, bumpy, rotations):
    with pytest.raises(ValueError, match=r"rotations: expected an integer >= 0, got"):
        align_rotated(align, *bumpy, [3, 4], np.eye(3)[:2], rotations)


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])
@pytest.mark.parametrize("rotations", [0, 2])
def test_copies_and_pickles_give_the_same(bumpy, targets, copied, rotations):
    aligner = LaplacianAligner(*bumpy, ANCHORS)
    expected = aligner.align(targets, rotations=rotations)
    np.testing.assert_array_equal(copied(aligner).align(targets, rotations=rotations), expected)
