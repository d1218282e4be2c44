"""How well an avatar came out."""

from dataclasses import dataclass

import numpy as np

from toongeo.metrics import MeshQuality, landmark_error
from toongeo.metrics.outer_eye_distance import outer_eye_distance
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.ibug68 import INNER
from toongeo.pipeline import AlignedFace, Eyes, FaceFit, Iris
from toongeo.protocols import LandmarkDetection

__all__ = [
    "AvatarReport",
    "detection_warnings",
    "eye_warnings",
    "landmark_errors",
    "shape_warnings",
]

_FEW_INTERSECTIONS = 0.003  # of the triangles of the face; more are worth a warning


@dataclass(frozen=True, eq=False)
class AvatarReport:
    """Figures of one avatar.

    Attributes
    ----------
    coarse, aligned : part -> RMS
        Landmark error of the fitted and of the aligned face by part, as a fraction of the outer-eye distance. The
        aligned face is forced through its landmarks: its error tells nothing about the face, unless they were noisy.
    quality : MeshQuality
        Of the triangles of the region ``face`` among themselves.
    seconds : stage -> float
    warnings : tuple of sentences
    """

    coarse: dict[str, float]
    aligned: dict[str, float]
    quality: MeshQuality
    seconds: dict[str, float]
    warnings: tuple[str, ...]

    def lines(self) -> list[str]:
        """The report in short lines of text."""
        errors = [f"{part:<9}{100 * self.coarse[part]:7.2f} %{100 * self.aligned[part]:8.3f} %" for part in self.coarse]
        quality, total = self.quality, sum(self.seconds.values())
        stages = [f"{stage:<9}{seconds:7.2f} s" for stage, seconds in self.seconds.items()]
        return [
            "landmark error, RMS / outer-eye distance",
            "part        coarse   aligned (forced)",
            *errors,
            f"self-intersecting: {len(quality.intersecting)} of {quality.selected} triangles of the face",
            *stages,
            f"{'in all':<9}{total:7.2f} s",
            *(f"warning: {warning}" for warning in self.warnings),
        ]


def landmark_errors(face: FaceFit | AlignedFace, landmarks: np.ndarray) -> dict[str, float]:
    """Landmark error by part / outer-eye distance (that of the face where an outer corner is missing)."""
    found = face.project(face.vertices[face.landmark_vertices])
    return landmark_error(found, landmarks, scale=outer_eye_distance(landmarks, found))


def detection_warnings(found: LandmarkDetection) -> tuple[str, ...]:
    """What is doubtful about landmarks that were not set by hand."""
    if found.is_sure:
        return ()
    trust = 100 * float(found.confidence[INNER].mean())
    return (f"the landmarks that were found are not sure (face {100 * found.score:.0f} %, points {trust:.0f} %)",)


def eye_warnings(irises: tuple[Iris | None, Iris | None]) -> list[str]:
    """Which eyes show too little of themselves, so that something else stands in for it."""
    without = [name for name, iris in zip(SIDES, irises, strict=True) if iris is None]
    if len(without) == len(SIDES):
        return ["no iris was found: what lids hide of the eyes is guessed"]
    return [f"no iris was found in the {name} eye: the other eye's stands in for it" for name in without]


def shape_warnings(face: AlignedFace, eyes: Eyes, quality: MeshQuality) -> list[str]:
    """What seems wrong with the shape of a face."""
    warnings = []
    if quality.intersecting_fraction > _FEW_INTERSECTIONS:
        warnings.append(f"{100 * quality.intersecting_fraction:.1f} % of the face's triangles intersect others")
    for side, name in enumerate(SIDES[: len(eyes.templates)]):
        skin = face.region("skin") & ~face.region(f"eye_{name}")
        inside = np.linalg.norm(face.vertices[skin] - eyes.centres[side], axis=1) < eyes.radii[side]
        if inside.any():
            warnings.append(f"the {name} eyeball reaches through the skin ({inside.sum()} vertices)")
    return warnings
