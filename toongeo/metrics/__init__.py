"""Measures: how far landmarks and colours are off, how sound a mesh is."""

from toongeo.metrics.face_square import face_square
from toongeo.metrics.landmark_distance import landmark_distance
from toongeo.metrics.landmark_error import IBUG68_PARTS, landmark_error
from toongeo.metrics.mesh_quality import MeshQuality, mesh_quality
from toongeo.metrics.photometric_error import photometric_error

__all__ = [
    "IBUG68_PARTS",
    "MeshQuality",
    "face_square",
    "landmark_distance",
    "landmark_error",
    "mesh_quality",
    "photometric_error",
]
