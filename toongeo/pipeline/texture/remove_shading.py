"""The picture without the light that falls on the face.

Constants were chosen by eye on the seven examples.
"""

import numpy as np

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.texture.face_picture import FacePicture
from toongeo.render import interpolate, irradiance, linear_to_srgb, srgb_to_linear

__all__ = ["remove_shading"]

_DARKEST = 0.1  # of full shading: what lies deeper in shadow is not brightened further


def remove_shading(picture: FacePicture, face: AlignedFace) -> np.ndarray:
    """Pixels (h, w, 3) uint8 of the crop divided by the fitted light: the albedo of Pan et al. 2024, Eq. 2.

    Shading is that of the aligned face's normals under the fit's harmonics, in linear light.

    Raises
    ------
    ValueError
        If the fit has no light.
    """
    light = face.fit.light
    if light is None:
        raise ValueError("delight: expected a fit with light, as photometric_fit gives, got landmarks only")
    normals = face.camera.view(face.normals + face.vertices) - face.camera.view(face.vertices)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    shading = np.maximum(irradiance(normals, light) / np.pi, _DARKEST).astype(np.float32)
    lit = interpolate(picture.fragments, face.faces, shading)
    lit[~picture.fragments.mask] = 1.0
    table = srgb_to_linear(np.arange(256, dtype=np.float32) / np.float32(255))
    albedo = linear_to_srgb(np.clip(table[picture.pixels] / lit, 0.0, 1.0))
    return np.clip(np.rint(255 * albedo), 0, 255).astype(np.uint8)
