"""The public names, for type checkers; ``__init__.py`` imports each when it is first used."""

from toongeo.avatar import Avatar as Avatar
from toongeo.caricature import CaricatureFit as CaricatureFit
from toongeo.caricature import CaricatureOptions as CaricatureOptions
from toongeo.caricature import DeformationSpace as DeformationSpace
from toongeo.caricature import FaceSpace as FaceSpace
from toongeo.caricature import caricature_surface as caricature_surface
from toongeo.caricature import exaggerate as exaggerate
from toongeo.caricature import face_space as face_space
from toongeo.caricature import fit_caricature as fit_caricature
from toongeo.geometry import DeformationTransfer as DeformationTransfer
from toongeo.geometry import LaplacianAligner as LaplacianAligner
from toongeo.geometry import deformation_transfer as deformation_transfer
from toongeo.geometry import laplacian_align as laplacian_align
from toongeo.io import read_image as read_image
from toongeo.io import read_landmarks as read_landmarks
from toongeo.io import write_landmarks as write_landmarks
from toongeo.make_avatar import make_avatar as make_avatar
from toongeo.model import MorphableModel as MorphableModel
from toongeo.model import default_model as default_model
from toongeo.pipeline import AlignedFace as AlignedFace
from toongeo.pipeline import ClassicalParser as ClassicalParser
from toongeo.pipeline import Eyes as Eyes
from toongeo.pipeline import FaceFit as FaceFit
from toongeo.pipeline import FitOptions as FitOptions
from toongeo.pipeline import PhotometricOptions as PhotometricOptions
from toongeo.pipeline import RidgeRegressor as RidgeRegressor
from toongeo.pipeline import Rig as Rig
from toongeo.pipeline import adjust_coefficients as adjust_coefficients
from toongeo.pipeline import align_face as align_face
from toongeo.pipeline import bake_eyes as bake_eyes
from toongeo.pipeline import bake_texture as bake_texture
from toongeo.pipeline import build_rig as build_rig
from toongeo.pipeline import clear_lids as clear_lids
from toongeo.pipeline import close_lids as close_lids
from toongeo.pipeline import diffuse_texture as diffuse_texture
from toongeo.pipeline import fit_3dmm as fit_3dmm
from toongeo.pipeline import fit_eyes as fit_eyes
from toongeo.pipeline import fit_lids as fit_lids
from toongeo.pipeline import parse_face as parse_face
from toongeo.pipeline import photometric_fit as photometric_fit
from toongeo.pipeline import rendered_picture as rendered_picture
from toongeo.pipeline import residual_map as residual_map
from toongeo.pipeline import snap_eyes as snap_eyes
from toongeo.pipeline import texture_coordinates as texture_coordinates
from toongeo.pipeline import train_ridge_regressor as train_ridge_regressor
from toongeo.protocols import Coefficients as Coefficients
from toongeo.protocols import FaceLabel as FaceLabel
from toongeo.protocols import FaceParse as FaceParse
from toongeo.render import PerspectiveCamera as PerspectiveCamera
from toongeo.render import ScaledOrthographicCamera as ScaledOrthographicCamera
from toongeo.render import render_mesh as render_mesh

__version__: str
__all__: list[str]
