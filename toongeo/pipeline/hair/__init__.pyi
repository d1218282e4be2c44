"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.hair.build_hair import build_hair as build_hair
from toongeo.pipeline.hair.hair import Hair as Hair
from toongeo.pipeline.hair.hair_faults import hair_faults as hair_faults
from toongeo.pipeline.hair.make_room import make_room as make_room
