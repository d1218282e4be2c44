"""Mesh quality: constructed folds and intersections."""

import numpy as np
import pytest

from toongeo.metrics.mesh_quality import mesh_quality


def hinge(degrees):
    """Two triangles along the x axis whose normals differ by this angle."""
    angle = np.radians(degrees)
    V = np.array([[0, 0, 0], [1, 0, 0], [0.5, -1, 0], [0.5, np.cos(angle), np.sin(angle)]])
    return V, np.array([[0, 2, 1], [0, 1, 3]])


@pytest.mark.parametrize("degrees", [0, 45, 99.9, 100.1, 150, 179.9])
def test_a_hinge_is_folded_beyond_100_degrees(degrees):
    quality = mesh_quality(*hinge(degrees))
    assert quality.folded.tolist() == ([[0, 1]] if degrees > 100 else [])
    assert quality.folded_count == (degrees > 100)
    assert quality.intersecting_fraction == 0 and quality.selected == 2


@pytest.mark.parametrize("degrees", [30, 60, 120])
def test_the_fold_angle_is_the_threshold(degrees):
    assert mesh_quality(*hinge(degrees - 0.1), fold_angle=degrees).folded_count == 0
    assert mesh_quality(*hinge(degrees + 0.1), fold_angle=degrees).folded_count == 1


def test_selection_reports_on_its_triangles_but_tests_against_all():
    V = [
        [0, 0, 0],
        [2, 0, 0],
        [0, 2, 0],
        [0.5, 0.5, -1],
        [0.5, 0.5, 1],
        [5, 5, 0],
        [9, 9, 9],
        [9, 8, 9],
        [8, 9, 9],
    ]
    F = [[0, 1, 2], [3, 4, 5], [6, 7, 8]]
    assert mesh_quality(V, F).intersecting.tolist() == [0, 1]
    assert mesh_quality(V, F).intersecting_fraction == pytest.approx(2 / 3)
    quality = mesh_quality(V, F, selection=[True, False, True])
    assert quality.intersecting.tolist() == [0] and quality.intersecting_fraction == 0.5
    V, F = hinge(150)
    assert mesh_quality(V, [*F, [0, 2, 3]], selection=[False, False, True]).folded.tolist() != [[0, 1]]


def test_degenerate_triangles_and_borders_are_not_folded():
    V = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]])
    quality = mesh_quality(V, [[0, 1, 3], [1, 0, 2]])
    assert quality.folded.shape == (0, 2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"F": [[0, 1, 4]]}, r"F: expected indices in 0\.\.3, got 4"),
        ({"fold_angle": 180.0}, r"fold_angle: expected degrees in \(0, 180\), got 180\.0"),
        ({"selection": [True]}, r"selection: expected bool of shape \(2,\), got bool \(1,\)"),
        ({"selection": [0, 1]}, "selection: expected bool .* got int64"),
        ({"selection": [False, False]}, "selection: expected at least one triangle, got none"),
    ],
)
def test_bad_input_is_named(change, message):
    V, F = hinge(10)
    with pytest.raises(ValueError, match=message):
        mesh_quality(**({"V": V, "F": F} | change))
