"""What is remembered of a performer's skin: places on it, how expressions move them, how bright they are at rest.

Constants were chosen on films of astronaut, bad_guy, blue_girl and manga_girl with other acting than those that are
measured (``benchmarks/tracking.py``).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo._read_only import read_only
from toongeo.arrays import Bytes, Floats
from toongeo.driving.landmark_rig import LandmarkRig, PerformerFace
from toongeo.driving.landmarks.landmark_pose import LandmarkPose
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.render import rasterize, sample_image

__all__ = ["BLURS_PX", "FACE_PX", "Grey", "SkinSamples", "blurred", "posed_px", "shrunken", "skin_samples"]

FACE_PX = 128.0  # width of the face in the pictures that are compared: finer detail is noise to films of 320 px
BLURS_PX = (2.5, 1.0)  # first far enough to see a brow that moved by its own thickness, then exact
Grey = NDArray[np.float32]
_SPACING_PX = 4
_BROW_MARGIN = 0.015  # of the width, above the brows: hair begins there in many faces, and does not move with them
_RIM_MARGIN = 0.03  # of the width, inside the jaw: what lies beyond turns away
_CONTRAST = 40.0  # grey levels that count as 1: of a brow or a lip against skin
_FLIP = np.array([1.0, -1.0])


@dataclass(frozen=True, eq=False)
class SkinSamples:
    """Places on a face at rest and their grey values in one frame of it.

    Attributes
    ----------
    rig : LandmarkRig
        Of the same face.
    rest : (s, 3) float64, mm, model frame
    deltas : (s, 3, k) float64, mm
        What each expression of the rig adds.
    normals : (s, 3) float64
    greys : tuple of (s,) float64, one for each of ``BLURS_PX``
    """

    rig: LandmarkRig
    rest: Floats
    deltas: Floats
    normals: Floats
    greys: tuple[Floats, ...]

    def __post_init__(self) -> None:
        read_only(self, "rest", "deltas", "normals")

    def shape(self, weights: Floats) -> Floats:
        """The places (s, 3) mm under weights (k,)."""
        return self.rest + self.deltas @ weights


def skin_samples(face: PerformerFace, frame: Grey, pose: LandmarkPose) -> SkinSamples:
    """Samples of the skin that a frame shows: front of the face from the brows down, inside of the jaw.

    Parameters
    ----------
    face : PerformerFace
    frame : (h, w) float32
        As of :func:`shrunken`, of the face at rest.
    pose : LandmarkPose
        In that frame; its weights are 0.
    """
    aligned, V, F = face.aligned, face.rig.neutral, face.aligned.faces
    turned = V @ pose.rotation.T
    px = posed_px(V, pose)
    fragments = rasterize(np.column_stack([px, turned[:, 2]]), F, *frame.shape)
    wanted = _inside(px[aligned.landmark_vertices], frame.shape) & fragments.mask
    is_skin = aligned.region("face")[F].all(axis=1)
    ys, xs = (axis.ravel() for axis in np.mgrid[: frame.shape[0] : _SPACING_PX, : frame.shape[1] : _SPACING_PX])
    chosen = wanted[ys, xs]
    ids, shares = fragments.face_ids[ys, xs][chosen], fragments.barycentrics[ys, xs][chosen].astype(np.float64)
    shares, ids = shares[is_skin[ids]], ids[is_skin[ids]]

    def there(values: Floats) -> Floats:
        return np.einsum("sc,sc...->s...", shares, values[F[ids]])

    places = there(V)
    where = posed_px(places, pose)
    return SkinSamples(
        face.landmarks,
        places,
        np.ascontiguousarray(there(face.rig.deltas.astype(np.float64).transpose(1, 2, 0))),
        there(vertex_normals(V, F)),
        tuple(sample_image(blurred(frame, blur), where).astype(np.float64) for blur in BLURS_PX),
    )


def posed_px(points: Floats, pose: LandmarkPose) -> Floats:
    """Where points (s, 3) mm of the model frame are seen: (s, 2) px."""
    return pose.scale * (points @ pose.rotation.T)[:, :2] * _FLIP + pose.translation


def shrunken(frame: Bytes, factor: float) -> Grey:
    """Grey values (h, w) float32 of an RGB frame, smaller by a factor."""
    grey = cv2.cvtColor(frame, cv2.COLOR_RGB2GRAY)
    way = cv2.INTER_AREA if factor < 1 else cv2.INTER_LINEAR
    return np.asarray(cv2.resize(grey, None, fx=factor, fy=factor, interpolation=way), np.float32)


def blurred(grey: Grey, blur: float) -> Grey:
    """Grey values with a Gaussian blur of so many px, in units of a good contrast."""
    return np.asarray(cv2.GaussianBlur(grey, (0, 0), blur) / _CONTRAST, np.float32)


def _inside(points: Floats, shape: tuple[int, int]) -> np.ndarray:
    """(h, w) bool: below the brows and within the jaw of landmarks (68, 2) px."""
    jaw, brows = points[:17], points[17:27]
    width = np.ptp(jaw[:, 0])
    down = points[8] - points[27]  # from between the eyes to the chin
    lifted = brows - _BROW_MARGIN * width * down / np.linalg.norm(down)
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.rint(np.vstack([jaw, lifted[::-1]])).astype(np.int32)], 1)
    reach = 2 * round(_RIM_MARGIN * width) + 1
    near_jaw = np.zeros(shape, np.uint8)
    cv2.polylines(near_jaw, [np.rint(jaw).astype(np.int32)], False, 1, reach)
    return (mask > 0) & (near_jaw == 0)
