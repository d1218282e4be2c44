"""A picture redrawn with its face moved.

Constants were judged on the seven examples (``benchmarks/editing.py``).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from toongeo.editing.texture.picture_mesh import EYE, MOUTH, SKIN, PictureMesh
from toongeo.editing.texture.spread_field import spread_field
from toongeo.protocols import FaceLabel, FaceParse
from toongeo.render import rasterize
from toongeo.render.interpolate import blend_corners

__all__ = ["PictureWarp", "Stroke", "picture_warp", "rim_cover"]

_REACH = 0.45  # of the face's width: farther from the landmarks' box nothing is ever touched
_FALLOFF = 2.2  # of the greatest motion: over this distance the neighbourhood comes to rest, without folding
_LEAST_FALLOFF = 0.12  # of the face's width
_CALM = 0.05  # of the face's width: over this distance the motion dies down towards hair and ears
_EYE_LINE, _MOUTH_LINE = 0.05, 0.015  # of the width of eye and mouth: reach of what is drawn along their rims
_BESIDE = 2.0  # lines: so near to what is seen of an eye, the rest looks alike
_LEAST_LINE = 1.5  # px
_JUMP = 1.5  # px between neighbours: motion that differs more has an edge in between, to be softened
_NOTHING = 255  # label where there is no face
_STILL = 1 / 64  # px; less motion is none


@dataclass(frozen=True, eq=False)
class Stroke:
    """A line along vertices: path (k,), colour (3,) 0-255, width as a share of the path's chord, strength in [0, 1]."""

    path: np.ndarray
    colour: np.ndarray
    width: float
    strength: float


