"""The rows of teeth: one clean, symmetric cage a jaw, and the shade that names its parts."""

import csv
import sys
from pathlib import Path

import numpy as np
import pytest

from toongeo.geometry import catmull_clark

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build"))

import teeth as module
from teeth import teeth_quads, teeth_shade

JAWS = ("upper", "lower")
COLUMNS, ROWS = 43, 8


def strip(jaw: str) -> np.ndarray:
    """A made-up strip: an arch 60 wide and 50 deep, its gum 18 above (below) its edge."""
    up = 1.0 if jaw == "upper" else -1.0
    s = np.linspace(0, 1, 9)
    arch = np.column_stack([30 * np.sin(0.5 * np.pi * s) ** 0.9, 5 * s**2, -50 * s**1.8])
    shift = {"gum": (18 * up, 3.0), "mid": (9 * up, 1.5), "edge": (0.0, 0.0), "inner": (9 * up, -6.0)}
    out = np.full((68, 3), 1e3)
    with open(Path(module.__file__).with_name("teeth_strips.csv"), encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["jaw"] == jaw:
                y, z = shift[row["row"]]
                out[np.array(row["vertices"].split(), int)] = arch + np.array([0.0, y, z])
    return out


@pytest.fixture(scope="module")
def teeth():
    return teeth_quads(strip("upper"), strip("lower"))


def triangles(quads):
    return np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


@pytest.mark.parametrize("jaw", JAWS)
def test_small_manifold_and_consistently_wound(teeth, jaw):
    Q = teeth[f"quads_{jaw}"]
    assert len(Q) <= 500
    assert set(np.unique(Q)) == set(range(len(teeth[f"vertices_{jaw}"])))
    directed = np.stack([Q, np.roll(Q, -1, axis=1)], -1).reshape(-1, 2)
    assert len(np.unique(directed, axis=0)) == len(directed)  # at most two quads an edge, and they agree
    single = {tuple(e) for e in directed} - {tuple(e[::-1]) for e in directed}
    following = dict(single)
    loop, at = [], next(iter(following))
    while at not in loop:
        loop.append(at)
        at = following[at]
    assert len(loop) == len(single) == 2 * COLUMNS  # one boundary, along both gums


@pytest.mark.parametrize("jaw", JAWS)
def test_outward(teeth, jaw):
    V, Q = teeth[f"vertices_{jaw}"], teeth[f"quads_{jaw}"]
    S, quads1 = catmull_clark(Q, len(V))
    fine = S @ V
    a, b, c = fine[triangles(quads1)].swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    unit = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    depth = (a + b + c)[:, 2] / 3
    outer = (depth > fine[:, 2].max() - 2) & (np.abs(unit[:, 2]) > 0.5)
    assert outer.any() and (unit[outer, 2] > 0).all()
    biting = np.abs(unit[:, 1]) > 0.9
    assert biting.any() and (unit[biting, 1] * (-1 if jaw == "upper" else 1) > 0).all()


@pytest.mark.parametrize("jaw", JAWS)
def test_mirror_symmetry_is_exact(teeth, jaw):
    V, Q, uv = teeth[f"vertices_{jaw}"] + 0.0, teeth[f"quads_{jaw}"], teeth[f"uv_{jaw}"]
    index = {tuple(v): i for i, v in enumerate(V)}
    assert len(index) == len(V)
    mirror = np.array([index[tuple(v * [-1, 1, 1] + 0.0)] for v in V])
    faces = {frozenset(q) for q in Q.tolist()}
    assert {frozenset(mirror[list(q)].tolist()) for q in faces} == faces
    np.testing.assert_allclose(uv[mirror], [1, 0] + uv * [-1, 1], atol=1e-15)


@pytest.mark.parametrize("jaw", JAWS)
def test_uv_tiles_the_unit_square_once(teeth, jaw):
    Q, uv = teeth[f"quads_{jaw}"], teeth[f"uv_{jaw}"]
    assert uv.min() == 0 and uv.max() == pytest.approx(1)
    corners = uv[Q]
    a = np.roll(corners, -1, 1) - corners
    b = np.roll(a, -1, 1)
    turn = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    assert (np.abs(turn) > 1e-7).all() and len(np.unique(np.sign(turn))) == 1  # convex, none flipped
    x, y = corners[..., 0], corners[..., 1]
    area = 0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum(1)
    assert np.abs(area.sum()) == pytest.approx(1)  # of one sign and of the square's area: nothing overlaps
    v = uv[:, 1].reshape(ROWS, COLUMNS)
    assert (np.diff(v[:, 0]) > 0).all() and np.ptp(v, axis=1).max() == 0  # bands from outer to inner gum


@pytest.mark.parametrize("scale", [1e-4, 1e-2, 1e4])
def test_equivariant_to_scale_and_to_lifting(teeth, scale):
    shift = np.array([0.0, 3.0, -7.0])
    other = teeth_quads(scale * (strip("upper") + shift), scale * (strip("lower") + shift))
    for jaw in JAWS:
        want = scale * (teeth[f"vertices_{jaw}"] + shift)
        np.testing.assert_allclose(other[f"vertices_{jaw}"], want, atol=1e-9 * scale)
        np.testing.assert_allclose(other[f"uv_{jaw}"], teeth[f"uv_{jaw}"], atol=1e-9)


def test_follows_the_strips_and_closes_without_meeting(teeth):
    upper, lower = (teeth[f"vertices_{jaw}"].reshape(ROWS, COLUMNS, 3) for jaw in JAWS)
    np.testing.assert_allclose(upper[0, :, 1].max(), 20, atol=4)  # the outer gum of the made-up strip
    assert np.abs(upper[..., 0]).max() < 36
    smooth = {j: catmull_clark(teeth[f"quads_{j}"], ROWS * COLUMNS)[0] @ teeth[f"vertices_{j}"] for j in JAWS}
    front = {j: v[np.abs(v[:, 0]) < 8] for j, v in smooth.items()}
    assert 0 < front["upper"][:, 1].min() - front["lower"][:, 1].max() < 5
    assert upper[4, COLUMNS // 2, 2] > lower[4, COLUMNS // 2, 2] + 1  # overjet


def test_fourteen_teeth_bulge_between_their_contacts(teeth):
    for jaw in JAWS:
        V = teeth[f"vertices_{jaw}"].reshape(ROWS, COLUMNS, 3)
        crown = V[3]
        contact = np.arange(COLUMNS) % 3 == 0
        assert contact.sum() - 1 == 14
        inner = np.flatnonzero(contact)[1:-1]
        # the contact lies behind the chord between the two crowns beside it, seen from above
        centre = np.array([0.0, -30.0])
        reach = np.linalg.norm(crown[:, [0, 2]] - centre, axis=1)
        assert (reach[inner] < 0.5 * (reach[inner - 1] + reach[inner + 1]) - 0.3).all()
    upper = teeth["vertices_upper"].reshape(ROWS, COLUMNS, 3)
    tips = upper[4, 21:, 1]  # on the left, midline first; y of the biting edge
    width = np.diff(upper[4, 21::3, 0])
    assert width[0] > width[1]  # central incisors are wider than lateral ones
    assert tips[7] < tips[4] - 0.2  # and the canines longer


def test_shade_follows_the_order_of_subdivision(teeth):
    shade = teeth_shade()
    for jaw in JAWS:
        Q, n = teeth[f"quads_{jaw}"], len(teeth[f"vertices_{jaw}"])
        S, quads1 = catmull_clark(Q, n)
        for value in shade.values():
            assert value.shape == (S.shape[0],)
            corner, edge, centre = quads1[:, 0], quads1[:, 1], quads1[:, 2]
            following = np.roll(Q, -1, axis=1).ravel()
            np.testing.assert_allclose(value[edge], 0.5 * (value[corner] + value[following]))
            np.testing.assert_allclose(value[centre], np.repeat(value[Q].mean(1), 4))
    n = ROWS * COLUMNS
    grid = {k: v[:n].reshape(ROWS, COLUMNS) for k, v in shade.items()}
    assert (grid["gum"][[0, 1, -1]] == 1).all() and (grid["gum"][3:6] == 0).all()
    np.testing.assert_array_equal(grid["contact"][4], np.arange(COLUMNS) % 3 == 0)
    np.testing.assert_array_equal(grid["tooth"][4], grid["tooth"][4, ::-1])
    assert grid["tooth"][4, 22] == 0 and grid["tooth"][4, 28] == 2 and grid["tooth"].max() == 6


def test_bad_strips():
    good = strip("upper")
    with pytest.raises(ValueError, match=r"upper_strip_vertices: expected finite \(68, 3\), got \(67, 3\)"):
        teeth_quads(good[:-1], strip("lower"))
    bad = strip("lower")
    bad[0, 0] = np.nan
    with pytest.raises(ValueError, match="lower_strip_vertices: expected finite"):
        teeth_quads(good, bad)
