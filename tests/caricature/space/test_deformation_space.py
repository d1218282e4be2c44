import dataclasses

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.caricature.space.deformation_representation import deformation_representation, full
from toongeo.caricature.space.deformation_space import DeformationSpace
from toongeo.caricature.space.fit_weights import WeightProblem
from toongeo.geometry.operators.one_rings import one_rings
from toongeo.metrics import check_gradient

TURN = Rotation.from_rotvec([0.4, -0.7, 0.2]).as_matrix()


def wide(space):
    """The same space in float64: its energy is smooth to the last digits."""
    return dataclasses.replace(
        space, rotations=space.rotations.astype(np.float64), stretches=space.stretches.astype(np.float64)
    )


def test_no_deformation_is_zero(mesh):
    V, F = mesh
    rotations, stretches = deformation_representation(one_rings(V, F), V)
    assert not rotations.any() and np.abs(stretches).max() < 1e-15


def test_rigid_motion_is_zero_after_alignment(mesh, rng):
    V, F = mesh
    space = DeformationSpace.from_meshes(V, F, [V @ TURN.T + [5, 6, 7], V])
    assert np.abs(space.rotations).max() < 1e-6
    assert np.abs(space.stretches).max() < 1e-6
    assert np.abs(space.offsets).max() < 1e-12


@pytest.mark.parametrize("scale", [0.3, 1.7])
def test_uniform_scale_is_a_multiple_of_the_identity(mesh, scale):
    V, F = mesh
    rings = one_rings(V, F)
    assert not rings.flat.any()
    rotations, stretches = deformation_representation(rings, scale * V)
    np.testing.assert_allclose(rotations, 0, atol=1e-12)
    identity = np.eye(3)[:, :, None]
    np.testing.assert_allclose(full(stretches), np.broadcast_to((scale - 1) * identity, (3, 3, len(V))), atol=1e-12)


def test_affine_deformations_are_reproduced(mesh, rng):
    V, F = mesh
    for _ in range(5):
        A = np.eye(3) + 0.4 * rng.normal(size=(3, 3))
        P = V @ A.T + [1.0, 2.0, 3.0]
        space = DeformationSpace.from_meshes(V, F, [P, V], align=False)
        np.testing.assert_allclose(space.vertices([1.0, 0.0]), P, atol=1e-6)


def test_reflections_are_reproduced(mesh):
    V, F = mesh
    space = DeformationSpace.from_meshes(V, F, [V * [-1, 1, 1], V], align=False)
    np.testing.assert_allclose(space.vertices([1.0, 0.0]), V * [-1, 1, 1], atol=1e-6)


def test_rotations_extrapolate(mesh):
    """Twice a turn is a turn by twice the angle; a sum of displacements would have swollen."""
    V, F = mesh
    space = DeformationSpace.from_meshes(V, F, [V @ Rotation.from_rotvec([0, 0, 0.7]).as_matrix().T, V], align=False)
    expected = V @ Rotation.from_rotvec([0, 0, 1.4]).as_matrix().T
    got = space.vertices([2.0, 0.0])
    np.testing.assert_allclose(got - got.mean(0), expected - expected.mean(0), atol=1e-6)


def test_rotation_and_stretch_have_weights_of_their_own(mesh):
    V, F = mesh
    turn = Rotation.from_rotvec([0, 0, 0.5]).as_matrix()
    space = DeformationSpace.from_meshes(V, F, [(V * [2, 1, 1]) @ turn.T, V], align=False)
    stretched = space.vertices([[0, 0], [1, 0]])
    np.testing.assert_allclose(stretched - stretched.mean(0), (V - V.mean(0)) * [2, 1, 1], atol=1e-6)


def test_a_unit_weight_gives_the_shape(small):
    """Rigid motions aside, to the digits of float32, whose errors here and there come with the Laplacian's inverse."""
    space, shapes = small
    size = np.linalg.norm(np.ptp(space.reference, axis=0))
    for k, shape in enumerate(shapes):
        P = space.vertices(np.eye(3)[k])
        A, B = P - P.mean(0), shape - shape.mean(0)
        U, _, Vt = np.linalg.svd(B.T @ A)
        assert np.linalg.norm(A @ (U @ Vt).T - B, axis=1).max() < 1e-6 * size


