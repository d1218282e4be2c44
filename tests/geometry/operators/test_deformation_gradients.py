import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.geometry.operators.deformation_gradients import deformation_gradients
from toongeo.geometry.operators.one_rings import one_rings


def sheet(n, bump=0.0):
    """Grid of n x n vertices, with a bump in the middle."""
    x, y = (a.ravel().astype(float) for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    middle = (n - 1) / 2
    z = bump * np.exp(-((x - middle) ** 2 + (y - middle) ** 2) / n)
    a = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.vstack([np.stack([a, a + n, a + n + 1], 1), np.stack([a, a + n + 1, a + 1], 1)])
    return np.stack([x, y, z], 1), faces


@pytest.fixture
def bumpy():
    return sheet(9, 3.0)


def test_affine_deformations_are_found_exactly(bumpy, rng):
    V, F = bumpy
    A = np.eye(3) + 0.5 * rng.normal(size=(3, 3))
    T = deformation_gradients(V, F, V @ A.T + [1, 2, 3])
    np.testing.assert_allclose(T, np.broadcast_to(A, T.shape), atol=1e-8)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_units_do_not_matter(bumpy, rng, scale):
    V, F = bumpy
    P = V + 0.1 * rng.normal(size=V.shape)
    np.testing.assert_allclose(
        deformation_gradients(scale * V, F, scale * P), deformation_gradients(V, F, P), atol=1e-9
    )


def test_a_flat_sheet_turns_with_its_normals():
    V, F = sheet(6)
    assert one_rings(V, F).flat.all()
    R = Rotation.from_rotvec([0.4, -1.0, 2.0]).as_matrix()
    T = deformation_gradients(V, F, 2.5 * V @ R.T)
    np.testing.assert_allclose(T, np.broadcast_to(2.5 * R, T.shape), atol=1e-9)


def test_gradients_minimize_the_energy_of_the_ring(bumpy, rng):
    """Within the tie of a thousandth: no other matrix makes Eq. 1 much smaller."""
    V, F = bumpy
    rings = one_rings(V, F)
    assert not rings.flat.any()
    P = V + 0.05 * rng.normal(size=V.shape)
    D = rings.displacement_gradients(P)
    M = rings.moments(P - V)

    def energy(D):
        return (np.einsum("abn,bcn->acn", D, rings.gram) * D - 2 * M * D).sum((0, 1))

    best = np.moveaxis(M, -1, 0) @ np.linalg.pinv(np.moveaxis(rings.gram, -1, 0), rcond=1e-9, hermitian=True)
    least = energy(np.moveaxis(best, 0, -1))
    assert (energy(D) >= least - 1e-12).all()
    assert energy(D).sum() < 0.9 * least.sum() < 0


def test_spread_is_the_transpose_of_moments(bumpy, rng):
    V, F = bumpy
    rings = one_rings(V, F)
    u, T = rng.normal(size=V.shape), rng.normal(size=(3, 3, len(V)))
    assert (rings.moments(u) * T).sum() == pytest.approx((u * rings.spread(T)).sum(), rel=1e-12)


def test_energy_of_edges_is_twice_the_laplacian(bumpy, rng):
    V, F = bumpy
    rings = one_rings(V, F)
    u = rng.normal(size=V.shape)
    L = rings.laplacian.tocoo()
    edges = L.row != L.col
    expected = (-L.data[edges] * ((u[L.row[edges]] - u[L.col[edges]]) ** 2).sum(1)).sum()
    assert 2 * (u * (rings.laplacian @ u)).sum() == pytest.approx(expected, rel=1e-12)


def test_bad_meshes_are_refused(bumpy):
    V, F = bumpy
    with pytest.raises(ValueError, match="V: expected triangles with an area, got 1 degenerate"):
        deformation_gradients(V, np.vstack([F, [0, 1, 1]]), V)
    with pytest.raises(ValueError, match="V: expected every vertex in a triangle, got 1 in none"):
        deformation_gradients(np.vstack([V, [0, 0, 9]]), F, np.vstack([V, [0, 0, 9]]))
    with pytest.raises(ValueError, match=r"P: expected shape \(81, 3\) as V, got \(80, 3\)"):
        deformation_gradients(V, F, V[:-1])
    needle = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 1e-8, 0]])
    with pytest.raises(ValueError, match="V: expected rings that span a plane, got 3 on a line"):
        one_rings(needle, [[0, 1, 2]])
