import numpy as np
import pytest

from toongeo.pipeline.hair.plane.working_plane import CELL_MM, WorkingPlane, working_plane
from toongeo.pipeline.hair.shell.edges import boundary_edges, edges_of, halved
from toongeo.pipeline.hair.shell.harmonic import smooth_max, solved
from toongeo.pipeline.hair.shell.planar_mesh import STEP_MM, planar_mesh

PLANE = WorkingPlane(np.eye(3), np.eye(2), 1.0, np.zeros(2), np.zeros(2), (120, 120))
RADIUS = 50.0


def disc(radius, centre=60):
    y, x = (np.mgrid[:120, :120] - centre) * CELL_MM
    return x * x + y * y <= radius * radius


def areas(P, T):
    u, v = P[T[:, 1]] - P[T[:, 0]], P[T[:, 2]] - P[T[:, 0]]
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


@pytest.fixture(scope="module")
def mesh():
    return planar_mesh(PLANE, disc(RADIUS) & ~disc(15), [disc(30)])


def test_triangles_fill_the_region_and_none_turns(mesh):
    P, T = mesh
    a = areas(P, T)
    assert a.min() > 0
    assert a.sum() == pytest.approx(np.pi * (RADIUS**2 - 15**2), rel=0.02)
    assert (edges_of(T)[2] <= 2).all()


def test_outlines_of_parts_are_edges(mesh):
    """No triangle reaches from within a part to without."""
    P, T = mesh
    r = np.linalg.norm(P - 60 * CELL_MM, axis=1)[T]
    assert not ((r.min(1) < 30 - 0.8) & (r.max(1) > 30 + 0.8)).any()
    rim = np.unique(boundary_edges(T))
    length = np.linalg.norm(P[boundary_edges(T)[:, 0]] - P[boundary_edges(T)[:, 1]], axis=1)
    assert length.max() <= STEP_MM + 1e-9
    assert np.abs(np.abs(np.linalg.norm(P[rim] - 60 * CELL_MM, axis=1) - 32.5) - 17.5).max() < 0.8


def test_an_outline_loses_notches_and_keeps_strands():
    """Noise of a pixel is gone from the rim; a tip that sticks out 12 mm is not."""
    y, x = (np.mgrid[:120, :120] - 60) * CELL_MM
    angle = np.arctan2(y, x)
    ragged = np.hypot(x, y) <= RADIUS + 0.9 * np.sin(24 * angle)
    strand = (np.abs(x) < 5) & (y > 0) & (y < RADIUS + 12)
    P, T = planar_mesh(PLANE, ragged | strand, [])
    Q = P[np.unique(boundary_edges(T))] - 60 * CELL_MM
    round_part = np.hypot(*Q.T)[np.arctan2(Q[:, 1], Q[:, 0]) < 0]
    assert np.abs(round_part - RADIUS).max() < 0.7 < 0.9
    assert Q[:, 1].max() > RADIUS + 12 - 1.5


def test_halved_keeps_area_and_puts_points_in_the_middle(mesh, rng):
    P, T = mesh
    split = rng.random(len(edges_of(T)[0])) < 0.3
    Q, S = halved(P, T, split)
    assert len(Q) == len(P) + split.sum()
    assert areas(Q, S).min() > 0
    assert areas(Q, S).sum() == pytest.approx(areas(P, T).sum(), rel=1e-12)
    np.testing.assert_allclose(Q[len(P) :], P[edges_of(T)[0][split]].mean(1))
    assert (edges_of(S)[2] <= 2).all()


def test_poisson_over_a_disc_is_a_sphere():
    """-laplacian g = 4 with g = 0 on a circle: g = R^2 - r^2, and its root a hemisphere (Igarashi et al. 1999)."""
    P, T = planar_mesh(PLANE, disc(RADIUS), [])
    known = np.zeros(len(P), bool)
    known[boundary_edges(T)] = True
    g = solved(P, T, known, np.zeros((len(P), 1)), np.array([4.0]))[:, 0]
    r2 = ((P - 60 * CELL_MM) ** 2).sum(1)
    np.testing.assert_allclose(g, np.maximum(RADIUS**2 - r2, 0), atol=0.02 * RADIUS**2)


def test_laplace_reproduces_a_plane():
    P, T = planar_mesh(PLANE, disc(RADIUS), [])
    known = np.zeros(len(P), bool)
    known[boundary_edges(T)] = True
    plane = (P @ [2.0, -1.0] + 3)[:, None]
    np.testing.assert_allclose(solved(P, T, known, plane * known[:, None], np.zeros(1)), plane, atol=5e-3)


def test_smooth_max_bounds_the_maximum():
    a, b = np.linspace(-10, 10, 41), np.zeros(41)
    z = smooth_max(a, b, np.full(41, 4.0))
    assert (z >= np.maximum(a, b)).all()
    assert z.max() - 10 < 0.4
    np.testing.assert_allclose(smooth_max(a, b, np.zeros(41)), np.maximum(a, b))


def test_sheets_are_heights_over_the_same_triangles(hair, roomy, mask):
    """Seen along the camera half of the faces turns one way, the other half the other: no fold, so no crossing."""
    X = working_plane(roomy[0], mask).of(hair.vertices)
    half = len(hair.faces) // 2
    assert (areas(X[:, :2], hair.faces[:half]) > -1e-4).all()
    assert (areas(X[:, :2], hair.faces[half:]) < 1e-4).all()
