"""Morphable models: the container, the default template and its tables."""

from toongeo.model.data_path import data_path
from toongeo.model.default_model import default_model
from toongeo.model.expression_weights import expression_weights, preset
from toongeo.model.eyeball_template import EyeballTemplate
from toongeo.model.load_eos import load_eos
from toongeo.model.load_ict_facekit import load_ict_facekit
from toongeo.model.morphable_model import MorphableModel

__all__ = [
    "EyeballTemplate",
    "MorphableModel",
    "data_path",
    "default_model",
    "expression_weights",
    "load_eos",
    "load_ict_facekit",
    "preset",
]
