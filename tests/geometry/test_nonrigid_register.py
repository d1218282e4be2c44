"""Registration of meshes: exact where they agree, equivariant, and on the surface elsewhere."""

import numpy as np
import pytest

from toongeo.geometry import nonrigid_register, vertex_normals
from toongeo.geometry.registration.thin_shell import ThinShell

LANDMARKS = np.array([0, 20, 57, 130, 200, 301, 377])


def warped(V):
    """A smooth deformation, up to a tenth of the size."""
    x, y, z = V.T
    return V + 0.1 * np.column_stack([np.sin(y + z), np.cos(x - z), np.sin(1.5 * x)])


def icosphere(levels):
    t = (1 + 5**0.5) / 2
    V = np.array([[-1, t, 0], [1, t, 0], [-1, -t, 0], [1, -t, 0], [0, -1, t], [0, 1, t], [0, -1, -t], [0, 1, -t],
                  [t, 0, -1], [t, 0, 1], [-t, 0, -1], [-t, 0, 1]])  # fmt: skip
    F = np.array([[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2],
                  [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11],
                  [6, 2, 10], [8, 6, 7], [9, 8, 1]])  # fmt: skip
    for _ in range(levels):
        a, b, c = F.T
        mids = [len(V) + k * len(F) + np.arange(len(F)) for k in range(3)]
        V = np.vstack([V, (V[a] + V[b]) / 2, (V[b] + V[c]) / 2, (V[c] + V[a]) / 2])
        F = np.vstack(
            [np.column_stack(x) for x in ([a, mids[0], mids[2]], [b, mids[1], mids[0]], [c, mids[2], mids[1]], mids)]
        )
        V, inverse = np.unique(V.round(12), axis=0, return_inverse=True)
        F = inverse.ravel()[F]
    return V / np.linalg.norm(V, axis=1, keepdims=True), F


def test_a_mesh_lies_on_itself(bumpy):
    V, F = bumpy
    found = nonrigid_register(V, F, V, F, LANDMARKS, LANDMARKS)
    np.testing.assert_allclose(found.vertices, V, atol=1e-9)
    assert found.status == "converged" and found.matched.all()
    assert found.distances.max() < 1e-9 and found.landmark_errors.max() < 1e-9
    on_target = np.einsum("pc,pcd->pd", found.barycentric, V[F[found.faces]])
    np.testing.assert_allclose(on_target, V, atol=1e-9)


def test_a_similarity_is_found_exactly(bumpy, rotation):
    V, F = bumpy
    found = nonrigid_register(V, F, 30 * V @ rotation.T + [5, -7, 100], F, LANDMARKS, LANDMARKS)
    np.testing.assert_allclose(found.vertices, 30 * V @ rotation.T + [5, -7, 100], atol=1e-8)
    np.testing.assert_allclose(found.rotation, rotation, atol=1e-9)
    assert found.scale == pytest.approx(30, rel=1e-9)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_the_result_moves_with_the_target(bumpy, rotation, scale):
    V, F = bumpy
    here = nonrigid_register(V, F, warped(V), F, LANDMARKS, LANDMARKS)
    shift = scale * np.array([1.0, 2, 3])
    there = nonrigid_register(V, F, scale * warped(V) @ rotation.T + shift, F, LANDMARKS, LANDMARKS)
    np.testing.assert_allclose((there.vertices - shift) @ rotation / scale, here.vertices, atol=1e-7)
    np.testing.assert_array_equal(there.matched, here.matched)


def test_a_smooth_deformation_is_recovered(bumpy):
    V, F = bumpy
    landmarks = np.arange(0, len(V), 12)
    target = warped(V)
    found = nonrigid_register(V, F, target, F, landmarks, landmarks)
    aligned = found.scale * V @ found.rotation.T + found.shift
    before, after = (np.linalg.norm(X - target, axis=1).mean() for X in (aligned, found.vertices))
    assert after < 0.15 * before
    assert found.distances.mean() < 0.02 * before


