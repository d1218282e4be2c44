"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.fit.adjust_coefficients import adjust_coefficients as adjust_coefficients
from toongeo.pipeline.fit.face_fit import FaceFit as FaceFit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm as fit_3dmm
from toongeo.pipeline.fit.fit_3dmm_together import fit_3dmm_together as fit_3dmm_together
from toongeo.pipeline.fit.fit_option_groups import JawOptions as JawOptions
from toongeo.pipeline.fit.fit_option_groups import PriorOptions as PriorOptions
from toongeo.pipeline.fit.fit_option_groups import SolverOptions as SolverOptions
from toongeo.pipeline.fit.fit_options import FitOptions as FitOptions
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks as ibug_landmarks
from toongeo.pipeline.fit.photometric_fit import photometric_fit as photometric_fit
from toongeo.pipeline.fit.photometric_options import PhotometricOptions as PhotometricOptions
from toongeo.pipeline.fit.rendered_picture import rendered_picture as rendered_picture
from toongeo.pipeline.fit.residual_map import residual_map as residual_map
from toongeo.pipeline.fit.ridge_regressor import RidgeRegressor as RidgeRegressor
from toongeo.pipeline.fit.ridge_regressor import train_ridge_regressor as train_ridge_regressor
