"""Deformation transfer: Sumner and Popovic's own system, exact cases, equivariance, translation, pins."""

import copy
import pickle

import numpy as np
import pytest

from toongeo.geometry.deformation_transfer import DeformationTransfer, deformation_transfer
from toongeo.geometry.source_motion import source_motion


@pytest.fixture
def deformed(bumpy):
    """A smooth large bend, twist and bulge of the bumpy sphere."""
    x, y, z = bumpy[0].T
    angle = 0.8 * z
    bent = np.stack([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle), z], axis=1)
    return bent * (1 + 0.2 * y)[:, None] + [0.1, 0.2, 0.3]


@pytest.fixture
def target(sphere):
    V = sphere[0]
    return V * [1.5, 1.0, 0.8] * (1 + 0.1 * V[:, :1] * V[:, 2:])


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])
def test_copies_and_pickles_give_the_same(bumpy, deformed, target, copied):
    transfer = DeformationTransfer(*bumpy, target, pinned=[0])
    np.testing.assert_array_equal(copied(transfer).transfer(deformed), transfer.transfer(deformed))


def test_motions_prepared_once_give_what_transfer_gives(bumpy, deformed, target):
    V, F = bumpy
    for pinned in (None, np.arange(20)):
        transfer = DeformationTransfer(V, F, target, pinned=pinned, align=True)
        shapes = np.stack([deformed, V + 0.5 * (deformed - V)])
        motions = [source_motion(V, np.ascontiguousarray(np.transpose(F)), shape - V) for shape in shapes]
        np.testing.assert_allclose(target + transfer.displacements(motions), transfer(shapes), atol=1e-12)


def with_fourth(V, F):
    """Frames (m, 3, 3) whose columns are v2 - v1, v3 - v1, v4 - v1 of Eq. 14."""
    e1, e2 = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    normal = np.cross(e1, e2)
    normal /= np.sqrt(np.linalg.norm(normal, axis=1, keepdims=True))
    return np.stack([e1, e2, normal], axis=2)


def gradients(source, deformed, F):
    """Q (m, 3, 3) of Eq. 15."""
    return with_fourth(deformed, F) @ np.linalg.inv(with_fourth(source, F))


def literal_system(Q, F, target, fixed, positions):
    """Eq. 14-16 as printed: all fourth vertices are unknowns; dense least squares; some vertices given."""
    n, m = len(target), len(F)
    W = np.linalg.inv(with_fourth(target, F))
    A = np.zeros((m, 3, n + m))
    for j in range(m):
        A[j][:, [*F[j, 1:], n + j]] += W[j].T
        A[j][:, F[j, 0]] -= W[j].sum(axis=0)
    A, b = A.reshape(3 * m, n + m), Q.transpose(0, 2, 1).reshape(3 * m, 3)
    free = np.setdiff1d(np.arange(n + m), fixed)
    x = np.empty((n + m, 3))
    x[fixed] = positions
    x[free] = np.linalg.lstsq(A[:, free], b - A[:, fixed] @ positions, rcond=None)[0]
    return x[:n]


@pytest.mark.parametrize("pinned", [None, [0], [5, 100, 301]])
def test_is_the_literal_system_of_sumner_and_popovic(bumpy, deformed, target, pinned):
    source, F = bumpy
    fixed = [0] if pinned is None else pinned
    at = target[fixed] + (deformed[fixed] - source[fixed] if pinned is None else 0)
    expected = literal_system(gradients(source, deformed, F), F, target, fixed, at)
    result = deformation_transfer(source, deformed, F, target, pinned=pinned)
    np.testing.assert_allclose(result, expected, atol=1e-10)


