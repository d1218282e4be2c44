"""The hair of a head in its picture."""

from __future__ import annotations

import os

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Singles
from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_image import check_image
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.parse.completed_landmarks import completed_landmarks
from toongeo.pipeline.parse.face_zones import face_zones
from toongeo.pipeline.parse.given_hair import given_hair
from toongeo.pipeline.parse.hair.hair_model import hair_model
from toongeo.pipeline.parse.hair.hair_trust import distrust
from toongeo.pipeline.parse.hair.hair_view import HEAD_PX, hair_view
from toongeo.pipeline.parse.hair.head_zones import head_zones
from toongeo.pipeline.parse.hair.segment_hair import segment_hair
from toongeo.pipeline.parse.head_and_skin import head_and_skin
from toongeo.pipeline.parse.masks import signed_distance
from toongeo.pipeline.parse.working_view import WorkingView
from toongeo.protocols import FittedFace, HairMask

__all__ = ["find_hair", "seen_hair"]

# Mean posterior in the mask below which the trees saw hair nowhere, and what the cuts made of it is chance: 0.40 to
# 0.51 on three of the pictures of benchmarks/hair_mask.py, two of them hairy, where the mask overlaps the hand's by
# 0.11 at most; the next has 0.61, and 0.55.
_LEAST = 0.55


def find_hair(
    img: NDArray[np.uint8],
    landmarks: ArrayLike,
    fit: FittedFace | None = None,
    *,
    hair_mask: ArrayLike | str | os.PathLike[str] | None = None,
    scheme: str = "ibug68",
) -> HairMask:
    """Which pixels of a picture are hair, and whether hair can be built from them.

    The head's surroundings are cut into superpixels; two sets of boosted trees, trained on renders of the template
    alone, say how likely each is hair or a hat, by its colour, texture and place and by what is around it. Where it
    lies on the head is told by the head that is cut out of the picture, as drawn crowns are lower and narrower than
    fitted ones; its skin is no hair. Two cuts follow the outlines, by colours and by GrabCut, and where they disagree a
    third one by edges alone; the two that are most alike make the mask. Hair grows on the head: brows and crumbs are
    left out, and below the chin counts only what hangs from above, not coats and collars; what hangs below the nose and
    has the colours of the clothes rather than of the hair is left out, too. A mask is trusted where the
    cuts agree, the trees are sure, head less skin bears it out, the picture shows its outline, the hair tops the head,
    and what hangs has the hair's colours. Where the trees see hair nowhere it is empty.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
        Photo, painting, cartoon or grey picture.
    landmarks : (68, 2) array_like, px
        iBUG-68 order; a NaN row is a missing point.
    fit : FittedFace, optional
        The face as `fit_3dmm` found it; it is fitted to the landmarks if None.
    hair_mask : array_like or path, optional
        A mask made elsewhere, which is believed: (H, W) bool or 0..255, or a picture of such.
    scheme : {"ibug68", "ibug51", "ibug49", "mediapipe478"}
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    HairMask
        Hair and hat, soft edges, and why the mask is not to be trusted, if so.

    Raises
    ------
    ValueError
        If picture, landmarks or mask have another shape or type, or the mask is empty or covers the whole picture.

    Examples
    --------
    >>> from toongeo import read_image, read_landmarks
    >>> from toongeo.model import data_path
    >>> img = read_image(data_path("examples/portraits/moustache_man.png"))
    >>> hair = find_hair(img, read_landmarks(data_path("examples/portraits/moustache_man.pts")))
    >>> hair.trusted, hair.mask.shape == img.shape[:2]
    (True, True)
    """
    check_image(img)
    given = ibug_landmarks(landmarks, scheme)
    if hair_mask is not None:
        return given_hair(hair_mask, img.shape)
    face = fit if fit is not None else fit_3dmm(None, given)
    return seen_hair(img, completed_landmarks(given, face), face)


def seen_hair(
    img: NDArray[np.uint8], points: NDArray[np.float64], face: FittedFace, head_px: float = HEAD_PX
) -> HairMask:
    """What :func:`find_hair` finds, with all landmarks (68, 2) px, in a view whose head has another size, px.

    At 150 px it takes two thirds of the time; on 13 renders the mask overlaps the truth by 0.755 in the mean instead of
    0.766 (median 0.91 both).
    """
    view = hair_view(img, face, head_px)
    with one_thread():
        cut = head_and_skin(view, face_zones(view, points, face))
        found = segment_hair(view, head_zones(view, points, face), cut, hair_model())
    seen = found.measures.inside >= _LEAST
    hair, hat = (_enlarged(view, part & seen, img.shape) for part in (found.hair, found.hat))
    alpha = np.zeros(img.shape[:2], np.float32)
    alpha[view.window()] = _resized(view, found.alpha * seen)
    reasons = distrust(found.measures)
    return HairMask(hair, not reasons, reasons, np.clip(alpha, 0, 1), hat & ~hair)


def _enlarged(view: WorkingView, mask: NDArray[np.bool_], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """A mask of the view in the whole picture; its outline is interpolated as a distance, so that it has no stairs."""
    full = np.zeros(shape[:2], bool)
    if mask.any():
        full[view.window()] = _resized(view, cv2.GaussianBlur(np.clip(signed_distance(mask), -6, 6), (0, 0), 0.8)) > 0
    return full


def _resized(view: WorkingView, field: NDArray[np.generic]) -> Singles:
    width, height = (int(n) for n in view.size)
    larger = width > field.shape[1]
    method = cv2.INTER_LINEAR if larger else cv2.INTER_AREA
    return np.asarray(cv2.resize(field.astype(np.float32), (width, height), interpolation=method), np.float32)
