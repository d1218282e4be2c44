"""Points of a mesh of scans are told from those of annotators."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_3dmm_together import fit_3dmm_together
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.problem.starting_problem import starting_problem
from toongeo.pipeline.fit.problem.told_convention import expected_minimum
from toongeo.render import ScaledOrthographicCamera


def seen(model, offsets, yaw=10.0):
    rng = np.random.default_rng(4)
    identity = model.prior.mean + 0.5 * rng.standard_normal(len(model.identity))
    points = model.vertices(identity)[model.landmarks] + offsets
    return ScaledOrthographicCamera.look(yaw=yaw, size=500).project(points) + rng.normal(0, 0.5, (68, 2))


@pytest.mark.parametrize("yaw", [0.0, 25.0])
def test_whose_points_they_are_is_told(model, yaw):
    annotated = fit_3dmm(None, seen(model, model.prior.landmark_offsets, yaw))
    scanned = fit_3dmm(None, seen(model, model.prior.scan_offsets, yaw))
    assert (annotated.report.convention, scanned.report.convention) == ("annotators", "scans")
    asked = fit_3dmm(None, seen(model, model.prior.scan_offsets, yaw), convention="scans")
    np.testing.assert_allclose(scanned.vertices, asked.vertices, atol=0.5)
    told = fit_3dmm(None, seen(model, model.prior.scan_offsets, yaw), convention="annotators")
    assert told.report.convention == "annotators" and told.report.loss > scanned.report.loss


def test_each_picture_of_a_person_is_told_by_itself(model):
    pictures = [seen(model, model.prior.scan_offsets), seen(model, model.prior.landmark_offsets, -10.0)]
    fits = fit_3dmm_together([None, None], pictures)
    assert [fit.report.convention for fit in fits] == ["scans", "annotators"]


def test_a_model_without_landmarks_of_scans_has_nothing_to_ask(model):
    plain = replace(model, prior=replace(model.prior, scan_offsets=None))
    for convention in ("auto", "scans"):
        fit = fit_3dmm(None, seen(model, model.prior.scan_offsets), model=plain, convention=convention)
        assert fit.report.convention == "annotators"


def test_one_step_ends_where_the_slope_of_the_free_unknowns_vanishes(model):
    """Near the minimum the loss is all but quadratic."""
    problem = starting_problem(model, seen(model, model.prior.landmark_offsets), FitOptions())
    state = problem.first_state(problem.search.start)
    loss = problem.loss(state.vertices, state.prior_weight)
    x, bounds = problem.search.start, (problem.search.bounds[0], state.upper)
    for _ in range(6):
        expected, there = expected_minimum(loss, x, bounds)
        value, x = loss(there)[0], there
    assert value == pytest.approx(expected, rel=0.05)
    assert (bounds[0] <= x).all() and (x <= bounds[1]).all()


def test_an_unknown_convention_is_refused():
    with pytest.raises(ValueError, match="convention: expected one of 'auto', 'annotators', 'scans', got 'mine'"):
        FitOptions(convention="mine")
