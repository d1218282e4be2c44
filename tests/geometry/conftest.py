"""Small meshes for the geometry tests."""

import numpy as np
import pytest

from toongeo.geometry.catmull_clark import catmull_clark

_CUBE = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
_CUBE_V = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1.0]]
)


def _triangles(quads):
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _blob(steps):
    V, quads = _CUBE_V, _CUBE
    for _ in range(steps):
        S, quads = catmull_clark(quads, len(V))
        V = S @ V
    return V, _triangles(quads)


@pytest.fixture(scope="session")
def sphere():
    """Closed, genus 0, 386 vertices on the unit sphere."""
    V, F = _blob(3)
    return V / np.linalg.norm(V, axis=1, keepdims=True), F


@pytest.fixture(scope="session")
def fine():
    """Closed, 6,146 vertices: fine enough for the conditioning of fourth-order systems to show."""
    V, F = _blob(5)
    return V * [80.0, 110, 95] * (1 + 0.1 * V[:, :1] * V[:, 1:2]), F


@pytest.fixture(scope="session")
def grid():
    """Open 8 x 6 grid of unit cells in z = 0, 63 vertices, row-major."""
    y, x = np.mgrid[:7, :9]
    V = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1).astype(float)
    index = np.arange(63).reshape(7, 9)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)
    return V, _triangles(quads)


@pytest.fixture(scope="session")
def bumpy(sphere):
    """The sphere with a smooth and a rough bump: no symmetry, no flat ring."""
    V, F = sphere
    rng = np.random.default_rng(7)
    x, y, z = V.T
    radius = 1 + 0.2 * x * y + 0.15 * z**3 + rng.normal(0, 0.01, len(V))
    return V * radius[:, None] * [1.1, 0.9, 1.3], F


@pytest.fixture(scope="session")
def two_parts(bumpy):
    """Two components: the bumpy blob and a copy of it to its right; and one lonely vertex at the end."""
    V, F = bumpy
    return np.concatenate([V, V + np.array([4.0, 0, 0]), [[9.0, 9, 9]]]), np.concatenate([F, F + len(V)])


@pytest.fixture(scope="session")
def rotation():
    """A generic rotation matrix."""
    Q, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    return Q * np.sign(np.linalg.det(Q))
