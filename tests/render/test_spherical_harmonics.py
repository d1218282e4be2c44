import numpy as np
import pytest

from toongeo.render import ScaledOrthographicCamera, irradiance, sh_basis, studio_light


def sphere_quadrature():
    """Directions and weights that integrate polynomials up to degree 15 on the sphere exactly."""
    z, wz = np.polynomial.legendre.leggauss(8)
    phi = np.arange(16) * (2.0 * np.pi / 16)
    r = np.sqrt(1.0 - z**2)
    directions = np.stack(
        [np.outer(r, np.cos(phi)), np.outer(r, np.sin(phi)), np.repeat(z[:, None], 16, axis=1)], axis=-1
    )
    return directions.reshape(-1, 3), np.repeat(wz, 16) * (2.0 * np.pi / 16)


def unit_vectors(count=40):
    vectors = np.random.default_rng(0).normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def test_basis_is_orthonormal():
    directions, weights = sphere_quadrature()
    Y = sh_basis(directions)
    np.testing.assert_allclose(Y.T @ (weights[:, None] * Y), np.eye(9), atol=1e-13)


def test_order_and_constants():
    x, y, z = unit_vectors().T
    constants = [0.282095, 0.488603, 0.488603, 0.488603, 1.092548, 1.092548, 0.315392, 1.092548, 0.546274]
    monomials = [np.ones_like(x), y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y]
    np.testing.assert_allclose(sh_basis(unit_vectors()), np.transpose(monomials) * constants, atol=2e-6)


def test_addition_theorem():
    # sum_m Y_lm(a) Y_lm(b) = (2 l + 1) / (4 pi) P_l(a . b)
    a, b = unit_vectors()[:20], unit_vectors()[20:]
    products, cosine = sh_basis(a) * sh_basis(b), (a * b).sum(axis=1)
    for degree, legendre in enumerate([np.ones(20), cosine, 1.5 * cosine**2 - 0.5]):
        band = slice(degree**2, (degree + 1) ** 2)
        expected = (2 * degree + 1) / (4.0 * np.pi) * legendre
        np.testing.assert_allclose(products[:, band].sum(axis=1), expected, atol=1e-13)


def test_constant_light_gives_pi_times_its_radiance():
    light = np.zeros((9, 3))
    light[0] = np.sqrt(4.0 * np.pi) * np.array([1.0, 2.0, 0.5])
    np.testing.assert_allclose(irradiance(unit_vectors(), light), np.pi * np.tile([1.0, 2.0, 0.5], (40, 1)))


def test_irradiance_is_the_cosine_integral_of_the_environment():
    # exact for an environment within the nine terms: E(n) = integral of L(w) max(n . w, 0)
    rng = np.random.default_rng(1)
    light = rng.normal(size=(9, 3))
    normals = unit_vectors(6)
    phi, u = np.meshgrid(np.arange(64) * (2 * np.pi / 64), np.polynomial.legendre.leggauss(32)[0])
    weight = np.polynomial.legendre.leggauss(32)[1][:, None] * np.ones(64) * (0.5 * 2 * np.pi / 64)
    cosine = 0.5 * (u + 1.0)  # Gauss points on the hemisphere about each normal
    sine = np.sqrt(1.0 - cosine**2)
    local = np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=-1).reshape(-1, 3)
    for normal in normals:
        frame = np.linalg.qr(np.column_stack([normal, rng.normal(size=(3, 2))]))[0][:, [1, 2, 0]]
        frame[:, 2] = normal
        environment = sh_basis(local @ frame.T) @ light
        expected = (environment * (weight * cosine).reshape(-1, 1)).sum(axis=0)
        np.testing.assert_allclose(irradiance(normal[None], light)[0], expected, atol=1e-12)


def test_directional_light_has_its_closed_form():
    # L_lm = Y_lm(d): E = 1/4 + cos/2 + 5/32 (3 cos^2 - 1), the nine-term cosine lobe
    d, normals = unit_vectors()[0], unit_vectors()
    light = np.repeat(sh_basis(d[None]).T, 3, axis=1)
    cosine = normals @ d
    lobe = 0.25 + 0.5 * cosine + 5.0 / 32.0 * (3.0 * cosine**2 - 1.0)
    np.testing.assert_allclose(irradiance(normals, light)[:, 1], lobe, atol=1e-13)
    assert np.abs(lobe - np.maximum(cosine, 0.0)).max() < 0.1


def test_turning_environment_and_surface_together_changes_nothing():
    R = ScaledOrthographicCamera.look(30.0, 50.0, -70.0).rotation
    directions, weights = sphere_quadrature()
    light = np.random.default_rng(2).normal(size=(9, 3))
    # the turned environment is L(R^T w): project it on the basis again
    turned = sh_basis(directions).T @ (weights[:, None] * (sh_basis(directions @ R) @ light))
    np.testing.assert_allclose(irradiance(unit_vectors() @ R.T, turned), irradiance(unit_vectors(), light), atol=1e-12)


def test_studio_light_comes_from_the_upper_left_and_is_neutral():
    normals = np.array([[0.0, 0.0, 1.0], [-0.6, 0.0, 0.8], [0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [0.0, -0.6, 0.8]])
    shade = irradiance(normals, studio_light()) / np.pi
    front, left, right, up, down = shade[:, 0]
    assert left > right and up > down
    assert front == pytest.approx(0.9, abs=0.1)  # faces show about their albedo
    np.testing.assert_allclose(shade, shade[:, :1] * np.ones(3))
    assert irradiance(unit_vectors(), studio_light()).min() > 0.0


def test_bad_input():
    with pytest.raises(ValueError, match=r"normals: expected shape \(k, 3\)"):
        sh_basis([0.0, 0.0, 1.0])
    with pytest.raises(ValueError, match=r"light: expected finite coefficients of shape \(9, 3\)"):
        irradiance(unit_vectors(), np.zeros((9, 1)))
    with pytest.raises(ValueError, match="light: expected finite"):
        irradiance(unit_vectors(), np.full((9, 3), np.nan))
