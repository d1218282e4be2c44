"""How light falls on the fitted head, without the photograph's noise."""

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats, Mask, Singles
from toongeo.geometry import vertex_normals
from toongeo.pipeline.fit import FaceFit
from toongeo.pipeline.stylize.appearance.pixels import blurred
from toongeo.protocols import Camera
from toongeo.render import Surface, irradiance, render_mesh

__all__ = ["HeadLight", "head_light"]

_SPREAD = 0.12  # face sizes, beyond the mesh
_SOFT = 0.05  # face sizes: no facet shows, and no wrinkle
_WEAK = 0.25  # log2: light that varies less over the face than this is even
_X = 3  # row of the harmonic that grows to the right of the camera
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear sRGB


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


def head_light(fit: FaceFit, shape: tuple[int, int], factor: float, size: float) -> HeadLight:
    """Light of the fit on its head, in a picture (h, w) that was reduced by a factor; size of the face there, px."""
    camera = fit.camera.cropped(np.full(2, 0.5 / factor - 0.5), factor)
    normals = vertex_normals(fit.vertices, fit.faces)
    head, facing = _rendered(fit, normals, "skin", camera, shape)
    face, _ = _rendered(fit, normals, "face", camera, shape)
    harmonics = np.zeros((9, 3)) if fit.light is None else fit.light
    from_right = bool(_LUMINANCE @ harmonics[_X] > 0)
    if not head.any():
        none = np.zeros(shape, np.float32)
        return HeadLight(none, none, none, from_right)
    shade = np.zeros(shape, np.float32)
    shade[head] = _log_light(fit.camera, harmonics, facing[head])
    shade[head] -= np.median(shade[head])
    weight = blurred(head.astype(np.float32), _SPREAD * size)
    beyond = blurred(shade, _SPREAD * size) / np.maximum(weight, np.float32(1e-3))
    shade = blurred(np.where(head, shade, beyond), _SOFT * size)
    spread = float(np.percentile(np.abs(shade[face if face.any() else head]), 80))
    covers = head.astype(np.float32), face.astype(np.float32)
    return HeadLight(*covers, shade / np.float32(max(spread, _WEAK)), from_right)


def _rendered(
    fit: FaceFit, normals: Floats, region: str, camera: Camera, shape: tuple[int, int]
) -> tuple[Mask, Floats]:
    """Pixels of a region (h, w) bool, and normals (h, w, 3) in the model frame."""
    faces = fit.faces[fit.region(region)[fit.faces].all(axis=1)]
    surface = Surface(fit.vertices, faces, colours=(normals + 1) / 2, normals=normals)
    drawn = render_mesh(surface, camera, shape, background=(0, 0, 0), shading="unlit", supersample=1)
    return np.asarray(drawn.any(axis=-1)), drawn.astype(np.float64) / 127.5 - 1


def _log_light(camera: Camera, harmonics: Floats, normals: Floats) -> Floats:
    """log2 of the luminance that falls on surfaces with normals (k, 3) in the model frame."""
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-6)
    turned = camera.view(normals) - camera.view(np.zeros((1, 3)))
    turned /= np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-6)
    return np.asarray(np.log2(np.maximum(irradiance(turned, harmonics) @ _LUMINANCE, 1e-3)))
