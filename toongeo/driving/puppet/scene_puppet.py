"""A face of a file as it performs."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.driving.head_turn import head_rotation
from toongeo.io import Scene, SceneMesh
from toongeo.render import FrameRenderer, ScaledOrthographicCamera, Surface

__all__ = ["ScenePuppet"]

_ROOM = 1.12  # of the height: how much of the world a picture shows
_NECK = 0.3  # of the height, above the lowest point: about which a head turns, as in the template


class ScenePuppet:
    """Pictures of a scene from the front as its targets move; what does not change is prepared once.

    Parameters
    ----------
    scene : Scene
        mm, the face along +Z.
    size : int
        Side of the pictures, px.
    """

    def __init__(self, scene: Scene, size: int = 512) -> None:
        self._meshes = scene.meshes
        points = np.vstack([mesh.vertices for mesh in scene.meshes])
        low, high = points.min(axis=0), points.max(axis=0)
        x, y, z = (low + high) / 2
        self._neck = np.array([x, low[1] + _NECK * (high[1] - low[1]), z])
        scale = size / (_ROOM * float((high - low).max()))
        centre = (size - 1) / 2
        camera = ScaledOrthographicCamera(scale, np.eye(3), np.array([centre - scale * x, centre + scale * y]))
        # Open meshes, as other programs write them, are seen from inside too.
        self._renderer = FrameRenderer([_surface(mesh) for mesh in scene.meshes], camera, size, cull_back=False)

    def frame(self, weights: Mapping[str, float], head: ArrayLike | None = None) -> NDArray[np.uint8]:
        """Picture (size, size, 3) RGB.

        Parameters
        ----------
        weights : name of a target -> weight
            Others are ignored.
        head : (3,) radians, optional
            Yaw, pitch and roll, as of `head_rotation`.
        """
        parts = [mesh.moved(weights).astype(np.float64) for mesh in self._meshes]
        if head is not None:
            turn = head_rotation(head)
            parts = [(part - self._neck) @ turn.T + self._neck for part in parts]
        return self._renderer.frame(parts)


def _surface(mesh: SceneMesh) -> Surface:
    vertices, faces = mesh.vertices.astype(np.float64), mesh.faces.astype(np.int64)
    if mesh.texture is None or mesh.uv is None or mesh.uv_faces is None:
        return Surface(vertices, faces, colours=np.tile(mesh.color, (len(vertices), 1)))
    uv, uv_faces = mesh.uv.astype(np.float64), mesh.uv_faces.astype(np.int64)
    return Surface(vertices, faces, uv=uv, uv_faces=uv_faces, texture=mesh.texture)
