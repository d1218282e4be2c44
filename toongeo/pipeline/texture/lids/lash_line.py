"""The line along a lid's edge, as it is drawn.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Reals
from toongeo.colour.cielab import cielab
from toongeo.model import MorphableModel, atlas_coordinates
from toongeo.model.anatomy.lid_rings import lid_rings
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.render import sample_image, uv_to_px

__all__ = ["LashLine", "drawn_lashes", "spike_count", "stroked"]

_FROM, _TO, _SAMPLES = -0.04, 0.09, 14  # where the line is looked for, in widths of the eye outwards of the edge
_SPIKES = 0.1  # widths of the eye off its edge where spikes are counted
_BLUR = 0.01  # widths of the eye
_SMOOTH = 7  # columns of which each takes the median
_FAINT, _CLEAR = 6.0, 20.0  # lightness below the skin's: from the first a line is drawn, from the second surely
_SHADOW, _LIGHTEST = 0.62, 0.72  # of the skin: the edge's own shadow where no line is drawn; and the lightest line
_VEIL = 0.55  # cover of that shadow; of a line it is whole
_WIDTHS = (0.03, 0.08)  # widths of the eye: least and largest thickness of the line
_FINE = 4  # subtexels a side
_SOFT = 0.8  # texels: s.d. of the line's edge


@dataclass(frozen=True, eq=False)
class LashLine:
    """A line along the edge of an upper lid, in columns from corner to corner.

    Attributes
    ----------
    colours : (k, 3) float, sRGB, 0-255
    cover : (k,) float in [0, 1]
    width : float
        Thickness as a share of the eye's width.
    """

    colours: Reals
    cover: Reals
    width: float


def drawn_lashes(img: np.ndarray, face: AlignedFace, side: str, skin: np.ndarray) -> LashLine:
    """The line that a picture shows along the edge of an upper lid, or the shadow of the edge where it shows none.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
        As drawn.
    side : {"left", "right"}
    skin : (n, 3) float, sRGB, 0-255
        Of the closed lid.
    """
    rings = lid_rings(face.model, side)
    columns = rings.upper.shape[1]
    edge, across, width = _edge(face, side)
    steps = np.linspace(_FROM, _TO, _SAMPLES) * width
    places = edge + steps[:, None, None] * across
    blurred, shift = _around(img, places.reshape(-1, 2), max(0.6, _BLUR * width))
    samples = sample_image(blurred, (places - shift).reshape(-1, 2)).reshape(_SAMPLES, columns, 3)
    lightness = cielab(np.clip(np.rint(samples), 0, 255).astype(np.uint8))[..., 0]
    line = samples[lightness.argmin(0), np.arange(columns)].astype(float)
    half = _SMOOTH // 2
    line = np.array([np.median(line[max(0, k - half) : k + half + 1], axis=0) for k in range(columns)])
    own = skin[rings.upper[2]]
    depth = _lightness(own) - _lightness(line)
    drawn = np.clip((depth - _FAINT) / (_CLEAR - _FAINT), 0, 1)
    colours = np.minimum(np.where((drawn > 0.3)[:, None], line, _SHADOW * own), _LIGHTEST * own)
    ends = np.minimum(np.arange(columns), np.arange(columns)[::-1])
    cover = (_VEIL + (1 - _VEIL) * drawn) * np.minimum(1, ends / 2 + 0.2)
    dark = (lightness < _lightness(own) - 0.5 * depth) & (drawn > 0.3)
    thick = dark.sum(0)[dark.any(0)] * (_TO - _FROM) / _SAMPLES
    return LashLine(colours, cover, float(np.clip(np.median(thick) if len(thick) else 0, *_WIDTHS)))


def spike_count(img: np.ndarray, face: AlignedFace, side: str, skin: np.ndarray) -> int:
    """How many dark strokes stand along an upper lid of a picture, apart from each other; arguments as above."""
    edge, across, width = _edge(face, side)
    at, fine = np.arange(len(edge)), np.linspace(0, len(edge) - 1, _FINE * _FINE * len(edge))
    own = float(np.median(_lightness(skin[lid_rings(face.model, side).upper[2]])))
    row = np.column_stack([np.interp(fine, at, axis) for axis in (edge + _SPIKES * width * across).T])
    blurred, shift = _around(img, row, 0.6)
    dark = _lightness(sample_image(blurred, row - shift)) < own - _CLEAR
    return int((dark[1:] & ~dark[:-1]).sum())


def stroked(texture: np.ndarray, model: MorphableModel, V: np.ndarray, side: str, line: LashLine) -> np.ndarray:
    """A texture (size, size, 3) float with a line along the edge of an upper lid of the face V (n, 3), mm."""
    rings, size = lid_rings(model, side), len(texture)
    atlas = atlas_coordinates(model)
    uv = np.zeros((len(V), 2))
    uv[model.faces] = atlas.uv[atlas.uv_faces]
    path = uv_to_px(0.5 * (uv[rings.upper[1]] + uv[rings.upper[2]]), size * _FINE, size * _FINE)
    length = np.linalg.norm(np.diff(V[rings.upper[2]], axis=0), axis=1).sum()
    subtexels = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
    width = np.linalg.norm(V[rings.upper[0, 0]] - V[rings.upper[0, -1]])
    thick = max(1, round(line.width * width * subtexels / length))
    margin = 8 + thick // _FINE
    low = np.maximum(np.floor(path.min(0) / _FINE).astype(int) - margin, 0)
    high = np.minimum(np.ceil(path.max(0) / _FINE).astype(int) + margin, size)
    canvas = np.zeros((*((high - low) * _FINE)[::-1], 4), np.float32)
    points = np.rint(path - low * _FINE).astype(int).tolist()
    for k in range(len(points) - 1):
        cover = 0.5 * (line.cover[k] + line.cover[k + 1])
        value = (*(0.5 * cover * (line.colours[k] + line.colours[k + 1])), cover)
        cv2.line(canvas, points[k], points[k + 1], [float(part) for part in value], thick)
    small = cv2.resize(canvas, None, fx=1 / _FINE, fy=1 / _FINE, interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), _SOFT)
    painted = texture.copy()
    box = painted[low[1] : high[1], low[0] : high[0]]
    box *= 1 - small[..., 3:]
    box += small[..., :3]
    return painted


def _edge(face: AlignedFace, side: str) -> tuple[np.ndarray, np.ndarray, float]:
    """The edge (k, 2) px of an upper lid in the picture, unit vectors out of the eye, and the eye's width."""
    rings = lid_rings(face.model, side)
    edge = face.project(face.vertices[rings.upper[1]])
    along = np.gradient(edge, axis=0)
    across = np.column_stack([-along[:, 1], along[:, 0]])
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    middle = face.project(face.vertices[rings.lower[1]]).mean(0)
    across *= np.sign(((edge - middle) * across).sum(1, keepdims=True))
    return edge, across, float(np.linalg.norm(edge[-1] - edge[0]))


def _around(img: np.ndarray, px: np.ndarray, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """The blurred part of a picture that holds pixels (k, 2), and its corner."""
    bounds = np.array(img.shape[1::-1])
    margin = np.ceil(3 * sigma) + 1
    low = np.clip(np.floor(px.min(0) - margin), 0, bounds - 1).astype(int)
    high = np.clip(np.ceil(px.max(0) + margin) + 1, low + 1, bounds).astype(int)
    return cv2.GaussianBlur(img[low[1] : high[1], low[0] : high[0]], (0, 0), sigma), low


def _lightness(colours: np.ndarray) -> np.ndarray:
    return cielab(np.clip(np.rint(colours), 0, 255).astype(np.uint8)[None])[0, :, 0]
