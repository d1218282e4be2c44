"""The fit against 3D truth: subjects drawn from a model of scans, seen by a perspective camera."""

import sys
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import ROOT


@pytest.fixture(scope="module")
def truth3d(shared):
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        import truth3d
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))
    return truth3d


@pytest.fixture(scope="module")
def bench(truth3d, shared):
    return truth3d.Bench(Path(shared))


@pytest.mark.parametrize(("population", "share"), [("ICT", 0.9), ("Surrey", 1.0)])
@pytest.mark.slow
def test_a_fit_is_nearer_to_the_truth_than_the_mean_face(truth3d, bench, population, share):
    """Fewer seeds than the benchmark has."""
    truth, model = bench.truths[population], bench.template
    errors = []
    for seed in range(2100, 2112):
        subject = truth.sample(seed)
        errors.append([bench.error(truth, subject, model, V) for V in (model.mean, truth3d.fitted(subject["q"]))])
    mean_face, fit = np.array(errors).T
    assert fit.mean() < share * mean_face.mean()
    assert (fit < mean_face).sum() >= 6
