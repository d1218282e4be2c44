"""Do points lie on a face, and is it a drawn one?"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.cascade import Cascade
from toongeo.pipeline.landmarks.search.face_crop import face_crop
from toongeo.pipeline.landmarks.search.frames import applied, similarity_onto

__all__ = ["FaceLook", "FaceVerifier", "verified_row"]

# Of the cascade, whose descriptors are looked at. Those of this one see 10 px of a face with a radius of 38 px about
# each point: on renders unlike those of the training as many false faces as before left 66 % found instead of 43 % (by
# a descriptor of the whole crop), for they follow a face that is bent. Stages 1 and 5 were no better, nor were sums.
_STAGE = 3


class FaceLook(NamedTuple):
    """`face`: the larger, the more a face; `figure`: the larger, the more one drawn in the plane; both near -1 to 1."""

    face: float
    figure: float


@dataclass(frozen=True, eq=False)
class FaceVerifier:
    """Linear classifiers of what is around all points: `weights` (v, d), `offsets` (v,) float32 of faces against
    others, one a view; `figure` (d + 1,) of figures against people, the offset last."""

    weights: NDArray[np.float32]
    offsets: NDArray[np.float32]
    figure: NDArray[np.float32]

    def look(self, grey: np.ndarray, points: NDArray[np.float64], cascade: Cascade) -> FaceLook:
        """What points (68, 2) px of a picture lie on."""
        row = verified_row(grey, points, cascade)
        return FaceLook(
            float((self.weights @ row + self.offsets).max()), float(self.figure[:-1] @ row + self.figure[-1])
        )


def verified_row(grey: np.ndarray, points: NDArray[np.float64], cascade: Cascade) -> NDArray[np.float32]:
    """(d,) Coordinates of the descriptors at the points (68, 2) px, in a crop that they align with the mean shape."""
    matrix = similarity_onto(points, cascade.shape)
    stage = cascade.stages[min(_STAGE, len(cascade.stages) - 1)]  # a toy has fewer
    return stage.coordinates(face_crop(grey, matrix), applied(matrix, points))