def test_unit_weights_of_a_face_give_its_expressions(face_space):
    model, space = face_space.model, face_space.space
    jaw = space.reference + model.expression[model.expression_index("jawOpen"), face_space.vertices].astype(np.float64)
    far = [np.linalg.norm(space.vertices(e) - jaw, axis=1).max() for e in np.eye(98)[75:]]
    assert min(far) < 2e-4 * np.ptp(space.reference, axis=0).max()


def test_bends_turn_on_with_the_weights(small):
    """None at w = 0, and in proportion: half of a shape's at half its weight."""
    space, _ = small
    straight = dataclasses.replace(space, bends=0 * space.bends)
    np.testing.assert_array_equal(space.vertices(np.zeros(3)), space.reference)
    moved = [space.vertices([w, 0, 0]) - straight.vertices([w, 0, 0]) for w in (0.5, 1.0, 3.0)]
    np.testing.assert_allclose(2 * moved[0], moved[1], atol=1e-7)
    np.testing.assert_allclose(moved[2], 3 * moved[1], atol=1e-7)


def test_components_keep_their_places(mesh):
    V, F = mesh
    both, faces = np.vstack([V, V + [5, 0, 0]]), np.vstack([F, F + len(V)])
    shape = both.copy()
    shape[len(V) :] += [0, 2, 0]
    space = DeformationSpace.from_meshes(both, faces, [shape, both], align=False)
    np.testing.assert_allclose(space.vertices([1.0, 0]), shape, atol=1e-9)


def test_the_mesh_minimizes_the_energy(small, rng):
    """Without the bends, which Eq. 6 does not know."""
    space = dataclasses.replace(small[0], bends=0 * small[0].bends)
    w = rng.normal(size=(2, 3))
    P = space.vertices(w)
    least = space.energy(P, w)
    for _ in range(5):
        assert space.energy(P + 1e-3 * rng.normal(size=P.shape), w) > least


def test_energy_is_the_sum_over_the_edges(small, rng):
    """Eq. 6, written out."""
    space, _ = small
    w, P, V = rng.normal(size=(2, 3)), space.reference + 0.1 * rng.normal(size=space.reference.shape), space.reference
    T = space.gradients(w) + np.eye(3)[:, :, None]
    L = space.rings.laplacian.tocoo()
    i, j, c = (a[L.row != L.col] for a in (L.row, L.col, -L.data))
    left = P[i] - P[j] - np.einsum("abe,eb->ea", T[:, :, i], V[i] - V[j])
    assert space.energy(P, w) == pytest.approx((c * (left**2).sum(1)).sum(), rel=1e-6)


def test_gradient_has_the_taylor_slope(small, rng):
    space, _ = small
    problem = WeightProblem(wide(space), space.reference + 0.1 * rng.normal(size=space.reference.shape))
    w = rng.normal(size=(2, 3))

    def energy(x):
        _, half, _ = problem.gradient(x.reshape(w.shape))
        return problem.energy(x.reshape(w.shape)), 2 * half.ravel()

    assert check_gradient(energy, w.ravel()).passed


def test_gauss_newton_matrix_is_that_of_the_edges(small, rng):
    """J^T J of the residuals of Eq. 9, with J by central differences."""
    space = wide(small[0])
    V, w = space.reference, rng.normal(size=(2, 3))
    L = space.rings.laplacian.tocoo()
    i, j, c = (a[L.row != L.col] for a in (L.row, L.col, -L.data))

    def residual(w):
        return (np.sqrt(c)[:, None] * np.einsum("abe,eb->ea", space.gradients(w)[:, :, i], V[i] - V[j])).ravel()

    h, J = 1e-5, []
    for d in np.eye(6).reshape(6, 2, 3):
        J.append((residual(w + h * d) - residual(w - h * d)) / (2 * h))
    H = WeightProblem(space, V).gradient(w)[2]
    np.testing.assert_allclose(H, np.array(J) @ np.array(J).T, rtol=1e-6, atol=1e-6 * np.abs(H).max())


def test_weights_are_recovered(small, rng):
    """From a mesh at w* the optimum is at least as good as w*; w itself is not unique."""
    space, _ = small
    for _ in range(4):
        w = rng.normal(scale=0.7, size=(2, 3))
        P = space.vertices(w)
        fit = space.fit(P)
        assert fit.converged
        assert fit.energy <= space.energy(P, w) * (1 + 1e-6)
        assert (np.diff(fit.energies) <= 0).all()


