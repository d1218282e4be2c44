"""Rebuild the landmark detector, data_templates/landmark_detector.npz, from renders of the default template.

usage: python data_templates/build/build_detector.py [--heads N] [--processes K] [--cache FOLDER] [--small] [-o FILE]

The same machine gives the same bytes, whatever the number of processes. What is finished is kept in the cache, if one
is named, and a run that was stopped goes on from there.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from detector.clutter import CALIBRATION, CLUTTER, clutter_pictures
from detector.samples import Samples, first_samples, joined_samples, rendered_samples
from detector.strange_samples import strange_samples
from detector.train_boxes import train_boxes
from detector.train_cascade import train_cascade
from detector.train_judge import train_judge
from detector.train_parts import WITHOUT_JAW, train_parts
from detector.train_verifier import train_verifier
from threadpoolctl import threadpool_limits

from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.landmarks.search.cascade import Cascade
from toongeo.pipeline.landmarks.search.detector_file import DetectorParts, detector_arrays, read_detector
from toongeo.pipeline.landmarks.search.face_boxes import BoxTemplates
from toongeo.pipeline.landmarks.search.face_judge import FACE_CUES, POINT_CUES, FaceJudge
from toongeo.pipeline.landmarks.search.face_verifier import FaceVerifier

_NOTHING = np.zeros((0, 0), np.float32)
_UNTRAINED = DetectorParts(
    BoxTemplates(_NOTHING, _NOTHING),
    Cascade(np.zeros((68, 2)), _NOTHING, ()),
    FaceVerifier(_NOTHING, _NOTHING, _NOTHING),
    FaceJudge(np.zeros(FACE_CUES), np.zeros((len(PARTS), POINT_CUES))),
)


@dataclass(frozen=True)
class _Size:
    """How many heads, two pictures each, are rendered or taken for what, and how many pictures of procedural clutter
    for training and, `fresh`, for the judge."""

    heads: int = 2250
    drawn: int = 1900
    held_out: int = 250
    boxes: int = 1200
    verifier: int = 1000
    judge: int = 90
    clutter: int = 40
    fresh: int = 30


_SMALL = _Size(60, 40, 10, 40, 40, 10, 2, 2)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--heads", type=int, help=f"heads to render, two pictures each ({_Size.heads})")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--cache", type=Path, help="folder of what is finished")
    parser.add_argument("--small", action="store_true", help="a toy from 60 heads, to try the script")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parents[1] / "landmark_detector.npz")
    arguments = parser.parse_args()
    size = _SMALL if arguments.small else _Size()
    size = replace(size, heads=arguments.heads or size.heads)
    if arguments.cache is not None:
        arguments.cache.mkdir(parents=True, exist_ok=True)
    start = time.perf_counter()

    def say(text: str, **options) -> None:
        print(f"{time.perf_counter() - start:6.0f} s  {text}", **options)

    with threadpool_limits(1):  # sums must not depend on the number of threads
        parts = trained_parts(size, arguments.processes, arguments.cache, say)
    _write(arguments.output, detector_arrays(parts))
    say(f"wrote {arguments.output}, {arguments.output.stat().st_size / 1e6:.1f} MB")


def trained_parts(size: _Size, processes: int, cache: Path | None, say) -> DetectorParts:
    """Every part of the detector; held-out renders choose and calibrate, and are not trained on.

    Boxes, the cascade of the whole face, the verifier and the parts learn from the usual renders and from drawn ones. A
    second set of parts learns from the usual ones alone, but for the jaw, which caricatures teach best.
    """
    usual = rendered_samples(1, size.heads, "usual", processes, cache)
    drawn = rendered_samples(1, size.drawn, "drawn", processes, cache)
    held_out = rendered_samples(2, size.held_out, "usual", processes, cache)
    held_drawn = rendered_samples(2, size.held_out, "every", processes, cache)
    say(f"{len(usual.grey)} usual renders, {len(drawn.grey)} drawn ones", flush=True)
    every, held_every = joined_samples((usual, drawn)), joined_samples((held_out, held_drawn))
    clutter = clutter_pictures(np.random.default_rng(3), CLUTTER, size.clutter)

    def mixed(heads: int) -> Samples:
        return joined_samples((first_samples(usual, 2 * heads), first_samples(drawn, 2 * heads)))

    def boxes():
        return replace(_UNTRAINED, boxes=train_boxes(mixed(size.boxes), clutter, say=say))

    def cascade():
        return replace(parts, cascade=train_cascade(every, held_every, processes, say=say))

    def verifier():
        some = mixed(size.verifier)
        return replace(parts, verifier=train_verifier(some, parts.boxes, parts.cascade, clutter, processes, say=say))

    def refined():
        trained = train_parts(every, held_drawn, parts.cascade, processes, say=say)
        return replace(parts, cascade=replace(parts.cascade, parts=trained))

    def refined_for_photos():
        trained = train_parts(usual, held_out, parts.cascade, processes, WITHOUT_JAW, say=say)
        return replace(parts, cascade=replace(parts.cascade, photo_parts=trained))

    parts = _kept(cache, "boxes", boxes)
    parts = _kept(cache, "cascade", cascade)
    parts = _kept(cache, "verifier", verifier)
    parts = _kept(cache, "parts", refined)
    parts = _kept(cache, "photo_parts", refined_for_photos)
    fresh = clutter_pictures(np.random.default_rng(4), CALIBRATION, size.fresh)
    strange = strange_samples(first_samples(held_drawn, 2 * size.judge), seed=5)
    return replace(parts, judge=train_judge(strange, parts, fresh, processes, say=say))


def _kept(cache: Path | None, name: str, train: Callable[[], DetectorParts]) -> DetectorParts:
    """What was trained up to a step, read from the cache if it is there."""
    path = None if cache is None else cache / f"{name}.npz"
    if path is not None and path.exists():
        return read_detector(path)
    parts = train()
    if path is not None:
        _write(path, detector_arrays(parts))
    return parts


def _write(path: Path, arrays: dict[str, np.ndarray]) -> None:
    """To a temporary file first, so that a reader never sees half a detector."""
    temporary = path.with_name(f".{path.stem}.tmp.npz")
    np.savez_compressed(temporary, **arrays)
    os.replace(temporary, path)


if __name__ == "__main__":
    main()
