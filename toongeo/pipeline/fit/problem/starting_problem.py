"""The landmark problem of a picture: everything a fit starts from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.ibug68 import INNER
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.opposites import opposite_expressions
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.frame.canonical_frame import CanonicalFrame, canonical_frame
from toongeo.pipeline.fit.frame.unknowns import Unknowns
from toongeo.pipeline.fit.landmarks.landmark_table import LandmarkTable
from toongeo.pipeline.fit.landmarks.outlier_errors import NEIGHBOURS
from toongeo.pipeline.fit.losses.prior_loss import PriorLoss
from toongeo.pipeline.fit.problem.initial_guess import (
    held_bounds,
    likeliest,
    posing_weight,
    principal_point_of,
    start_vector,
)
from toongeo.pipeline.fit.problem.landmark_problem import LandmarkProblem
from toongeo.pipeline.fit.problem.landmark_target import LandmarkTarget, SearchBox
from toongeo.pipeline.fit.problem.landmark_weights import landmark_weights
from toongeo.protocols import Coefficients

__all__ = ["starting_problem"]

_FEWEST = 6  # points from which the affine camera of the first pose is overdetermined
# Inverse distances of a viewer whose focal length is not known, 1/mm: least, first, greatest.
_NEARNESS = (1 / 5000, 1 / 1000, 1 / 350)
# Box of the pose: a quarter turn from the first one, in each direction four times as large, 200 mm away.
_TURN, _LOG_SCALE, _SHIFT_MM = np.pi / 2, np.log(4.0), 200.0


def starting_problem(
    model: MorphableModel,
    pixels: Floats,
    options: FitOptions,
    guess: Coefficients | None = None,
    table: LandmarkTable | None = None,
    image_centre: Floats | None = None,
) -> LandmarkProblem:
    """The problem for landmarks px, NaN rows missing, started at a guess or held there.

    They are (68, 2), or (k, 2) with a table.
    """
    guess = Coefficients() if guess is None else guess
    unknowns = Unknowns(len(model.identity), len(model.expression), options.camera == "perspective")
    basis = landmark_basis(model)
    seen = np.flatnonzero(np.isfinite(pixels).all(axis=1))
    own = None if table is None else table.rows(model)
    # The offsets of jaw points start on the contour lines; a point of the silhouette is where it is seen.
    known = model.prior if table is None and options.contour == "lines" else None
    offsets = np.zeros((68, 3)) if known is None else known.landmark_offsets
    scan_offsets = None if known is None or options.convention == "annotators" else known.scan_offsets
    convention = "annotators"
    if options.convention == "scans" and scan_offsets is not None:
        offsets, scan_offsets, convention = scan_offsets, None, "scans"
    expected = likeliest(model, unknowns)
    start = start_vector(guess, unknowns, expected)
    # The expected face sets the unit of the errors, whatever the guess: a fit does not minimise where it starts.
    mean, modes = basis.at(basis.landmarks) if own is None else own
    face = mean + (modes @ expected[unknowns.shape]).reshape(-1, 3)
    face = face + offsets if own is None else face
    frame, robust_weight = _first_pose(face, pixels, seen, options, guess, table)
    principal_point = principal_point_of(options, image_centre, frame)
    bounds = _bounds(model, unknowns, expected, options.prior.max_deviation)
    if unknowns.perspective:
        start[unknowns.translation] = -frame.from_pixels(principal_point)
        for bound in bounds:
            bound[unknowns.translation] += start[unknowns.translation]
        nearness = _NEARNESS if options.focal_px is None else (frame.scale / options.focal_px,) * 3
        bounds[0][-1], start[-1], bounds[1][-1] = nearness
    points = np.full(pixels.shape, np.nan)
    points[seen] = frame.from_pixels(pixels[seen])
    if table is None:
        weights = landmark_weights(points, model, frame.rotation0, options)
    else:
        weights = np.tile(np.eye(2), (len(pixels), 1, 1))
    return LandmarkProblem(
        model=model,
        unknowns=unknowns,
        basis=basis,
        frame=frame,
        principal_point=principal_point,
        target=LandmarkTarget(
            pixels=pixels,
            seen=seen,
            points=points[seen],
            weights=weights[seen] / basis.outer_eye_mm**2,
            offsets=offsets,
            own=own if own is None else (own[0][seen], _row_blocks(own[1], seen)),
            neighbours=_neighbours(seen, table),
            robust_weight=robust_weight[seen],
            scan_offsets=scan_offsets,
            convention=convention,
        ),
        search=SearchBox(
            start=start,
            bounds=bounds if options.refine else held_bounds(bounds, start, unknowns, guess.pose is not None),
            opposites=unknowns.n_identity + opposite_expressions(model)[: None if options.refine else 0],
        ),
        prior=PriorLoss(unknowns, options.prior.identity_weight, options.prior.expression_weight, expected),
        options=options,
    )


def _first_pose(
    face: Floats,
    pixels: Floats,
    seen: NDArray[np.int64],
    options: FitOptions,
    guess: Coefficients,
    table: LandmarkTable | None,
) -> tuple[CanonicalFrame, Floats]:
    """Frame of the pose in which a face (k, 3) is seen, or of a guess, and robust weights (k,) of the points.

    The jaw's vertices depend on the pose, so the first one leaves the jaw out while enough is left.
    """
    inner = np.intersect1d(seen, INNER)
    posing = inner if table is None and len(inner) >= _FEWEST else seen
    robust_weight = np.ones(len(pixels))
    robust_weight[posing] = posing_weight(face[posing], pixels[posing], options)
    frame = canonical_frame(face[posing], pixels[posing], robust_weight[posing])
    if guess.pose is None:
        return frame, robust_weight
    posed = canonical_frame(face[posing], guess.pose.project(face[posing]))
    if not options.refine:
        return posed, robust_weight
    return replace(frame, rotation0=frame.roll.T @ posed.roll @ posed.rotation0), robust_weight


def _row_blocks(modes: Floats, points: NDArray[np.int64]) -> Floats:
    """Modes (3 p, c) of some points out of those (3 k, c) of all."""
    return modes.reshape(len(modes) // 3, 3, -1)[points].reshape(3 * len(points), -1)


def _neighbours(seen: NDArray[np.int64], table: LandmarkTable | None) -> NDArray[np.bool_]:
    """Which of the points that are there follow each other; a table does not tell."""
    return NEIGHBOURS[np.ix_(seen, seen)] if table is None else np.zeros((len(seen), len(seen)), bool)


def _bounds(model: MorphableModel, unknowns: Unknowns, expected: Floats, deviation: float) -> tuple[Floats, Floats]:
    """Lower and upper bounds (n,) of all unknowns."""
    upper = np.full(unknowns.size, deviation)
    upper[unknowns.rotation], upper[unknowns.log_scale] = _TURN, _LOG_SCALE
    upper[unknowns.translation] = _SHIFT_MM
    lower = expected - upper
    upper = expected + upper
    named = slice(unknowns.n_identity, unknowns.n_identity + model.n_named)
    lower[named], upper[named] = 0.0, 1.0
    if "mouthClose" in model.expression_names:
        upper[unknowns.n_identity + model.expression_index("mouthClose")] = 0.0
    return lower, upper
