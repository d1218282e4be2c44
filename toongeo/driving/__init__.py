"""Weights from a performance: landmarks of another face, or what a phone recorded."""

from toongeo.driving.landmark_driver import LandmarkDriver, LiveLandmarks
from toongeo.driving.landmark_rig import LandmarkRig

__all__ = ["LandmarkDriver", "LandmarkRig", "LiveLandmarks"]
