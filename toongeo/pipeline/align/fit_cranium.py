"""A skull that is no taller than the head in the picture.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import dataclasses

import numpy as np

from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.protocols import FaceLabel, FaceParse

__all__ = ["fit_cranium"]

_LEAST = 0.7  # of the height that suits the breadth of the face: no parse is believed about a lower skull
_MIDDLE = 0.5  # of the skull's breadth: here the top of the head is looked for
_COLUMNS = 17  # that this part of the picture is cut into
_TOP = 60  # percentile of their tops: locks and tufts stand above the head
_BROW = 0.2  # of the skull's height: over this distance above the brows skin passes into the change
_ROUNDS = 3  # a head that nods shows another point at its top after each


def fit_cranium(face: AlignedFace, parse: FaceParse) -> AlignedFace:
    """The face with its skull lowered to the top of hair, hat or skin in the picture.

    What a drawing stretches between brows and chin, the alignment carries on above the brows, where no landmark is.
    Only where the skull rises above the head that is drawn does it give way, alike on both sides, and the more the
    higher it is above the brows, which stay. In depth nothing changes.

    Parameters
    ----------
    face : AlignedFace
    parse : FaceParse
        Of the picture; what is not its background is the head.

    Returns
    -------
    AlignedFace
        The same object if the skull is not too high.

    Raises
    ------
    ValueError
        If the parse shows no head.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> fit = tg.fit_3dmm(None, landmarks)
    >>> face = tg.align_face(fit, landmarks)
    >>> lower = tg.fit_cranium(face, tg.parse_face(img, landmarks, fit))
    >>> bool(lower.vertices[:, 1].max() <= face.vertices[:, 1].max() + 1e-9)
    True
    """
    head = parse.labels != FaceLabel.BACKGROUND
    if not head.any():
        raise ValueError("parse: expected pixels that are not background, got none")
    skin = face.region("skin")
    origin = face.project(np.zeros((1, 3)))[0]
    up = face.project(np.array([[0.0, 1.0, 0.0]]))[0] - origin
    scale = float(np.linalg.norm(up))
    up /= scale
    brows = face.landmark_vertices[[*PARTS["brow_left"], *PARTS["brow_right"]]]
    low, high = face.vertices[brows, 1].max(), face.vertices[skin, 1].max()
    height = np.clip((face.vertices[:, 1] - low) / (high - low), 0, None)
    line = float((face.project(face.vertices[brows]) @ up).max())
    drawn = _drawn_top(face, head, up, line) - line
    drawn = max(drawn, _LEAST * scale * _suiting_height(face))
    left, V = 1.0, face.vertices
    for _ in range(_ROUNDS):
        top = float((face.project(V[skin]) @ up).max()) - line
        if top <= drawn and left == 1.0:
            return face
        left = min(1.0, left * drawn / top)
        V = face.vertices.copy()
        V[:, 1] += (high - low) * (left - 1) * height * (1 - np.exp(-height / _BROW))
    return dataclasses.replace(face, vertices=V)


def _drawn_top(face: AlignedFace, head: np.ndarray, up: np.ndarray, line: float) -> float:
    """Where the head of the picture ends, px upwards; infinity where the picture's edge cuts it off."""
    side = np.array([-up[1], up[0]])
    skull = face.vertices[face.region("scalp") if face.model.has("scalp") else face.region("skin")]
    px = face.project(skull)
    across = (px @ side)[px @ up > line]
    if not len(across):
        return np.inf
    middle, half = (across.min() + across.max()) / 2, max(_MIDDLE * np.ptp(across) / 2, 1.0)
    rows, columns = np.nonzero(head)
    at = np.column_stack([columns, rows])
    beside = (at @ side - middle) / half
    at, beside = at[np.abs(beside) < 1], beside[np.abs(beside) < 1]
    bins = np.floor((beside + 1) / 2 * _COLUMNS).astype(int)
    tops = np.full(_COLUMNS, -np.inf)
    np.maximum.at(tops, bins, at @ up)
    if not np.isfinite(tops).any():
        return np.inf
    top = float(np.percentile(tops[np.isfinite(tops)], _TOP))
    corner = at[np.abs(at @ up - top).argmin()]
    return np.inf if (corner < 2).any() or (corner > np.array(head.shape[::-1]) - 3).any() else top


def _suiting_height(face: AlignedFace) -> float:
    """Height of a skull above its brows, mm, that suits the breadth of this face as the mean head's does."""
    model = face.model
    ends = model.landmarks[[PARTS["jaw"][0], PARTS["jaw"][-1]]]
    brows = model.landmarks[[*PARTS["brow_left"], *PARTS["brow_right"]]]
    breadth = [float(np.linalg.norm(np.subtract(*V[ends]))) for V in (face.vertices, model.mean)]
    above = model.mean[model.region("skin"), 1].max() - model.mean[brows, 1].max()
    return float(above * breadth[0] / breadth[1])
