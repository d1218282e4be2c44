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

__all__ = ["DetectorParts", "detector_arrays", "packed_axes", "read_detector", "shipped_detector", "unpacked_axes"]

_STAGE = ("mean", "weights")
_LARGEST, _TINY = 127, 1e-6  # of a signed byte; of an axis of length one none is that small


@dataclass(frozen=True, eq=False)
class DetectorParts:
    """Templates of face boxes, the cascade, and what tells faces from clutter and good points from bad."""

    boxes: BoxTemplates
    cascade: Cascade
    verifier: FaceVerifier
    judge: FaceJudge


def detector_arrays(parts: DetectorParts) -> dict[str, NDArray[Any]]:
    """The arrays of the file by name: bytes and half precision where it makes no difference."""
    cascade, judge = parts.cascade, parts.judge
    arrays: dict[str, NDArray[Any]] = {
        "shape": cascade.shape,
        "shape_axes": cascade.shape_axes.astype(np.float16),
        "box_weights": parts.boxes.weights.astype(np.float32),
        "box_offsets": parts.boxes.offsets.astype(np.float32),
        "verifier_weights": parts.verifier.weights.astype(np.float32),
        "verifier_offsets": parts.verifier.offsets.astype(np.float32),
        "verifier_figure": parts.verifier.figure.astype(np.float32),
        "judge_face": judge.face,
        "judge_points": judge.points,
    }
    arrays |= _stage_arrays("stage", cascade.stages)
    return arrays | _part_arrays("part", cascade.parts) | _part_arrays("photo_part", cascade.photo_parts)


def _part_arrays(prefix: str, parts: tuple[PartCascade, ...]) -> dict[str, NDArray[Any]]:
    arrays: dict[str, NDArray[Any]] = {f"{prefix}s": np.array([len(part.rows) for part in parts])}
    for k, part in enumerate(parts):
        arrays |= {f"{prefix}{k}_rows": part.rows, f"{prefix}{k}_shape": part.shape}
        arrays |= _stage_arrays(f"{prefix}{k}_stage", part.stages)
    return arrays


def _stage_arrays(prefix: str, stages: tuple[CascadeStage, ...]) -> dict[str, NDArray[Any]]:
    arrays: dict[str, NDArray[Any]] = {f"{prefix}s": np.array([(stage.radius, *stage.blurs) for stage in stages])}
    for k, stage in enumerate(stages):
        for name in _STAGE:
            arrays[f"{prefix}{k}_{name}"] = getattr(stage, name).astype(np.float16)
        arrays[f"{prefix}{k}_axes"], arrays[f"{prefix}{k}_units"] = packed_axes(stage.axes)
    return arrays


def _stages(arrays: dict[str, NDArray[Any]], prefix: str) -> tuple[CascadeStage, ...]:
    stages = []
    for k, (r, near, far) in enumerate(arrays[f"{prefix}s"]):
        axes = unpacked_axes(arrays[f"{prefix}{k}_axes"], arrays[f"{prefix}{k}_units"])
        mean, weights = (arrays[f"{prefix}{k}_{name}"] for name in _STAGE)
        stages.append(CascadeStage(float(r), (float(near), float(far)), mean, axes, weights))
    return tuple(stages)


def packed_axes(axes: NDArray[np.float32]) -> tuple[NDArray[np.int8], NDArray[np.int8]]:
    """Axes (k, d, c) as bytes and, (k, 1, c), the power of 2 that is the unit of each axis.

    Rounded so they are off by 1 %, which moves no point by more than the jitter of the starts does. What is unpacked
    packs to the same bytes.
    """
    largest = np.maximum(np.abs(axes).max(axis=1, keepdims=True), _TINY)
    units = np.ceil(np.log2(largest / _LARGEST)).astype(np.int8)
    return np.rint(np.ldexp(axes, -units.astype(np.int32))).astype(np.int8), units


def unpacked_axes(packed: NDArray[np.int8], units: NDArray[np.int8]) -> NDArray[np.float32]:
    """The inverse of :func:`packed_axes`."""
    return np.ldexp(packed.astype(np.float32), units.astype(np.int32))


def read_detector(path: Path) -> DetectorParts:
    """The detector of a file that :func:`detector_arrays` describes."""
    z = read_npz(path, expected="a landmark detector")
    single: dict[str, Any] = {name: a.astype(np.float32) if a.dtype == np.float16 else a for name, a in z.items()}
    parts, photo_parts = (
        tuple(
            PartCascade(z[f"{prefix}{k}_rows"], z[f"{prefix}{k}_shape"], _stages(single, f"{prefix}{k}_stage"))
            for k in range(len(z[f"{prefix}s"]))
        )
        for prefix in ("part", "photo_part")
    )
    return DetectorParts(
        BoxTemplates(single["box_weights"], single["box_offsets"]),
        Cascade(single["shape"], single["shape_axes"], _stages(single, "stage"), parts, photo_parts),
        FaceVerifier(*(single[f"verifier_{name}"] for name in ("weights", "offsets", "figure"))),
        FaceJudge(single["judge_face"], single["judge_points"]),
    )


@cache
def shipped_detector() -> DetectorParts:
    """The detector that comes with the library; read once a process."""
    return read_detector(data_path("data_templates/landmark_detector.npz"))
