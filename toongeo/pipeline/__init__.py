"""The way of the data, a stage a folder: fit, parse, align, texture, rig."""

from toongeo.pipeline.align.align_face import AlignedFace, align_face
from toongeo.pipeline.fit.adjust_coefficients import adjust_coefficients
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.photometric_fit import photometric_fit
from toongeo.pipeline.fit.photometric_options import PhotometricOptions
from toongeo.pipeline.fit.rendered_picture import rendered_picture
from toongeo.pipeline.fit.residual_map import residual_map
from toongeo.pipeline.fit.ridge_regressor import RidgeRegressor, train_ridge_regressor
from toongeo.pipeline.parse.classical_parser import ClassicalParser
from toongeo.pipeline.parse.find_hair import find_hair
from toongeo.pipeline.parse.parse_face import parse_face
from toongeo.pipeline.parse.snap_eyes import snap_eyes
from toongeo.pipeline.rig.animator import Animator
from toongeo.pipeline.rig.build_rig import build_rig
from toongeo.pipeline.rig.clear_lids import clear_lids
from toongeo.pipeline.rig.close_lids import close_lids
from toongeo.pipeline.rig.fit_eyes import Eyes, fit_eyes
from toongeo.pipeline.rig.fit_lids import fit_lids
from toongeo.pipeline.rig.fit_mouth import fit_mouth
from toongeo.pipeline.rig.neutral_face import neutral_face
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.rig.rig_mesh import rig_mesh
from toongeo.pipeline.texture.aim_eyes import aim_eyes
from toongeo.pipeline.texture.bake_eyes import bake_eyes
from toongeo.pipeline.texture.bake_texture import bake_texture
from toongeo.pipeline.texture.diffuse_texture import diffuse_texture
from toongeo.pipeline.texture.find_irises import Iris, find_irises
from toongeo.pipeline.texture.texture_coordinates import texture_coordinates

__all__ = [
    "AlignedFace",
    "Animator",
    "ClassicalParser",
    "Eyes",
    "FaceFit",
    "FitOptions",
    "RidgeRegressor",
    "PhotometricOptions",
    "Rig",
    "Iris",
    "adjust_coefficients",
    "aim_eyes",
    "find_hair",
    "find_irises",
    "align_face",
    "bake_eyes",
    "bake_texture",
    "build_rig",
    "clear_lids",
    "close_lids",
    "diffuse_texture",
    "fit_3dmm",
    "fit_eyes",
    "fit_mouth",
    "rig_mesh",
    "fit_lids",
    "train_ridge_regressor",
    "neutral_face",
    "parse_face",
    "photometric_fit",
    "rendered_picture",
    "residual_map",
    "snap_eyes",
    "texture_coordinates",
]
