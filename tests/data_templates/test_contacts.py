"""Nothing passes through anything: lips, lids, eyeballs, the inside of the mouth."""

import igl
import numpy as np
import pytest

from toongeo.model.artist_model import artist_model
from toongeo.render.camera import ScaledOrthographicCamera
from toongeo.render.rasterize import rasterize

pymeshlab = pytest.importorskip("pymeshlab", reason="needs pymeshlab")

JAW_UNITS = ("jawForward", "jawLeft", "jawOpen", "jawRight")


def submesh(F, mask):
    kept = F[mask[F].all(1)]
    ids, local = np.unique(kept, return_inverse=True)
    return ids, local.reshape(-1, 3)


def intersecting(V, F):
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(V, F))
    meshes.compute_selection_by_self_intersections_per_face()
    return meshes.current_mesh().selected_face_number() / len(F)


@pytest.fixture(scope="module")
def model():
    """With the artist's modes, whose N(0, I) is wider than faces of people are."""
    return artist_model()


@pytest.fixture(scope="module")
def face(model):
    ids, F = submesh(model.faces, model.regions["face"])
    return lambda identity=None, expression=None: intersecting(model.vertices(identity, expression)[ids], F)


def weights(model, **units):
    """Expression coefficients; a name without a side means both."""
    out = np.zeros(len(model.expression_names))
    for name, value in units.items():
        sides = [name] if name in model.expression_names else [f"{name}Left", f"{name}Right"]
        for side in sides:
            out[model.expression_index(side)] = value
    return out


def random_identities(model, seed, count):
    return np.random.default_rng(seed).standard_normal((count, len(model.identity)))


def test_random_faces_hardly_intersect_themselves(model, face):
    assert np.mean([face(c) for c in random_identities(model, 0, 50)]) <= 2e-4


@pytest.mark.parametrize("k", range(46))
def test_expressions_hardly_intersect_themselves(model, face, k):
    name = model.expression_names[k]
    units = {name: 1.0, "jawOpen": 1.0} if name == "mouthClose" else {name: 1.0}
    assert face(None, weights(model, **units)) <= 2e-4


@pytest.mark.parametrize("name", ["jawOpen", "eyeBlink", "mouthPucker", "mouthSmile"])
def test_expressions_of_random_faces(model, face, name):
    expression = weights(model, **{name: 1.0})
    assert np.mean([face(c, expression) for c in random_identities(model, 1, 20)]) <= 5e-4


def eyeball_pixels(model, identity, expression, yaw, pitch=0.0):
    """How many pixels show an eyeball, 5 px a mm, seen under yaw and pitch in degrees."""
    V, F = model.vertices(identity, expression), model.faces
    n = len(F)
    for eye in model.eyes:
        centre, radius = eye.placed(identity)
        F = np.vstack([F, eye.faces + len(V)])
        V = np.vstack([V, centre + radius * eye.vertices])
    y, p = np.radians([yaw, pitch])
    turn = np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]])
    tilt = np.array([[1, 0, 0], [0, np.cos(p), -np.sin(p)], [0, np.sin(p), np.cos(p)]])
    x = V @ (tilt @ turn).T * 5
    points = np.column_stack([x[:, 0] + 300, 200 - x[:, 1], x[:, 2]])
    return int((rasterize(points, F, 400, 600).face_ids >= n).sum())


def test_open_eyes_show(model):
    assert eyeball_pixels(model, None, None, 0) > 5000


@pytest.mark.parametrize("yaw", [-20, 0, 20])
def test_blink_covers_the_eyeballs(model, yaw):
    expression = weights(model, eyeBlink=1.0)
    for identity in [None, *random_identities(model, 1, 20)]:
        assert eyeball_pixels(model, identity, expression, yaw) == 0


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_blink_moves_its_own_eye_only(model, side):
    motion = np.linalg.norm(model.expression[model.expression_index(f"eyeBlink{side}")], axis=1)
    other = model.regions["socket_right" if side == "Left" else "socket_left"]
    inside = [model.regions[r] for r in ("mouth_cavity", "teeth_upper", "teeth_lower", "tongue", "neck")]
    assert motion[other | np.any(inside, axis=0)].max() == 0
    x = model.mean[:, 0] * (1 if side == "Left" else -1)
    assert motion[x < -1e-6].max() == 0


