"""``toongeo make``: a picture into a file."""

from __future__ import annotations

import dataclasses
import sys
from typing import TextIO

import numpy as np
from tqdm import tqdm

from toongeo.app.commands.path_is import path_is
from toongeo.app.contact_sheet import contact_sheet
from toongeo.app.landmark_source import LandmarkSource
from toongeo.app.making.head_jobs import HeadJob
from toongeo.app.making.made_head import MadeHead
from toongeo.app.making.make_options import MakeOptions
from toongeo.arrays import Bytes, Floats
from toongeo.avatar.make_avatar import STAGES, make_avatar
from toongeo.caricature.align_caricature import align_caricature
from toongeo.io import LandmarkFile, read_image, write_image
from toongeo.model.ibug68 import INNER
from toongeo.pipeline import FaceFit, held_out_errors
from toongeo.pipeline.parse.given_hair import given_hair

__all__ = ["make", "read_job"]

_FEWEST_HELD_OUT = 40  # inner points that are there, of 51: with fewer there is too little to leave out


def make(
    job: HeadJob,
    source: LandmarkSource | None = None,
    options: MakeOptions | None = None,
    *,
    prepared: tuple[Bytes, Floats] | None = None,
    fit: FaceFit | None = None,
) -> MadeHead:
    """Read, build, save and report, with a progress line a stage.

    Parameters
    ----------
    job : HeadJob
        What is read and written; the output has been checked (`check_jobs`).
    source : LandmarkSource, optional
        Of the landmarks; those of the job's file, or found, if None.
    options : MakeOptions, optional
    prepared : (picture, landmarks), optional
        What `read_job` gave, if it was called already.
    fit : FaceFit, optional
        Of :func:`toongeo.make_avatar`.

    Raises
    ------
    UnsureLandmarksError
        If landmarks were found that are not sure, and the source does not accept them.
    ValueError, OSError
        For bad input, or an output that cannot be written.
    """
    options = options or MakeOptions()
    img, points = prepared or read_job(job, source or LandmarkSource(), options)
    bar_format = "{desc:<12}{bar:24} {n_fmt}/{total_fmt} {elapsed}"
    with tqdm(total=len(STAGES), unit="stage", bar_format=bar_format) as bar:

        def announce(stage: str) -> None:
            bar.update(STAGES.index(stage) - bar.n)
            bar.set_description(stage)

        given = options.making() | ({} if fit is None else {"fit": fit})
        avatar = make_avatar(img, points, progress=announce, **given)
        bar.update(len(STAGES) - bar.n)
        bar.set_description("done")
    if avatar.style is not None:
        img, points = avatar.style.img, avatar.style.landmarks
    made = MadeHead(job, avatar, _held_out(img, points, options))
    avatar.save(job.output, format=options.format, **options.saving)
    if job.sheet is not None:
        write_image(job.sheet, contact_sheet(avatar, img, points, lines=made.lines()))
    if not options.json:
        print("\n".join(made.lines()))
    for path in filter(None, (job.output, job.sheet)):
        print(f"wrote {path}", file=_aside(options))
    return made


def read_job(job: HeadJob, source: LandmarkSource, options: MakeOptions) -> tuple[Bytes, Floats]:
    """Picture and landmarks (68, 2) px; raises as `make`, and for a hair mask that cannot be one of the picture."""
    with path_is("image"):
        img = read_image(job.image)
    if options.hair_mask is not None:
        with path_is("hair_mask"):
            given_hair(options.hair_mask, img.shape)
    points, found = dataclasses.replace(source, file=job.landmarks).landmarks(job.image, img)
    if isinstance(found, LandmarkFile):
        print(found.message, file=_aside(options))
    else:
        trust = 100 * found.confidence[INNER].mean()
        print(f"landmarks found: face {100 * found.score:.0f} %, points {trust:.0f} % sure", file=_aside(options))
    return img, points


def _aside(options: MakeOptions) -> TextIO:
    """Where all goes that is not the report: nothing but JSON is on standard output if that is asked for."""
    return sys.stderr if options.json else sys.stdout


def _held_out(img: Bytes, points: Floats, options: MakeOptions) -> dict[str, float] | None:
    """None where there are too few points."""
    if np.isfinite(points[INNER]).all(1).sum() < _FEWEST_HELD_OUT:
        return None
    try:
        align = align_caricature if options.method == "caricature" else None
        return held_out_errors(img, points, model=options.model, align=align)
    except ValueError:  # what is left cannot be a face
        return None
