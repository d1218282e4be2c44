"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.landmarks.detect_faces import detect_faces as detect_faces
from toongeo.pipeline.landmarks.detect_landmarks import NoFaceError as NoFaceError
from toongeo.pipeline.landmarks.detect_landmarks import detect_landmarks as detect_landmarks
