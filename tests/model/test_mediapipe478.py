"""The table MediaPipe's face mesh -> iBUG-68, and the rule that made it, on a mesh made to order."""

import csv
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build"))

import mediapipe478 as build

from toongeo.model.data_path import data_path
from toongeo.model.ibug68 import MIRROR, NAMES, PARTS
from toongeo.model.mediapipe478 import N_MESH, VERTICES

# The mesh lists the right side and the middle line first, then the left side in the order of the right one.
FIRST_LEFT = 248


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_every_point_has_a_vertex_of_its_own():
    assert VERTICES.shape == (68,) and len(set(VERTICES.tolist())) == 68
    assert VERTICES.min() >= 0 and VERTICES.max() < N_MESH


def test_rows_carry_the_names_and_where_they_come_from():
    table = rows(data_path("data_templates/mediapipe478.csv"))
    assert [row["name"] for row in table] == list(NAMES)
    assert [int(row["index"]) for row in table] == list(range(68))
    assert all(row["note"] for row in table)


def test_the_table_is_symmetric():
    """Without the mesh: mirrored vertices come in the same order on both sides."""
    sides = np.flatnonzero(np.arange(68) < MIRROR)
    right, left = VERTICES[sides], VERTICES[MIRROR[sides]]
    lefts = left >= FIRST_LEFT
    right, left = np.where(lefts, right, left), np.where(lefts, left, right)
    assert (right < FIRST_LEFT).all() and (left >= FIRST_LEFT).all()
    np.testing.assert_array_equal(np.argsort(right), np.argsort(left))
    assert (VERTICES[np.arange(68) == MIRROR] < FIRST_LEFT).all()


def test_points_follow_the_chains_of_the_mesh_in_order():
    seen = set()
    for row in rows(build.CURVES):
        points, chain = ([int(n) for n in row[key].split()] for key in ("points", "vertices"))
        places = [chain.index(VERTICES[k]) for k in points]
        assert places == sorted(set(places))
        seen |= {*points, *MIRROR[points].tolist()}
    assert seen == set(range(68))


def test_inner_points_lie_near_the_templates_own():
    distances = np.array([float(row["distance_mm"]) for row in rows(data_path("data_templates/mediapipe478.csv"))])
    np.testing.assert_array_equal(distances, distances[MIRROR])
    assert distances[17:].max() < 10 and np.median(distances[17:]) < 4
    assert distances[PARTS["eye_right"]].max() < 5


@pytest.fixture
def landmarks(model):
    return model.mean[model.landmarks]


@pytest.fixture
def mesh(landmarks):
    """A symmetric cloud that has the vertices of the table at our landmarks, the rest of the oval between them, and
    all others far away."""
    rng = np.random.default_rng(1)
    right = rng.uniform([-900, -900, -900], [-500, 900, -500], (N_MESH // 2, 3))
    V = np.r_[right, right * [-1, 1, 1]]
    V[VERTICES] = (landmarks + landmarks[MIRROR] * [-1, 1, 1]) / 2
    for between, a, b in [(132, 93, 58), (150, 136, 149), (148, 176, 152)]:
        V[between] = (V[a] + V[b]) / 2
    return V


def test_the_rule_finds_the_landmarks_in_any_position_of_the_mesh(mesh, landmarks):
    moved = build.aligned(0.1 * mesh + [0, 3, -2], landmarks)
    np.testing.assert_allclose(moved[VERTICES[17:]], landmarks[17:], atol=1.0)
    vertices, notes = build.chosen(moved, landmarks)
    np.testing.assert_array_equal(vertices, VERTICES)
    assert notes[26] == "upper edge of the left brow" and notes[17] == "upper edge of the right brow"


def test_a_mesh_in_another_order_is_refused(mesh, tmp_path):
    path = tmp_path / "mesh.obj"
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in mesh))
    np.testing.assert_allclose(build.mesh_vertices(path), mesh)
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in mesh[::-1]))
    with pytest.raises(ValueError, match=r"mesh: expected vertex 4 of .* to protrude most, got 463"):
        build.mesh_vertices(path)
    path.write_text("v 1 2 3\n")
    with pytest.raises(ValueError, match="mesh: expected 468 vertices in .*, got 1"):
        build.mesh_vertices(path)


def test_a_chain_that_runs_the_other_way_is_refused(mesh, landmarks):
    turned = mesh.copy()
    turned[[37, 39]] = turned[[39, 37]]
    with pytest.raises(ValueError, match="mesh: expected points .* in the order of chain"):
        build.chosen(turned, landmarks)
