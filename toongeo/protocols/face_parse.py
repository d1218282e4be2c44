"""The parts of a picture, and what tells them."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._notebook_png import notebook_png
from toongeo.protocols.faces import FittedFace

__all__ = ["FaceLabel", "FaceParse", "FaceParser", "HairFinder", "HairMask"]


class FaceLabel(IntEnum):
    """What a pixel of a parsed face shows: a number of uint8. Left and right are the subject's.

    Attributes
    ----------
    BACKGROUND, SKIN, BROW_LEFT, BROW_RIGHT, EYE_LEFT, EYE_RIGHT, NOSE, UPPER_LIP, LOWER_LIP, INNER_MOUTH : 0 to 9
    HAIR, EARS, NECK : 10 to 12
    OTHER : 13
        Glasses, hands, beards, black outlines.
    HAT : 14
        Caps, hoods, helmets, scarves about the head.

    Examples
    --------
    >>> import toongeo as tg
    >>> int(tg.FaceLabel.HAIR), tg.FaceLabel(10).name
    (10, 'HAIR')
    >>> [label.name for label in tg.FaceLabel if label.name.endswith("LIP")]
    ['UPPER_LIP', 'LOWER_LIP']
    """

    BACKGROUND = 0
    SKIN = 1
    BROW_LEFT = 2
    BROW_RIGHT = 3
    EYE_LEFT = 4
    EYE_RIGHT = 5
    NOSE = 6
    UPPER_LIP = 7
    LOWER_LIP = 8
    INNER_MOUTH = 9
    HAIR = 10
    EARS = 11
    NECK = 12
    OTHER = 13  # glasses, hands, beards, black outlines
    HAT = 14  # caps, hoods, helmets, scarves about the head


@dataclass(frozen=True, eq=False)
class HairMask:
    """The hair of one head in a picture.

    Attributes
    ----------
    mask : (H, W) bool
        Pixels of hair: of the head's hair alone, without brows, beard and hat.
    trusted : bool
        Whether it is good enough to build hair from; otherwise hair stays painted on the head.
    reasons : tuple of str
        Why it is not trusted, a short sentence each; empty if it is.
    alpha : (H, W) float32 in [0, 1], optional
        How far each pixel is covered by hair: soft where strands mix with what is behind them.
    hat : (H, W) bool, optional
        Pixels of a hat; None or all False where there is none. No pixel is hair and hat.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> hair = tg.HairMask(np.zeros((48, 64), dtype=bool), trusted=False, reasons=("No hair was found.",))
    >>> hair.mask.shape, hair.trusted
    ((48, 64), False)
    """

    mask: np.ndarray
    trusted: bool
    reasons: tuple[str, ...] = ()
    alpha: np.ndarray | None = None
    hat: np.ndarray | None = None

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        mask = np.array(self.mask)
        if mask.ndim != 2 or mask.dtype != np.bool_:
            raise ValueError(f"mask: expected (H, W) bool, got {mask.dtype} of shape {mask.shape}")
        if self.trusted == bool(self.reasons):
            raise ValueError(f"reasons: expected some exactly if not trusted, got {self.reasons}")
        fields: dict[str, np.ndarray | None] = {"mask": mask, "alpha": None, "hat": None}
        if self.alpha is not None:
            fields["alpha"] = alpha = np.array(self.alpha, np.float32)
            if alpha.shape != mask.shape or not ((alpha >= 0) & (alpha <= 1)).all():
                raise ValueError(f"alpha: expected numbers in [0, 1] of shape {mask.shape}, got shape {alpha.shape}")
        if self.hat is not None:
            fields["hat"] = hat = np.array(self.hat)
            if hat.shape != mask.shape or hat.dtype != np.bool_ or (hat & mask).any():
                raise ValueError(f"hat: expected bool of shape {mask.shape} apart from the hair, got {hat.shape}")
        for name, array in fields.items():
            if array is not None:
                array.setflags(write=False)
            object.__setattr__(self, name, array)


@dataclass(frozen=True, eq=False)
class FaceParse:
    """A picture cut into the parts of a face.

    Attributes
    ----------
    labels : (H, W) uint8
        A :class:`FaceLabel` a pixel.
    confidence : (H, W) float in [0, 1]
        How far each label is to be believed.
    hair : HairMask, optional
        The hair that the labels follow, and whether it is to be trusted.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> labels = np.zeros((4, 4), dtype=np.uint8)
    >>> labels[1:3, 1:3] = tg.FaceLabel.SKIN
    >>> parse = tg.FaceParse(labels, np.ones((4, 4)))
    >>> int(parse.mask(tg.FaceLabel.SKIN, tg.FaceLabel.NOSE).sum())
    4
    """

    labels: np.ndarray
    confidence: np.ndarray
    hair: HairMask | None = None

    __repr__ = brief_repr
    _repr_png_ = notebook_png

    def __post_init__(self) -> None:
        labels, confidence = np.array(self.labels), np.array(self.confidence, np.float32)
        if labels.ndim != 2 or labels.dtype != np.uint8 or labels.max(initial=0) > max(FaceLabel):
            raise ValueError(
                f"labels: expected (H, W) uint8 up to {max(FaceLabel)}, "
                f"got {labels.shape} {labels.dtype} up to {labels.max(initial=0)}"
            )
        if confidence.shape != labels.shape:
            raise ValueError(f"confidence: expected the shape of labels {labels.shape}, got {confidence.shape}")
        if not ((confidence >= 0) & (confidence <= 1)).all():
            raise ValueError("confidence: expected numbers in [0, 1], got others or NaN")
        if self.hair is not None and self.hair.mask.shape != labels.shape:
            raise ValueError(f"hair: expected the shape of labels {labels.shape}, got {self.hair.mask.shape}")
        for name, array in (("labels", labels), ("confidence", confidence)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def mask(self, *parts: FaceLabel) -> np.ndarray:
        """Pixels (H, W) bool of any of these parts."""
        return np.isin(self.labels, parts)


class FaceParser(Protocol):
    """Cuts a picture into the parts of a face; a network, say, or the classical parser.

    :func:`toongeo.testing.check_face_parser` checks one; ``make_avatar(img, parser=...)`` uses it, or its name
    (:func:`toongeo.plugins.plugin`).

    Examples
    --------
    >>> from toongeo.testing import check_face_parser
    >>> class Box:
    ...     "All between the landmarks is skin."
    ...     def __call__(self, img, landmarks, fit=None):
    ...         labels = np.zeros(img.shape[:2], np.uint8)
    ...         (left, top), (right, bottom) = np.nanmin(landmarks, 0).astype(int), np.nanmax(landmarks, 0).astype(int)
    ...         labels[top:bottom, left:right] = FaceLabel.SKIN
    ...         return FaceParse(labels, np.full(labels.shape, 0.5))
    >>> check_face_parser(Box())
    """

    def __call__(self, img: np.ndarray, landmarks: np.ndarray, fit: "FittedFace | None" = None) -> FaceParse:
        """Labels of the picture (H, W, 3) uint8 with landmarks (68, 2) px, NaN where missing, and its fitted face."""
        ...


class HairFinder(Protocol):
    """Finds the hair in a picture; a network, say, or :func:`toongeo.find_hair`.

    :func:`toongeo.testing.check_hair_finder` checks one; ``make_avatar(img, hair_mask=finder(...).mask)`` uses it.

    Examples
    --------
    >>> from toongeo.testing import check_hair_finder
    >>> class Dark:
    ...     "What is dark above the eyes is hair."
    ...     def __call__(self, img, landmarks, fit):
    ...         above = np.arange(len(img))[:, None] < np.nanmin(landmarks[36:48, 1])
    ...         return HairMask((img.max(axis=2) < 60) & above, trusted=False, reasons=("darkness proves little",))
    >>> check_hair_finder(Dark())
    """

    def __call__(self, img: np.ndarray, landmarks: np.ndarray, fit: "FittedFace") -> HairMask:
        """Hair of the head with landmarks (68, 2) px, NaN where missing, in a picture (H, W, 3) uint8.

        ``fit`` is the fitted face.
        """
        ...
