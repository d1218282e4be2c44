"""Null spaces, definiteness, linear precision and closed forms of the two Laplacians."""

import numpy as np
import pytest

from toongeo.geometry.operators.cotangent_laplacian import cotangent_laplacian
from toongeo.geometry.operators.uniform_laplacian import uniform_laplacian

TETRAHEDRON = (
    np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]),
    np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]),
)


def inner(V):
    x, y = V[:, 0], V[:, 1]
    return (x > 0) & (x < 8) & (y > 0) & (y < 6)


def test_uniform_is_equation_9_vertex_by_vertex(bumpy):
    V, F = bumpy
    result = uniform_laplacian(F, len(V)) @ V
    for i in (0, 17, 200, len(V) - 1):
        ring = np.setdiff1d(F[np.isin(F, i).any(axis=1)], [i])
        np.testing.assert_allclose(result[i], (V[i] - V[ring]).sum(axis=0) / len(ring), atol=1e-14)


def test_null_spaces_are_the_components(two_parts):
    V, F = two_parts
    n, half = len(V), (len(V) - 1) // 2
    indicators = np.zeros((n, 3))
    indicators[:half, 0] = indicators[half:-1, 1] = indicators[-1, 2] = 1
    for L in (uniform_laplacian(F, n), cotangent_laplacian(V, F), cotangent_laplacian(V, F, clamp=0.01)):
        np.testing.assert_allclose(L @ indicators, 0, atol=1e-13)
        assert np.linalg.matrix_rank(L.toarray(), tol=1e-8) == n - 3


def test_uniform_eigenvalues_are_real_and_within_0_and_2(grid):
    values = np.linalg.eigvals(uniform_laplacian(grid[1], 63).toarray())
    assert np.abs(values.imag).max() < 1e-10
    assert values.real.min() > -1e-12
    assert values.real.max() < 2 + 1e-12


def test_both_annihilate_linear_functions_inside_a_flat_grid(grid):
    V, F = grid
    np.testing.assert_allclose((uniform_laplacian(F, 63) @ V)[inner(V)], 0, atol=1e-14)
    # Cotangents do so on any flat mesh, however irregular.
    rng = np.random.default_rng(0)
    jittered = V + np.where(inner(V)[:, None], rng.uniform(-0.3, 0.3, V.shape), 0) * [1, 1, 0]
    np.testing.assert_allclose((cotangent_laplacian(jittered, F) @ jittered)[inner(V)], 0, atol=1e-13)


def test_cotangent_is_symmetric_psd_and_the_dirichlet_energy(bumpy):
    V, F = bumpy
    C = cotangent_laplacian(V, F).toarray()
    np.testing.assert_array_equal(C, C.T)
    assert np.linalg.eigvalsh(C).min() > -1e-12
    f = V[:, 0] * V[:, 1] - V[:, 2]
    energy = 0.0
    for a, b, c in F:
        e1, e2 = V[b] - V[a], V[c] - V[a]
        gram = np.array([[e1 @ e1, e1 @ e2], [e1 @ e2, e2 @ e2]])
        df = np.array([f[b] - f[a], f[c] - f[a]])
        energy += 0.5 * np.sqrt(np.linalg.det(gram)) * df @ np.linalg.solve(gram, df)
    assert f @ C @ f == pytest.approx(energy, rel=1e-12)


def test_cotangent_closed_form_on_a_tetrahedron():
    # Equilateral faces: every edge has two angles of 60 degrees, weight cot 60 = 1 / sqrt 3.
    pattern = 4 * np.eye(4) - 1
    np.testing.assert_allclose(cotangent_laplacian(*TETRAHEDRON).toarray(), pattern / np.sqrt(3), atol=1e-14)
    np.testing.assert_allclose(uniform_laplacian(TETRAHEDRON[1], 4).toarray(), pattern / 3, atol=1e-15)


def cotangents_angle_by_angle(V, F, clamp=None):
    """The definition, dense."""
    W, edge = np.zeros((len(V), len(V))), np.zeros((len(V), len(V)), bool)
    for triangle in F:
        for tip, i, j in (np.roll(triangle, k) for k in range(3)):
            u, v = V[i] - V[tip], V[j] - V[tip]
            W[[i, j], [j, i]] += 0.5 * (u @ v) / np.linalg.norm(np.cross(u, v))
            edge[[i, j], [j, i]] = True
    if clamp is not None:
        W = np.where(edge, W.clip(clamp, 1 / clamp), 0.0)
    return np.diag(W.sum(axis=1)) - W


