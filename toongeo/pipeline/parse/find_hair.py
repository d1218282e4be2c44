"""The hair of a head in its picture."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io.check_image import check_image
from toongeo.io.landmark_array import landmark_array
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.parse.classical_parser import ClassicalParser
from toongeo.pipeline.parse.given_hair import given_hair
from toongeo.protocols import FaceLabel, FittedFace, HairMask

__all__ = ["find_hair"]


def find_hair(
    img: NDArray[np.uint8],
    landmarks: ArrayLike,
    fit: FittedFace | None = None,
    *,
    hair_mask: ArrayLike | str | os.PathLike[str] | None = None,
) -> HairMask:
    """Which pixels of a picture are hair, and whether hair can be built from them.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) array_like, px
        iBUG-68 order; a NaN row is a missing point.
    fit : FittedFace, optional
        The face as `fit_3dmm` found it; it is fitted to the landmarks if None.
    hair_mask : array_like or path, optional
        A mask made elsewhere, which is believed: (H, W) bool or 0..255, or a picture of such.

    Returns
    -------
    HairMask

    Raises
    ------
    ValueError
        If picture, landmarks or mask have another shape or type.
    """
    check_image(img)
    points = landmark_array(landmarks)
    if hair_mask is not None:
        return given_hair(hair_mask, img.shape)
    face = fit if fit is not None else fit_3dmm(None, points)
    mask = ClassicalParser()(img, points, face).mask(FaceLabel.HAIR)
    return HairMask(mask, trusted=False, reasons=("hair of the parse, which clothes may have joined",))
