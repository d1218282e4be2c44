"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.caricature.baselines.bilinear_model import BilinearModel as BilinearModel
from toongeo.caricature.baselines.bilinear_model import bilinear_fit as bilinear_fit
from toongeo.caricature.baselines.caricatured_modes import caricatured_modes as caricatured_modes
from toongeo.caricature.baselines.linear_fit import LinearFit as LinearFit
from toongeo.caricature.baselines.linear_fit import linear_fit as linear_fit
from toongeo.caricature.baselines.thin_plate_warp import thin_plate_warp as thin_plate_warp
from toongeo.caricature.blendshapes.caricature_rig import caricature_rig as caricature_rig
from toongeo.caricature.blendshapes.initial_blendshapes import InitialBlendshapes as InitialBlendshapes
from toongeo.caricature.blendshapes.initial_blendshapes import initial_blendshapes as initial_blendshapes
from toongeo.caricature.blendshapes.landmark_mapper import PartMapper as PartMapper
from toongeo.caricature.blendshapes.optimize_blendshapes import BlendshapeWeights as BlendshapeWeights
from toongeo.caricature.blendshapes.optimize_blendshapes import optimize_blendshapes as optimize_blendshapes
from toongeo.caricature.blendshapes.restore_similarities import restore_similarities as restore_similarities
from toongeo.caricature.blendshapes.sparse_expression import sparse_expression as sparse_expression
from toongeo.caricature.blendshapes.weights_of_expression import weights_of_expression as weights_of_expression
from toongeo.caricature.caricature_fit import CaricatureFit as CaricatureFit
from toongeo.caricature.caricature_options import CaricatureOptions as CaricatureOptions
from toongeo.caricature.caricature_surface import caricature_surface as caricature_surface
from toongeo.caricature.exaggerate import exaggerate as exaggerate
from toongeo.caricature.fit_caricature import fit_caricature as fit_caricature
from toongeo.caricature.space.deformation_space import DeformationSpace as DeformationSpace
from toongeo.caricature.space.face_space import FaceSpace as FaceSpace
from toongeo.caricature.space.face_space import face_space as face_space
