"""The picture itself as the texture of a face."""

import numpy as np

from toongeo.protocols import FittedFace

__all__ = ["texture_coordinates"]


def texture_coordinates(face: FittedFace, shape: tuple[int, ...]) -> np.ndarray:
    """Where every vertex falls in the picture, normalized (Pan et al. 2024, Eq. 12).

    With them the picture serves as texture as it is, with all that hides the face or surrounds it;
    :func:`toongeo.bake_texture` makes an atlas without.

    Parameters
    ----------
    face : FittedFace
    shape : (H, W) or (H, W, 3)
        Of the picture.

    Returns
    -------
    (n, 2) float64
        u to the right, v up, [0, 1] inside the picture: that of ``render_mesh``, OBJ and the atlas.

    Raises
    ------
    ValueError
        If the shape is none of a picture.

    Examples
    --------
    >>> from toongeo import default_model, fit_3dmm
    >>> model = default_model()
    >>> landmarks = model.mean[model.landmarks, :2] * [1, -1] + 150
    >>> u, v = texture_coordinates(fit_3dmm(None, landmarks), (300, 300)).T
    >>> bool(u[model.region("nose")].mean().round(1) == 0.5)
    True
    """
    if len(shape) not in (2, 3) or min(shape[:2]) < 1:
        raise ValueError(f"shape: expected (H, W) or (H, W, 3) of a picture, got {shape}")
    px = face.camera.project(face.vertices)
    # Integers are pixel centres, hence the half; v runs up, rows run down: the inverse of `uv_to_px`.
    return np.column_stack([(px[:, 0] + 0.5) / shape[1], 1.0 - (px[:, 1] + 0.5) / shape[0]])
