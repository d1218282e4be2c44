import dataclasses

import numpy as np

from toongeo.caricature.space.face_space import _skin
from toongeo.model.anatomy.parts import INNER_PARTS


def test_skin_is_what_belongs_to_no_inner_part(model):
    inner = np.any([model.region(name) for name in INNER_PARTS], axis=0)
    outside = model.faces[~inner[model.faces].any(axis=1)]
    np.testing.assert_array_equal(_skin(model), np.unique(outside))


def test_a_model_without_inner_parts_is_all_skin(model):
    regions = {name: inside for name, inside in model.regions.items() if name not in INNER_PARTS}
    bare = dataclasses.replace(model, regions=regions)
    np.testing.assert_array_equal(_skin(bare), np.arange(len(model.mean)))
