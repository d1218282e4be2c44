"""The stage that gives a head its hair."""

import os
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import ArrayLike

from toongeo.pipeline import AlignedFace, FaceFit, Hair, Rig, build_hair, find_hair, hair_faults, make_room
from toongeo.protocols import FaceLabel, FaceParse, HairMask, HairModeler

__all__ = ["HairyHead", "add_hair", "under_hair"]

GivenMask = ArrayLike | str | os.PathLike[str] | None
_EDGE = 0.01  # of the face's size: along the edge of hair its colour is mixed into the skin's


@dataclass(frozen=True, eq=False)
class HairyHead:
    """A head with hair, or as it was, with the reasons why it has none."""

    face: AlignedFace
    rig: Rig
    parse: FaceParse
    hair: Hair | None
    reasons: tuple[str, ...] = ()


def add_hair(
    img: np.ndarray,
    landmarks: np.ndarray,
    fit: FaceFit,
    head: HairyHead,
    modeler: HairModeler | None = None,
    mask: GivenMask = None,
) -> HairyHead:
    """A head that has made room for its hair, with the hair; the same head, with reasons, where there is none to build.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    fit : FaceFit
    head : HairyHead
        Without hair.
    modeler : HairModeler, optional
        :func:`toongeo.build_hair` unless another is given.
    mask : array_like or path, optional
        Hair in the picture; the parser's, or that of :func:`toongeo.find_hair`, unless given.
    """
    found = _found(img, landmarks, fit, head.parse, mask)
    reasons = found.reasons if not found.trusted else hair_faults(head.face, found.mask)
    if reasons:
        return replace(head, reasons=reasons)
    face, rig = make_room(head.face, head.rig, found.mask, head.parse)
    hair = (modeler or build_hair)(img, face, rig, found.mask)
    if hair is None:
        return replace(head, reasons=("the modeler built none",))
    return HairyHead(face, rig, _labelled(head.parse, found), hair)


def under_hair(parse: FaceParse, face: AlignedFace, mask: np.ndarray) -> FaceParse:
    """The parse as a texture of the skin needs it: pixels of hair (H, W), and of its edge, are not of the head."""
    breadth = float(np.ptp(face.project(face.vertices[face.region("face")])[:, 0]))
    side = 2 * max(1, round(_EDGE * breadth)) + 1
    hairy = cv2.dilate(mask.astype(np.uint8), np.ones((side, side), np.uint8)) > 0
    labels = np.where(parse.labels == FaceLabel.HAIR, FaceLabel.OTHER, parse.labels).astype(np.uint8)
    labels[hairy] = FaceLabel.BACKGROUND
    return FaceParse(labels, parse.confidence)


def _found(img: np.ndarray, landmarks: np.ndarray, fit: FaceFit, parse: FaceParse, mask: GivenMask) -> HairMask:
    if mask is None and parse.hair is not None:
        return parse.hair
    try:
        return find_hair(img, landmarks, fit, hair_mask=mask)
    except ValueError as error:
        if mask is None:
            raise
        # A mask that was made elsewhere is an offer: a head comes out without it, too.
        return HairMask(np.zeros(img.shape[:2], bool), trusted=False, reasons=(str(error),))


def _labelled(parse: FaceParse, found: HairMask) -> FaceParse:
    """The parse whose hair is that of the mask."""
    labels = np.where(parse.labels == FaceLabel.HAIR, FaceLabel.OTHER, parse.labels).astype(np.uint8)
    labels[found.mask] = FaceLabel.HAIR
    return FaceParse(labels, parse.confidence, found)
