"""Performers, and takes in which they move."""

import numpy as np
import pytest

from toongeo.model.opposites import OPPOSITES
from toongeo.render import ScaledOrthographicCamera

FACE_PX = 250.0
UNSEEN = ("tongueOut", "mouthClose")  # by landmarks


def smooth_weights(rng, names, frames=60, active=8):
    """Weights (frames, k) of a lively face, 30 a second: ``active`` expressions swell and ebb at about 0.5 Hz."""
    t = np.arange(frames) / 30
    weights = np.zeros((frames, len(names)))
    for k in rng.choice(len(names), active, replace=False):
        wave = np.sin(2 * np.pi * (rng.uniform(0.2, 0.8) * t + rng.uniform()))
        weights[:, k] = np.clip(wave, 0, 1) * rng.uniform(0.5, 1)
    weights[:, [names.index(name) for name in UNSEEN]] = 0
    for pair in OPPOSITES:
        one, other = (names.index(name) for name in pair)
        weights[:, other] = np.where(weights[:, one] > 0, 0, weights[:, other])
    return weights


def film(avatar, weights, *, moving=True, vertices=None):
    """Landmarks (f, 68, 2) px of an avatar whose head turns by 20 degrees, nods, tilts, and comes near and far."""
    vertices = avatar.face.landmark_vertices if vertices is None else vertices
    width = np.ptp(avatar.rig.neutral[avatar.face.landmark_vertices, 0])
    frames = []
    for i, row in enumerate(weights):
        t = i / 30 if moving else 0.0
        camera = ScaledOrthographicCamera.look(
            yaw=20 * np.sin(1.7 * t),
            pitch=8 * np.sin(2 * t),
            roll=8 * np.sin(1.1 * t),
            size=600,
            extent=600 / FACE_PX * width * np.exp(0.2 * np.sin(t)),
        )
        frames.append(camera.project(avatar.vertices(row)[vertices]))
    return np.array(frames)


def moves_landmarks(avatar, px=3.0):
    """Which expressions move a landmark of a face 250 px wide by so much, seen from the front."""
    deltas = avatar.rig.deltas[:, avatar.face.landmark_vertices, :2]
    width = np.ptp(avatar.rig.neutral[avatar.face.landmark_vertices, 0])
    return np.linalg.norm(deltas, axis=2).max(axis=1) * FACE_PX / width > px


def rms(errors):
    return float(np.sqrt(np.mean(np.square(errors))))


@pytest.fixture(scope="session")
def performers(avatars):
    return {name: avatars(name) for name in ("moustache_man", "blue_girl", "astronaut")}
