"""A model laid into a head, wherever the head is."""

import numpy as np
import pytest

from toongeo.pipeline.rig.foreign.register_face import register_face


@pytest.mark.slow
def test_it_goes_with_the_head(model):
    """Moved and scaled the head takes the registered face along: its rims are where the landmarks say."""
    V, points = model.mean * [1.05, 1.0, 1.0], model.mean[model.landmarks] * [1.05, 1.0, 1.0]
    place = np.array([700.0, -500.0, 300.0])
    here = register_face(V, model.faces, points, model)
    there = register_face(V + place, model.faces, points + place, model)
    apart = np.linalg.norm(there.registration.vertices - place - here.registration.vertices, axis=1)
    assert np.quantile(apart, 0.99) < 0.02 and apart.mean() < 0.002
