"""Meshes and operators; knows no faces."""

from toongeo.geometry.adjacency import adjacency
from toongeo.geometry.catmull_clark import catmull_clark
from toongeo.geometry.cotangent_laplacian import cotangent_laplacian
from toongeo.geometry.deformation_gradients import deformation_gradients
from toongeo.geometry.deformation_transfer import DeformationTransfer, deformation_transfer
from toongeo.geometry.laplacian_align import laplacian_align
from toongeo.geometry.laplacian_aligner import LaplacianAligner
from toongeo.geometry.nonrigid_register import RegisteredMesh, nonrigid_register
from toongeo.geometry.one_rings import OneRings, one_rings
from toongeo.geometry.polar_decomposition import polar_decomposition
from toongeo.geometry.rotation_exp import rotation_exp
from toongeo.geometry.rotation_log import rotation_log
from toongeo.geometry.self_intersections import self_intersections
from toongeo.geometry.uniform_laplacian import uniform_laplacian
from toongeo.geometry.validate_mesh import validate_mesh
from toongeo.geometry.vertex_components import vertex_components
from toongeo.geometry.vertex_normals import vertex_normals

__all__ = [
    "DeformationTransfer",
    "LaplacianAligner",
    "OneRings",
    "RegisteredMesh",
    "adjacency",
    "catmull_clark",
    "cotangent_laplacian",
    "deformation_gradients",
    "deformation_transfer",
    "laplacian_align",
    "nonrigid_register",
    "one_rings",
    "polar_decomposition",
    "rotation_exp",
    "rotation_log",
    "self_intersections",
    "uniform_laplacian",
    "validate_mesh",
    "vertex_components",
    "vertex_normals",
]
