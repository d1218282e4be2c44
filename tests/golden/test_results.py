"""Results are those on record: what changes them says so by changing the record."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tests.conftest import CARTOONS
from tests.golden.results import FOLDER, picture, results
from toongeo import make_avatar

FAST = ("blue_girl",)
# By the unit of a key, the last word of its name. Versions of numpy and scipy move a rig by up to 0.024 mm.
TOLERANCE = {"mm": 0.05, "px": 0.05, "weights": 0.005, "confidence": 0.005, "levels": 2.0}


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in FAST else pytest.mark.slow) for n in CARTOONS])
def test_results_are_those_on_record(once, name):
    img, landmarks = picture(name)
    avatar = once(f"hairy-{name}", lambda: make_avatar(img, landmarks))
    now = results(avatar, img, landmarks)
    with np.load(FOLDER / f"{name}.npz") as file:
        before = dict(file)
    assert sorted(now) == sorted(before)
    differences = {key: difference(key, now[key], before[key]) for key in now}
    assert {key: value for key, value in differences.items() if value > 1} == {}


def difference(key, now, before):
    """How far two results are apart, in what is tolerated."""
    if key == "parse.labels":
        return np.mean(now != before) / 2e-4 if now.shape == before.shape else np.inf
    if key == "hair.surface_mm":  # vertices of a new one may be others
        apart = np.r_[cKDTree(before).query(now)[0], cKDTree(now).query(before)[0]]
        return np.percentile(apart, 98) / 0.5
    if now.shape != before.shape:
        return np.inf
    apart = np.abs(now.astype(float) - before)
    return apart.max() / TOLERANCE[key.rsplit("_", 1)[-1].rsplit(".", 1)[-1]]