def closed_skin(model):
    """Faces of the outer skin and neck, and a strip that closes the slit between the lips."""
    r = model.regions
    F = model.faces[(r["skin"] | r["neck"])[model.faces].all(1)]
    edges = np.vstack([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    key, count = np.unique(np.sort(edges, 1), axis=0, return_counts=True)
    rim = np.unique(key[(count == 1) & r["lips"][key].all(1)])
    x = model.mean[rim, 0]
    corners = rim[[x.argmin(), x.argmax()]]
    upper, lower = (np.unique(np.r_[rim[r[lip][rim]], corners]) for lip in ("lip_upper", "lip_lower"))
    upper, lower = (side[np.argsort(model.mean[side, 0])] for side in (upper, lower))
    strip, i, j = [], 0, 0
    while i + 1 < len(upper) or j + 1 < len(lower):
        forward = j + 1 == len(lower) or (
            i + 1 < len(upper) and model.mean[upper[i + 1], 0] < model.mean[lower[j + 1], 0]
        )
        strip.append([upper[i], lower[j], upper[i + 1] if forward else lower[j + 1]])
        i, j = (i + 1, j) if forward else (i, j + 1)
    strip = np.array([t for t in strip if len(set(t)) == 3])
    return np.vstack([F, strip])


def test_mouth_stays_inside_the_head(model):
    skin = closed_skin(model)
    r = model.regions
    on_skin = np.zeros(len(model.mean), bool)
    on_skin[skin.ravel()] = True
    inside = np.flatnonzero((r["mouth_cavity"] | r["teeth_upper"] | r["teeth_lower"] | r["tongue"]) & ~on_skin)
    for identity in [None, *random_identities(model, 0, 50)]:
        V = model.vertices(identity)
        outside = inside[igl.fast_winding_number(V, skin, V[inside]) < 0.5]
        # Right behind the line where the lips meet, the strip is as good as the skin to 0.3 mm.
        if len(outside):
            assert np.sqrt(igl.point_mesh_squared_distance(V[outside], V, skin)[0]).max() < 0.3


def test_teeth_and_tongue_follow_the_jaw(model):
    r = model.regions

    def motion(name, region):
        return model.expression[model.expression_index(name)][r[region]]

    for name in model.expression_names[:46]:
        assert np.abs(motion(name, "teeth_upper")).max() == 0, name
        if name not in JAW_UNITS:
            assert np.abs(motion(name, "teeth_lower")).max() == 0, name
    assert motion("jawOpen", "teeth_lower")[:, 1].mean() < -8
    assert motion("jawLeft", "teeth_lower")[:, 0].mean() > 2
    assert motion("jawRight", "teeth_lower")[:, 0].mean() < -2
    assert motion("jawForward", "teeth_lower")[:, 2].mean() > 2
    assert motion("jawOpen", "tongue")[:, 1].mean() < -4
    assert motion("tongueOut", "tongue")[:, 2].max() > 15


def test_lower_teeth_move_rigidly(model):
    ids = np.flatnonzero(model.regions["teeth_lower"])
    for name in JAW_UNITS:
        before = model.mean[ids]
        after = before + model.expression[model.expression_index(name)][ids]
        lengths = [np.linalg.norm(x - x[0], axis=1) for x in (before, after)]
        np.testing.assert_allclose(lengths[0], lengths[1], atol=0.05)


def test_frontal_jaw_points_lie_on_the_outline(model):
    """Seen from the front, no face vertex lies farther out than a jaw point, along the line from the face's
    middle."""
    camera = ScaledOrthographicCamera(1.0, np.eye(3), np.zeros(2))
    px = camera.project(model.mean)
    face = px[model.regions["face"]]
    middle = px[model.landmarks[[36, 45]]].mean(0)
    for k in range(2, 15):
        ray = px[model.landmarks[k]] - middle
        reach = np.linalg.norm(ray)
        offset = face - middle
        along, across = offset @ ray / reach, offset @ np.array([-ray[1], ray[0]]) / reach
        assert along[np.abs(across) < 2].max() < reach + 3
