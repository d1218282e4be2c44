"""A face of a file as it performs."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from toongeo.io import Scene
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

__all__ = ["ScenePuppet"]

_ROOM = 1.12  # of the height: how much of the world a picture shows


class ScenePuppet:
    """Pictures of a scene whose targets move; what does not matter for them is prepared once.

    Parameters
    ----------
    scene : Scene
        mm, the face along +Z.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        points = np.vstack([mesh.vertices for mesh in scene.meshes])
        self._middle, self._side = (points.max(axis=0) + points.min(axis=0)) / 2, float(np.ptp(points, axis=0).max())
        self._colours = [np.tile(mesh.color, (len(mesh.vertices), 1)) for mesh in scene.meshes]

    def render(self, weights: Mapping[str, float], size: int = 512) -> NDArray[np.uint8]:
        """Picture (size, size, 3) from the front, with weights by the names of the targets; others are ignored."""
        scale = size / (_ROOM * self._side)
        x, y, _ = self._middle
        centre = (size - 1) / 2
        camera = ScaledOrthographicCamera(scale, np.eye(3), np.array([centre - scale * x, centre + scale * y]))
        return render_mesh([self._surface(k, weights) for k in range(len(self._scene.meshes))], camera, size)

    def _surface(self, number: int, weights: Mapping[str, float]) -> Surface:
        mesh = self._scene.meshes[number]
        vertices, faces = mesh.moved(weights).astype(np.float64), mesh.faces.astype(np.int64)
        if mesh.texture is None or mesh.uv is None or mesh.uv_faces is None:
            return Surface(vertices, faces, colours=self._colours[number])
        uv, uv_faces = mesh.uv.astype(np.float64), mesh.uv_faces.astype(np.int64)
        return Surface(vertices, faces, uv=uv, uv_faces=uv_faces, texture=mesh.texture)
