"""Exaggerated faces: a deformation space that extrapolates (Wu et al. 2018); expressions of them (Chen et al. 2020)."""

from toongeo.caricature.attention_map import attention_map
from toongeo.caricature.bilinear_model import BilinearModel, bilinear_fit
from toongeo.caricature.caricature_fit import CaricatureFit
from toongeo.caricature.caricature_options import CaricatureOptions
from toongeo.caricature.caricature_rig import caricature_rig
from toongeo.caricature.caricature_surface import caricature_surface
from toongeo.caricature.caricatured_modes import caricatured_modes
from toongeo.caricature.compose_texture import compose_texture
from toongeo.caricature.deformation_space import DeformationSpace
from toongeo.caricature.exaggerate import exaggerate
from toongeo.caricature.face_space import FaceSpace, face_space
from toongeo.caricature.fit_caricature import fit_caricature
from toongeo.caricature.initial_blendshapes import InitialBlendshapes, initial_blendshapes
from toongeo.caricature.landmark_mapper import PartMapper
from toongeo.caricature.linear_fit import linear_fit
from toongeo.caricature.optimize_blendshapes import BlendshapeWeights, optimize_blendshapes
from toongeo.caricature.restore_similarities import restore_similarities
from toongeo.caricature.sparse_expression import sparse_expression
from toongeo.caricature.texture_generator import ClassicalTextureGenerator
from toongeo.caricature.thin_plate_warp import thin_plate_warp
from toongeo.caricature.weights_of_expression import weights_of_expression

__all__ = [
    "BilinearModel",
    "BlendshapeWeights",
    "CaricatureFit",
    "CaricatureOptions",
    "ClassicalTextureGenerator",
    "DeformationSpace",
    "FaceSpace",
    "InitialBlendshapes",
    "PartMapper",
    "attention_map",
    "bilinear_fit",
    "caricature_rig",
    "caricature_surface",
    "caricatured_modes",
    "compose_texture",
    "exaggerate",
    "face_space",
    "fit_caricature",
    "initial_blendshapes",
    "linear_fit",
    "optimize_blendshapes",
    "restore_similarities",
    "sparse_expression",
    "weights_of_expression",
    "thin_plate_warp",
]
