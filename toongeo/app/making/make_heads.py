"""Several heads, one after the other."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence

from toongeo.app.landmark_source import LandmarkSource
from toongeo.app.make import make, read_job
from toongeo.app.making.head_jobs import HeadJob
from toongeo.app.making.make_options import MakeOptions
from toongeo.app.making.same_person import same_person
from toongeo.app.unsure_landmarks_error import UnsureLandmarksError

__all__ = ["make_heads"]


def make_heads(jobs: Sequence[HeadJob], source: LandmarkSource, options: MakeOptions, *, one: bool = False) -> None:
    """Make each head and report.

    Of several pictures one that fails is told and left out; the others are made.

    Parameters
    ----------
    jobs : sequence of HeadJob
        Checked.
    source : LandmarkSource
    options : MakeOptions
    one : bool
        All pictures show the same person: one identity is fitted to all of them, and none may fail.

    Raises
    ------
    UnsureLandmarksError
        If landmarks were found that are not sure, and nothing else failed.
    ValueError, OSError
        As :func:`~toongeo.app.make.make`; of several pictures, how many failed.
    """
    reports, failures = [], []
    if one:
        prepared = [read_job(job, source, options) for job in jobs]
        fits = same_person([img for img, _ in prepared], [points for _, points in prepared], options)
        for job, both, fit in zip(jobs, prepared, fits, strict=True):
            reports.append(make(job, source, options, prepared=both, fit=fit).to_dict())
    elif len(jobs) == 1:
        reports.append(make(jobs[0], source, options).to_dict())
    else:
        for job in jobs:
            try:
                reports.append(make(job, source, options).to_dict())
            except (ValueError, OSError, UnsureLandmarksError) as error:
                print(f"toongeo: {job.image}: {error}", file=sys.stderr)
                failures.append(error)
    if options.json:
        print(json.dumps(reports if len(jobs) > 1 else reports[0], indent=2))
    if failures:
        unsure = all(isinstance(error, UnsureLandmarksError) for error in failures)
        text = f"{len(failures)} of {len(jobs)} pictures gave no head"
        raise UnsureLandmarksError(text) if unsure else ValueError(text)