@pytest.mark.parametrize("clamp", [None, 0.01, 0.4, 1.0])
def test_cotangent_is_its_definition(bumpy, clamp):
    V, F = bumpy
    C = cotangent_laplacian(V, F, clamp=clamp)
    assert C.format == "csr" and C.dtype == np.float64
    np.testing.assert_allclose(C.toarray(), cotangents_angle_by_angle(V, F, clamp), atol=1e-12)


@pytest.mark.parametrize("flat", [[0, 1, 2], [1, 1, 3], [3, 3, 3]], ids=["a line", "two corners", "one corner"])
def test_a_triangle_without_area_changes_only_its_own_edges_when_clamped(grid, flat):
    V, F = grid
    assert np.ptp(V[[0, 1, 2]], axis=0).astype(bool).sum() == 1  # they do lie on a line
    before = cotangent_laplacian(V, F, clamp=0.01).toarray()
    after = cotangent_laplacian(V, np.vstack([F, flat]), clamp=0.01).toarray()
    touched = np.isin(np.arange(len(V)), flat)
    elsewhere = ~(touched[:, None] & touched)
    np.testing.assert_array_equal(after[elsewhere], before[elsewhere])
    np.testing.assert_allclose(after.sum(axis=1), 0, atol=1e-12)
    np.testing.assert_array_equal(after, after.T)


def test_an_edge_whose_weights_cancel_is_clamped_like_any_other():
    # Both angles that face the diagonal of a square are right ones.
    V, F = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    assert cotangent_laplacian(V, F, clamp=0.25).toarray()[0, 2] == -0.25
    # A flat triangle adds plus and minus infinity to an edge of another flat one: no NaN, and clamped.
    V = np.array([[0.0, 0, 0], [2, 0, 0], [1, 0, 0], [3, 0, 0]])
    C = cotangent_laplacian(V, [[0, 1, 2], [0, 1, 3]], clamp=0.25).toarray()
    assert C[0, 1] == -0.25 and C[0, 2] == -4.0 and C[0, 3] == -0.25


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_cotangent_ignores_rigid_motion_and_scale(bumpy, rotation, scale):
    V, F = bumpy
    moved = scale * (V @ rotation.T + [1, 2, 3])
    assert abs(cotangent_laplacian(moved, F) - cotangent_laplacian(V, F)).max() < 1e-11


def test_clamped_weights_stay_within_bounds_even_on_degenerate_triangles():
    V = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0], [1, 1, 0]])
    F = np.array([[0, 1, 3], [1, 2, 3], [0, 1, 2], [2, 4, 3]])
    with pytest.raises(ValueError, match="V: expected triangles with an area, got 2 degenerate of 4"):
        cotangent_laplacian(V, F)
    C = cotangent_laplacian(V, F, clamp=0.01).toarray()
    off = -C[~np.eye(5, dtype=bool)]
    off = off[off != 0]
    assert np.isfinite(C).all() and off.min() >= 0.01 and off.max() <= 100
    assert np.linalg.eigvalsh(C).min() > -1e-10


@pytest.mark.parametrize("clamp", [0, -1, 2.0, np.nan])
def test_clamp_is_checked(clamp):
    with pytest.raises(ValueError, match=r"clamp: expected a number in \(0, 1\] or None"):
        cotangent_laplacian(*TETRAHEDRON, clamp=clamp)


def test_bad_faces():
    with pytest.raises(ValueError, match=r"F: expected indices in 0\.\.2, got 3"):
        uniform_laplacian([[0, 1, 3]], 3)
    with pytest.raises(ValueError, match=r"F: expected integers of shape \(m, 3\)"):
        uniform_laplacian([[0, 1]], 3)


@pytest.mark.parametrize("thickness", 10.0 ** -np.arange(2.0, 11.5, 0.5))
def test_thin_triangles_have_the_cotangents_of_their_angles(thickness):
    """An isosceles triangle of base 2 and height h: cot h at the base, (h^2 - 1) / (2 h) at the tip."""
    V = np.array([[-1.0, 0, 0], [1, 0, 0], [0, thickness, 0]]) * 17.0 + [3.0, 5.0, -7.0]
    C = cotangent_laplacian(V, [[0, 1, 2]]).toarray()
    expected = -(1 / thickness) / 2, (1 - thickness**2) / (4 * thickness)
    np.testing.assert_allclose([C[0, 2], C[0, 1]], expected, rtol=1e-3)
    np.testing.assert_allclose(C.sum(axis=1), 0, atol=1e-6 / thickness)
