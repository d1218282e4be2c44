import numpy as np

from toongeo.pipeline.texture.diffuse_over_mesh import diffuse_over_mesh


def grid(rows, columns):
    """A triangulated rectangle whose vertex (i, j) has the index i * columns + j."""
    i = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    return np.vstack([np.c_[i, i + columns, i + 1], np.c_[i + 1, i + columns, i + columns + 1]])


def test_a_constant_colour_spreads_unchanged():
    F, known = grid(9, 7), np.zeros(63, bool)
    known[31] = True
    filled, rings = diffuse_over_mesh(F, np.where(known[:, None], [[10.0, 20, 30]], 0), known)
    np.testing.assert_allclose(filled, np.tile([10.0, 20, 30], (63, 1)), rtol=1e-14)
    assert rings.min() == 0 and rings[31] == 0


def test_values_stay_within_their_sources_and_known_ones_untouched(rng):
    F, known = grid(12, 12), rng.random(144) < 0.2
    colours = rng.random((144, 3))
    filled, _ = diffuse_over_mesh(F, colours, known)
    np.testing.assert_array_equal(filled[known], colours[known])
    assert (filled >= colours[known].min(0) - 1e-12).all() and (filled <= colours[known].max(0) + 1e-12).all()


def test_agrees_with_a_queue_of_rings(rng):
    F, known = grid(8, 8), rng.random(64) < 0.1
    known[5] = True
    colours = rng.random((64, 2))
    filled, rings = diffuse_over_mesh(F, colours, known)
    neighbours = [set() for _ in range(64)]
    for face in F:
        for a in face:
            neighbours[a] |= set(face) - {a}
    expected, depth = colours.copy(), np.where(known, 0, -1)
    ring = 0
    while (depth < 0).any():
        ring += 1
        front = [v for v in range(64) if depth[v] < 0 and any(depth[w] >= 0 for w in neighbours[v])]
        for v in front:
            expected[v] = np.mean([expected[w] for w in neighbours[v] if 0 <= depth[w] < ring], axis=0)
        depth[front] = ring
    np.testing.assert_array_equal(rings, depth)
    np.testing.assert_allclose(filled, expected, rtol=1e-13)


def test_what_no_path_reaches_keeps_its_value():
    F = np.array([[0, 1, 2], [3, 4, 5]])
    filled, rings = diffuse_over_mesh(F, np.arange(6.0)[:, None], np.arange(6) == 0)
    np.testing.assert_array_equal(filled[3:, 0], [3, 4, 5])
    np.testing.assert_array_equal(rings, [0, 1, 1, -1, -1, -1])
