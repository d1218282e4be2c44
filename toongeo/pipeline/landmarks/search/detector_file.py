"""The trained parts of the detector, in one file."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.model.data_path import data_path
from toongeo.pipeline.landmarks.search.cascade import Cascade, CascadeStage, PartCascade
from toongeo.pipeline.landmarks.search.face_boxes import BoxTemplates
from toongeo.pipeline.landmarks.search.face_judge import FaceJudge
from toongeo.pipeline.landmarks.search.face_verifier import FaceVerifier
from toongeo.reading.read_npz import read_npz

__all__ = ["DetectorParts", "detector_arrays", "read_detector", "shipped_detector"]

_STAGE = ("mean", "axes", "weights")


@dataclass(frozen=True, eq=False)
class DetectorParts:
    """Templates of face boxes, the cascade, and what tells faces from clutter and good points from bad."""

    boxes: BoxTemplates
    cascade: Cascade
    verifier: FaceVerifier
    judge: FaceJudge


def detector_arrays(parts: DetectorParts) -> dict[str, NDArray[Any]]:
    """The arrays of the file by name: half precision where it makes no difference."""
    cascade, judge = parts.cascade, parts.judge
    arrays: dict[str, NDArray[Any]] = {
        "shape": cascade.shape,
        "shape_axes": cascade.shape_axes.astype(np.float16),
        "box_weights": parts.boxes.weights.astype(np.float32),
        "box_offsets": parts.boxes.offsets.astype(np.float32),
        "verifier_weights": parts.verifier.weights.astype(np.float32),
        "verifier_offsets": parts.verifier.offsets.astype(np.float32),
        "judge_face": judge.face,
        "judge_points": judge.points,
    }
    arrays |= _stage_arrays("stage", cascade.stages)
    arrays["parts"] = np.array([len(part.rows) for part in cascade.parts])
    for k, part in enumerate(cascade.parts):
        arrays |= {f"part{k}_rows": part.rows, f"part{k}_shape": part.shape}
        arrays |= _stage_arrays(f"part{k}_stage", part.stages)
    return arrays


def _stage_arrays(prefix: str, stages: tuple[CascadeStage, ...]) -> dict[str, NDArray[Any]]:
    arrays: dict[str, NDArray[Any]] = {f"{prefix}s": np.array([(stage.radius, *stage.blurs) for stage in stages])}
    for k, stage in enumerate(stages):
        for name in _STAGE:
            arrays[f"{prefix}{k}_{name}"] = getattr(stage, name).astype(np.float16)
    return arrays


def _stages(arrays: dict[str, NDArray[Any]], prefix: str) -> tuple[CascadeStage, ...]:
    return tuple(
        CascadeStage(float(r), (float(near), float(far)), *(arrays[f"{prefix}{k}_{name}"] for name in _STAGE))
        for k, (r, near, far) in enumerate(arrays[f"{prefix}s"])
    )


def read_detector(path: Path) -> DetectorParts:
    """The detector of a file that :func:`detector_arrays` describes."""
    z = read_npz(path, expected="a landmark detector")
    single: dict[str, Any] = {name: a.astype(np.float32) if a.dtype == np.float16 else a for name, a in z.items()}
    parts = tuple(
        PartCascade(z[f"part{k}_rows"], z[f"part{k}_shape"], _stages(single, f"part{k}_stage"))
        for k in range(len(z["parts"]))
    )
    return DetectorParts(
        BoxTemplates(single["box_weights"], single["box_offsets"]),
        Cascade(single["shape"], single["shape_axes"], _stages(single, "stage"), parts),
        FaceVerifier(single["verifier_weights"], single["verifier_offsets"]),
        FaceJudge(single["judge_face"], single["judge_points"]),
    )


@cache
def shipped_detector() -> DetectorParts:
    """The detector that comes with the library; read once a process."""
    return read_detector(data_path("data_templates/landmark_detector.npz"))
