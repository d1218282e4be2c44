"""The compiled template: its layout, its mirror symmetry, its surface, its atlas and its tables."""

import csv
from pathlib import Path

import numpy as np
import pytest

from toongeo.model import data_path
from toongeo.model.ibug68 import MIRROR as MIRRORED_POINT

FLIP = np.array([-1.0, 1.0, 1.0])


@pytest.fixture(scope="module")
def archive():
    with np.load(data_path("data_templates/head.npz"), allow_pickle=False) as z:
        return {name: z[name] for name in z.files}


def table(name):
    with open(data_path(f"data_templates/{name}.csv"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def other_side(name):
    return name.replace("left", "right") if "left" in name else name.replace("right", "left")


def test_layout(archive):
    n0, q0 = len(archive["mean"]), len(archive["quads"])
    n1 = len(archive["mirror"])
    assert archive["identity"].shape == (80, n0, 3) and archive["identity"].dtype == np.float16
    assert archive["expression"].shape == (64, n0, 3) and archive["expression"].dtype == np.float16
    assert archive["quad_part"].shape == (q0,) and archive["uv_quads"].shape == (q0, 4)
    assert archive["quad_part"].max() == 7
    assert archive["diagonal"].shape == (4 * q0,) and archive["diagonal"].dtype == bool
    assert archive["albedo_mean"].shape == (n1, 3) and archive["albedo"].shape == (9, n1, 3)
    assert archive["region_bits"].shape == (len(table("regions")), -(-n1 // 8))
    assert archive["eye_centre"].shape == (2, 3) and archive["eye_uv"].shape[0] == 2
    assert all(np.isfinite(a).all() for a in archive.values() if a.dtype.kind == "f")


def test_size_of_the_file():
    assert Path(data_path("data_templates/head.npz")).stat().st_size <= 6e6


def test_frame(model):
    left, right = model.eyes
    np.testing.assert_allclose((left.centre + right.centre) / 2, 0, atol=0.3)
    assert left.centre[0] > 25 and model.mean[model.landmarks[30], 2] > 30
    assert 55 < left.centre[0] - right.centre[0] < 68


def test_mean_and_mirror_map(model):
    assert np.array_equal(model.mirror[model.mirror], np.arange(len(model.mean)))
    np.testing.assert_allclose(model.mean[model.mirror] * FLIP, model.mean, atol=1e-4)


def test_identity_modes_are_symmetric_or_antisymmetric(model):
    kinds = []
    for mode in model.identity:
        mirrored = mode[model.mirror] * FLIP
        same, opposite = np.abs(mirrored - mode).max(), np.abs(mirrored + mode).max()
        assert min(same, opposite) < 0.01
        kinds.append(same < opposite)
    assert sum(kinds) == 71  # the mean of people among them


def test_expressions_left_and_right_are_mirror_images(model):
    names = list(model.expression_names)
    for name, mode in zip(names[: model.n_named], model.expression, strict=False):
        partner = name.replace("Left", "Right") if "Left" in name else name.replace("Right", "Left")
        mirrored = model.expression[names.index(partner)][model.mirror] * FLIP
        np.testing.assert_allclose(mirrored, mode, atol=0.02, err_msg=name)


def test_extra_modes_are_symmetric_or_antisymmetric(model):
    for mode in model.expression[model.n_named :]:
        mirrored = mode[model.mirror] * FLIP
        assert min(np.abs(mirrored - mode).max(), np.abs(mirrored + mode).max()) < 0.01


def test_landmarks_and_contours_are_mirrored(model):
    assert np.array_equal(model.mirror[model.landmarks], model.landmarks[MIRRORED_POINT])
    for k, line in enumerate(model.contour_lines[:8]):
        assert np.array_equal(model.mirror[line], model.contour_lines[16 - k])
        assert model.landmarks[k] in line
        assert len(set(line.tolist())) == len(line) >= 5


def test_albedo_mean_is_symmetric(model):
    np.testing.assert_allclose(model.albedo_mean[model.mirror], model.albedo_mean, atol=2e-3)
    assert model.albedo_mean.min() >= 0 and model.albedo_mean.max() <= 1


def test_regions_are_mirrored(model):
    for name, mask in model.regions.items():
        assert np.array_equal(mask[model.mirror], model.regions[other_side(name)]), name
        assert mask.any()


def test_regions_nest(model):
    r = model.regions
    for name in ("lips", "mouth", "eye_left", "nose", "cheek_left", "jaw", "forehead", "brow_left"):
        assert not (r[name] & ~r["face"]).any(), name
    assert not (r["face"] & (r["ears"] | r["neck"] | r["mouth_cavity"] | r["scalp"])).any()
    assert np.array_equal(r["lip_upper"] | r["lip_lower"], r["lips"])
    assert np.array_equal(r["skin"], r["face"] | r["scalp"] | r["ears"])
    assert r["face"][model.landmarks[17:]].all()


def test_surface_is_manifold_and_oriented(model):
    F = model.faces
    directed = np.vstack([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    assert len(np.unique(directed, axis=0)) == len(directed)  # an edge runs once in each direction at most
    assert np.unique(np.sort(directed, 1), axis=0, return_counts=True)[1].max() <= 2


def test_triangulation_is_mirror_symmetric(model):
    mirrored = model.mirror[model.faces]
    assert {tuple(sorted(f)) for f in model.faces.tolist()} == {tuple(sorted(f)) for f in mirrored.tolist()}


def test_no_degenerate_triangle_and_outward_normals(model):
    a, b, c = model.mean[model.faces].swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    assert np.linalg.norm(normal, axis=1).min() > 1e-4
    face = model.regions["face"][model.faces].all(1)
    outward = ((a + b + c) / 3 - [0, -40, -60]) * normal
    assert (outward[face].sum(1) > 0).mean() > 0.97


def signed_uv_area(uv, faces):
    a, b, c = uv[faces].swapaxes(0, 1)
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def test_atlas_has_no_flipped_triangle(model):
    assert model.uv.min() >= 0 and model.uv.max() <= 1
    assert (signed_uv_area(model.uv, model.uv_faces) > 0).all()
    for eye in model.eyes:
        assert (signed_uv_area(eye.uv, eye.faces) > 0).all()


def test_atlas_has_no_overlap(model):
    """Every triangle shrunk a little about its centre covers texels of its own: none is claimed twice."""
    from toongeo.render.rasterize import rasterize

    size = 2048
    everything = [(model.uv, model.uv_faces)] + [(eye.uv, eye.faces) for eye in model.eyes]
    corners = np.vstack([uv[faces].reshape(-1, 2) for uv, faces in everything]).reshape(-1, 3, 2)
    corners = corners + 0.02 * (corners.mean(1, keepdims=True) - corners)
    px = np.column_stack([corners[..., 0].ravel() * size - 0.5, (1 - corners[..., 1].ravel()) * size - 0.5])
    faces = np.arange(len(px)).reshape(-1, 3)
    first = rasterize(px, faces, size, size).face_ids
    last = len(faces) - 1 - rasterize(px, faces[::-1], size, size).face_ids  # at equal depth the lower row wins
    covered = first >= 0
    assert (first[covered] == last[covered]).all()


def test_islands_keep_their_distance(model):
    import cv2

    from toongeo.render.rasterize import rasterize

    size = 1024
    n = model.uv_faces.max() + 1
    uv = np.vstack([model.uv, *(eye.uv for eye in model.eyes)])
    shift = np.cumsum([len(model.uv)] + [len(eye.uv) for eye in model.eyes])[:2]
    faces = np.vstack([model.uv_faces, *(eye.faces + s for eye, s in zip(model.eyes, shift, strict=True))])
    assert n <= len(model.uv)
    label = _components(len(uv), faces)[faces[:, 0]]
    px = np.column_stack([uv[:, 0] * size - 0.5, (1 - uv[:, 1]) * size - 0.5])
    ids = rasterize(px, faces, size, size).face_ids
    owner = np.where(ids >= 0, label[ids], -1)
    grown = np.zeros((size, size), int)
    for island in np.unique(label):
        grown += cv2.dilate((owner == island).astype(np.uint8), np.ones((5, 5), np.uint8))
    assert grown.max() == 1  # two texels round each: four between any two


def _components(n, faces):
    import scipy.sparse as sp
    from scipy.sparse.csgraph import connected_components

    edges = np.vstack([faces[:, :2], faces[:, 1:]])
    graph = sp.coo_matrix((np.ones(len(edges)), edges.T), shape=(n, n))
    return connected_components(graph, directed=False)[1]


def test_face_is_upright_and_large_in_the_atlas(model):
    at = {}
    for corner in range(3):
        at.update(zip(model.faces[:, corner].tolist(), model.uv[model.uv_faces[:, corner]], strict=True))
    eye_right, eye_left, chin, brow = (at[int(model.landmarks[k])] for k in (36, 45, 8, 27))
    assert eye_left[0] - eye_right[0] > 0.2 and brow[1] - chin[1] > 0.2
    assert abs(eye_left[1] - eye_right[1]) < 0.01
    face = signed_uv_area(model.uv, model.uv_faces)[model.regions["face"][model.faces].all(1)].sum()
    assert face > 0.2


def test_tables(model):
    assert [int(r["index"]) for r in table("landmarks")] == list(range(68))
    assert [int(r["line"]) for r in table("contours")] == list(range(17))
    names = [r["name"] for r in table("expressions")]
    assert names == sorted(names) == list(model.expression_names[:46])
    aliases = {r["arkit"] for r in table("expressions")}
    assert len(aliases) == 44 and {"browInnerUp", "cheekPuff"} <= aliases
    assert all(r["description"] for t in ("expressions", "regions") for r in table(t))
