"""Flow along edges, and filters along it."""

import numpy as np

from toongeo.pipeline.stylize.appearance.edge_flow import (
    abstracted,
    line_response,
    mean_along,
    streamlines,
    tangent_flow,
)


def stripes(angle, period=12.0, side=96):
    """Waves (h, w) whose lines run at an angle to the x axis."""
    rows, columns = np.mgrid[:side, :side].astype(np.float32)
    across = -np.sin(angle) * columns + np.cos(angle) * rows
    return (50 + 40 * np.sin(2 * np.pi * across / period)).astype(np.float32)


def test_tangents_run_along_stripes():
    for angle in (0.0, 0.5, 1.2, 2.5):
        flow = tangent_flow(stripes(angle), 4.0)[20:-20, 20:-20]
        np.testing.assert_allclose(np.linalg.norm(flow, axis=-1), 1, atol=1e-5)
        assert np.abs(flow @ np.array([np.cos(angle), np.sin(angle)], np.float32)).min() > 0.999


def test_a_mean_along_the_flow_keeps_stripes_and_takes_noise():
    clean = stripes(0.7)
    noise = np.random.default_rng(1).normal(size=clean.shape).astype(np.float32) * 10
    lines = streamlines(tangent_flow(clean, 4.0), 4.0)
    inner = np.s_[20:-20, 20:-20]
    np.testing.assert_allclose(mean_along(clean, lines)[inner], clean[inner], atol=4)
    left = mean_along(clean + noise, lines) - mean_along(clean, lines)
    assert left[inner].std() < 0.45 * noise.std()
    few = streamlines(tangent_flow(clean[:9, :9], 2.0), 2.0)
    np.testing.assert_allclose(mean_along(np.full((9, 9), 3.0, np.float32), few), 3, rtol=1e-6)


def test_abstraction_keeps_a_step_and_takes_texture():
    rng = np.random.default_rng(2)
    picture = np.zeros((120, 120, 3), np.float32)
    picture[:, 60:, 0] = 60
    picture[..., 0] += rng.normal(size=(120, 120)) * 2.5
    smooth, *_ = abstracted(picture, 130.0, 3, 9.0)
    assert smooth[20:-20, 65:-20, 0].std() < 1 and smooth[20:-20, 20:55, 0].std() < 1
    assert np.diff(smooth[60, 55:65, 0]).max() > 20  # the step is still one


def test_dark_lines_answer():
    picture = np.full((80, 80), 70, np.float32)
    picture[39:41] = 20
    lines = streamlines(tangent_flow(picture, 2.0), 3.0)
    answer = line_response(picture, lines, 130.0)
    assert answer[39:41, 20:60].min() > 5 and answer[25:30].max() < 0.5
    assert line_response(140 - picture, lines, 130.0)[39:41, 20:60].max() < -5
