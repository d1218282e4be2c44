"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.metrics.check_gradient import GradientCheck as GradientCheck
from toongeo.metrics.check_gradient import check_gradient as check_gradient
from toongeo.metrics.face_square import face_square as face_square
from toongeo.metrics.landmark_distance import landmark_distance as landmark_distance
from toongeo.metrics.landmark_error import IBUG68_PARTS as IBUG68_PARTS
from toongeo.metrics.landmark_error import landmark_error as landmark_error
from toongeo.metrics.mesh_quality import MeshQuality as MeshQuality
from toongeo.metrics.mesh_quality import mesh_quality as mesh_quality
from toongeo.metrics.photometric_error import photometric_error as photometric_error
