"""The albedo basis on the committed head: symmetric, in range, orthogonal, repeatable; and its colours."""

import csv
import sys
from pathlib import Path

import numpy as np
import pytest
from skimage.color import lab2rgb

from toongeo.geometry import catmull_clark

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build"))

import albedo
import face_paint
import skin_colour
from albedo import albedo_basis

TEMPLATE = Path(albedo.__file__).parents[1]
SKIN, NECK, CAVITY, UPPER, LOWER, TONGUE = 0, 1, 2, 5, 6, 7


def rows(name: str) -> list[dict[str, str]]:
    with open(TEMPLATE / name, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


@pytest.fixture(scope="module")
def head():
    """The arguments of `albedo_basis` but rng, from the committed template, and its mirror map."""
    with np.load(TEMPLATE / "head.npz", allow_pickle=False) as data:
        quads = data["quads"].astype(int)
        S, quads1 = catmull_clark(quads, len(data["mean"]))
        bits, quad_part = data["region_bits"], np.repeat(data["quad_part"], 4)
        mirror = data["mirror"].astype(int)
        vertices = S @ data["mean"].astype(float)
    part = np.full(len(vertices), -1)
    for k in range(7, -1, -1):
        part[np.unique(quads1[quad_part == k])] = k
    masks = np.unpackbits(bits, axis=1)[:, : len(vertices)].astype(bool)
    faces = np.vstack([quads1[:, [0, 1, 2]], quads1[:, [0, 2, 3]]])
    a, b, c = vertices[faces].swapaxes(0, 1)
    normals = np.zeros_like(vertices)
    np.add.at(normals, faces.ravel(), np.repeat(np.cross(b - a, c - a), 3, axis=0))
    arguments = {
        "vertices_l1": vertices,
        "normals_l1": normals / np.linalg.norm(normals, axis=1, keepdims=True),
        "landmarks": np.array([int(r["vertex"]) for r in rows("landmarks.csv")]),
        "regions": {r["name"]: m for r, m in zip(rows("regions.csv"), masks, strict=True)},
        "part": part,
        "faces": faces,
    }
    return arguments, mirror


@pytest.fixture(scope="module")
def basis(head):
    return albedo_basis(**head[0], rng=np.random.default_rng(0))


def test_shapes_and_range_within_two_and_a_half_deviations(head, basis):
    mean, modes = basis
    n = len(head[0]["vertices_l1"])
    assert mean.shape == (n, 3) and modes.shape == (9, n, 3)
    assert mean.min() > 0 and mean.max() < 1
    for sign in (-2.5, 2.5):
        moved = mean + sign * modes
        assert moved.min() > 0 and moved.max() < 1


def test_exactly_symmetric(head, basis):
    mirror = head[1]
    for value in (basis[0], *basis[1]):
        np.testing.assert_array_equal(value, value[mirror])


def test_modes_are_orthogonal_ordered_and_brighten(basis):
    flat = basis[1].reshape(9, -1)
    gram = flat @ flat.T
    size = np.diag(gram)
    assert (np.diff(size) < 0).all()
    np.testing.assert_allclose(gram / np.sqrt(np.outer(size, size)), np.eye(9), atol=1e-9)
    assert (flat.sum(1) > 0).all()
    assert size[0] > 0.9 * size.sum()  # light to dark skin is what differs most


def test_only_skin_varies(head, basis):
    inner = head[0]["part"] > NECK
    assert (basis[1][:, inner] == 0).all()
    assert (np.abs(basis[1][0][~inner]).max(1) > 0).all()


def test_same_generator_same_bits(head, monkeypatch):
    monkeypatch.setattr(albedo, "SAMPLES", 30)
    one, two, other = (albedo_basis(**head[0], rng=np.random.default_rng(k)) for k in (5, 5, 6))
    for a, b in zip(one, two, strict=True):
        np.testing.assert_array_equal(a, b)
    assert np.abs(one[0] - other[0]).max() > 0


def test_principal_modes_recover_what_the_samples_were_made_of(rng):
    weights = rng.integers(1, 3, 40).astype(float)
    truth = rng.standard_normal((2, 40, 3))
    w = weights[:, None]
    truth[1] -= truth[0] * (w * truth[0] * truth[1]).sum() / (w * truth[0] ** 2).sum()
    truth[0] *= 3
    truth *= np.sign((truth * w).sum((1, 2)))[:, None, None]
    score = np.linalg.qr(rng.standard_normal((50, 2)))[0] * np.sqrt(50)  # uncorrelated, unit variance
    found = albedo._principal_modes(np.tensordot(score, truth, 1), weights)
    np.testing.assert_allclose(found[:2], truth, atol=1e-12)
    np.testing.assert_allclose(found[2:], 0, atol=1e-6)


def test_areas_have_their_colours(head, basis):
    mean, regions, part = basis[0], head[0]["regions"], head[0]["part"]
    skin = np.median(mean[regions["face"]], axis=0)
    red = mean[:, 0] / mean.mean(1)
    assert 0.6 < skin[0] < 0.9 and skin[0] > skin[1] > skin[2]
    assert np.median(red[regions["lips"]]) > np.median(red[regions["face"]]) + 0.04
    assert np.median(red[regions["cheek_left"]]) > np.median(red[regions["forehead"]])
    brow = mean[head[0]["landmarks"][[19, 24]]]
    assert (brow.mean(1) < 0.8 * skin.mean()).all()
    for k in (UPPER, LOWER):
        bright = mean[part == k].min(1)
        assert 0.6 < np.percentile(bright, 98) < 0.8 and np.percentile(bright, 2) < 0.3
    assert mean[part == CAVITY].mean() < mean[part == TONGUE].mean() < skin.mean()


def test_lab_agrees_with_scikit_image(rng):
    lab = np.column_stack([rng.uniform(10, 90, 200), rng.uniform(-5, 30, 200), rng.uniform(0, 30, 200)])
    np.testing.assert_allclose(skin_colour.lab_to_srgb(lab), lab2rgb(lab), atol=2e-3)
    np.testing.assert_allclose(skin_colour.lab_to_srgb(np.array([100.0, 0, 0])), 1.0, atol=1e-3)
    assert (skin_colour.lab_to_srgb(np.array([0.0, 0, 0])) == 0).all()


def test_skin_tones_pass_through_the_table_and_hair_darkens():
    np.testing.assert_allclose(skin_colour.skin_tone(58.2), [58.2, 11.5, 15.9])
    between = skin_colour.skin_tone(np.array([40.0, 70.0]))
    assert between.shape == (2, 3) and (between[:, 1:] > 5).all()
    shades = [skin_colour.hair_colour(d, 0.2).mean() for d in (0.0, 0.4, 0.7, 1.0)]
    assert (np.diff(shades) < 0).all()


def test_appearances_are_skin_like(rng):
    drawn = [skin_colour.draw_appearance(rng) for _ in range(400)]
    tone = np.array([a["tone"] for a in drawn])
    assert tone.min() >= 30 and tone.max() <= 82 and 60 < tone.mean() < 72 and 7 < tone.std() < 11
    beard = np.array([a["beard"] for a in drawn])
    assert 0.4 < (beard == 0).mean() < 0.6 and beard.max() <= 1


def test_mirror_map_keeps_touching_surfaces_apart():
    v = np.array([[1.0, 0, 0], [-1, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [5, 5, 5]])
    up = np.array([0.0, 1, 0])
    normals = np.array([up, up, -up, -up, up, up])
    assert face_paint.mirror_map(v, normals, np.zeros(6, int)).tolist() == [1, 0, 3, 2, 4, 5]
    sockets = np.array([3, 4, 0, 0, 0, 0])  # a socket's twin is the other socket
    assert face_paint.mirror_map(v, normals, sockets).tolist() == [1, 0, 3, 2, 4, 5]


def test_smoothing_keeps_constants_and_the_range(rng):
    faces = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2]])
    smooth = face_paint.smoothing(faces, 6)  # vertex 5 is alone
    np.testing.assert_allclose(smooth @ np.ones(6), 1.0)
    value = smooth @ np.array([1.0, 0, 0, 0, 0, 0])
    np.testing.assert_allclose(value, [0.5, 1 / 6, 1 / 8, 0, 0, 0])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"normals_l1": np.zeros((3, 3))}, "normals_l1: expected"),
        ({"landmarks": np.zeros(67, int)}, r"landmarks: expected \(68,\)"),
        ({"landmarks": np.full(68, 10**6)}, r"landmarks: expected \(68,\)"),
        ({"part": np.zeros(4, int)}, "part: expected"),
        ({"faces": np.array([[0, 1, -1]])}, "faces: expected"),
        ({"regions": {}}, "regions: expected 'lips'"),
    ],
)
def test_bad_arguments(head, change, message):
    with pytest.raises(ValueError, match=message):
        albedo_basis(**(head[0] | change), rng=np.random.default_rng(0))


def test_other_teeth_are_refused(head, monkeypatch):
    monkeypatch.setattr(albedo, "SAMPLES", 12)
    part = head[0]["part"].copy()
    part[np.flatnonzero(part == UPPER)[0]] = TONGUE
    with pytest.raises(ValueError, match="part: expected 1287 vertices of teeth_quads in part 5, got 1286"):
        albedo_basis(**(head[0] | {"part": part}), rng=np.random.default_rng(0))
