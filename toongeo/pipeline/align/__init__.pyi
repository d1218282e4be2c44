"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.align.align_face import AlignedFace as AlignedFace
from toongeo.pipeline.align.align_face import AlignReport as AlignReport
from toongeo.pipeline.align.align_face import align_face as align_face
from toongeo.pipeline.align.denoise_landmarks import DenoisedLandmarks as DenoisedLandmarks
from toongeo.pipeline.align.denoise_landmarks import LandmarkNoise as LandmarkNoise
from toongeo.pipeline.align.denoise_landmarks import denoise_landmarks as denoise_landmarks
from toongeo.pipeline.align.fit_cranium import fit_cranium as fit_cranium
from toongeo.pipeline.align.held_out_errors import held_out_errors as held_out_errors
