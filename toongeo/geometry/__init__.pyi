"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.geometry.catmull_clark import catmull_clark as catmull_clark
from toongeo.geometry.deformation_transfer import DeformationTransfer as DeformationTransfer
from toongeo.geometry.deformation_transfer import deformation_transfer as deformation_transfer
from toongeo.geometry.laplacian_align import laplacian_align as laplacian_align
from toongeo.geometry.laplacian_aligner import LaplacianAligner as LaplacianAligner
from toongeo.geometry.nonrigid_register import RegisteredMesh as RegisteredMesh
from toongeo.geometry.nonrigid_register import nonrigid_register as nonrigid_register
from toongeo.geometry.operators.adjacency import adjacency as adjacency
from toongeo.geometry.operators.cotangent_laplacian import cotangent_laplacian as cotangent_laplacian
from toongeo.geometry.operators.deformation_gradients import deformation_gradients as deformation_gradients
from toongeo.geometry.operators.one_rings import OneRings as OneRings
from toongeo.geometry.operators.one_rings import one_rings as one_rings
from toongeo.geometry.operators.uniform_laplacian import uniform_laplacian as uniform_laplacian
from toongeo.geometry.operators.vertex_components import vertex_components as vertex_components
from toongeo.geometry.operators.vertex_normals import vertex_normals as vertex_normals
from toongeo.geometry.rotations.polar_decomposition import polar_decomposition as polar_decomposition
from toongeo.geometry.rotations.rotation_exp import rotation_exp as rotation_exp
from toongeo.geometry.rotations.rotation_log import rotation_log as rotation_log
from toongeo.geometry.self_intersections import self_intersections as self_intersections
from toongeo.geometry.validate_mesh import MeshLike as MeshLike
from toongeo.geometry.validate_mesh import validate_mesh as validate_mesh
