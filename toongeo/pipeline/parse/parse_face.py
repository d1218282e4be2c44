"""The parts of a face in a picture."""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.parse.classical_parser import ClassicalParser
from toongeo.pipeline.parse.given_hair import given_hair
from toongeo.protocols import FaceLabel, FaceParse, FaceParser, FittedFace, HairMask

__all__ = ["parse_face"]

_FEATURES = (
    *(FaceLabel.BROW_LEFT, FaceLabel.BROW_RIGHT, FaceLabel.EYE_LEFT, FaceLabel.EYE_RIGHT),
    *(FaceLabel.UPPER_LIP, FaceLabel.LOWER_LIP, FaceLabel.INNER_MOUTH),
)


def parse_face(
    img: NDArray[np.uint8],
    landmarks: ArrayLike,
    fit: FittedFace | None = None,
    *,
    parser: FaceParser | None = None,
    scheme: str = "ibug68",
    hair_mask: ArrayLike | str | os.PathLike[str] | None = None,
) -> FaceParse:
    """Cut a picture into the parts of a face (the mask of Pan et al. 2024, sections 3.1 and 3.2).

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
        Photo, painting, cartoon or grey picture.
    landmarks : (68, 2) array_like, px
        iBUG-68 order; a NaN row is a missing point. Those of the eyes may be off by a tenth of the face.
    fit : FittedFace, optional
        The face as `fit_3dmm` found it; it is fitted to the landmarks if None.
    parser : FaceParser, optional
        Anything that is called as this function is, a network say; `ClassicalParser` if None.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.
    hair_mask : array_like or path, optional
        Hair that was cut out elsewhere, which is believed: (H, W) bool or 0..255, or a picture of such.

    Returns
    -------
    FaceParse
        Labels and confidence (H, W), and the hair that they follow. That of a parser which gives none is taken from
        its labels, and is trusted if there is any.

    Raises
    ------
    ValueError
        If the picture or the landmarks have another shape or type, the landmarks are no face (see
        `toongeo.io.check_landmarks`), the parser returns labels of another size, or the hair mask is none (see
        `find_hair`).

    Examples
    --------
    >>> from toongeo import FaceLabel, read_image, read_landmarks
    >>> from toongeo.model import data_path
    >>> img = read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> parse = parse_face(img, landmarks)
    >>> parse.labels.shape == img.shape[:2]
    True
    >>> x, y = landmarks[36:42].mean(axis=0).astype(int)
    >>> FaceLabel(parse.labels[y, x]).name
    'EYE_RIGHT'
    """
    check_image(img)
    points = ibug_landmarks(landmarks, scheme)
    check_landmarks(points, img.shape)
    given = None if hair_mask is None else given_hair(hair_mask, img.shape)
    if parser is None:
        parser = ClassicalParser() if given is None else ClassicalParser(hair_finder=lambda *_: given)
    parse = parser(img, points, fit)
    if parse.labels.shape != img.shape[:2]:
        raise ValueError(f"parser: expected labels of shape {img.shape[:2]}, got {parse.labels.shape}")
    if given is not None:
        return _relabelled(parse, given)
    return parse if parse.hair is not None else replace(parse, hair=_of_labels(parse))


def _relabelled(parse: FaceParse, hair: HairMask) -> FaceParse:
    """The parse with another hair; what was hair before and is none now is something else."""
    labels = np.where(parse.labels == FaceLabel.HAIR, np.uint8(FaceLabel.OTHER), parse.labels)
    labels[hair.mask & ~parse.mask(*_FEATURES)] = FaceLabel.HAIR
    return replace(parse, labels=labels, hair=hair)


def _of_labels(parse: FaceParse) -> HairMask:
    mask = parse.mask(FaceLabel.HAIR)
    reasons = () if mask.any() else ("the parser found no hair",)
    return HairMask(mask, not reasons, reasons, hat=parse.mask(FaceLabel.HAT))
