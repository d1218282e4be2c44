"""Weights from a performance: landmarks of another face, or what a phone recorded."""

from toongeo.driving.arkit_driver import ArkitDriver
from toongeo.driving.landmark_driver import LandmarkDriver, LiveLandmarks
from toongeo.driving.landmark_rig import LandmarkRig
from toongeo.driving.read_live_link import read_live_link
from toongeo.driving.send_weights import send_weights
from toongeo.driving.take import Take

__all__ = ["ArkitDriver", "LandmarkDriver", "LandmarkRig", "LiveLandmarks", "Take", "read_live_link", "send_weights"]
