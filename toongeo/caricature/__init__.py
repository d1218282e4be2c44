"""Exaggerated faces: a deformation space that extrapolates (Wu et al. 2018, "Alive caricature from 2D to 3D")."""

from toongeo.caricature.attention_map import attention_map
from toongeo.caricature.bilinear_model import BilinearModel, bilinear_fit
from toongeo.caricature.caricature_fit import CaricatureFit
from toongeo.caricature.caricature_options import CaricatureOptions
from toongeo.caricature.caricature_surface import caricature_surface
from toongeo.caricature.caricatured_modes import caricatured_modes
from toongeo.caricature.compose_texture import compose_texture
from toongeo.caricature.deformation_space import DeformationSpace
from toongeo.caricature.exaggerate import exaggerate
from toongeo.caricature.face_space import FaceSpace, face_space
from toongeo.caricature.fit_caricature import fit_caricature
from toongeo.caricature.linear_fit import linear_fit
from toongeo.caricature.texture_generator import ClassicalTextureGenerator
from toongeo.caricature.thin_plate_warp import thin_plate_warp

__all__ = [
    "BilinearModel",
    "CaricatureFit",
    "CaricatureOptions",
    "ClassicalTextureGenerator",
    "DeformationSpace",
    "FaceSpace",
    "attention_map",
    "bilinear_fit",
    "caricature_surface",
    "caricatured_modes",
    "compose_texture",
    "exaggerate",
    "face_space",
    "fit_caricature",
    "linear_fit",
    "thin_plate_warp",
]
