import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.geometry.rotations.similarity import similarity
from toongeo.io import read_image, read_landmarks
from toongeo.metrics import mesh_quality
from toongeo.model.anatomy.rims import rim_path
from toongeo.model.anatomy.visible_contour import visible_contour
from toongeo.pipeline import align_face, fit_3dmm
from toongeo.render import ScaledOrthographicCamera

DEPTHS = ("keep", "scaled")


def outer_eyes(landmarks):
    return np.linalg.norm(landmarks[36] - landmarks[45])


@pytest.fixture(scope="module")
def girl(cartoon, fits):
    return fits("blue_girl"), cartoon("blue_girl")[1]


def test_reaches_every_landmark_of_the_cartoons(cartoon, aligned):
    for name in CARTOONS:
        face, landmarks = aligned(name), cartoon(name)[1]
        error = np.linalg.norm(face.project(face.vertices[face.landmark_vertices]) - landmarks, axis=1)
        assert np.sqrt((error[17:] ** 2).mean()) <= 1e-3 * outer_eyes(landmarks), name


def test_reaches_every_landmark_of_the_portraits(shared):
    for path in sorted((shared / "data" / "portraits").glob("*.pts")):
        landmarks = read_landmarks(path)
        picture = next(p for p in path.parent.glob(f"{path.stem}.*") if p.suffix != ".pts")
        face = align_face(fit_3dmm(read_image(picture), landmarks), landmarks)
        error = np.linalg.norm(face.project(face.vertices[face.landmark_vertices]) - landmarks, axis=1)
        assert np.sqrt((error[17:] ** 2).mean()) <= 1e-3 * outer_eyes(landmarks), path.stem


def test_landmarks_that_are_met_already_move_nothing(girl):
    fit, _ = girl
    met = fit.project(fit.vertices[fit.landmark_vertices])
    np.testing.assert_allclose(align_face(fit, met).vertices, fit.vertices, atol=1e-6)


def test_anchors_keep_their_depth_by_eq_11(girl):
    fit, landmarks = girl
    for options in ({"flow": False}, {"depth": "keep"}):
        face = align_face(fit, landmarks, **options)
        apart = np.isin(np.arange(68), [*range(36, 48), *range(60, 68)])  # rims may yield to each other
        at = face.landmark_vertices[~apart]
        before, after = (fit.camera.depth(V[at]) for V in (fit.vertices, face.vertices))
        np.testing.assert_allclose(after, before, atol=0.05)


# Landmarks about whose centre a part grows, how far behind them the centre lies (mm), its radius (mm), its growth.
GROWN = {
    "nose": ((range(30, 34), 20, 30, 1.5),),
    "eyes": ((range(36, 42), 8, 22, 1.4), (range(42, 48), 8, 22, 1.4)),
    "chin": ((range(8, 9), 0, 45, 1.4),),
    "mouth": ((range(48, 60), 0, 32, 1.4),),
}


def exaggerated_face(model, part, seed):
    """A random face of which a part has grown about a centre inside, and its landmarks as a camera sees them."""
    rng = np.random.default_rng(seed)
    V = model.vertices(rng.normal(0, 0.8, len(model.identity)))
    for points, behind, radius, growth in GROWN[part]:
        centre = V[model.landmarks[list(points)]].mean(0) - [0, 0, behind]
        near = np.exp(-((np.linalg.norm(V - centre, axis=1) / radius) ** 4))
        V = V + (growth - 1) * near[:, None] * (V - centre)
    camera = ScaledOrthographicCamera.look(rng.uniform(-30, 30), rng.uniform(-10, 10))
    return V, camera.project(V[visible_contour(model, camera, V, model.landmarks)])


@pytest.mark.slow
def test_scaled_depth_is_nearer_to_the_truth_than_kept_depth(model):
    """Mean distance over the face, after the best similarity, of exaggerated faces that are known in 3D."""
    front = model.region("face")
    distances = []
    for part in GROWN:
        for seed in range(2):
            truth, landmarks = exaggerated_face(model, part, seed)
            fit = fit_3dmm(None, landmarks)
            faces = [align_face(fit, landmarks, flow=False), *(align_face(fit, landmarks, depth=d) for d in DEPTHS)]
            for V in (face.vertices[front] for face in faces):
                scale, rotation, shift = similarity(V, truth[front])
                distances.append(np.linalg.norm(scale * V @ rotation.T + shift - truth[front], axis=1).mean())
    plain, kept, scaled = np.reshape(distances, (-1, 3)).mean(0)
    assert scaled < 0.98 * kept and kept < 0.97 * plain


