"""The end of the neck."""

import numpy as np

from toongeo.model import default_model
from toongeo.model.anatomy.neck import neck_rim


def test_the_rim_is_one_loop_of_open_edges_around_the_lowest_points():
    model = default_model()
    rim = neck_rim(model)
    assert rim is not None and len(np.unique(rim)) == len(rim) > 20
    assert model.region("neck")[rim].all()
    loop = np.column_stack([rim, np.roll(rim, -1)])
    edges = np.vstack([model.faces[:, [0, 1]], model.faces[:, [1, 2]], model.faces[:, [2, 0]]])
    keys = {(int(a), int(b)) for a, b in edges}
    assert all((int(a), int(b)) in keys and (int(b), int(a)) not in keys for a, b in loop)
    low, high = model.mean[rim].min(axis=0), model.mean[rim].max(axis=0)
    around = model.mean[(model.mean >= low).all(axis=1) & (model.mean <= high).all(axis=1)]
    assert len(around) and model.mean[:, 1].min() == low[1]


def test_a_model_without_a_neck_has_no_rim(monkeypatch):
    model = default_model()
    monkeypatch.setattr(type(model), "has", lambda self, part: part != "neck")
    assert neck_rim.__wrapped__(model) is None