def test_another_triangulation_of_the_surface_is_met(sphere):
    V, F = sphere
    fine, fine_faces = icosphere(4)
    directions = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    found = nonrigid_register(V * [1.2, 1.0, 0.9], F, fine, fine_faces, directions * [1.2, 1, 0.9], directions)
    radius = np.linalg.norm(found.vertices, axis=1)
    assert np.abs(radius - 1).max() < 5e-3  # the facets of the target are 1e-3 inside the sphere
    area = np.einsum("fi,fi->f", np.cross(*(found.vertices[F[:, k]] - found.vertices[F[:, 0]] for k in (1, 2))),
                     found.vertices[F].mean(1))  # fmt: skip
    assert (area > 0).all()  # nothing has turned over


def test_the_two_sides_of_a_thin_part_are_not_confused(sphere):
    V, F = sphere
    thin = V * [1, 1, 0.04]
    landmarks = [int(np.argmax(V @ d)) for d in ([1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0])]
    # A source that is moved by its thickness has the wrong side nearest to it.
    found = nonrigid_register(thin, F, thin + [0, 0, 0.08], F, landmarks, thin[landmarks] + [0, 0, 0.02])
    inner = np.linalg.norm(V[:, :2], axis=1) < 0.8
    normals = vertex_normals(thin, F)[F[found.faces]]
    towards = np.einsum("pc,pcd->pd", found.barycentric, normals)[:, 2]
    assert (np.sign(towards) == np.sign(V[:, 2]))[inner & (np.abs(V[:, 2]) > 0.1)].all()


def test_distances_are_those_to_the_partners_in_the_unit_of_the_target(bumpy, rotation):
    V, F = bumpy
    target = 70 * warped(V) @ rotation.T + [1, 2, 3]
    found = nonrigid_register(V, F, target, F, LANDMARKS, LANDMARKS, iterations=1)
    partners = np.einsum("pc,pcd->pd", found.barycentric, target[F[found.faces]])
    np.testing.assert_allclose(found.distances, np.linalg.norm(found.vertices - partners, axis=1), atol=1e-9)
    np.testing.assert_allclose(
        found.landmark_errors, np.linalg.norm(found.vertices - target, axis=1)[LANDMARKS], atol=1e-9
    )
    assert found.distances.max() > 0.1


@pytest.mark.parametrize(("step", "status"), [(0.99e-3, "converged"), (1.01e-3, "iteration limit")])
def test_a_last_step_of_a_thousandth_has_converged(bumpy, monkeypatch, step, status):
    V, F = bumpy
    monkeypatch.setattr(ThinShell, "laid_on", lambda self, *_: (self.V, step))
    assert nonrigid_register(V, F, V, F, LANDMARKS, LANDMARKS).status == status


@pytest.mark.parametrize(("off", "near"), [(0.099, True), (0.101, False)])
def test_a_partner_within_a_tenth_of_the_spread_of_the_landmarks_is_one(bumpy, monkeypatch, off, near):
    V, F = bumpy
    monkeypatch.setattr(ThinShell, "laid_on", lambda self, *_: (self.V + off * vertex_normals(self.V, F), 0.0))
    found = nonrigid_register(V, F, V, F, LANDMARKS, LANDMARKS)
    unit = np.sqrt(((V[LANDMARKS] - V[LANDMARKS].mean(0)) ** 2).sum(1).mean())
    facing = found.distances > 0.995 * off * unit  # elsewhere the surface bends towards the point
    assert facing.sum() > 100 and (found.matched[facing] == near).all()


def test_landmarks_are_vertices_or_points(bumpy):
    V, F = bumpy
    target = warped(V)
    by_vertex = nonrigid_register(V, F, target, F, LANDMARKS, LANDMARKS)
    by_point = nonrigid_register(V, F, target, F, V[LANDMARKS], target[LANDMARKS])
    np.testing.assert_allclose(by_point.vertices, by_vertex.vertices, atol=1e-7)


def test_missing_landmarks_have_no_effect(bumpy):
    V, F = bumpy
    points = warped(V)[LANDMARKS]
    points[2] = np.nan
    found = nonrigid_register(V, F, warped(V), F, LANDMARKS, points)
    without = nonrigid_register(V, F, warped(V), F, np.delete(LANDMARKS, 2), np.delete(points, 2, axis=0))
    np.testing.assert_array_equal(found.vertices, without.vertices)
    assert np.isnan(found.landmark_errors).tolist() == [k == 2 for k in range(len(LANDMARKS))]


