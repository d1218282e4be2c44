"""Films of an avatar, of which every weight and every landmark is known."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.render import ScaledOrthographicCamera

BLINK = 0.2  # s, once a second


@dataclass(frozen=True, eq=False)
class Film:
    """Frames (f, size, size, 3) uint8 RGB, landmarks (f, 68, 2) px, weights (f, 46), where the face is hidden (f,)."""

    frames: np.ndarray
    landmarks: np.ndarray
    weights: np.ndarray
    hidden: np.ndarray
    fps: float


def filmed(avatar, seconds=3.0, *, fps=15.0, size=320, still=False, noise=4.0, hidden=(1.6, 2.0), seed=0):
    """An actor who talks, smiles, raises the brows and blinks once a second, turns the head, under a light that
    wanders; a board passes before the face for a while (s), and the camera is noisy (grey levels).

    A `still` actor only sits there.
    """
    rng = np.random.default_rng(seed)
    wall = cv2.resize(rng.integers(60, 150, (9, 9, 3), dtype=np.uint8), (size, size), interpolation=cv2.INTER_CUBIC)
    width = np.ptp(avatar.rig.neutral[avatar.face.landmark_vertices, 0])
    times = np.arange(round(seconds * fps)) / fps
    frames, landmarks, rows, covered = [], [], [], []
    for t in times:
        weights = {} if still else acted(t)
        row = np.zeros(len(avatar.names))
        row[[avatar.names.index(name) for name in weights]] = list(weights.values())
        wave = 0.0 if still else np.sin(2 * np.pi * t / 3)
        camera = ScaledOrthographicCamera.look(
            yaw=15 * wave, pitch=4 * wave, roll=6 * wave, size=size, extent=2.1 * width, centre=(8 * wave, -20, 0)
        )
        picture = avatar.render(row, size, camera=camera).astype(np.float64)
        empty = (picture == picture[0, 0]).all(axis=2)
        picture[empty] = wall[empty]
        light = 1 + 0.15 * np.sin(2 * t) * (np.arange(size) / size - 0.5)
        picture = picture * light[None, :, None] * (1 + 0.05 * np.sin(3 * t))
        is_hidden = hidden is not None and hidden[0] <= t < hidden[1]
        if is_hidden:
            picture[size // 8 : size * 7 // 8, size // 5 : size * 4 // 5] = (90, 110, 80)
        picture += rng.normal(0, noise, picture.shape)
        frames.append(np.clip(np.rint(picture), 0, 255).astype(np.uint8))
        landmarks.append(camera.project(avatar.vertices(row)[avatar.face.landmark_vertices]))
        rows.append(row)
        covered.append(is_hidden)
    return Film(np.array(frames), np.array(landmarks), np.array(rows), np.array(covered), fps)


def acted(t):
    """Weights by name at a time in s."""
    blink = max(0.0, 1 - abs(t % 1 - 0.6) / (BLINK / 2))
    smile = max(0.0, np.sin(2 * np.pi * (t - 0.4) / 3)) * 0.8
    brow = max(0.0, -np.sin(2 * np.pi * (t - 0.2) / 2.5)) * 0.8
    return {
        "jawOpen": 0.5 * max(0.0, np.sin(2 * np.pi * (t - 0.2) / 1.5)),
        **{f"mouthSmile{side}": smile for side in ("Left", "Right")},
        **{f"browInnerUp{side}": brow for side in ("Left", "Right")},
        **{f"browOuterUp{side}": brow for side in ("Left", "Right")},
        **{f"eyeBlink{side}": blink for side in ("Left", "Right")},
    }
