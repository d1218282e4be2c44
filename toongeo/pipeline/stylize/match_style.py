"""A picture in the colours, tones and lines of another."""

import cv2
import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Bytes, Floats, Mask, Singles
from toongeo.colour.cielab import cielab
from toongeo.io import check_image
from toongeo.pipeline.fit import fit_3dmm
from toongeo.pipeline.landmarks.given_or_found import given_or_found
from toongeo.pipeline.parse.completed_landmarks import completed_landmarks
from toongeo.pipeline.parse.parse_face import parse_face
from toongeo.pipeline.stylize.appearance.line_weight import drawn_lines, lines_as_broad, without_lines
from toongeo.pipeline.stylize.appearance.pixels import blurred, rgb_of
from toongeo.pipeline.stylize.appearance.reference_tones import in_tones, tones_of
from toongeo.pipeline.stylize.face_frame import face_frame
from toongeo.protocols import FaceLabel

__all__ = ["match_style"]

# Parts of a face whose colours go together; what is none of them keeps to the rest.
_PARTS = (
    (FaceLabel.SKIN, FaceLabel.NOSE, FaceLabel.EARS, FaceLabel.NECK),
    (FaceLabel.UPPER_LIP, FaceLabel.LOWER_LIP),
    (FaceLabel.HAIR, FaceLabel.BROW_LEFT, FaceLabel.BROW_RIGHT),
)
_ELSE, _KEPT = len(_PARTS), len(_PARTS) + 1  # all else, and eyes and teeth, which keep their colours
_FEW = 50  # pixels; a smaller part of either picture has no statistics of its own
_LEAST = 1.0  # Lab, squared; flat colours of drawings have no spread to divide by
_SAME_LINES = 0.002  # face sizes: lines are as broad already
_SOFT = 0.004  # of the picture's diagonal: borders between parts


def match_style(
    img: np.ndarray,
    reference: np.ndarray,
    landmarks: ArrayLike | None = None,
    reference_landmarks: ArrayLike | None = None,
) -> Bytes:
    """The picture with the colours, tones and lines of a reference drawing, part by part: skin, lips, hair, all else.

    A part that the reference has in a few flat tones gets as many, in their colours. The colours of one that is shaded
    smoothly are moved by the linear map that takes one Gaussian to another with the least effort (the
    Monge-Kantorovich map in CIELAB), so its mean and covariance become those of the reference. Lines become as broad,
    in face sizes, and as dark as the reference's; a picture without any gets them along its edges.

    Parameters
    ----------
    img, reference : (H, W, 3) uint8 RGB
        A drawing of :func:`toongeo.stylize`, say, and one whose colours it shall have; each shows a face.
    landmarks, reference_landmarks : (68, 2) array_like, px, optional
        iBUG-68; found if None.

    Returns
    -------
    (H, W, 3) uint8 RGB

    Raises
    ------
    ValueError
        If a picture is not (H, W, 3) uint8, or landmarks cannot belong to it or are not found.

    References
    ----------
    F. Pitie, A. Kokaram: The linear Monge-Kantorovitch linear colour mapping. CVMP 2007.

    Examples
    --------
    >>> from toongeo import read_image, read_landmarks
    >>> from toongeo.model import data_path
    >>> img = read_image(data_path("examples/portraits/bad_guy.png"))
    >>> points = read_landmarks(data_path("examples/portraits/bad_guy.pts"))
    >>> same = match_style(img, img, points, points)
    >>> bool(np.abs(same.astype(int) - img).mean() < 0.5)  # in its own style it stays
    True
    """
    check_image(img)
    check_image(reference, "reference")
    (own, size), (others, size_there) = _parts(img, landmarks), _parts(reference, reference_landmarks)
    lab, goal = cielab(img), cielab(reference)
    lines, wanted = drawn_lines(lab, size), drawn_lines(goal, size_there)
    same = abs(lines.width - wanted.width) < _SAME_LINES
    bare = lab if same else without_lines(lab, lines, size)
    result, total = np.zeros_like(lab), np.zeros(lab.shape[:2], np.float32)
    for k in range(_KEPT + 1):
        mask, there = own == k, others == k
        if not mask.any():
            continue
        enough = mask.sum() >= _FEW and there.sum() >= _FEW and k != _KEPT
        target, limits = goal[there & ~wanted.cover], goal[there]
        matched = _matched(bare, mask & ~lines.cover, target, limits, k < _ELSE) if enough else lab
        weight = blurred(mask.astype(np.float32), _SOFT * float(np.hypot(*lab.shape[:2])))
        result += weight[..., None] * matched
        total += weight
    result = np.asarray(result / np.maximum(total, 1e-6)[..., None], np.float32)
    retoned = _is_retoned(lab[(own == 0) & ~lines.cover], goal[(others == 0) & ~wanted.cover])
    if not same or (lines.width > 0 and retoned):
        cover = lines_as_broad(lab, lines, wanted.width, size)[..., None]
        result += cover * (wanted.colour.astype(np.float32) - result)
    return np.rint(rgb_of(result)).astype(np.uint8)


