import numpy as np
import pytest

from toongeo import TextureGeometry, attention_map
from toongeo.editing.attention_map import FULL


def moved(model, where, by):
    target = np.array(model.mean)
    target[where] += by
    return TextureGeometry(model.mean, target, model.faces, model.uv, model.uv_faces)


def test_is_one_where_nothing_moves(model):
    assert (attention_map(moved(model, slice(0), 0.0), 128) == 1).all()


def test_falls_with_the_motion_up_to_full(model):
    width = np.ptp(model.mean[:, 0])
    half, full = (attention_map(moved(model, slice(None), [0, share * FULL * width, 0]), 128) for share in (0.5, 1.0))
    inside = full < 0.01
    assert inside.mean() > 0.3
    assert np.allclose(half[inside], 0.5, atol=0.02)


def test_changes_only_what_moves(model):
    nose = model.region("nose")
    A = attention_map(moved(model, nose, [0, 0, 20.0]), 256)
    px = np.rint(model.uv[model.uv_faces[nose[model.faces].all(1)]].mean(1) * [255, -255] + [0, 255]).astype(int)
    far = np.rint(model.uv[model.uv_faces[model.region("ears")[model.faces].all(1)]].mean(1) * [255, -255] + [0, 255])
    far = far.astype(int)
    assert A[px[:, 1], px[:, 0]].max() < 0.6
    assert (A[far[:, 1], far[:, 0]] == 1).all()


def test_extra_counts_where_it_is_larger(model):
    extra = np.ones(len(model.mean), np.float32)
    assert attention_map(moved(model, slice(0), 0.0), 64, extra=extra).min() < 0.01


def test_bad_input(model):
    geometry = moved(model, slice(0), 0.0)
    with pytest.raises(ValueError, match="size: expected"):
        attention_map(geometry, 0)
    with pytest.raises(ValueError, match="extra: expected shape"):
        attention_map(geometry, 64, extra=np.zeros(3))
    with pytest.raises(ValueError, match="target: expected vertices"):
        TextureGeometry(model.mean, model.mean[:-1], model.faces, model.uv, model.uv_faces)
    with pytest.raises(ValueError, match="uv_faces: expected shape"):
        TextureGeometry(model.mean, model.mean, model.faces, model.uv, model.uv_faces[:-1])