@dataclass(frozen=True, eq=False)
class PictureWarp:
    """What is the same for all expressions of one picture.

    Attributes
    ----------
    mesh : PictureMesh
    picture : (h, w, 3) float32
        What of the picture an expression may touch.
    corner : (2,) int
        Its pixel (x, y) at the upper left.
    freedom : (h, w) float32 in [0, 1]
        How far a pixel may move: 0 in hair and ears.
    interior : (h, w) float32
        1 between lids and lips, away from the lines drawn along them.
    width : float
        Of the face, px.
    lines : (2,) float
        Reach, px, of what is drawn along the rims of mouth and eyes.
    """

    mesh: PictureMesh
    picture: np.ndarray
    corner: np.ndarray
    freedom: np.ndarray
    interior: np.ndarray
    width: float
    lines: tuple[float, float]

    @property
    def box(self) -> tuple[slice, slice]:
        """Rows and columns of the picture that may change."""
        rows, columns = self.freedom.shape
        x, y = self.corner
        return slice(y, y + rows), slice(x, x + columns)

    def redrawn(self, vertices: np.ndarray, texture: np.ndarray, change: np.ndarray, renewed: np.ndarray) -> np.ndarray:
        """Colours (h, w, 3), 0-255, within :attr:`box`, with the mesh moved to ``vertices`` (n + e, 3).

        Parameters
        ----------
        vertices : (n + e, 3) float, mm
        texture : (S, S, 3) float32, 0-255
            What is seen where the picture shows nothing.
        change : (S, S, 3) float32
            What is added to the picture elsewhere.
        renewed : (n + e,) float in [0, 1]
            How far the texture takes the place of the picture.
        """
        px = self.mesh.camera.project(vertices) - self.corner
        ids, values = self._drawn(px, self.mesh.camera.depth(vertices), renewed)
        label = np.where(ids >= 0, self.mesh.labels[ids], _NOTHING)
        skin, inner = label == SKIN, (label == EYE) | (label == MOUTH)
        motion, share = values[..., :2], values[..., 2:3]
        carried = spread_field(motion, skin)
        carried *= (self._falloff(skin | inner, carried) * self.freedom)[..., None]
        carried *= (_largest(carried) >= _STILL)[..., None]
        uv = _texels(values[..., 3:], texture)
        outer = self._sampled(carried)
        rows = _bounds(ids >= 0)
        free = self.freedom[rows][..., None] * skin[rows][..., None]
        painted, added = (_remap(part, uv[rows], cv2.INTER_LINEAR) for part in (texture, change))
        blended = outer[rows] + added * share[rows]
        blended += (1 - share[rows]) * (painted - blended)
        outer[rows] += free * (blended - outer[rows])
        if not inner.any():
            return _softened(outer, _jumps(carried))
        rows = _bounds(inner, margin=2)
        motion = np.where(np.abs(motion) < _STILL, 0, motion)[rows]
        confidence = share[rows] * self._sampled(motion, self.interior, rows)[..., None]
        within = np.where(inner[rows][..., None], _remap(texture, uv[rows], cv2.INTER_LINEAR), 0)
        drawn = self._sampled(motion, self.picture, rows)
        within = self._eyes_completed(within, drawn, (label == EYE)[rows], confidence[..., 0])
        within += confidence * (drawn - within)
        # Colours of the inside reach a little under the rim, so that its edge can be soft.
        within = spread_field(within, inner[rows])
        over = rim_cover(label, self.lines)[rows][..., None]
        outer[rows] = over * outer[rows] + (1 - over) * within
        sharp = _jumps(carried)
        sharp[rows] |= _edges(np.where(ids >= 0, self.mesh.parts[ids], 0)[rows], (label == MOUTH)[rows])
        return _softened(outer, sharp)

    def stroked(self, image: np.ndarray, vertices: np.ndarray, strokes: Sequence[Stroke]) -> np.ndarray:
        """What :meth:`redrawn` gave, with lines drawn over it; they end in points."""
        for stroke in strokes:
            px = self.mesh.camera.project(vertices[stroke.path]) - self.corner
            thick = stroke.width * float(np.linalg.norm(px[-1] - px[0]))
            half = 0.5 * thick * np.sqrt(np.maximum(np.sin(np.linspace(0, np.pi, len(px))), 0.1))[:, None]
            along = np.gradient(px, axis=0)
            across = along[:, ::-1] * [-1, 1] / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
            outline = np.vstack([px + half * across, (px - half * across)[::-1]])
            cover = np.zeros(self.freedom.shape, np.uint8)
            cv2.fillPoly(cover, [np.rint(outline * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
            image = image + (stroke.strength / 255 * cover * self.freedom)[..., None] * (stroke.colour - image)
        return image

    def _eyes_completed(
        self, painted: np.ndarray, drawn: np.ndarray, eye: np.ndarray, confidence: np.ndarray
    ) -> np.ndarray:
        """Colours of eyes where they come into view: those of what is seen beside it, farther off the texture's."""
        seen = eye & (confidence > 0.99)
        if not seen.any():
            return painted
        away = cv2.distanceTransform((~seen).astype(np.uint8), cv2.DIST_L2, 5)
        near = np.clip(2 - away / (_BESIDE * self.lines[1]), 0, 1) * eye
        return np.asarray(painted + near[..., None] * (spread_field(drawn, seen) - painted))

    def _drawn(self, px: np.ndarray, depth: np.ndarray, renewed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Triangle (h, w) at every pixel, -1 where none, and (h, w, 5): motion back to the picture, share, uv."""
        mesh, bounds = self.mesh, np.array(self.freedom.shape[::-1])
        used = px[mesh.faces.ravel()]
        low = np.clip(np.floor(used.min(0)), 0, bounds - 1).astype(int)
        width, height = np.clip(np.ceil(used.max(0)) + 1, low + 1, bounds).astype(int) - low
        fragments = rasterize(np.column_stack([px - low, depth]), mesh.faces, height, width)
        covered = np.flatnonzero(fragments.face_ids.ravel() >= 0)
        ids = fragments.face_ids.ravel()[covered]
        back = mesh.px - self.corner - px
        at_vertices = np.column_stack([back, mesh.shares(px + self.corner) * (1 - renewed)]).astype(np.float32)
        corners = np.concatenate([at_vertices[mesh.faces], mesh.uv], axis=2)
        inside = np.zeros((height * width, 5), np.float32)
        inside[covered] = blend_corners(corners, ids, fragments.barycentrics.reshape(-1, 3)[covered])
        box = slice(low[1], low[1] + height), slice(low[0], low[0] + width)
        face_ids, values = np.full(self.freedom.shape, -1), np.zeros((*self.freedom.shape, 5), np.float32)
        face_ids[box], values[box] = fragments.face_ids, inside.reshape(height, width, 5)
        return face_ids, values

    def _sampled(
        self, motion: np.ndarray, image: np.ndarray | None = None, rows: tuple[slice, slice] = np.s_[:, :]
    ) -> np.ndarray:
        """An image of the box's size, by default the picture, at the pixels of a part of it plus a motion."""
        height, width = self.freedom.shape
        columns, lines = np.arange(width, dtype=np.float32)[rows[1]], np.arange(height, dtype=np.float32)[rows[0]]
        places = np.stack([motion[..., 0] + columns, motion[..., 1] + lines[:, None]], axis=2)
        image = self.picture if image is None else image
        return _remap(image, places, cv2.INTER_CUBIC if image.ndim == 3 else cv2.INTER_LINEAR)

    def _falloff(self, face: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """1 (h, w) on the face, falling to 0 around it over a distance in which the motion cannot fold."""
        away = cv2.distanceTransform((~face).astype(np.uint8), cv2.DIST_L2, 5)
        most = float(_largest(motion)[face].max(initial=0))
        t = np.clip(1 - away / max(_FALLOFF * most, _LEAST_FALLOFF * self.width), 0, 1)
        return np.asarray(t * t * (3 - 2 * t))


def rim_cover(label: np.ndarray, lines: tuple[float, float]) -> np.ndarray:
    """How far (h, w) the skin, and the line drawn along its rim, cover what lies within an opening."""
    skin = (label != EYE) & (label != MOUTH)
    into = cv2.distanceTransform((~skin).astype(np.uint8), cv2.DIST_L2, 5)
    reach = np.where(label == EYE, lines[1], lines[0]).astype(np.float32)
    return np.where(skin, 1, np.clip((reach + 0.5 - into) / np.maximum(0.5 * reach, 1.0), 0, 1)).astype(np.float32)


def picture_warp(img: np.ndarray, landmarks: np.ndarray, mesh: PictureMesh, parse: FaceParse) -> PictureWarp:
    """Crop a picture to what an expression may touch, and find what must stay."""
    used = np.vstack([mesh.px[np.unique(mesh.faces)], landmarks])
    width = float(np.ptp(landmarks[:, 0]))
    low, high = landmarks.min(0), landmarks.max(0)
    low, high = np.minimum(low, used.min(0)), np.maximum(high, used.max(0))
    bounds = np.array(img.shape[1::-1])
    start = np.clip(np.floor(low - _REACH * width), 0, bounds - 1).astype(int)
    end = np.clip(np.ceil(high + _REACH * width) + 1, start + 1, bounds).astype(int)
    box = slice(start[1], end[1]), slice(start[0], end[0])
    hull = cv2.convexHull(np.rint(landmarks - start).astype(np.int32))
    hair = parse.mask(FaceLabel.HAIR, FaceLabel.EARS)[box]
    amid = cv2.fillConvexPoly(np.zeros(hair.shape, np.uint8), hull, 1)
    # Specks are mistakes of the parse, a beard or a moustache moves with the skin, and the edge of hair is a mixture.
    fixed = (hair & (np.asarray(amid) == 0)).astype(np.uint8)
    fixed = np.asarray(cv2.morphologyEx(fixed, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)), np.uint8)
    fixed = np.asarray(cv2.dilate(fixed, np.ones((3, 3), np.uint8)), np.uint8)
    # At the border of the box, unless it is that of the picture, all is at rest.
    frame = np.ones((fixed.shape[0] + 2, fixed.shape[1] + 2), np.uint8)
    frame[1:-1, 1:-1] = fixed
    for edge, inside in ((np.s_[0], start[1] == 0), (np.s_[-1], end[1] == bounds[1])):
        frame[edge] = 0 if inside else 1
    for edge, inside in ((np.s_[0], start[0] == 0), (np.s_[-1], end[0] == bounds[0])):
        frame[:, edge] = 0 if inside else 1
    away = cv2.distanceTransform(1 - frame, cv2.DIST_L2, 5)[1:-1, 1:-1]
    t = np.clip(away / (_CALM * width), 0, 1)
    mouth, eye = (
        float(np.ptp(landmarks[48:60, 0])),
        max(float(np.ptp(landmarks[rows, 0])) for rows in (slice(36, 42), slice(42, 48))),
    )
    lines = max(_MOUTH_LINE * mouth, 1.0), max(_EYE_LINE * eye, _LEAST_LINE)
    freedom = (t * t * (3 - 2 * t)).astype(np.float32)
    warp = PictureWarp(mesh, img[box].astype(np.float32), start, freedom, np.ones_like(freedom), width, lines)
    ids = warp._drawn(mesh.px - start, mesh.camera.depth(mesh.vertices), np.zeros(len(mesh.px)))[0]
    interior = rim_cover(np.where(ids >= 0, mesh.labels[ids], _NOTHING), lines) < 1
    return replace(warp, interior=interior.astype(np.float32))


def _jumps(motion: np.ndarray) -> np.ndarray:
    """Where (h, w) a motion (h, w, 2) is another one than beside or above."""
    edge = np.zeros(motion.shape[:2], bool)
    edge[:, 1:] = _largest(motion[:, 1:] - motion[:, :-1]) > _JUMP
    edge[1:] |= _largest(motion[1:] - motion[:-1]) > _JUMP
    return edge


def _edges(parts: np.ndarray, mouth: np.ndarray) -> np.ndarray:
    """Where (h, w) one part ends and another begins, of which at least one is within the mouth."""
    edge = np.zeros(parts.shape, bool)
    for here, before in ((np.s_[:, 1:], np.s_[:, :-1]), (np.s_[1:], np.s_[:-1])):
        other = (parts[here] != parts[before]) & (mouth[here] | mouth[before])
        edge[here] |= other
        edge[before] |= other
    return edge


def _softened(image: np.ndarray, edge: np.ndarray) -> np.ndarray:
    """An image (h, w, 3), changed in place: pixels at an edge (h, w) are mixed with their neighbours."""
    if not edge.any():
        return image
    box = _bounds(edge, margin=2)
    share = np.minimum(2 * cv2.GaussianBlur(edge[box].astype(np.float32), (3, 3), 0), 1)[..., None]
    image[box] += share * (cv2.GaussianBlur(image[box], (3, 3), 0) - image[box])
    return image


def _largest(motion: np.ndarray) -> np.ndarray:
    """Larger component (h, w) of a motion (h, w, 2), without its sign."""
    return np.maximum(np.abs(motion[..., 0]), np.abs(motion[..., 1]))


def _remap(image: np.ndarray, px: np.ndarray, how: int) -> np.ndarray:
    return np.asarray(cv2.remap(image, px[..., 0].copy(), px[..., 1].copy(), how, borderMode=cv2.BORDER_REPLICATE))


def _texels(uv: np.ndarray, texture: np.ndarray) -> np.ndarray:
    """Texture coordinates (h, w, 2) as texels."""
    height, width = texture.shape[:2]
    return np.asarray(uv * np.array([width, -height], np.float32) + np.array([-0.5, height - 0.5], np.float32))


def _bounds(mask: np.ndarray, margin: int = 0) -> tuple[slice, slice]:
    """Rows and columns within which a mask is."""
    rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    return (
        slice(max(int(rows[0]) - margin, 0), int(rows[-1]) + 1 + margin),
        slice(max(int(columns[0]) - margin, 0), int(columns[-1]) + 1 + margin),
    )
