"""A mesh with what it takes to paint it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo._brief_repr import brief_repr
from toongeo.geometry.validate_mesh import validate_faces, validate_mesh, validate_vertices

__all__ = ["Surface"]


@dataclass(frozen=True, eq=False)
class Surface:
    """One mesh to be rendered, painted by vertex colours, by a texture, or not at all (mid grey).

    Parameters
    ----------
    vertices : array_like, shape (n, 3)
        Model frame, mm.
    faces : array_like of int, shape (m, 3)
        Counter-clockwise from outside.
    colours : array_like, shape (n, 3), optional
        sRGB, 0..1.
    uv, uv_faces : array_like, shapes (t, 2) and (m, 3), optional
        Texture coordinates (origin bottom left) and the corners of each face in them.
    texture : array_like of uint8, shape (H, W, 3), optional
        sRGB; needs ``uv`` and ``uv_faces``, and wins over ``colours``.
    normals : array_like, shape (n, 3), optional
        Unit normals, model frame; computed from the mesh if None.

    Raises
    ------
    ValueError
        If a shape, type or index is wrong, or only a part of uv, uv_faces and texture is given.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.render import Surface
    >>> triangle = Surface([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], colours=np.eye(3))
    >>> triangle.vertices.dtype, triangle.texture is None
    (dtype('float64'), True)
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    colours: NDArray[np.float64] | None = None
    uv: NDArray[np.float64] | None = None
    uv_faces: NDArray[np.int64] | None = None
    texture: NDArray[np.uint8] | None = None
    normals: NDArray[np.float64] | None = None

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        vertices, faces = validate_mesh(self.vertices, self.faces, names=("vertices", "faces"))
        self._keep(vertices=vertices, faces=faces)
        for name in ("colours", "normals"):
            if getattr(self, name) is not None:
                rows = validate_vertices(getattr(self, name), name=name)
                if len(rows) != len(vertices):
                    raise ValueError(f"{name}: expected shape ({len(vertices)}, 3), got {rows.shape}")
                self._keep(**{name: rows})
        given = [name for name in ("uv", "uv_faces", "texture") if getattr(self, name) is not None]
        if len(given) == 3:
            self._check_texture()
        elif given:
            raise ValueError(f"texture: expected it with uv and uv_faces, got only {', '.join(given)}")

    def _check_texture(self) -> None:
        uv, texture = np.asarray(self.uv, dtype=np.float64), np.asarray(self.texture)
        if uv.ndim != 2 or uv.shape[1] != 2 or not np.isfinite(uv).all():
            raise ValueError(f"uv: expected finite coordinates of shape (t, 2), got shape {uv.shape}")
        assert self.uv_faces is not None
        uv_faces = validate_faces(self.uv_faces, len(uv), name="uv_faces")
        if len(uv_faces) != len(self.faces):
            raise ValueError(f"uv_faces: expected {len(self.faces)} rows like faces, got {uv_faces.shape}")
        if texture.dtype != np.uint8 or texture.ndim != 3 or texture.shape[2] != 3 or texture.size == 0:
            raise ValueError(f"texture: expected uint8 (H, W, 3), got {texture.dtype} {texture.shape}")
        self._keep(uv=uv, uv_faces=uv_faces, texture=texture)

    def _keep(self, **arrays: NDArray) -> None:
        for name, array in arrays.items():
            view = array.view()
            view.setflags(write=False)
            object.__setattr__(self, name, view)