def test_what_lies_beyond_a_border_is_not_drawn_to_it(bumpy):
    V, F = bumpy
    cut = F[(V[F][:, :, 1] > -0.3).all(1)]
    landmarks = np.flatnonzero(V[:, 1] > -0.1)[::9]
    found = nonrigid_register(V, F, V, cut, landmarks, landmarks)
    np.testing.assert_allclose(found.vertices, V, atol=1e-3)  # at the border the target's normals are others
    assert not found.matched[V[:, 1] < -0.5].any() and found.matched[V[:, 1] > 0].all()


def test_unfitted_and_loose_parts_are_taken_along(two_parts):
    V, F = two_parts
    V = V[:-1]
    first = np.arange(len(V)) < len(V) // 2
    found = nonrigid_register(V, F, 2 * V[first] + 1, F[: len(F) // 2], LANDMARKS, LANDMARKS, fitted=first)
    np.testing.assert_allclose(found.vertices, 2 * V + 1, atol=1e-6)


def test_the_same_bits_every_time_and_no_argument_written_to(bumpy):
    V, F = bumpy
    arguments = [V.copy(), F.copy(), warped(V), F.copy(), LANDMARKS.copy(), LANDMARKS.copy()]
    kept = [a.copy() for a in arguments]
    first, second = nonrigid_register(*arguments), nonrigid_register(*arguments)
    np.testing.assert_array_equal(first.vertices, second.vertices)
    for before, after in zip(kept, arguments, strict=True):
        np.testing.assert_array_equal(before, after)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"V_source": np.zeros((0, 3))}, "V_source: expected real numbers"),
        ({"V_target": np.full((4, 3), np.nan)}, "V_target: expected finite"),
        ({"F_source": [[0, 1, 999]]}, r"F_source: expected indices in 0\.\.385, got 999"),
        ({"F_target": np.zeros((0, 3), int)}, "F_target: expected integers"),
        ({"V_source": np.zeros((386, 3))}, "V_source: expected triangles with an area"),
        (
            {"source_landmarks": [0, 1, 2, 3, 4, 5, 386]},
            r"source_landmarks: expected vertex indices .* got 386",
        ),
        (
            {"target_landmarks": [0, 1, 2, 3, 4, 5, -1]},
            r"target_landmarks: expected vertex indices .* got -1",
        ),
        ({"target_landmarks": [0.5, 1.5]}, r"target_landmarks: expected vertex indices \(k,\) or points"),
        ({"target_landmarks": np.full((7, 3), np.inf)}, "target_landmarks: expected finite coordinates or NaN"),
        ({"target_landmarks": [0, 1, 2]}, "target_landmarks: expected 7 as source_landmarks has, got 3"),
        ({"target_landmarks": np.full((7, 3), np.nan)}, "target_landmarks: expected at least 3 .* got 0 of 7"),
        ({"source_landmarks": [4, 4, 4, 4, 4, 4, 4]}, "source_landmarks: expected points that are not all on a line"),
        ({"fitted": np.ones(3, bool)}, r"fitted: expected bool of shape \(386,\)"),
        ({"landmark_weight": 0.0}, "landmark_weight: expected a number"),
        ({"landmark_weight": [1.0, 2.0]}, "landmark_weight: expected a number"),
        ({"stiffness": ()}, "stiffness: expected at least one"),
        ({"stiffness": (1.0, np.nan)}, "stiffness: expected at least one"),
        ({"iterations": 0}, "iterations: expected a whole number"),
    ],
)
def test_bad_input_is_named(bumpy, change, message):
    V, F = bumpy
    arguments = {
        "V_source": V, "F_source": F, "V_target": V, "F_target": F,
        "source_landmarks": LANDMARKS, "target_landmarks": LANDMARKS, **change,
    }  # fmt: skip
    with pytest.raises(ValueError, match=message):
        nonrigid_register(**arguments)


def test_a_mesh_that_is_inside_out_is_refused(bumpy):
    V, F = bumpy
    with pytest.raises(ValueError, match="V_target: expected a surface on which the source can be laid"):
        nonrigid_register(V, F, V, F[:, ::-1], LANDMARKS, LANDMARKS)


def test_degenerate_triangles_of_the_target_do_no_harm(bumpy):
    V, F = bumpy
    found = nonrigid_register(V, F, V, np.vstack([F, [[0, 0, 1], [5, 5, 5]]]), LANDMARKS, LANDMARKS)
    np.testing.assert_allclose(found.vertices, V, atol=1e-9)
