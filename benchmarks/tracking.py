"""Faces followed through films of avatars: how exact, how quiet, how fast, and how soon found again.

usage: python benchmarks/tracking.py [NAME ...]
(of the bundled examples; default: astronaut moustache_man beethoven blue_girl)

Each avatar acts for 3 s at 15 frames a second, 320 px: it talks, smiles, raises the brows, blinks once a second, turns
the head by 15 degrees, under light that wanders and with noise of 4 grey levels; a board hides it for 0.4 s. Another
film shows it sitting still for 2 s. The rival looks at each frame by itself (`detect_faces`); its weights are read in
the same way. `zero` are the weights of a driver that does nothing.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import cv2
import numpy as np
from pictures import pictures, roles

from tests.driving.conftest import moves_landmarks, rms
from tests.filmed import Film, filmed
from toongeo import (
    LandmarkDriver,
    LandmarkTracker,
    LiveVideo,
    VideoDriver,
    detect_faces,
    make_avatar,
    read_image,
    read_landmarks,
    track_landmarks,
)
from toongeo.driving.video_driver import CAUTION
from toongeo.metrics import landmark_error

DEFAULT = ("astronaut", "moustache_man", "beethoven", "blue_girl")
HEADING = (
    "film",
    "who",
    "error",
    "lost: seen, hidden",
    "found after",
    "weights",
    "acted",
    "zero",
    "still",
    "ms a frame",
)


def main() -> None:
    cv2.setNumThreads(1)
    names = sys.argv[1:] or DEFAULT
    print(f"| {' | '.join(HEADING)} |\n|{'---|' * len(HEADING)}")
    for picture in pictures():
        if picture.name in names:
            avatar = make_avatar(read_image(picture.image), read_landmarks(picture.landmarks))
            acting, still = filmed(avatar), filmed(avatar, 2.0, still=True, hidden=None)
            moving = moves_landmarks(avatar)
            for who in (video_driver, video_driver_told, live_video, followed, followed_live, looked_at_singly):
                print(row(picture.name, who, acting, still, moving), flush=True)
    print(roles("tracking", names))


Seen = tuple[np.ndarray, np.ndarray]  # points (f, 68, 2) px, NaN where lost, and weights (f, 46)


def video_driver(film: Film) -> Seen:
    return track_landmarks(film.frames, fps=film.fps).seen, VideoDriver().frames(film.frames, film.fps)[:, :46]


def video_driver_told(film: Film) -> Seen:
    """Which frame is neutral, as ``toongeo drive --neutral`` says it."""
    driver = VideoDriver(neutral=at_rest(film) / film.fps)
    return track_landmarks(film.frames, fps=film.fps).seen, driver.frames(film.frames, film.fps)[:, :46]


def at_rest(film: Film) -> int:
    """The frame of least expression."""
    return int(np.argmin(film.weights.sum(axis=1) + film.hidden * 1e3))


def live_video(film: Film) -> Seen:
    """After a moment at rest: the frame of least expression, noisy."""
    rng, live, rows = np.random.default_rng(1), LiveVideo(), []
    frames = [film.frames[at_rest(film)]] * 8
    frames = [np.clip(frame + rng.normal(0, 4, frame.shape), 0, 255).astype(np.uint8) for frame in frames]
    for k, frame in enumerate([*frames, *film.frames]):
        rows.append(live(frame, k / film.fps)[:46])
    return live_points(film), np.array(rows[len(frames) :])


def live_points(film: Film) -> np.ndarray:
    """As a camera needs it: quick passes."""
    tracker = LandmarkTracker()
    faces = [tracker.track(frame, k / film.fps) for k, frame in enumerate(film.frames)]
    return np.array([np.full((68, 2), np.nan) if face.lost else face.points for face in faces])


def followed(film: Film) -> Seen:
    return by_landmarks(track_landmarks(film.frames, fps=film.fps).seen, film)


def followed_live(film: Film) -> Seen:
    return by_landmarks(live_points(film), film)


def looked_at_singly(film: Film) -> Seen:
    found = [detect_faces(frame) for frame in film.frames]
    points = [faces[0].points if faces else np.full((68, 2), np.nan) for faces in found]
    return by_landmarks(np.array(points), film)


def by_landmarks(points: np.ndarray, film: Film) -> Seen:
    return points, LandmarkDriver(caution=CAUTION).frames(points, film.fps)[:, :46]


def row(name: str, who, acting: Film, still: Film, moving: np.ndarray) -> str:
    started = time.process_time()
    points, weights = who(acting)
    ms = (time.process_time() - started) / len(points) * 1e3
    lost, seen = np.isnan(points).any(axis=(1, 2)), ~acting.hidden
    error = np.mean(
        [
            landmark_error(found, truth)["inner51"]
            for found, truth in zip(points[seen & ~lost], acting.landmarks[seen & ~lost], strict=True)
        ]
    )
    back = np.flatnonzero(acting.hidden)[-1] + 1
    wait = float(np.argmax(~lost[back:])) / acting.fps
    wrong = (weights - acting.weights)[seen]
    acted = acting.weights.any(axis=0)
    quiet = who(still)[1].std(axis=0).max()
    cells = (
        name,
        who.__name__.replace("_", " "),
        f"{error:.4f}",
        f"{(lost & seen).sum()} of {seen.sum()}, {(lost & ~seen).sum()} of {(~seen).sum()}",
        f"{wait:.2f} s",
        f"{rms(wrong[:, moving]):.3f}",
        f"{rms(wrong[:, acted]):.3f}",
        f"{rms(acting.weights[seen][:, moving]):.3f}, {rms(acting.weights[seen][:, acted]):.3f}",
        f"{quiet:.4f}",
        f"{ms:.0f}",
    )
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
