"""The parts of a face in a picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.parse.classical_parser import ClassicalParser
from toongeo.protocols import FaceParse, FaceParser, FittedFace

__all__ = ["parse_face"]


def parse_face(
    img: NDArray[np.uint8],
    landmarks: ArrayLike,
    fit: FittedFace | None = None,
    *,
    parser: FaceParser | None = None,
    scheme: str = "ibug68",
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

    Returns
    -------
    FaceParse
        Labels and confidence (H, W).

    Raises
    ------
    ValueError
        If the picture or the landmarks have another shape or type, the landmarks are no face (see
        `toongeo.io.check_landmarks`), or the parser returns labels of another size.

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
    parse = (parser or ClassicalParser())(img, points, fit)
    if parse.labels.shape != img.shape[:2]:
        raise ValueError(f"parser: expected labels of shape {img.shape[:2]}, got {parse.labels.shape}")
    return parse
