"""How light falls on the fitted head, without the photograph's noise."""

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Bytes, Floats, Mask, Singles
from toongeo.colour.srgb import srgb_to_linear
from toongeo.geometry import vertex_normals
from toongeo.pipeline.fit import FaceFit
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.stylize.appearance.pixels import blurred, hull_of, placed_in, reduced
from toongeo.protocols import Camera
from toongeo.render import interpolate, irradiance, rasterize

__all__ = ["LIGHT_SIZE", "HeadLight", "best_light", "head_light"]

LIGHT_SIZE = 64.0  # px of the face; light on it is smooth, and a pixel is then a fourth of what it is smoothed by
_SPREAD = 0.12  # face sizes, beyond the mesh
_SOFT = 0.05  # face sizes: no facet shows, and no wrinkle
_WEAK = 0.25  # log2: light that varies less over the face than this is even
_X = 3  # row of the harmonic that grows to the right of the camera
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear sRGB
_FEATURES = (
    (range(36, 42), 0.05),
    (range(42, 48), 0.05),
    (range(48, 60), 0.04),
    (range(17, 22), 0.04),
    (range(22, 27), 0.04),
)
_ROUNDS = 6  # of robust weights: they no longer change
_OFF = 0.25  # of the luminance: so far from the model a pixel counts a half. Beards, glasses, highlights are farther
_RIDGE = 0.003  # on all but the ambient harmonic, which the visible half of a face hardly tells apart; of the trace


@dataclass(frozen=True, eq=False)
class HeadLight:
    """Where the fitted head is in a picture, and its shading.

    Attributes
    ----------
    head, face : (h, w) float32
        1 where its skin is; where its face is, forehead included.
    shade : (h, w) float32
        log2 of the light, 0 at its median, over the spread within the face: about -1 in shadow, 1 in full light.
    from_right : bool
        Whether it comes from the right of the picture rather than from the left.
    """

    head: Singles
    face: Singles
    shade: Singles
    from_right: bool


def head_light(photo: Bytes, fit: FaceFit, landmarks: Floats, size: float) -> HeadLight:
    """Light on the head in a picture (H, W, 3) whose face has landmarks (68, 2) px and a size in px; planes are of the
    picture reduced to a face of ``LIGHT_SIZE``."""
    factor = LIGHT_SIZE / size
    small = np.asarray(reduced(photo, factor), np.uint8)
    camera = fit.camera.cropped(np.full(2, 0.5 / factor - 0.5), factor)
    head, face, normals = _seen(fit, camera, (small.shape[0], small.shape[1]))
    if not head.any():
        none = np.zeros(small.shape[:2], np.float32)
        return HeadLight(none, none, none, False)
    basis = _shading_basis(_in_view(camera, normals[head]))
    luminance = srgb_to_linear(small[head]) @ _LUMINANCE
    known = _bare(small.shape, placed_in(landmarks, factor))[head]
    harmonics = best_light(basis[known], luminance[known]) if known.sum() > len(basis.T) else np.eye(9)[0]
    shade = np.zeros(head.shape, np.float32)
    shade[head] = np.log2(np.maximum(basis @ harmonics, 0.02 * max(float(np.median(luminance)), 1e-3)))
    shade[head] -= np.median(shade[head])
    weight = blurred(head.astype(np.float32), _SPREAD * LIGHT_SIZE)
    beyond = blurred(shade, _SPREAD * LIGHT_SIZE) / np.maximum(weight, np.float32(1e-3))
    shade = blurred(np.where(head, shade, beyond), _SOFT * LIGHT_SIZE)
    spread = float(np.percentile(np.abs(shade[face if face.any() else head]), 80))
    covers = head.astype(np.float32), face.astype(np.float32)
    return HeadLight(*covers, shade / np.float32(max(spread, _WEAK)), bool(harmonics[_X] > 0))


def best_light(basis: Floats, luminance: Floats) -> Floats:
    """Radiance (9,) in harmonics that explains the luminance (k,) of skin of one albedo, whose normals have a shading
    basis (k, 9): least squares, reweighted by how far each pixel is off (Cauchy), as most of a face is bare skin."""
    scale = max(float(np.median(luminance)), 1e-4)
    weights, ridge = np.ones(len(luminance)), np.full(9, _RIDGE)
    ridge[0] = 0.0
    for _ in range(_ROUNDS):
        normal = (basis * weights[:, None]).T @ basis
        regular = np.diag(ridge * np.trace(normal) + 1e-9)
        light = np.linalg.solve(normal + regular, basis.T @ (weights * luminance))
        weights = 1 / (1 + np.square((luminance - basis @ light) / (_OFF * scale)))
    return np.asarray(light)


def _seen(fit: FaceFit, camera: Camera, shape: tuple[int, int]) -> tuple[Mask, Mask, Floats]:
    """Pixels (h, w) of the head's skin and of its face, and normals (h, w, 3) in the model frame."""
    faces = fit.faces[fit.region("skin")[fit.faces].all(axis=1)]
    px = np.column_stack([camera.project(fit.vertices), camera.depth(fit.vertices)])
    fragments = rasterize(px, faces, *shape, cull_back=True)
    attributes = np.column_stack([vertex_normals(fit.vertices, fit.faces), fit.region("face")])
    drawn = interpolate(fragments, faces, attributes)
    return fragments.mask, drawn[..., 3] > 0.5, drawn[..., :3]


def _shading_basis(normals: Floats) -> Floats:
    """Light (k, 9) on surfaces with normals (k, 3) under each harmonic of unit radiance."""
    each = np.eye(9)  # as three channels at a time
    return np.hstack([irradiance(normals, each[:, first : first + 3]) for first in (0, 3, 6)])


def _in_view(camera: Camera, normals: Floats) -> Floats:
    """Unit normals (k, 3) in the camera's frame, of ones in the model's."""
    turned = camera.view(normals) - camera.view(np.zeros((1, 3)))
    return np.asarray(turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-6))


def _bare(shape: tuple[int, ...], landmarks: Floats) -> Mask:
    """Between jaw and brows, but for eyes, brows and lips."""
    bare = filled(shape, np.vstack([landmarks[:17], landmarks[26:16:-1]]))
    for part, margin in _FEATURES:
        bare &= ~grown(filled(shape, hull_of(landmarks[list(part)])), margin * LIGHT_SIZE)
    return np.asarray(bare)
