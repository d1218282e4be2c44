"""One picture that shows what became of a face."""

from collections.abc import Sequence

import cv2
import numpy as np

from toongeo.avatar.avatar import Avatar

__all__ = ["contact_sheet"]

_EXPRESSIONS = (
    (
        "smile",
        {"mouthSmileLeft": 1.0, "mouthSmileRight": 1.0, "cheekSquintLeft": 0.5, "cheekSquintRight": 0.5},
    ),
    ("jaw open", {"jawOpen": 0.8}),
    ("eyes closed", {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}),
    (
        "brows up",
        {n: 1.0 for n in ("browInnerUpLeft", "browInnerUpRight", "browOuterUpLeft", "browOuterUpRight")},
    ),
    ("pucker", {"mouthPucker": 1.0}),
    ("looks aside", {"eyeLookOutLeft": 0.9, "eyeLookInRight": 0.9, "mouthLeft": 0.6}),
)
_VIEWS = (("front", 0.0), ("three-quarter", 40.0), ("side", 85.0))
_INK, _PAPER = (40, 40, 40), 255


def contact_sheet(
    avatar: Avatar, img: np.ndarray, landmarks: np.ndarray, *, tile: int = 320, lines: Sequence[str] | None = None
) -> np.ndarray:
    """Input, clay views at rest, textured views as drawn, six expressions, and the report, on one sheet.

    Parameters
    ----------
    avatar : Avatar
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    tile : int
        Side of one picture of the sheet, px.
    lines : sequence of str, optional
        What is told in words; ``avatar.report.lines()`` if None.

    Returns
    -------
    (3 * tile, 5 * tile, 3) uint8 RGB
    """
    views = [
        [_titled(avatar.render(pose, tile, yaw, textured=textured), f"{look}, {name}") for name, yaw in _VIEWS]
        for look, pose, textured in (("clay", None, False), ("as drawn", avatar.pose, True))
    ]
    posed = [_titled(avatar.render(weights, size=tile), name) for name, weights in _EXPRESSIONS]
    input_tile = _titled(_input(img, landmarks, tile), "input")
    overlay = _titled(_overlay(avatar, img, landmarks, tile), "as drawn, over input")
    rows = [
        [input_tile, *views[0], _words(avatar.report.lines() if lines is None else lines, tile)],
        [overlay, *views[1], posed[0]],
        posed[1:],
    ]
    return np.vstack([np.hstack(row) for row in rows])


def _frame(landmarks: np.ndarray, tile: int) -> tuple[np.ndarray, float]:
    """Corner and scale of a square around the face."""
    low, high = np.nanmin(landmarks, 0), np.nanmax(landmarks, 0)
    side = 1.7 * (high - low).max()
    return (low + high) / 2 - side / 2 - [0, 0.12 * side], tile / side


def _window(img: np.ndarray, corner: np.ndarray, scale: float, tile: int) -> np.ndarray:
    method = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    resized = cv2.resize(img, None, fx=scale, fy=scale, interpolation=method)
    shift = np.array([[1, 0, -corner[0] * scale], [0, 1, -corner[1] * scale]])
    return cv2.warpAffine(resized, shift, (tile, tile), borderValue=(_PAPER,) * 3)


def _input(img: np.ndarray, landmarks: np.ndarray, tile: int) -> np.ndarray:
    corner, scale = _frame(landmarks, tile)
    view = _window(img, corner, scale, tile)
    for x, y in (landmarks[np.isfinite(landmarks).all(1)] - corner) * scale:
        cv2.circle(view, (round(x * 16), round(y * 16)), 28, (220, 30, 30), -1, cv2.LINE_AA, shift=4)
    return view


def _overlay(avatar: Avatar, img: np.ndarray, landmarks: np.ndarray, tile: int) -> np.ndarray:
    corner, scale = _frame(landmarks, tile)
    camera = avatar.face.camera.cropped(corner, scale)
    face = avatar.render(avatar.pose, tile, camera=camera, textured=False).astype(float)
    return np.rint(0.45 * _window(img, corner, scale, tile) + 0.55 * face).astype(np.uint8)


def _titled(view: np.ndarray, title: str) -> np.ndarray:
    view = np.ascontiguousarray(view)
    cv2.putText(view, title, (8, 18), cv2.FONT_HERSHEY_SIMPLEX, 0.45, _INK, 1, cv2.LINE_AA)
    return view


def _words(lines: Sequence[str], tile: int) -> np.ndarray:
    view = np.full((tile, tile, 3), _PAPER, np.uint8)
    for i, line in enumerate(lines):
        at = (round(0.025 * tile), round((0.06 + 0.92 * i / len(lines)) * tile))
        cv2.putText(view, line, at, cv2.FONT_HERSHEY_SIMPLEX, 0.0012 * tile, _INK, 1, cv2.LINE_AA)
    return view
