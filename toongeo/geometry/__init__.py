"""Meshes and operators; knows no faces."""

from toongeo.geometry.adjacency import adjacency
from toongeo.geometry.catmull_clark import catmull_clark
from toongeo.geometry.cotangent_laplacian import cotangent_laplacian
from toongeo.geometry.deformation_transfer import DeformationTransfer, deformation_transfer
from toongeo.geometry.laplacian_align import laplacian_align
from toongeo.geometry.laplacian_aligner import LaplacianAligner
from toongeo.geometry.self_intersections import self_intersections
from toongeo.geometry.uniform_laplacian import uniform_laplacian
from toongeo.geometry.validate_mesh import validate_mesh
from toongeo.geometry.vertex_components import vertex_components
from toongeo.geometry.vertex_normals import vertex_normals

__all__ = [
    "DeformationTransfer",
    "LaplacianAligner",
    "adjacency",
    "catmull_clark",
    "cotangent_laplacian",
    "deformation_transfer",
    "laplacian_align",
    "self_intersections",
    "uniform_laplacian",
    "validate_mesh",
    "vertex_components",
    "vertex_normals",
]