def test_a_ridge_makes_weights_smaller(small, rng):
    space, _ = small
    P = space.vertices(rng.normal(size=(2, 3)))
    sizes = [np.linalg.norm(space.fit(P, ridge=ridge).w) for ridge in (0.0, 0.1, 10.0)]
    assert sizes[0] > sizes[1] > sizes[2]


def test_a_ridge_pulls_towards_its_centre(small, rng):
    space, _ = small
    P, centre = space.vertices(rng.normal(size=(2, 3))), rng.normal(size=(2, 3))
    far = [np.linalg.norm(space.fit(P, ridge=ridge, centre=centre).w - centre) for ridge in (0.0, 0.1, 10.0)]
    assert far[0] > far[1] > far[2]


def test_a_file_gives_the_same_space(small, tmp_path):
    space, _ = small
    space.save(tmp_path / "space.npz")
    loaded = DeformationSpace.load(tmp_path / "space.npz")
    for name in ("reference", "faces", "rotations", "stretches", "bends", "offsets"):
        np.testing.assert_array_equal(getattr(loaded, name), getattr(space, name))
    np.testing.assert_array_equal(loaded.vertices([1.0, 2, 3]), space.vertices([1.0, 2, 3]))


def test_other_files_are_refused(tmp_path):
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    with pytest.raises(ValueError, match="path: expected a deformation space of format 1, got no .*'format'"):
        DeformationSpace.load(tmp_path / "other.npz")


def test_bad_shapes_are_refused(mesh):
    V, F = mesh
    with pytest.raises(ValueError, match="shapes: expected at least 2, got 1"):
        DeformationSpace.from_meshes(V, F, [V])
    with pytest.raises(ValueError, match=r"shapes\[1\]: expected 184 vertices as the reference has, got 183"):
        DeformationSpace.from_meshes(V, F, [V, V[:-1]])
    with pytest.raises(ValueError, match=r"shapes\[0\]: expected finite coordinates"):
        DeformationSpace.from_meshes(V, F, [V * np.nan, V])
    flat = V.copy()
    flat[F[0]] = V[F[0, 0]]
    with pytest.raises(ValueError, match="V: expected triangles with an area"):
        DeformationSpace.from_meshes(flat, F, [V, V])


def test_references_with_degenerate_rings_are_refused(mesh):
    V, F = mesh
    alone = np.vstack([V, [9.0, 9.0, 9.0]])
    with pytest.raises(ValueError, match="V: expected every vertex in a triangle, got 1 in none"):
        DeformationSpace.from_meshes(alone, F, [alone, alone])
    needle, sliver = np.array([[0.0, 0, 0], [1, 0, 0], [2, 1e-6, 0]]), [[0, 1, 2]]
    with pytest.raises(ValueError, match="V: expected"):
        DeformationSpace.from_meshes(needle, sliver, [needle, needle])


def test_bad_weights_are_refused(small):
    space, _ = small
    with pytest.raises(ValueError, match=r"w: expected shape \(3,\) or \(2, 3\), got \(4,\)"):
        space.vertices(np.zeros(4))
    with pytest.raises(ValueError, match="w: expected finite weights"):
        space.vertices([0, 0, np.nan])
    with pytest.raises(ValueError, match=r"start: expected shape \(3,\) or \(2, 3\)"):
        space.fit(space.reference, start=[1.0])
    with pytest.raises(ValueError, match=r"centre: expected shape \(3,\) or \(2, 3\)"):
        space.fit(space.reference, centre=[1.0])
    with pytest.raises(ValueError, match=r"P: expected shape \(184, 3\), got \(3, 3\)"):
        space.fit(np.eye(3))
    with pytest.raises(ValueError, match="ridge: expected a finite number >= 0, got -1"):
        space.fit(space.reference, ridge=-1)
    with pytest.raises(ValueError, match="iterations: expected a number >= 0, got -1"):
        space.fit(space.reference, iterations=-1)


def test_bad_fields_are_refused(small):
    space, _ = small
    with pytest.raises(ValueError, match=r"rotations: expected shape \(3, 3, 184\), got \(3, 3, 3\)"):
        dataclasses.replace(space, rotations=space.rotations[:, :, :3])
    with pytest.raises(ValueError, match="offsets: expected finite numbers"):
        dataclasses.replace(space, offsets=space.offsets * np.nan)
