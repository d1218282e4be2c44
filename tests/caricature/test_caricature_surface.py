import numpy as np
import pytest

from toongeo.caricature.caricature_surface import caricature_surface


def test_gamma_zero_changes_nothing(mesh):
    V, F = mesh
    np.testing.assert_allclose(caricature_surface(V, F, 0.0), V, atol=1e-12)


def test_a_sphere_has_nothing_to_exaggerate(mesh):
    V, F = mesh
    V = V / np.linalg.norm(V, axis=1, keepdims=True)
    np.testing.assert_allclose(caricature_surface(V, F, 0.2), V, atol=0.03)


def test_what_is_curved_grows(mesh):
    """The ends of a long ellipsoid are curved most: it gets longer as against its width; less so if gamma < 0."""
    V, F = mesh
    V = V / np.linalg.norm(V, axis=1, keepdims=True) * [1, 1, 1.6]

    def slenderness(P):
        return np.ptp(P[:, 2]) / np.ptp(P[:, 0])

    slender = [slenderness(caricature_surface(V, F, gamma)) for gamma in (-0.2, 0.0, 0.2, 0.4)]
    spread = [np.abs(caricature_surface(V, F, gamma) - V).max() for gamma in (0.1, 0.2, 0.4)]
    assert (np.diff(spread) > 0).all()
    assert len(set(np.round(slender, 6))) == 4
    assert (np.diff(slender) > 0).all() or (np.diff(slender) < 0).all()


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_moves_with_the_surface(mesh, scale):
    V, F = mesh
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    expected = scale * caricature_surface(V, F, 0.3) @ turn.T + scale
    np.testing.assert_allclose(
        caricature_surface(scale * V @ turn.T + scale, F, 0.3), expected, rtol=0, atol=1e-9 * scale
    )


def test_components_are_apart(mesh):
    V, F = mesh
    both = caricature_surface(np.vstack([V, 0.1 * V + 5]), np.vstack([F, F + len(V)]), 0.3)
    alone = caricature_surface(V, F, 0.3)
    np.testing.assert_allclose(both[: len(V)], alone, atol=1e-9)
    np.testing.assert_allclose(both[len(V) :], 0.1 * alone + 5, atol=1e-9)


def test_flat_pieces_stay():
    V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    np.testing.assert_array_equal(caricature_surface(V, [[0, 1, 2], [1, 3, 2]], 0.3), V)


def test_a_gamma_that_is_no_number_is_refused(mesh):
    with pytest.raises(ValueError, match="gamma: expected a finite number, got nan"):
        caricature_surface(*mesh, np.nan)