@pytest.mark.parametrize("gain", [-0.5, 0.5, 2.0])
def test_is_linear_in_the_gradients_and_not_in_the_vertices(bumpy, deformed, target, gain):
    """The displacement times g is the transfer of I + g (Q - I); that of g times the motion is another one."""
    source, F = bumpy
    displacement = deformation_transfer(source, deformed, F, target, pinned=[0]) - target
    Q = np.eye(3) + gain * (gradients(source, deformed, F) - np.eye(3))
    expected = literal_system(Q, F, target, [0], target[[0]])
    np.testing.assert_allclose(target + gain * displacement, expected, atol=1e-10)
    moved = source + gain * (deformed - source)
    assert np.abs(deformation_transfer(source, moved, F, target, pinned=[0]) - expected).max() > 0.01


@pytest.mark.parametrize("pinned", [None, [7, 8]])
def test_a_shift_of_any_mesh_only_shifts_the_result(bumpy, deformed, target, pinned):
    source, F = bumpy
    t = np.array([3.0, -1, 2])
    expected = deformation_transfer(source, deformed, F, target, pinned=pinned)
    both = deformation_transfer(source + t, deformed + t, F, target, pinned=pinned)
    np.testing.assert_allclose(both, expected, atol=1e-11)
    alone = deformation_transfer(source, deformed, F, target + t, pinned=pinned)
    np.testing.assert_allclose(alone, expected + t, atol=1e-11)


@pytest.mark.parametrize("pinned", [None, [7, 8]])
def test_a_rigid_motion_of_one_mesh_is_harmless_when_aligned(bumpy, deformed, target, rotation, pinned):
    source, F = bumpy
    move = lambda X: X @ rotation.T + [3.0, -1, 2]  # noqa: E731

    def transfer(V_source, V_deformed, V_target, align=True):
        return deformation_transfer(V_source, V_deformed, F, V_target, pinned=pinned, align=align)

    expected = transfer(source, deformed, target)
    np.testing.assert_allclose(transfer(move(source), move(deformed), target), expected, atol=1e-10)
    np.testing.assert_allclose(transfer(source, deformed, move(target)), move(expected), atol=1e-10)
    # Without it the gradients keep the axes of the source, and the motion goes another way.
    free = transfer(source, deformed, target, align=False)
    assert np.abs(transfer(move(source), move(deformed), target, align=False) - free).max() > 0.1


def test_aligned_is_the_literal_system_of_the_turned_source(bumpy, deformed, target, rotation):
    from scipy.spatial.transform import Rotation

    source, F = bumpy
    target = target @ rotation.T
    turn = Rotation.align_vectors(target - target.mean(0), source - source.mean(0))[0].as_matrix()
    Q = gradients(source @ turn.T, deformed @ turn.T, F)
    result = deformation_transfer(source, deformed, F, target, pinned=[3], align=True)
    np.testing.assert_allclose(result, literal_system(Q, F, target, [3], target[[3]]), atol=1e-10)


def test_no_deformation_gives_the_target_exactly(bumpy, target):
    source, F = bumpy
    np.testing.assert_array_equal(deformation_transfer(source, source, F, target), target)
    np.testing.assert_array_equal(deformation_transfer(source, source, F, target, pinned=[3]), target)


def test_the_source_as_target_gives_the_deformed_source(bumpy, deformed):
    source, F = bumpy
    np.testing.assert_allclose(deformation_transfer(source, deformed, F, source), deformed, atol=1e-12)


def test_a_scaled_and_shifted_source_as_target(bumpy, deformed):
    source, F = bumpy
    result = deformation_transfer(source, deformed, F, 2.5 * source + [1, 2, 3])
    expected = 2.5 * deformed
    np.testing.assert_allclose(result - result[0], expected - expected[0], atol=1e-11)


def test_a_similarity_of_the_source_is_the_same_similarity_of_any_target(bumpy, target, rotation):
    source, F = bumpy
    result = deformation_transfer(source, 1.7 * source @ rotation.T + [4, 5, 6], F, target)
    expected = 1.7 * target @ rotation.T
    np.testing.assert_allclose(result - result[0], expected - expected[0], atol=1e-12)


def test_a_translation_moves_the_target_as_far(bumpy, target):
    source, F = bumpy
    t = np.array([1.0, -2, 0.5])
    np.testing.assert_allclose(deformation_transfer(source, source + t, F, target), target + t, atol=1e-12)


