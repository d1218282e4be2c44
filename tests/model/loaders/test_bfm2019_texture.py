"""Texture coordinates that come in a file of their own."""

import json

import numpy as np
import pytest

from tests.model.loaders import layouts
from toongeo.model import load_model

pytest.importorskip("h5py")


@pytest.fixture
def face():
    return layouts.Face()


def written(face, folder, uv):
    mapping = {"triangles": face.faces.tolist(), "textureMapping": {"pointData": uv}}
    (folder / "model2019_textureMapping.json").write_text(json.dumps(mapping))
    return layouts.bfm2017(face, folder / "model2019_fullHead.h5")


def test_the_mapping_beside_the_file_is_taken(face, tmp_path):
    assert not load_model(layouts.bfm2017(face, tmp_path / "model2019_fullHead.h5")).has("uv")
    model = load_model(written(face, tmp_path, face.uv.tolist()))
    assert model.has("uv")
    np.testing.assert_array_equal(model.uv, face.uv)
    np.testing.assert_array_equal(model.uv_faces, model.faces)


def test_a_cropped_model_has_none(face, tmp_path):
    assert not load_model(written(face, tmp_path, face.uv[:-5].tolist())).has("uv")


@pytest.mark.parametrize("uv", [[["x", 1.0]], [[1e999, 0.0]] * layouts.N, None])
def test_a_damaged_mapping_is_told_of(face, tmp_path, uv):
    with pytest.raises(ValueError, match=r"textureMapping.json is damaged|uv: expected finite"):
        load_model(written(face, tmp_path, uv))
