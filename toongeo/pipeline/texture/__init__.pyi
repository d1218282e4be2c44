"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.texture.bake_texture import bake_texture as bake_texture
from toongeo.pipeline.texture.diffuse_texture import diffuse_texture as diffuse_texture
from toongeo.pipeline.texture.eyes.aim_eyes import aim_eyes as aim_eyes
from toongeo.pipeline.texture.eyes.bake_eyes import bake_eyes as bake_eyes
from toongeo.pipeline.texture.eyes.find_irises import Iris as Iris
from toongeo.pipeline.texture.eyes.find_irises import find_irises as find_irises
from toongeo.pipeline.texture.texture_coordinates import texture_coordinates as texture_coordinates
