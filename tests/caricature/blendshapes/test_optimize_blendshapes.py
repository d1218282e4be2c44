from itertools import product

import numpy as np
import pytest

from toongeo.caricature.blendshapes.optimize_blendshapes import (
    BlendshapeWeights,
    displacement_masks,
    expression_similarities,
    optimize_blendshapes,
    signed_graph,
    squared_laplacian,
)
from toongeo.caricature.blendshapes.restore_similarities import restore_similarities


@pytest.fixture
def task(mesh, rng):
    """Smooth motions of a ball, each of one half of it, for a caricature and its normal face."""
    V, F = mesh
    directions = rng.normal(size=(5, 3))
    normal = np.stack([np.maximum(V @ d, 0)[:, None] * rng.normal(size=3) for d in directions])
    return normal * 1.5 + 0.05 * np.sin(3 * V), normal, V, F


def energy(best, D, D_normal, V, F, weights):
    """Eq. 7, 9 (signed), 10 and 11, written as they stand."""
    K = squared_laplacian(V, F, weights.reach)
    masks, c, k = displacement_masks(D_normal, weights.saturation), expression_similarities(D_normal), len(D)
    off = best - masks[:, :, None] * D
    deformation = sum(np.sum(x * (K @ x)) for x in off)
    smoothness = sum(np.sum(x * (K @ x)) for x in best)
    pairs = product(range(k), range(k))
    structure = sum(abs(c[i, j]) * np.sum((best[i] - np.sign(c[i, j]) * best[j]) ** 2) for i, j in pairs if i != j)
    return weights.deformation * deformation + weights.structure * structure / (k - 1) + weights.smoothness * smoothness


@pytest.mark.parametrize(
    "weights", [BlendshapeWeights(), BlendshapeWeights(reach=1.0), BlendshapeWeights(1, 3, 0.2, 1)]
)
def test_the_result_is_the_minimum(task, rng, weights):
    """Along any direction the energy is a parabola with its vertex at D*, for vertices that move at all."""
    best = optimize_blendshapes(*task, weights)
    free = (displacement_masks(task[1]).max(axis=0) > 0)[None, :, None]
    at = energy(best, *task, weights)
    for _ in range(3):
        step = rng.normal(size=best.shape) * free
        ahead, behind = (energy(best + sign * step, *task, weights) for sign in (1, -1))
        assert ahead > at and behind > at
        assert abs(ahead - behind) < 1e-8 * (ahead + behind)  # the slope
        half = energy(best + 0.5 * step, *task, weights)
        assert (half - at) / (ahead - at) == pytest.approx(0.25, rel=1e-6)


def test_it_equals_a_dense_solution(task):
    D, D_normal, V, F = task
    weights = BlendshapeWeights(reach=2.0)
    masks = displacement_masks(D_normal)
    moving = masks.max(axis=0) > 0
    K = squared_laplacian(V, F, weights.reach).toarray()
    G = weights.structure * signed_graph(expression_similarities(D_normal))
    A = np.kron(np.eye(len(D)), (1 + weights.smoothness) * K[np.ix_(moving, moving)]) + np.kron(G, np.eye(moving.sum()))
    right = np.stack([(K @ (m[:, None] * d))[moving] for m, d in zip(masks, D, strict=True)]).reshape(-1, 3)
    dense = np.linalg.solve(A, right).reshape(len(D), -1, 3)
    np.testing.assert_allclose(optimize_blendshapes(D, D_normal, V, F, weights)[:, moving], dense, atol=1e-6)


def test_the_signed_energy_is_bounded_and_the_printed_one_is_not(rng):
    for _ in range(20):
        c = expression_similarities(rng.normal(size=(7, 4, 3)))
        assert np.linalg.eigvalsh(signed_graph(c)).min() > -1e-12
    opposite = np.array([[1.0, -0.8], [-0.8, 1.0]])
    printed = np.diag(opposite.sum(1) - 1) - (opposite - np.eye(2))
    assert np.linalg.eigvalsh(printed).min() < 0 <= np.linalg.eigvalsh(signed_graph(opposite)).min() + 1e-15


def test_the_signed_energy_is_the_printed_one_where_cosines_are_positive(rng):
    D = rng.normal(size=(4, 6, 3))
    c = np.abs(expression_similarities(rng.normal(size=(4, 6, 3))))
    printed = sum(c[i, j] * np.sum((D[i] - D[j]) ** 2) for i in range(4) for j in range(4)) / 3
    flat = D.reshape(4, -1)
    assert np.trace(flat.T @ signed_graph(c) @ flat) == pytest.approx(printed)


def test_a_multiple_of_the_input_gives_the_same_multiple(task):
    D, D_normal, V, F = task
    weights = BlendshapeWeights(reach=1.0)
    once, seven = (optimize_blendshapes(factor * D, D_normal, V, F, weights) for factor in (1, 7))
    np.testing.assert_allclose(seven, 7 * once, atol=1e-7)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_unit_changes_nothing(task, scale):
    D, D_normal, V, F = task
    weights = BlendshapeWeights(reach=1.0, softness=0.1)
    scaled = BlendshapeWeights(reach=scale, softness=0.1 * scale)
    np.testing.assert_allclose(
        optimize_blendshapes(scale * D, scale * D_normal, scale * V, F, scaled),
        scale * optimize_blendshapes(D, D_normal, V, F, weights),
        atol=1e-6 * scale,
    )


