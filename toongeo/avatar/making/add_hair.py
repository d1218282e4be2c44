"""The stage that gives a head its hair."""

import os
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Mask
from toongeo.pipeline import AlignedFace, Hair, Rig, build_hair, hair_faults, make_room
from toongeo.pipeline.parse.given_hair import given_hair
from toongeo.protocols import FaceLabel, FaceParse, HairModeler

__all__ = ["GivenMask", "HairyHead", "add_hair", "read_mask", "under_hair"]

GivenMask = ArrayLike | str | os.PathLike[str] | None
_EDGE = 0.01  # of the face's breadth: along the edge of hair its colour is mixed into the skin's


@dataclass(frozen=True, eq=False)
class HairyHead:
    """A head with hair, or as it was, with the reasons why it has none."""

    face: AlignedFace
    rig: Rig
    hair: Hair | None
    reasons: tuple[str, ...] = ()


def read_mask(mask: GivenMask, shape: tuple[int, ...]) -> tuple[Mask | None, tuple[str, ...]]:
    """A mask that was made elsewhere (see :func:`toongeo.find_hair`), or why it cannot be one of a picture (H, W, 3).

    It is an offer: a head comes out without it, too.
    """
    if mask is None:
        return None, ()
    try:
        return given_hair(mask, shape).mask, ()
    except ValueError as error:
        return None, (str(error),)


def add_hair(
    img: np.ndarray, face: AlignedFace, rig: Rig, parse: FaceParse, modeler: HairModeler | None = None
) -> HairyHead:
    """A head that has made room for its hair, with the hair; the same head, with reasons, where there is none to build.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
    rig : Rig
        Of that face.
    parse : FaceParse
        With the hair of the picture.
    modeler : HairModeler, optional
        :func:`toongeo.build_hair` unless another is given.
    """
    bare = HairyHead(face, rig, None)
    if parse.hair is None or not parse.hair.trusted:
        return replace(bare, reasons=("no hair was looked for",) if parse.hair is None else parse.hair.reasons)
    mask = parse.hair.mask
    reasons = hair_faults(face, mask)
    if reasons:
        return replace(bare, reasons=reasons)
    roomy = make_room(face, rig, mask, parse)
    hair = (modeler or build_hair)(img, *roomy, mask)
    if hair is None:
        return replace(bare, reasons=("the modeler built none",))
    return HairyHead(*roomy, hair)


def under_hair(parse: FaceParse, face: AlignedFace) -> FaceParse:
    """The parse as a texture of the skin needs it: pixels of hair, and of its edge, are not of the head."""
    assert parse.hair is not None
    breadth = float(np.ptp(face.project(face.vertices[face.region("face")])[:, 0]))
    side = 2 * max(1, round(_EDGE * breadth)) + 1
    hairy = cv2.dilate(parse.hair.mask.astype(np.uint8), np.ones((side, side), np.uint8)) > 0
    labels = np.where(parse.labels == FaceLabel.HAIR, FaceLabel.OTHER, parse.labels).astype(np.uint8)
    labels[hairy] = FaceLabel.BACKGROUND
    return replace(parse, labels=labels)
