"""Which samples of the face the camera sees.

Constants were chosen on rendered faces, seeds 20-29, and looked at on ten pictures (``benchmarks/photometric.py``).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.fit.photometric.photometric_samples import PhotometricSamples
from toongeo.render.rasterize import rasterize

__all__ = ["visible_samples"]

_DEPTH_STEP, _DEPTH_SLACK = 1.5, 3.0  # mm: pixel of the depth buffer, and how far behind it a sample is still seen


def visible_samples(posed: NDArray[np.float64], samples: PhotometricSamples) -> NDArray[np.bool_]:
    """Mask (k,) of the samples that no other part of the face hides, by a depth buffer.

    Parameters
    ----------
    posed : (n, 3) float, mm
        All vertices of the model in the canonical frame, y up, larger z nearer.
    samples : PhotometricSamples
    """
    half = (
        np.ceil(np.abs(posed[samples.vertices, :2]).max(axis=0) / _DEPTH_STEP) + 1
    )  # symmetric, so that a mirrored face is too
    px = posed[:, :2] * [1.0, -1.0] / _DEPTH_STEP + half
    width, height = (2 * half + 1).astype(int)
    fragments = rasterize(np.column_stack([px, posed[:, 2]]), samples.faces, int(height), int(width))
    column, row = np.rint(px[samples.vertices]).astype(int).T
    ids = fragments.face_ids[row, column]
    depth = (posed[:, 2][samples.faces[ids]] * fragments.barycentrics[row, column]).sum(axis=1)
    return (ids < 0) | (posed[samples.vertices, 2] > depth - _DEPTH_SLACK)
