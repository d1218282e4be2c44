"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.model.atlas_coordinates import Atlas as Atlas
from toongeo.model.atlas_coordinates import atlas_coordinates as atlas_coordinates
from toongeo.model.data_path import data_path as data_path
from toongeo.model.default_model import default_model as default_model
from toongeo.model.expression_weights import expression_weights as expression_weights
from toongeo.model.expression_weights import preset as preset
from toongeo.model.eyeball_template import EyeballTemplate as EyeballTemplate
from toongeo.model.loaders.load_eos import load_eos as load_eos
from toongeo.model.loaders.load_ict_facekit import load_ict_facekit as load_ict_facekit
from toongeo.model.loaders.load_model import FORMATS as FORMATS
from toongeo.model.loaders.load_model import load_model as load_model
from toongeo.model.loaders.load_model import model_format as model_format
from toongeo.model.loaders.save_model import save_model as save_model
from toongeo.model.morphable_model import MorphableModel as MorphableModel
from toongeo.model.supply.skinning import Skinning as Skinning
