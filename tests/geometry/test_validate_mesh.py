"""The shared input check names the array, what was expected and what came."""

import numpy as np
import pytest

from toongeo.geometry.validate_mesh import degenerate_triangles, validate_mesh

V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]])
F = np.array([[0, 1, 2]])


def test_good_input_passes_without_copy():
    v, f = validate_mesh(V, F)
    assert v is V and f is F
    v, f = validate_mesh(V.astype(np.float32), F.astype(np.uint16))
    assert v.dtype == np.float64 and f.dtype == np.int64 and v.flags.c_contiguous


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        (V[:, :2], F, r"V: expected real numbers of shape \(n, 3\).*got float64 \(4, 2\)"),
        (V[0], F, r"V: expected real numbers of shape \(n, 3\)"),
        (V[:0], F, r"V: expected real numbers of shape \(n, 3\), n >= 1"),
        (V.astype(complex), F, "V: expected real numbers"),
        (
            V + np.array([[0], [np.nan], [0], [np.inf]]),
            F,
            r"V: expected finite coordinates, got 2 rows .* V\[1\]",
        ),
        (V, F[:, :2], r"F: expected integers of shape \(m, 3\).*got int64 \(1, 2\)"),
        (V, F[:0], r"F: expected integers of shape \(m, 3\), m >= 1"),
        (V, F.astype(float), "F: expected integers .* got float64"),
        (V, [[0, 1, 2], [1, 2, 4]], r"F: expected indices in 0\.\.3, got 4 in triangle 1"),
        (V, [[0, -1, 2]], r"F: expected indices in 0\.\.3, got -1 in triangle 0"),
    ],
)
def test_bad_input_is_named(vertices, faces, message):
    with pytest.raises(ValueError, match=message):
        validate_mesh(vertices, faces)


def test_names_are_those_of_the_caller():
    with pytest.raises(ValueError, match="^V_target: expected finite"):
        validate_mesh(V * np.nan, F, names=("V_target", "F"))


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_degenerate_triangles_are_found_at_every_scale(scale):
    faces = np.array([[0, 1, 2], [0, 1, 3], [1, 1, 2], [1, 1, 1]])
    np.testing.assert_array_equal(degenerate_triangles(V * scale, faces), [False, True, True, True])
    validate_mesh(V * scale, faces)
    with pytest.raises(ValueError, match=r"got 3 degenerate of 4, the first F\[1\] = \[0, 1, 3\]"):
        validate_mesh(V * scale, faces, nondegenerate=True)


def test_only_what_one_rounding_error_decides_is_degenerate():
    """The height over an edge of length 1 is the ratio itself."""
    heights = np.array([1e-10, 1e-11, 2e-12, 5e-13, 1e-13])
    for height, lost in zip(heights, heights < 1e-12, strict=True):
        thin = np.array([[0, 0, 0], [1, 0, 0], [0.5, height, 0]])
        assert degenerate_triangles(thin, F).tolist() == [lost]


def test_coordinates_whose_products_overflow_are_refused():
    assert validate_mesh(1e59 * V, F)[0].max() == 2e59
    with pytest.raises(ValueError, match="V: expected coordinates up to 1e.60, got 2e.61"):
        validate_mesh(1e61 * V, F)