@pytest.mark.parametrize("pinned", [None, [7, 8]])
@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_follows_a_rigid_motion_and_scale_of_all_three(bumpy, deformed, target, rotation, pinned, scale):
    source, F = bumpy
    move = lambda X: scale * (X @ rotation.T + [3.0, -1, 2])  # noqa: E731
    expected = move(deformation_transfer(source, deformed, F, target, pinned=pinned))
    result = deformation_transfer(move(source), move(deformed), F, move(target), pinned=pinned)
    np.testing.assert_allclose(result, expected, rtol=0, atol=1e-9 * scale)


def test_pins_stay_exactly_and_hold_their_component(bumpy, deformed, target):
    source, F = bumpy
    result = deformation_transfer(source, deformed + 9, F, target, pinned=[5, 100, 5])
    np.testing.assert_array_equal(result[[5, 100]], target[[5, 100]])
    np.testing.assert_allclose(result, deformation_transfer(source, deformed, F, target, pinned=[5, 100]), atol=1e-11)
    everything = deformation_transfer(source, deformed, F, target, pinned=np.arange(len(source)))
    np.testing.assert_array_equal(everything, target)


def test_each_component_is_placed_by_itself(two_parts, deformed):
    source, F = two_parts
    half = (len(source) - 1) // 2
    up, forward = np.array([0, 1, 0]), np.array([0, 0, 7])
    moved = np.concatenate([deformed, source[half:-1] + up, source[-1:] + forward])
    target = source * 1.5
    result = deformation_transfer(source, moved, F, target, pinned=[2])
    np.testing.assert_array_equal(result[2], target[2])
    np.testing.assert_allclose(result[half:-1], target[half:-1] + up, atol=1e-12)
    np.testing.assert_array_equal(result[-1], target[-1] + forward)


def test_a_stack_is_its_shapes_one_by_one(bumpy, deformed, target):
    source, F = bumpy
    transfer = DeformationTransfer(source, F, target)
    stack = np.stack([deformed, source, 2 * deformed]).astype(np.float32)
    result = transfer.transfer(stack)
    assert result.shape == stack.shape and result.dtype == np.float64
    for one, shape in zip(result, stack, strict=True):
        np.testing.assert_array_equal(one, transfer(shape))
    assert transfer.transfer(stack[:0]).shape == (0, *source.shape)


def test_a_collapsed_triangle_in_the_deformed_source_is_allowed(bumpy, deformed, target):
    source, F = bumpy
    deformed = deformed.copy()
    deformed[F[10]] = deformed[F[10, 0]]
    onto_itself = deformation_transfer(source, deformed, F, source)
    np.testing.assert_allclose(onto_itself - onto_itself.mean(0), deformed - deformed.mean(0), atol=1e-9)
    assert np.isfinite(deformation_transfer(source, deformed, F, target)).all()


def test_arguments_are_not_written_to(bumpy, deformed, target):
    source, F = bumpy
    arguments = (source, deformed, F, target)
    copies = [a.copy() for a in arguments]
    deformation_transfer(*arguments, pinned=np.array([1]))
    for before, after in zip(copies, arguments, strict=True):
        np.testing.assert_array_equal(before, after)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"V_source": np.zeros((386, 2))}, r"V_source: expected real numbers of shape \(n, 3\)"),
        ({"V_source": np.zeros((386, 3))}, "V_source: expected triangles with an area, got 768 degenerate"),
        ({"V_target": np.zeros((386, 3))}, "V_target: expected triangles with an area"),
        ({"V_target": np.full((386, 3), np.nan)}, "V_target: expected finite coordinates"),
        (
            {"V_target": np.random.default_rng(0).normal(size=(400, 3))},
            "V_target: expected 386 vertices .* got 400",
        ),
        ({"F": [[0, 1, 386]]}, r"F: expected indices in 0\.\.385, got 386"),
        (
            {"V_deformed": np.zeros((385, 3))},
            r"V_deformed: expected .* \(386, 3\) or \(k, 386, 3\), got float64 \(385, 3\)",
        ),
        ({"V_deformed": np.zeros((1, 1, 386, 3))}, "V_deformed: expected real numbers of shape"),
        ({"V_deformed": np.full((386, 3), np.inf)}, "V_deformed: expected finite coordinates, got 1158"),
        ({"pinned": [386]}, r"pinned: expected vertex indices in 0\.\.385, got 386"),
        ({"pinned": [-1]}, "pinned: expected vertex indices .* got -1"),
        ({"pinned": [[1]]}, r"pinned: expected integers of shape \(p,\)"),
        ({"pinned": [0.5]}, "pinned: expected integers"),
    ],
)
def test_bad_input_is_named(bumpy, deformed, target, change, message):
    source, F = bumpy
    arguments = {"V_source": source, "V_deformed": deformed, "F": F, "V_target": target} | change
    with pytest.raises(ValueError, match=message):
        deformation_transfer(**arguments)


