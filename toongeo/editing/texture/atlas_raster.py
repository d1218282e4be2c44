"""Values of vertices as an atlas, again and again."""

import numpy as np

from toongeo.render import rasterize, uv_to_px

__all__ = ["AtlasRaster"]


class AtlasRaster:
    """Rasterized texture coordinates (t, 2) of faces (m, 3), with the vertices behind every texel."""

    def __init__(self, faces: np.ndarray, uv: np.ndarray, uv_faces: np.ndarray, size: int) -> None:
        fragments = rasterize(uv_to_px(uv, size, size), uv_faces, size, size)
        self.size = size
        self.texels = np.flatnonzero(fragments.face_ids.ravel() >= 0)
        self.corners = np.asarray(faces)[fragments.face_ids.ravel()[self.texels]]
        self.weights = fragments.barycentrics.reshape(-1, 3)[self.texels]

    def image(self, values: np.ndarray, empty: float = 0.0) -> np.ndarray:
        """Values (n, c) of vertices as (size, size, c) float32; ``empty`` between the islands."""
        values = np.asarray(values, np.float32)
        image = np.full((self.size * self.size, values.shape[1]), empty, np.float32)
        image[self.texels] = sum(values[self.corners[:, k]] * self.weights[:, k, None] for k in range(3))
        return image.reshape(self.size, self.size, -1)
