"""Where a command takes the landmarks of its picture from."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.app.commands.path_is import path_is
from toongeo.app.unsure_landmarks_error import UnsureLandmarksError
from toongeo.io import LandmarkFile, read_landmark_file
from toongeo.model.ibug68 import INNER
from toongeo.pipeline import detect_landmarks, landmark_evidence
from toongeo.protocols import LandmarkDetection

__all__ = ["LandmarkSource"]


@dataclass(frozen=True)
class LandmarkSource:
    """A file of landmarks and their scheme or, without one, what to find; `accept` takes points that are not sure.

    `face` is which of several, in the file or, by size, in the picture.
    """

    file: Path | None = None
    scheme: str = "auto"
    face: int = 0
    accept: bool = False

    def landmarks(
        self, image: Path, img: NDArray[np.uint8]
    ) -> tuple[NDArray[np.float64], LandmarkFile | LandmarkDetection]:
        """Landmarks (68, 2) px of the picture, and how they were read or found.

        Raises
        ------
        UnsureLandmarksError
            If they were found but a person should look at them: because the detector is not sure of them, or because
            the picture does not bear them out (see `landmark_evidence`), whatever the detector says.
        ValueError, OSError
            If the file cannot be read, or there is no such face.
        """
        if self.file is not None:
            with path_is("landmarks"):
                read = read_landmark_file(self.file, scheme=self.scheme, face=self.face, size=img)
            return read.points, read
        if self.scheme != "auto":
            raise ValueError(f"scheme: expected --landmarks FILE with --scheme, got {self.scheme!r} alone")
        found = detect_landmarks(img, face=self.face)
        if not self.accept:
            evidence = landmark_evidence(img, found.points)
            if not (found.is_sure and evidence.is_plausible):
                trust = 100 * float(found.confidence[INNER].mean())
                raise UnsureLandmarksError(
                    f"{image}: the landmarks that were found are not sure (face {100 * found.score:.0f} %, points "
                    f"{trust:.0f} %, the picture {100 * evidence.chance:.0f} %); correct them with toongeo landmarks "
                    f"{image}, give others with --landmarks FILE, or go on with --accept"
                )
        return found.points, found
