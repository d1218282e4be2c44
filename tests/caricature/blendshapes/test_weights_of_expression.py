import numpy as np
import pytest

from toongeo.caricature.blendshapes.weights_of_expression import weights_of_expression


def test_weights_of_named_expressions_come_back(model, rng):
    expression = np.zeros(len(model.expression))
    expression[: model.n_named] = rng.uniform(0, 1, model.n_named) * (rng.uniform(size=model.n_named) < 0.4)
    found = weights_of_expression(expression, model)
    np.testing.assert_allclose(found, expression[: model.n_named], atol=1e-4)


def test_any_expression_gets_the_nearest_weights_within_the_bounds(model, rng):
    expression = np.r_[rng.uniform(-0.5, 1.5, model.n_named), rng.normal(size=len(model.expression) - model.n_named)]
    found = weights_of_expression(expression, model, bounds=(0.0, 0.8))
    assert found.min() >= 0 and found.max() <= 0.8
    flat = model.expression.reshape(len(model.expression), -1).astype(float)
    gram, k = flat @ flat.T, model.n_named

    def error(w):
        off = expression.copy()
        off[:k] -= w
        return off @ gram @ off

    least = error(found)
    for _ in range(20):  # convex: no feasible step may help
        step = np.clip(found + 0.01 * rng.normal(size=k), 0, 0.8)
        assert error(step) > least - 1e-6 * least


def test_bad_input_is_refused(model):
    with pytest.raises(ValueError, match=r"expression: expected shape \(64,\), got \(46,\)"):
        weights_of_expression(np.zeros(46), model)
    with pytest.raises(ValueError, match="expression: expected finite numbers"):
        weights_of_expression(np.full(64, np.nan), model)
    with pytest.raises(ValueError, match="bounds: expected lowest < highest"):
        weights_of_expression(np.zeros(64), model, bounds=(1, 0))
