"""Rebuild the landmark detector, data_templates/landmark_detector.npz, from renders of the default template.

usage: python data_templates/build/build_detector.py [--heads N] [--processes K] [-o FILE]

The same machine gives the same bytes, whatever the number of processes.
"""

from __future__ import annotations

import argparse
import os
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from detector.clutter import CALIBRATION, CLUTTER, clutter_pictures
from detector.samples import Samples, rendered_samples
from detector.train_boxes import train_boxes
from detector.train_cascade import train_cascade
from detector.train_judge import train_judge
from detector.train_parts import train_parts
from detector.train_verifier import train_verifier
from threadpoolctl import threadpool_limits

from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.landmarks.search.detector_file import DetectorParts, detector_arrays
from toongeo.pipeline.landmarks.search.face_judge import FaceJudge

_HEADS, _HELD_OUT = 2250, 250
_BOX_HEADS, _VERIFIER_HEADS, _JUDGE_HEADS = 1200, 1000, 100
_PROCEDURAL = 40  # pictures of clutter
_UNTRAINED = FaceJudge(np.zeros(5), np.zeros((len(PARTS), 6)))


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--heads", type=int, default=_HEADS, help="heads to render, two pictures each")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parents[1] / "landmark_detector.npz")
    arguments = parser.parse_args()
    start = time.perf_counter()

    def say(text: str, **options) -> None:
        print(f"{time.perf_counter() - start:6.0f} s  {text}", **options)

    with threadpool_limits(1):  # sums must not depend on the number of threads
        samples = rendered_samples(1, arguments.heads, arguments.processes)
        held_out = rendered_samples(2, _HELD_OUT, arguments.processes)
        say(f"{len(samples.grey)} renders", flush=True)
        parts = trained_parts(samples, held_out, arguments.processes, say)
    _write(arguments.output, detector_arrays(parts))
    say(f"wrote {arguments.output}, {arguments.output.stat().st_size / 1e6:.1f} MB")


def trained_parts(samples: Samples, held_out: Samples, processes: int, say) -> DetectorParts:
    """Every part of the detector; `held_out` calibrates and chooses, and is not trained on."""
    clutter = clutter_pictures(np.random.default_rng(3), CLUTTER, _PROCEDURAL)
    boxes = train_boxes(_first(samples, 2 * _BOX_HEADS), clutter, say=say)
    cascade = train_cascade(samples, held_out, processes, say=say)
    cascade = replace(cascade, parts=train_parts(samples, held_out, cascade, processes, say=say))
    verifier = train_verifier(_first(samples, 2 * _VERIFIER_HEADS), boxes, cascade, clutter, processes, say=say)
    parts = DetectorParts(boxes, cascade, verifier, _UNTRAINED)
    fresh = clutter_pictures(np.random.default_rng(4), CALIBRATION, _PROCEDURAL)
    judge = train_judge(_first(held_out, 2 * _JUDGE_HEADS), parts, fresh, processes, say=say)
    return DetectorParts(boxes, cascade, verifier, judge)


def _write(path: Path, arrays: dict[str, np.ndarray]) -> None:
    """To a temporary file first, so that a reader never sees half a detector."""
    temporary = path.with_name(f".{path.stem}.tmp.npz")
    np.savez_compressed(temporary, **arrays)
    os.replace(temporary, path)


def _first(samples: Samples, count: int) -> Samples:
    return Samples(samples.grey[:count], samples.landmarks[:count], samples.kinds[:count], samples.yaw[:count])


if __name__ == "__main__":
    main()
