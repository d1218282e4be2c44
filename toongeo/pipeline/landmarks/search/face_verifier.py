"""Does an aligned crop show a face?"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.face_crop import face_crop, whole_descriptor
from toongeo.pipeline.landmarks.search.frames import similarity_onto

__all__ = ["FaceVerifier"]


@dataclass(frozen=True, eq=False)
class FaceVerifier:
    """Linear classifiers of the whole aligned crop, one a view: `weights` (v, 4000), `offsets` (v,) float32."""

    weights: NDArray[np.float32]
    offsets: NDArray[np.float32]

    def score(self, grey: np.ndarray, points: NDArray[np.float64], shape: NDArray[np.float64]) -> float:
        """The larger, the more a face: of the picture aligned by its points (68, 2) with the mean shape."""
        row = whole_descriptor(face_crop(grey, similarity_onto(points, shape)))
        return float((self.weights @ row + self.offsets).max())
