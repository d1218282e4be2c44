"""The face of a picture as a mesh that carries the picture.

Constants were judged on the seven examples (``benchmarks/editing.py``).
"""

from dataclasses import dataclass

import numpy as np

from toongeo._read_only import read_only, restored
from toongeo.model.anatomy.parts import MOUTH_PARTS
from toongeo.pipeline import AlignedFace, Eyes
from toongeo.protocols import Camera
from toongeo.render import rasterize

__all__ = ["EYE", "MOUTH", "PictureMesh", "SKIN", "picture_mesh"]

SKIN, MOUTH, EYE, _BEHIND = range(4)  # what a triangle shows; _BEHIND is skin that the picture does not show
_EDGED = ("lips", "mouth_cavity", "teeth_upper", "teeth_lower", "tongue")
_FINE = 1400  # px over the face's larger side at which visibility in the picture is decided
_GRAZING = 0.12  # cosine to the viewer below which skin moves with what is beside it in the picture
_STRETCH = (2.0, 4.0)  # growth of the projected area up to which a drawing is stretched, and from which it is not


@dataclass(frozen=True, eq=False)
class PictureMesh:
    """Front of the head, inside of the mouth and eyeballs in one mesh, as the picture shows them.

    Attributes
    ----------
    vertices : (n + e, 3) float64, mm
        Of the head, then of the left and the right eyeball.
    faces : (m, 3) int64
    labels : (m,) uint8
        SKIN, MOUTH, EYE or _BEHIND.
    parts : (m,) uint8
        Skin 0, lips 1, inside of the mouth 2, upper teeth 3, lower teeth 4, tongue 5, eyes 6: what has edges.
    uv : (m, 3, 2) float32
        Texture coordinates of the corners, origin bottom left.
    seen : (n + e,) float32
        1 at the corners of triangles that the picture shows.
    soft : (n + e,) bool
        Lids, lips and what is within: only these show the texture where the picture shows nothing of them.
    px : (n + e, 2) float32
        Place in the picture.
    camera : Camera
    """

    vertices: np.ndarray
    faces: np.ndarray
    labels: np.ndarray
    parts: np.ndarray
    uv: np.ndarray
    seen: np.ndarray
    soft: np.ndarray
    px: np.ndarray
    camera: Camera

    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "vertices", "faces", "labels", "parts", "uv", "seen", "soft", "px")

    def shares(self, px: np.ndarray) -> np.ndarray:
        """How far (n + e,) the picture is to be used with vertices moved to ``px``: not hidden, not stretched manyfold.

        1 for all that is seen if nothing has moved. Skin of the cheeks, say, is as in the picture whatever happens.
        """
        before, after = (np.abs(_twice_areas(points, self.faces)) for points in (self.px, px))
        floor = 1e-3 * float(before.mean())
        growth = (after + floor) / (before + floor)
        worst = np.zeros(len(self.seen), np.float32)
        np.maximum.at(worst, self.faces.ravel(), growth.astype(np.float32).repeat(3))
        share = self.seen * (1 - np.clip((worst - _STRETCH[0]) / (_STRETCH[1] - _STRETCH[0]), 0, 1))
        return np.where(self.soft, share, 1).astype(np.float32)


def picture_mesh(face: AlignedFace, eyes: Eyes) -> PictureMesh:
    """Mesh of a face as the picture shows it, with eyes that look as drawn."""
    model = face.model
    inner = np.any([model.region(name) for name in MOUTH_PARTS], axis=0)
    socket = model.region("socket_left") | model.region("socket_right")
    wanted = (model.region("face") | inner | socket)[model.faces].all(1)
    vertices, faces, uv = [face.vertices], [model.faces[wanted]], [model.uv[model.uv_faces[wanted]]]
    labels = [np.select([inner[faces[0]].any(1), socket[faces[0]].any(1)], [MOUTH, EYE], SKIN)]
    for side, eye in enumerate(eyes.templates):
        faces.append(eye.faces + sum(map(len, vertices)))
        vertices.append(eyes.looking_as_drawn(side))
        uv.append(eye.uv[eye.faces])
        labels.append(np.full(len(eye.faces), EYE))
    V, F, label = np.concatenate(vertices), np.concatenate(faces), np.concatenate(labels).astype(np.uint8)
    px = face.camera.project(V)
    shown, cosine = _shown(px, face.camera.depth(V), F), _cosines(face.camera.view(V), F)
    seen = np.zeros(len(V), np.float32)
    seen[F[shown]] = 1
    seen[: len(face.vertices)][model.region("lips") & ~inner] = 1  # between closed lips the picture shows their line
    soft = np.ones(len(V), bool)
    lips_and_lids = model.region("lips") | model.region("eye_left") | model.region("eye_right")
    soft[: len(face.vertices)] = lips_and_lids | inner | socket
    hidden = (seen[F].min(1) == 0) | (cosine < _GRAZING)
    label[(label == SKIN) & hidden & ~soft[F].any(1)] = _BEHIND
    uv_corners = np.concatenate(uv).astype(np.float32)
    parts = np.where(label == EYE, len(_EDGED) + 1, 0).astype(np.uint8)
    for number, name in enumerate(_EDGED, 1):
        parts[: len(faces[0])][model.region(name)[faces[0]].all(1)] = number
    return PictureMesh(V, F, label, parts, uv_corners, seen, soft, px.astype(np.float32), face.camera)


def _shown(px: np.ndarray, depth: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Triangles (m,) of which something is in front."""
    used = px[np.unique(F)]
    low, high = used.min(0), used.max(0)
    scale = _FINE / (high - low).max()
    width, height = (np.ceil((high - low) * scale) + 1).astype(int)
    ids = rasterize(np.column_stack([(px - low) * scale, depth * scale]), F, height, width).face_ids
    shown = np.zeros(len(F), bool)
    shown[np.unique(ids[ids >= 0])] = True
    return shown & (_twice_areas(px, F) < 0)  # counter-clockwise from outside; rows run down


def _twice_areas(px: np.ndarray, F: np.ndarray) -> np.ndarray:
    a, b, c = px[F[:, 0]], px[F[:, 1]], px[F[:, 2]]
    return np.asarray((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))


def _cosines(view: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Cosines (m,) between the triangles' normals and the viewer, from camera-frame points (n, 3)."""
    normals = np.cross(view[F[:, 1]] - view[F[:, 0]], view[F[:, 2]] - view[F[:, 0]])
    return np.asarray(normals[:, 2] / np.maximum(np.linalg.norm(normals, axis=1), 1e-12))