def test_expressions_that_move_nothing_are_left_out(task):
    D, D_normal, V, F = task
    still = np.concatenate([D_normal, np.zeros_like(D_normal[:1])])
    found = optimize_blendshapes(np.concatenate([D, np.ones_like(D[:1])]), still, V, F)
    np.testing.assert_array_equal(found[-1], 0.0)
    np.testing.assert_allclose(found[:-1], optimize_blendshapes(D, D_normal, V, F), atol=1e-9)
    c = expression_similarities(still)
    assert np.isfinite(c).all() and not c[-1].any()


def test_vertices_that_no_expression_moves_are_held(task):
    D, D_normal, V, F = task
    D_normal = D_normal * (V[:, 2] > 0)[:, None]
    found = optimize_blendshapes(D, D_normal, V, F)
    np.testing.assert_array_equal(found[:, V[:, 2] <= 0], 0.0)


def test_masks():
    D = np.zeros((2, 3, 3))
    D[0, :, 0] = 0.0, 1.0, 4.0
    np.testing.assert_allclose(displacement_masks(D), [[0, 0.25, 1], [0, 0, 0]])
    np.testing.assert_allclose(displacement_masks(D, 0.5), [[0, 0.5, 1], [0, 0, 0]])


def test_a_normal_face_keeps_its_shapes(face_space):
    """|D* - M D| below 25 %, more than 85 % of the peak, over the expressions of the template."""
    model, at = face_space.model, face_space.vertices
    D = model.expression[: model.n_named, at].astype(float)
    masks = displacement_masks(D)
    acting = masks.max(axis=1) > 0
    wanted = (masks[:, :, None] * D)[acting]
    found = optimize_blendshapes(D, D, model.mean[at], face_space.space.faces)[acting]
    off = np.linalg.norm(found - wanted, axis=(1, 2)) / np.linalg.norm(wanted, axis=(1, 2))
    peak = np.linalg.norm(found, axis=2).max(axis=1) / np.linalg.norm(wanted, axis=2).max(axis=1)
    assert off.mean() < 0.25 and peak.mean() > 0.85
    assert [model.expression_names[k] for k in np.flatnonzero(~acting)] == ["tongueOut"]


def test_similarities_are_restored_by_the_nearest_shapes(rng):
    D, normal = rng.normal(size=(4, 9, 3)), rng.normal(size=(4, 9, 3))
    D[3] = 0.0
    found = restore_similarities(D, normal)
    np.testing.assert_allclose(
        expression_similarities(found)[:3, :3], expression_similarities(normal)[:3, :3], atol=1e-9
    )
    np.testing.assert_allclose(np.linalg.norm(found, axis=(1, 2)), np.linalg.norm(D, axis=(1, 2)))
    np.testing.assert_array_equal(found[3], 0.0)
    np.testing.assert_allclose(restore_similarities(D, D), D, atol=1e-9)
    # Turning all shapes among themselves keeps the cosines, and leads farther away.
    sizes = np.linalg.norm(D[:3], axis=(1, 2))[:, None]
    unit, best = D[:3].reshape(3, -1) / sizes, found[:3].reshape(3, -1) / sizes
    for _ in range(5):
        rotation = np.linalg.qr(rng.normal(size=(27, 27)))[0]
        assert np.sum((best @ rotation - unit) ** 2) > np.sum((best - unit) ** 2)


def test_bad_input_is_refused(task):
    D, D_normal, V, F = task
    with pytest.raises(ValueError, match=r"D: expected shape \(k, \d+, 3\) with k >= 2"):
        optimize_blendshapes(D[:1], D_normal[:1], V, F)
    with pytest.raises(ValueError, match=r"D_normal: expected shape \(k, \d+, 3\) with k >= 2"):
        optimize_blendshapes(D, D_normal[:, :-1], V, F)
    with pytest.raises(ValueError, match="D_normal: expected the shape of D"):
        optimize_blendshapes(D, D_normal[:-1], V, F)
    broken = D.copy()
    broken[0, 0, 0] = np.nan
    with pytest.raises(ValueError, match="D: expected finite numbers"):
        optimize_blendshapes(broken, D_normal, V, F)
    with pytest.raises(ValueError, match="D_normal: expected an expression that moves a vertex"):
        optimize_blendshapes(D, np.zeros_like(D), V, F)
    with pytest.raises(ValueError, match="F"):
        optimize_blendshapes(D, D_normal, V, F + 1)
    with pytest.raises(ValueError, match="D_normal: expected the shape of D"):
        restore_similarities(D, D_normal[:-1])
    with pytest.raises(ValueError, match="D: expected finite numbers"):
        restore_similarities(broken, D_normal)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"structure": -1.0}, "structure: expected a finite number >= 0, got -1"),
        ({"deformation": 0.0}, "deformation: expected a finite number > 0, got 0"),
        ({"reach": np.inf}, "reach: expected a finite number > 0, got inf"),
        ({"saturation": 1.5}, r"saturation: expected a number in \(0, 1\], got 1.5"),
    ],
)
def test_bad_weights_are_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        BlendshapeWeights(**changes)
