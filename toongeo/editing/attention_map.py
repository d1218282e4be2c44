"""Where an expression changes the texture: the displacement of the geometry, in texture space.

Constants were judged on the seven examples (``benchmarks/editing.py``).
"""

import cv2
import numpy as np

from toongeo.editing.texture.atlas_raster import AtlasRaster
from toongeo.protocols import TextureGeometry

__all__ = ["FULL", "MAP_SIDE", "attention_map", "vertex_change"]

FULL = 0.035  # of the head's width: where a vertex moves by so much, nothing of the texture is kept
MAP_SIDE = 256  # texels; the map is smooth, a larger one is enlarged from this
_SMOOTH = 0.006  # of the atlas's side: s.d. of the smoothing


def attention_map(
    geometry: TextureGeometry, size: int, *, extra: np.ndarray | None = None, raster: AtlasRaster | None = None
) -> np.ndarray:
    """Attention of Eq. 12 of Chen et al. 2020 from the motion of the vertices, as the paper trains its network on it.

    Parameters
    ----------
    geometry : TextureGeometry
        The face in the source and in the target expression.
    size : int
        Side of the atlas in texels.
    extra : (n,) float in [0, 1], optional
        Change of vertices that motion does not tell, such as of teeth that come into view; the larger counts.
    raster : AtlasRaster, optional
        Of the geometry's texture coordinates, where it is at hand.

    Returns
    -------
    (size, size) float32 in [0, 1]
        1 keeps the texture, 0 takes the new colour: 1 where nothing moves and between the islands, falling to 0 for
        motion of ``FULL`` of the head's width.

    Raises
    ------
    ValueError
        If the size is not positive, or ``extra`` is not one number a vertex.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> model = default_model()
    >>> geometry = TextureGeometry(model.mean, model.mean + 20.0, model.faces, model.uv, model.uv_faces)
    >>> float(attention_map(geometry, 64).min())
    0.0
    """
    if size < 1:
        raise ValueError(f"size: expected a positive number of texels, got {size!r}")
    n = len(geometry.source)
    if extra is not None and extra.shape != (n,):
        raise ValueError(f"extra: expected shape ({n},), got {extra.shape}")
    change = vertex_change(geometry)
    if extra is not None:
        change = np.maximum(change, extra)
    raster = raster or AtlasRaster(geometry.faces, geometry.uv, geometry.uv_faces, min(size, MAP_SIDE))
    image = raster.image(np.column_stack([change, np.ones(n)]))
    image = cv2.GaussianBlur(image, (0, 0), max(_SMOOTH * raster.size, 0.3))
    # Islands are smoothed within themselves: lids are thin beside the hole of the eye.
    image = image[..., 0] / np.maximum(image[..., 1], 0.05)
    image = cv2.resize(image, (size, size), interpolation=cv2.INTER_LINEAR)
    return np.asarray(1 - np.clip(image, 0, 1), np.float32)


def vertex_change(geometry: TextureGeometry) -> np.ndarray:
    """0 (n,) where a vertex stays, 1 where it moves by ``FULL`` of the head's width or more."""
    motion = np.linalg.norm(geometry.target - geometry.source, axis=1)
    return np.asarray(np.clip(motion / (FULL * float(np.ptp(geometry.source[:, 0]))), 0, 1), np.float32)
