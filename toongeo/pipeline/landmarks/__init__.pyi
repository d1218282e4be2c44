"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.landmarks.detect_faces import detect_faces as detect_faces
from toongeo.pipeline.landmarks.detect_landmarks import NoFaceError as NoFaceError
from toongeo.pipeline.landmarks.detect_landmarks import detect_landmarks as detect_landmarks
from toongeo.pipeline.landmarks.landmark_evidence import LandmarkEvidence as LandmarkEvidence
from toongeo.pipeline.landmarks.landmark_evidence import landmark_evidence as landmark_evidence
from toongeo.pipeline.landmarks.landmark_track import LandmarkTrack as LandmarkTrack
from toongeo.pipeline.landmarks.landmark_track import TrackedFace as TrackedFace
from toongeo.pipeline.landmarks.landmark_tracker import LandmarkTracker as LandmarkTracker
from toongeo.pipeline.landmarks.track_landmarks import track_landmarks as track_landmarks
