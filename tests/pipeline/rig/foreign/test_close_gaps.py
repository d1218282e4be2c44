"""Lids of a blink meet, also in a taller eye."""

import numpy as np
import pytest

from toongeo.model.anatomy.rims import rim_path
from toongeo.pipeline.rig.foreign.close_gaps import _heights, close_gaps


def test_a_taller_eye_is_closed(model):
    blink = model.expression[model.expression_index("eyeBlinkLeft")]
    upper, lower = rim_path(model, "lid_upper_left"), rim_path(model, "lid_lower_left")
    tall = model.mean.copy()
    near = np.exp(-(np.linalg.norm(tall - model.mean[upper].mean(0), axis=1) ** 2) / 200)
    tall[:, 1] += 4.0 * near * (tall[:, 1] > model.mean[lower, 1].mean())
    before = tall + blink
    after = close_gaps(model, tall, before, "left")
    heights, up, width = _heights(tall, before, upper, lower)
    assert heights.max() > 1.0 and up[1] > 0.9 and np.linalg.norm(up) == pytest.approx(1)
    assert width == pytest.approx(np.linalg.norm(tall[upper[0]] - tall[upper[-1]]))
    assert _heights(tall, after, upper, lower)[0].max() < 0.05
    still = ~(model.region("eye_left") | model.region("socket_left"))
    np.testing.assert_array_equal(after[still], before[still])
    np.testing.assert_array_equal(close_gaps(model, model.mean, model.mean + blink, "left"), model.mean + blink)
