"""Faces with known coefficients, their landmarks, and Taylor slopes."""

import numpy as np
import pytest

from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import visible_landmarks
from toongeo.model.artist_model import artist_model


@pytest.fixture(scope="session")
def artist():
    """The template without a prior of people: its mean is the likeliest face, so exact landmarks give it back."""
    return artist_model()


@pytest.fixture(scope="session")
def random_face(model):
    """Function ``seed -> (identity, expression)`` of a plausible face within the bounds."""

    def draw(seed):
        rng = np.random.default_rng(seed)
        expression = np.zeros(len(model.expression))
        chosen = rng.choice(model.n_named, 4, replace=False)
        expression[chosen] = rng.uniform(0.1, 0.6, 4)
        expression[model.expression_index("mouthClose")] = 0
        return 0.5 * rng.standard_normal(len(model.identity)), expression

    return draw


@pytest.fixture(scope="session")
def annotated():
    """Function ``(model, camera, identity, expression) -> (68, 2) px``, jaw points on the outline."""

    def project(model, camera, identity=None, expression=None):
        identity = np.zeros(len(model.identity)) if identity is None else identity
        expression = np.zeros(len(model.expression)) if expression is None else expression
        coefficients = np.concatenate([identity, expression])
        vertices = visible_landmarks(landmark_basis(model), coefficients, camera.rotation)
        return camera.project(model.vertices(identity, expression)[vertices])

    return project


@pytest.fixture(scope="session")
def taylor_slope():
    """Order at which ``f(x + h d) - f(x) - h g.d`` vanishes: 2 if the gradient is right, 1 if not."""

    def slope(loss, x, direction, steps=(1e-2, 1e-3)):
        value, gradient = loss(x)
        rests = [abs(loss(x + h * direction)[0] - value - h * gradient @ direction) for h in steps]
        return float(np.log(rests[0] / rests[1]) / np.log(steps[0] / steps[1]))

    return slope
