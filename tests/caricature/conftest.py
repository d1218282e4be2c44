import numpy as np
import pytest

from toongeo.caricature.space.deformation_space import DeformationSpace
from toongeo.caricature.space.face_space import face_space as build


@pytest.fixture(scope="session")
def face_space():
    return build()


def ball(n):
    """Closed mesh of a bumpy ball; no ring is flat."""
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, (np.arange(n - 1) + 1) * np.pi / n, indexing="ij")
    r = 1 + 0.15 * np.sin(2 * u) * np.sin(v) ** 2
    rings = np.stack([r * np.sin(v) * np.cos(u), r * np.sin(v) * np.sin(u), r * np.cos(v)], -1).reshape(-1, 3)
    V = np.vstack([rings, [[0, 0, 1]], [[0, 0, -1]]])
    top, bottom, faces = len(V) - 2, len(V) - 1, []
    for i in range(n):
        a, b = i * (n - 1), (i + 1) % n * (n - 1)
        faces += [[top, a, b], [bottom, b + n - 2, a + n - 2]]
        for j in range(n - 2):
            faces += [[a + j, a + j + 1, b + j + 1], [a + j, b + j + 1, b + j]]
    return V, np.array(faces)


@pytest.fixture
def mesh():
    return ball(14)


@pytest.fixture
def small(mesh):
    """Space of three shapes of the ball: bent, twisted, stretched; float64 so that derivatives can be measured."""
    V, F = mesh
    x, y, z = V.T
    bent = np.stack([x, y * np.cos(0.5 * x) - z * np.sin(0.5 * x), y * np.sin(0.5 * x) + z * np.cos(0.5 * x)], 1)
    twisted = np.stack([x * np.cos(z) - y * np.sin(z), x * np.sin(z) + y * np.cos(z), z], 1)
    shapes = [bent, twisted, V * [1.5, 0.8, 1.0]]
    return DeformationSpace.from_meshes(V, F, shapes), shapes
