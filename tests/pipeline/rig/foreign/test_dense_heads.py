"""Heads of very many vertices, of loose triangles, and with lips that are one surface."""

import numpy as np
import pytest
from scipy.ndimage import grey_closing

from toongeo.geometry.operators.adjacency import adjacency
from toongeo.geometry.operators.vertex_components import vertex_components
from toongeo.pipeline.rig.foreign import rig_mesh as module
from toongeo.pipeline.rig.foreign.back_to_dense import back_to_dense
from toongeo.pipeline.rig.foreign.mouth_opens import mouth_opens
from toongeo.pipeline.rig.foreign.rig_mesh import rig_mesh
from toongeo.pipeline.rig.foreign.thinned_mesh import thinned_mesh


def sheet(n):
    """A square of n x n vertices, and its triangles."""
    y, x = np.mgrid[:n, :n]
    k = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]))
    V = np.column_stack([x.ravel(), y.ravel(), np.zeros(n * n)]).astype(float)
    return V, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def test_thinning_keeps_the_surface_its_winding_and_its_gaps():
    V, F = sheet(60)
    whole = thinned_mesh(V, F, len(V))
    assert whole[0].tolist() == list(range(len(V))) and whole[1] is F
    two = np.vstack([V, V + [0, 0, 1e-3]]), np.vstack([F, F + len(V)])  # two sheets, almost in one place
    kept, faces = thinned_mesh(*two, 2000)
    assert len(kept) <= 2000 and (np.diff(kept) > 0).all()
    again = thinned_mesh(*two, 2000)
    assert all(np.array_equal(a, b) for a, b in zip((kept, faces), again, strict=True))
    corners = two[0][kept][faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    assert (normals > 0).mean() > 0.99 and 0.9 < normals.sum() / 2 / (2 * 59**2) < 1.02
    part = vertex_components(faces, len(kept))
    assert len(np.unique(part)) == 2 and len({(kept[part == p] >= len(V)).all() for p in (0, part.max())}) == 2
    around = adjacency(two[1], len(two[0]))[kept][:, kept]
    small = thinned_mesh(*sheet(20), 10)
    assert len(small[0]) == 400  # a small part is left whole
    assert around.nnz < len(kept)  # hardly two that stay were side by side before


def test_what_is_linear_comes_back_exactly_and_each_part_from_itself():
    V, F = sheet(60)
    both = np.vstack([V, V + [0, 0, 0.01]]), np.vstack([F, F + len(V)])
    kept, faces = thinned_mesh(*both, 2000)
    upper = (np.arange(2 * len(V)) >= len(V)).astype(float)
    shape = (both[0] @ np.array([[0.1, 0.2, 0], [0, 0.3, 0.1], [0, 0, 0]]) + upper[:, None]).astype(np.float32)
    found = back_to_dense(*both, kept, faces, shape[kept][None])[0]
    inside = ((both[0][:, :2] > 3) & (both[0][:, :2] < 56)).all(1)
    np.testing.assert_allclose(found[inside], shape[inside], atol=1e-4)
    assert np.abs(found - shape).max() < 1.5  # at the border the nearest point of the thinned mesh has to do


@pytest.fixture(scope="module")
def whole(model):
    return rig_mesh(model.mean, model.faces, model.landmarks)


@pytest.mark.slow
def test_a_thinned_head_moves_nearly_as_the_whole(model, whole, monkeypatch):
    monkeypatch.setattr(module, "_MOST_VERTICES", 8000)
    found = rig_mesh(model.mean, model.faces, model.landmarks)
    assert found.deltas.shape == whole.deltas.shape and found.report.mouth_opens
    off = np.linalg.norm(found.deltas - whole.deltas, axis=2)
    moved = np.linalg.norm(whole.deltas, axis=2)
    face = model.region("face")
    assert np.sqrt((off[:, face] ** 2).mean()) < 0.15 * np.sqrt((moved[:, face] ** 2).mean())
    jaw = whole.names.index("jawOpen")
    gap = [(r.vertices({"jawOpen": 1})[model.landmarks[[62, 66]]] @ [0, 1, 0]) @ [1, -1] for r in (found, whole)]
    assert gap[0] > 0.8 * gap[1] > 3 and moved[jaw].max() > 5


@pytest.mark.slow
def test_loose_triangles_move_as_one_surface(model, whole):
    torn = model.faces.ravel()
    V, F = model.mean[torn], np.arange(len(torn)).reshape(-1, 3)
    found = rig_mesh(V, F, model.mean[model.landmarks])
    assert np.abs(found.deltas - whole.deltas[:, torn]).max() < 0.5
    first = np.unique(torn, return_index=True)[1]
    copies = np.abs(found.deltas - found.deltas[:, first][:, np.searchsorted(torn[first], torn)])
    border = np.isin(torn, np.unique(torn)[np.bincount(torn)[np.unique(torn)] > 0])
    assert copies[:, border].max() == 0 and len(found.neutral) == len(V)


def fused(model):
    """The face as a sheet over the picture plane, which knows no gap between lips."""
    from toongeo.render import ScaledOrthographicCamera, rasterize

    V = model.mean
    front = model.region("face") & model.region("skin")
    camera = ScaledOrthographicCamera.look(
        size=160, centre=V[front].mean(0), extent=1.2 * np.ptp(V[front], axis=0).max()
    )
    px = np.column_stack([np.asarray(camera.project(V))[:, :2], camera.depth(V)])
    skin = model.faces[model.region("skin")[model.faces].all(1)]
    fragments = rasterize(px, skin, 160, 160)
    seen = fragments.face_ids >= 0
    corners = V[skin[fragments.face_ids[seen]]]
    places = np.full((160, 160, 3), np.nan)
    places[seen] = np.einsum("pc,pcd->pd", fragments.barycentrics[seen], corners)
    for column in places.swapaxes(0, 1):  # what is seen through gaps is covered
        known = np.flatnonzero(np.isfinite(column[:, 0]))
        if len(known):
            rows = np.arange(known[0], known[-1] + 1)
            column[rows] = np.column_stack([np.interp(rows, known, column[known, axis]) for axis in range(3)])
    places[..., 2] = grey_closing(places[..., 2], (9, 9))  # and so is what is seen through the slit of the mouth
    _, F = sheet(160)
    P = places.reshape(-1, 3)
    F = F[np.isfinite(P[F]).all((1, 2))][:, ::-1]
    used = np.unique(F)
    return P[used], np.searchsorted(used, F)


def test_lips_that_are_one_surface_are_told_from_lips_that_touch(model):
    points = model.mean[model.landmarks]
    assert mouth_opens(model.mean, model.faces, points) is True
    V, F = fused(model)
    assert mouth_opens(V, F, points) is False
    lost = points.copy()
    lost[51] = np.nan
    assert mouth_opens(V, F, lost) is None
    bare = model.faces[model.region("skin")[model.faces].all(1)]  # a slit, and nothing behind it
    assert mouth_opens(model.mean, bare, points) is True