@pytest.mark.parametrize("name", CARTOONS)
def test_lids_and_lips_keep_their_order_and_nothing_folds(cartoon, fits, aligned, name):
    """Also where the drawing is exaggerated once more."""
    fit, landmarks = fits(name), cartoon(name)[1]
    met = fit.project(fit.vertices[fit.landmark_vertices])
    more = align_face(fit, landmarks + 0.2 * (landmarks - met))
    for face, bound in ((aligned(name), 0.003), (more, 0.01)):
        front = face.faces[face.region("face")[face.faces].all(1)]
        assert mesh_quality(face.vertices, front).intersecting_fraction < bound
        px = face.project(face.vertices)
        for side in ("left", "right"):
            upper, lower = (rim_path(face.model, f"lid_{lid}_{side}") for lid in ("upper", "lower"))
            assert (gaps(px, upper, lower) > -1e-3 * outer_eyes(landmarks)).all()


def gaps(px, upper, lower):
    """How far the upper rim is above the lower one, px, at the same places from corner to corner."""
    along = px[upper[-1]] - px[upper[0]]
    along /= np.linalg.norm(along)
    up = np.array([along[1], -along[0]])  # image y runs down
    order = np.argsort(px[lower] @ along)
    return px[upper] @ up - np.interp(px[upper] @ along, (px[lower] @ along)[order], (px[lower] @ up)[order])


@pytest.mark.slow
def test_left_out_landmarks_are_foretold_better_than_by_the_laplacian_alone(cartoon):
    """Every third one, another third in the next picture."""
    found = []
    for k, name in enumerate(CARTOONS):
        hidden = np.arange(68) % 3 == k % 3
        _, landmarks = cartoon(name)
        fewer = np.where(hidden[:, None], np.nan, landmarks)
        fit = fit_3dmm(None, fewer)
        for options in ({}, {"flow": False}):
            face = align_face(fit, fewer, **options)
            error = np.linalg.norm(face.project(face.vertices[face.landmark_vertices]) - landmarks, axis=1)
            found.append(error[hidden].mean() / outer_eyes(landmarks))
    flowed, plain = np.reshape(found, (-1, 2)).mean(0)
    assert flowed < 0.95 * plain and flowed < 0.033


def test_the_jaw_points_end_where_they_are_said_to(girl):
    fit, landmarks = girl
    slid, still = (align_face(fit, landmarks, slide=slide) for slide in (True, False))
    np.testing.assert_array_equal(still.landmark_vertices, fit.landmark_vertices)
    for face in (slid, still):
        error = np.linalg.norm(face.project(face.vertices[face.landmark_vertices]) - landmarks, axis=1)
        assert error.max() < 1e-3 * outer_eyes(landmarks)
    for vertex, line in zip(slid.landmark_vertices, fit.model.contour_lines, strict=False):
        assert vertex in line


def test_a_missing_landmark_anchors_nothing(girl):
    fit, landmarks = girl
    fewer = landmarks.copy()
    fewer[30] = np.nan
    moved = landmarks.copy()
    moved[30] += 40
    face = align_face(fit, fewer)
    nose = fit.landmark_vertices[30]
    assert np.isfinite(face.vertices).all()
    wanted = np.linalg.norm(fit.project(face.vertices[[nose]]) - landmarks[30])
    assert wanted < 0.5 * np.linalg.norm(moved[30] - landmarks[30])
    others = np.arange(68) != 30
    error = face.project(face.vertices[face.landmark_vertices])[others] - landmarks[others]
    assert np.abs(error[17:]).max() < 1e-3 * outer_eyes(landmarks)


@pytest.mark.parametrize("row", [["teeth_upper"], ["teeth_lower", "tongue"]])
def test_each_row_of_teeth_moves_as_a_whole(aligned, row):
    """An affine map carries it, the tongue with the lower one, and stretches no axis twice as much as another."""
    face = aligned("blue_girl")
    fit = face.fit
    parts = np.any([fit.region(name) for name in row], axis=0)
    before = np.column_stack([fit.vertices[parts], np.ones(parts.sum())])
    affine, *_ = np.linalg.lstsq(before, face.vertices[parts], rcond=None)
    np.testing.assert_allclose(before @ affine, face.vertices[parts], atol=1e-9)
    stretches = np.linalg.svd(affine[:3], compute_uv=False)
    assert stretches[0] < 2 * stretches[2]


def test_bad_landmarks_are_refused(girl):
    fit, _ = girl
    with pytest.raises(ValueError, match="landmarks: expected 68 points in iBUG order, got 51"):
        align_face(fit, np.zeros((51, 2)))
    with pytest.raises(ValueError, match="landmarks: expected at least one point"):
        align_face(fit, np.full((68, 2), np.nan))
    with pytest.raises(ValueError, match="depth: expected 'keep' or 'scaled', got 'flat'"):
        align_face(fit, fit.project(fit.vertices[fit.landmark_vertices]), depth="flat")
    with pytest.raises(ValueError, match="landmarks: expected finite px or NaN, got infinity in row 0"):
        align_face(fit, np.full((68, 2), np.inf))
