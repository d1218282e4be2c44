"""Weights from landmarks: how exact, how quiet, how fast; and how many messages a second a page takes.

usage: python benchmarks/driving.py [FOLDER OF PICTURES AND LANDMARKS ...]
       python benchmarks/driving.py --page

For each head: landmarks are projected from known weights (60 frames, 8 expressions that swell and ebb, the head turning
by 20 degrees and scaled by 0.8 to 1.2), and read again. RMS over the expressions that move a landmark by 3 px on a face
250 px wide. The rival is scipy.optimize.least_squares on the same bounded problem, with the same Jacobian.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from pictures import FOLDER, pictures, roles
from scipy.optimize import least_squares

from tests.driving.conftest import film, moves_landmarks, rms, smooth_weights
from toongeo import make_avatar, read_image, read_landmarks
from toongeo.driving import LandmarkDriver, LandmarkRig, send_weights
from toongeo.driving.landmarks.landmark_pose import _jacobian, landmark_pose
from toongeo.geometry.rotations.rotation_vectors import rotation_matrix

ROOT = Path(__file__).parents[1]
RIVAL_FRAMES = 5


def main() -> None:
    if sys.argv[1:] == ["--page"]:
        page()
        return
    found = pictures(sys.argv[1:])
    print("| head | known performer | only a neutral frame known ", end="")
    print("| 1/3 px noise | still, 1 px: max s.d. | ms a frame | `least_squares`, times ours |")
    print("|---|---|---|---|---|---|---|")
    for picture in found:
        print(row(picture.name, read_image(picture.image), read_landmarks(picture.landmarks)), flush=True)
    print(roles("driving", [picture.name for picture in found]))


def row(name: str, img: np.ndarray, landmarks: np.ndarray) -> str:
    avatar = make_avatar(img, landmarks)
    rng = np.random.default_rng(7)
    weights = smooth_weights(rng, avatar.names)
    moving = moves_landmarks(avatar)
    frames = film(avatar, weights)

    def error(driver: LandmarkDriver, seen: np.ndarray) -> float:
        return rms((driver.frames(seen)[:, :46] - weights)[:, moving])

    driver = LandmarkDriver(avatar)
    neutral = LandmarkDriver(film(avatar, np.zeros((1, 46)))[0])
    still = film(avatar, np.zeros((90, 46)), moving=False)
    jitter = driver.frames(still + rng.standard_normal(still.shape)).std(axis=0).max()
    noisy = error(driver, frames + rng.normal(0, 1 / 3, frames.shape))
    started = time.process_time()
    known = error(driver, frames)
    ours = (time.process_time() - started) / len(frames) * 1e3
    single, rival = against_scipy(avatar, frames[:RIVAL_FRAMES])
    return (
        f"| {name} | {known:.4f} | {error(neutral, frames):.3f} | {noisy:.3f} | {jitter:.4f} | {ours:.1f} "
        f"| {rival / single:.0f} |"
    )


def against_scipy(avatar, frames: np.ndarray) -> tuple[float, float]:
    """Milliseconds a frame of one solve: ours, and scipy's trust region."""
    rig = LandmarkRig.of_rig(avatar.rig, avatar.face.landmark_vertices)
    k, noise = len(rig.names), 1e-3
    started = time.process_time()
    poses = [landmark_pose(rig, frame, np.zeros(k), noise) for frame in frames]
    ours = time.process_time() - started

    started = time.process_time()
    for frame, pose in zip(frames, poses, strict=True):

        def posed(x: np.ndarray, start=pose):
            turned = rotation_matrix(x[k : k + 3]) @ start.rotation
            scale = start.scale * np.exp(x[k + 3])
            return type(start)(x[:k], scale, turned, start.translation + x[k + 4 :] * [1, -1] * start.scale * rig.width)

        def residual(x: np.ndarray, seen=frame):
            return np.r_[posed(x).errors(seen, rig).ravel() / noise, x[:k]]

        def slope(x: np.ndarray):
            return np.vstack([-_jacobian(rig, posed(x)).reshape(136, -1) / noise, np.eye(k, k + 6)])

        bounds = np.r_[np.zeros(k), np.full(6, -np.inf)], np.r_[np.ones(k), np.full(6, np.inf)]
        least_squares(residual, np.r_[np.full(k, 0.01), np.zeros(6)], slope, bounds=bounds, max_nfev=200)
    rival = time.process_time() - started
    return ours / len(frames) * 1e3, rival / len(frames) * 1e3


def page() -> None:
    """1,000 messages to a page in headless Chromium, of a few weights and of all."""
    from tests.app.running import running

    avatar = make_avatar(read_image(FOLDER / "blue_girl.png"), read_landmarks(FOLDER / "blue_girl.pts"))
    with tempfile.TemporaryDirectory() as folder:
        glb, steps = Path(folder) / "face.glb", Path(folder) / "steps.json"
        avatar.save(glb, loadable=False, quantize=True, animation=None)
        steps.write_text('[{"wait": "window.toongeo?.weights().jawOpen === 1"}]')
        with running(glb) as server:
            command = ["node", str(ROOT / "tests" / "web" / "browse.mjs"), server.url, str(steps), folder]
            browser = subprocess.Popen(command, stdout=subprocess.DEVNULL)
            while not server.pages:
                threading.Event().wait(0.1)
            threading.Event().wait(2.0)
            for label, frames in (
                ("2 weights", [{"jawOpen": i / 2000, "eyeBlinkLeft": 0.5} for i in range(1000)]),
                ("54 weights", [np.full(len(server.names), i / 2000) for i in range(1000)]),
            ):
                started = time.perf_counter()
                applied = send_weights(server.source_url, frames)
                seconds = time.perf_counter() - started
                print(f"{label}: {applied} messages acknowledged in {seconds:.2f} s, {applied / seconds:.0f}/s")
            send_weights(server.source_url, [{"jawOpen": 1}])
            browser.wait(60)


if __name__ == "__main__":
    main()
