"""Measures: how far the landmarks are off, how sound a mesh is."""

from toongeo.metrics.landmark_error import IBUG68_PARTS, landmark_error
from toongeo.metrics.mesh_quality import MeshQuality, mesh_quality

__all__ = [
    "IBUG68_PARTS",
    "MeshQuality",
    "landmark_error",
    "mesh_quality",
]