def _parts(img: Bytes, landmarks: ArrayLike | None) -> tuple[np.ndarray, float]:
    """Which of the parts each pixel (h, w) belongs to, the last is all else; and the size of the face, px."""
    points = np.asarray(given_or_found(img, landmarks), np.float64)
    fit = fit_3dmm(img, points)
    labels = parse_face(img, completed_landmarks(points, fit), fit).labels
    result = np.full(labels.shape, _ELSE)
    result[np.isin(labels, (FaceLabel.EYE_LEFT, FaceLabel.EYE_RIGHT, FaceLabel.INNER_MOUTH))] = _KEPT
    for k, members in enumerate(_PARTS):
        result[np.isin(labels, members)] = k
    return result, face_frame(completed_landmarks(points, fit)).size


def _matched(lab: Singles, mask: Mask, target: Singles, limits: Singles, on_head: bool) -> Singles:
    """A picture (h, w, 3) in the colours of a sample (k, 3), if a part of it (h, w) is matched to that, and within
    those of the sample with its lines (l, 3).

    A blank sheet around the head says nothing of what should be there.
    """
    source = lab[mask] if mask.any() else lab.reshape(-1, 3)
    tones = tones_of(target) if len(target) else None
    if tones is not None and len(tones.colours) == 1 and not on_head:
        return lab
    if tones is None or not _is_retoned(source, target):
        return _mapped(lab, source, target if len(target) else source, limits)
    return in_tones(np.asarray(cv2.medianBlur(lab, 5)), source[:, 0].astype(np.float64), tones)


def _is_retoned(source: np.ndarray, target: np.ndarray) -> bool:
    """Whether a part with colours (k, 3) is painted in the tones of another, which has another number of them."""
    own, tones = (tones_of(part) if len(part) else None for part in (source, target))
    return tones is not None and (own is None or len(own.colours) != len(tones.colours))


def _mapped(lab: Singles, source: np.ndarray, target: np.ndarray, limits: np.ndarray) -> Singles:
    """Colours (h, w, 3) after the map that takes the Gaussian of one sample (k, 3) to that of another, within the
    limits of a third."""
    spread = _root(np.cov(source.T) + _LEAST * np.eye(3))
    inverse = np.linalg.inv(spread)
    turn = inverse @ _root(spread @ (np.cov(target.T) + _LEAST * np.eye(3)) @ spread) @ inverse
    moved = (lab - source.mean(axis=0)) @ turn.T + target.mean(axis=0)
    # teeth among lips, say: what is far off its part must not become a colour that the other drawing has nowhere
    return np.asarray(np.clip(moved, limits.min(axis=0), limits.max(axis=0)), np.float32)


def _root(matrix: Floats) -> Floats:
    """Square root of a symmetric positive matrix."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0)) @ vectors.T)
