"""The detector that comes with the library."""

import toongeo
from toongeo.app.editor.protocols import Detector

__all__ = ["shipped_detector"]


def shipped_detector() -> Detector | None:
    """``toongeo.detect_landmarks``; None where it is not there."""
    return getattr(toongeo, "detect_landmarks", None)