def test_by_area_the_result_hardly_depends_on_the_mesh(sphere, target, deformed, bumpy):
    """Triangles cut into four count as before; in the paper's energy they count four times."""
    V, F = bumpy
    cut = F[:, 0] % 3 == 0  # a third of the triangles, each into three about its centre

    def refined(X):
        return np.vstack([X, X[F[cut]].mean(1)])

    centres = len(V) + np.arange(cut.sum())
    a, b, c = F[cut].T
    finer = np.vstack([F[~cut], *(np.column_stack(t) for t in ((a, b, centres), (b, c, centres), (c, a, centres)))])
    moved = {}
    for weights in ("uniform", "area"):
        coarse = DeformationTransfer(V, F, target, pinned=[0], weights=weights).transfer(deformed)
        fine = DeformationTransfer(refined(V), finer, refined(target), pinned=[0], weights=weights)
        moved[weights] = np.abs(fine.transfer(refined(deformed))[: len(V)] - coarse).max()
    assert moved["area"] < 0.5 * moved["uniform"]
    same = DeformationTransfer(V, F, V, weights="area").transfer(deformed)
    np.testing.assert_allclose(same, deformed, atol=1e-10)


def test_unknown_weights_are_refused(bumpy):
    V, F = bumpy
    with pytest.raises(ValueError, match="weights: expected 'uniform' or 'area', got 'angle'"):
        DeformationTransfer(V, F, V, weights="angle")


def with_sliver(thickness):
    """A wavy sheet (49, 3), one of whose triangles is `thickness` times as high as long, and its triangles."""
    V = np.array([[x, y, 0.1 * np.sin(x + 2 * y)] for y in range(7) for x in range(7)])
    F = np.array([t for i in range(48) if i % 7 < 6 and i < 42 for t in ((i, i + 1, i + 7), (i + 1, i + 8, i + 7))])
    slim = next(f for f in F if 24 in f)
    near, far = V[[k for k in slim if k != 24]]
    away = V[24] - (near + far) / 2
    V[24] = (near + far) / 2 + thickness * np.linalg.norm(near - far) * away / np.linalg.norm(away)
    return V, F


@pytest.mark.parametrize("thickness", 10.0 ** -np.arange(1, 12))
def test_a_sliver_throws_no_vertex_away(thickness):
    source, F = with_sliver(thickness)
    deformed = source * [1.1, 1.1, 1.0] + 0.05 * np.sin(np.arange(source.size)).reshape(source.shape)
    target = source * [1.0, 1.3, 0.9]
    found = deformation_transfer(source, deformed, F, target)
    assert np.abs(found - target).max() < 3 * np.abs(deformed - source).max()
    np.testing.assert_allclose(deformation_transfer(source, 2 * source, F, source), 2 * source - source[0], atol=1e-3)


def test_slivers_of_the_template_are_none():
    from toongeo.geometry.deformation.transfer_operators import _fullness
    from toongeo.model import default_model

    model = default_model()
    assert (_fullness(model.mean.astype(float), model.faces.T) == 1).all()
