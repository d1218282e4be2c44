"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.batch.batch_options import BatchLimits as BatchLimits
from toongeo.batch.batch_options import BatchOptions as BatchOptions
from toongeo.batch.engines.begun_engine import BACKENDS as BACKENDS
from toongeo.batch.make_avatars import BatchResult as BatchResult
from toongeo.batch.make_avatars import make_avatars as make_avatars
from toongeo.batch.manifest import read_manifest as read_manifest
