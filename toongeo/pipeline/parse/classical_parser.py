"""A face parser without a network.

Constants were chosen by eye on the seven examples and 15 caricatures.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Mask
from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_image import check_image
from toongeo.io.landmark_array import landmark_array
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.parse.colour_share import colour_codes, colour_share
from toongeo.pipeline.parse.completed_landmarks import completed_landmarks
from toongeo.pipeline.parse.doubtful_hair import doubtful_hair
from toongeo.pipeline.parse.face_zones import FaceZones, face_zones
from toongeo.pipeline.parse.find_hair import find_hair
from toongeo.pipeline.parse.head_and_skin import HeadAndSkin, border_confidence, head_and_skin
from toongeo.pipeline.parse.lids.find_lids import Lids, find_lids
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.parse.working_view import WorkingView, working_view
from toongeo.protocols import FaceLabel, FaceParse, FittedFace, HairFinder

__all__ = ["ClassicalParser"]

_EARS = 0.06  # of the head's size: so far beyond the fitted ears there are ears
_HAIR_SHARE = 0.01  # of the hair's pixels: so common is a colour of hair
_LINES = 0.02  # of the head's size: the breadth of the outlines around it
_FINE = 4  # subpixels a side


@dataclass(frozen=True)
class ClassicalParser:
    """Labels the parts of a face by colour, outlines, landmarks and a fitted face; no network.

    The head is cut from the background, and skin from hair and from what is worn, by GrabCut, seeded by the fitted
    head and a model of the skin's colour that is learned from the face itself. The eyes are found in the picture
    at its own resolution: shifted and scaled copies of the landmarks' contour are weighed by what is inside them and
    across their line. Brows are what differs from skin along their landmarks; nose and lips are where
    the landmarks are. Hair and hats are where ``hair_finder`` finds them; a mask that is not trusted loses what the
    other cuts take for skin or background; if it is empty, hair is what of the head above the chin is not skin. Dark
    outlines belong to neither side: they are ``OTHER``, and so are glasses and beards; clothes are background.

    Parameters
    ----------
    head_px : float
        Size of the head, px, at which all but the eyes is cut; larger is finer and slower.
    hair_finder : HairFinder
        `find_hair` unless another is given; what it finds is kept in ``parse.hair``.

    Raises
    ------
    ValueError
        If ``head_px`` is below 64.

    Examples
    --------
    >>> from toongeo import read_image, read_landmarks
    >>> from toongeo.model import data_path
    >>> img = read_image(data_path("examples/portraits/bad_guy.png"))
    >>> parse = ClassicalParser()(img, read_landmarks(data_path("examples/portraits/bad_guy.pts")))
    >>> FaceLabel.HAIR in parse.labels
    True
    """

    head_px: float = 200.0
    hair_finder: HairFinder = find_hair

    def __post_init__(self) -> None:
        if not self.head_px >= 64:
            raise ValueError(f"head_px: expected at least 64, got {self.head_px}")

    def __call__(self, img: NDArray[np.uint8], landmarks: ArrayLike, fit: FittedFace | None = None) -> FaceParse:
        """Labels of the picture (H, W, 3) uint8 with landmarks (68, 2) px, NaN where missing, and its fitted face."""
        check_image(img)
        given = landmark_array(landmarks)
        face = fit if fit is not None else fit_3dmm(None, given)
        points = completed_landmarks(given, face)
        on_head = face.camera.project(face.vertices[face.region("skin")])
        view = working_view(img, np.vstack([on_head, points]), self.head_px)
        zones = face_zones(view, points, face)
        with one_thread():
            cut = head_and_skin(view, zones)
            confidence = border_confidence(view, cut)
        hair = self.hair_finder(img, given, face)
        mask = _in_view(view, hair.mask)
        mask = mask if hair.trusted else doubtful_hair(view, zones, cut, mask)
        labels = _labels(view, zones, cut, mask)
        labels, confidence = _full_size(view, labels, confidence, img.shape[:2])
        if hair.hat is not None:
            labels[hair.hat] = FaceLabel.HAT
        for side, label in (("right", FaceLabel.EYE_RIGHT), ("left", FaceLabel.EYE_LEFT)):
            _paint_eye(labels, confidence, find_lids(img, points, side), label)
        return FaceParse(labels, confidence, hair)


def _in_view(view: WorkingView, mask: Mask) -> Mask:
    height, width = view.pixels.shape[:2]
    part = mask[view.window()].astype(np.float32)
    return np.asarray(cv2.resize(part, (width, height), interpolation=cv2.INTER_AREA) > 0.5)


def _labels(view: WorkingView, zones: FaceZones, cut: HeadAndSkin, hair: Mask) -> NDArray[np.uint8]:
    """Labels (h, w) of the working view; later ones cover earlier ones."""
    labels = np.full(view.pixels.shape[:2], FaceLabel.BACKGROUND, np.uint8)
    non_skin = cut.head & ~cut.skin
    neck = (zones.below_chin | (zones.neck & zones.lower_face)) & ~zones.hull
    ears = grown(zones.ears, _EARS * view.head) & ~zones.hull & ~neck
    labels[non_skin & zones.hull] = FaceLabel.OTHER
    labels[cut.skin] = FaceLabel.SKIN
    labels[cut.skin & neck] = FaceLabel.NECK
    labels[cut.skin & ears] = FaceLabel.EARS
    labels[cut.skin & zones.nose] = FaceLabel.NOSE
    labels[hair] = FaceLabel.HAIR
    thick = hair & ~cut.outline
    strands = hair & (colour_share(colour_codes(view.pixels), thick) > _HAIR_SHARE)
    beside = grown(labels != FaceLabel.BACKGROUND, _LINES * view.head)  # not the lines of clothes
    labels[cut.outline & cut.head & beside & ~strands] = FaceLabel.OTHER
    for brow, label in ((zones.brow_right, FaceLabel.BROW_RIGHT), (zones.brow_left, FaceLabel.BROW_LEFT)):
        labels[brow & (cut.non_skin > 0.5)] = label
    labels[zones.upper_lip] = FaceLabel.UPPER_LIP
    labels[zones.lower_lip] = FaceLabel.LOWER_LIP
    labels[zones.inner_mouth] = FaceLabel.INNER_MOUTH
    return labels


def _full_size(
    view: WorkingView, labels: NDArray[np.uint8], confidence: NDArray[np.float32], shape: tuple[int, int]
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Labels and confidence of the whole picture; each pixel takes the label that is largest once interpolated."""
    width, height = (int(n) for n in view.size)
    best = np.zeros((height, width), np.float32)
    winner = np.zeros((height, width), np.uint8)
    for label in np.unique(labels):
        share = cv2.resize((labels == label).astype(np.float32), (width, height), interpolation=cv2.INTER_LINEAR)
        better = share > best
        best[better], winner[better] = share[better], label
    full = np.full(shape, FaceLabel.BACKGROUND, np.uint8)
    trust = np.ones(shape, np.float32)
    full[view.window()] = winner
    soft = cv2.resize(confidence, (width, height), interpolation=cv2.INTER_LINEAR)
    trust[view.window()] = np.clip(soft * (2 * best - 1), 0, 1)
    return full, trust


def _paint_eye(labels: NDArray[np.uint8], confidence: NDArray[np.float32], lids: Lids, label: FaceLabel) -> None:
    """Put an eye into labels and confidence, in place: the pixels that are half covered or more."""
    height, width = labels.shape
    x0, y0 = np.clip(np.floor(lids.contour.min(axis=0)).astype(int) - 1, 0, [width - 1, height - 1])
    x1, y1 = np.clip(np.ceil(lids.contour.max(axis=0)).astype(int) + 2, [x0 + 1, y0 + 1], [width, height])
    inner = (lids.contour - [x0, y0] + 0.5) * _FINE - 0.5
    fine = filled(((y1 - y0) * _FINE, (x1 - x0) * _FINE), inner).astype(np.float32)
    covered = cv2.resize(fine, (int(x1 - x0), int(y1 - y0)), interpolation=cv2.INTER_AREA)
    eye = covered >= 0.5
    labels[y0:y1, x0:x1][eye] = label
    confidence[y0:y1, x0:x1][eye] = lids.confidence
