"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.parse.classical_parser import ClassicalParser as ClassicalParser
from toongeo.pipeline.parse.find_hair import find_hair as find_hair
from toongeo.pipeline.parse.parse_face import parse_face as parse_face
from toongeo.pipeline.parse.snap_eyes import snap_eyes as snap_eyes
