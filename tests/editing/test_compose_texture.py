import numpy as np
import pytest

from toongeo import compose_texture


def test_is_equation_12(rng):
    T, C = rng.integers(0, 256, (2, 5, 5, 3)).astype(np.uint8)
    A = rng.random((5, 5))
    expected = A[..., None] * T + (1 - A[..., None]) * C
    assert np.allclose(compose_texture(T, C, A), expected, atol=1e-3)
    assert (compose_texture(T, C, np.ones((5, 5))) == T).all()
    assert (compose_texture(T, C, np.zeros((5, 5))) == C).all()


@pytest.mark.parametrize(
    ("shapes", "message"),
    [
        (((5, 5), (5, 5, 3), (5, 5)), "texture: expected"),
        (((5, 5, 3), (4, 5, 3), (5, 5)), "colour: expected"),
        (((5, 5, 3), (5, 5, 3), (4, 5)), "attention: expected shape"),
    ],
)
def test_refuses_shapes_that_do_not_go_together(shapes, message):
    with pytest.raises(ValueError, match=message):
        compose_texture(*(np.zeros(shape) for shape in shapes))


@pytest.mark.parametrize("value", [1.5, -0.1, np.nan])
def test_refuses_attention_that_is_none(value):
    with pytest.raises(ValueError, match="attention: expected numbers in"):
        compose_texture(np.zeros((2, 2, 3)), np.zeros((2, 2, 3)), np.full((2, 2), value))
