"""Frames of a film: CPU milliseconds to draw and to encode one, and how near it is to the picture of `Avatar.render`.

usage: python benchmarks/films.py [PICTURE ...]     (default: astronaut and moustache_man of examples/portraits)

A take of two seconds at 512 px, in which jaw, lids, gaze and head move. Every time is the least of the frames, in one
process; PSNR is the least over them. "bound" is what these times leave at best on two cores, frames a second: all
frames are drawn on both, and encoded on one of them. The rival is `Avatar.render`, from whose picture frames differ
only where texture is minified. With --drive the command itself is run, and its frames a second counted by the clock.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
from pictures import FOLDER, roles

from toongeo import make_avatar, read_image, read_landmarks
from toongeo.app import drive
from toongeo.app.read_take import TakeSource
from toongeo.app.video import write_video as videos
from toongeo.app.video.film_options import FilmOptions
from toongeo.driving import AvatarPuppet, Take, write_live_link
from toongeo.io import has_pyav
from toongeo.model.expression_schemes import EXPRESSIONS

SIZE, FPS, COUNT = 512, 30, 60
HEAD = (
    "| picture | frame ms | `Avatar.render` ms | ratio | PSNR to it dB | `.mp4` / `.webm` by PyAV ms, MB "
    "| by OpenCV ms, MB | bound, frames/s: PyAV | OpenCV |"
)
KINDS = [(suffix, pyav) for pyav in ((False, True) if has_pyav() else (False,)) for suffix in (".mp4", ".webm")]


def performance() -> Take:
    times = np.arange(COUNT) / FPS
    weights = np.zeros((COUNT, len(EXPRESSIONS)))
    weights[:, EXPRESSIONS.index("jawOpen")] = 0.4 - 0.4 * np.cos(6 * times)
    weights[:, EXPRESSIONS.index("eyeBlinkLeft")] = (times % 1 < 0.15).astype(float)
    weights[:, EXPRESSIONS.index("eyeLookUpLeft")] = 0.5 + 0.5 * np.sin(5 * times)
    head = np.column_stack([0.4 * np.sin(3 * times), 0.15 * np.sin(4 * times), 0.1 * np.sin(5 * times)])
    return Take(times, weights, head)


def seconds(act, *arguments):
    start = time.process_time()
    result = act(*arguments)
    return time.process_time() - start, result


def psnr(a, b):
    return 10 * np.log10(255**2 / max(((a.astype(float) - b) ** 2).mean(), 1e-9))


def encoded(frames, suffix, pyav, folder):
    videos.has_pyav = lambda: pyav
    start = time.process_time()
    videos.write_video(Path(folder) / f"a{suffix}", frames, SIZE, FPS)
    return (time.process_time() - start) / len(frames), os.path.getsize(Path(folder) / f"a{suffix}")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("pictures", nargs="*", default=["astronaut", "moustache_man"])
    parser.add_argument("--drive", action="store_true")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    take = performance()
    names = [Path(name).stem for name in options.pictures]
    rows, clock = [], []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            avatar = make_avatar(read_image(FOLDER / f"{name}.png"), read_landmarks(FOLDER / f"{name}.pts"))
            puppet = AvatarPuppet(avatar, SIZE)
            plain = [seconds(avatar.render, row, SIZE) for row in take.weights[:4]]
            still = [puppet.frame(row) for row in take.weights[:4]]
            near = min(psnr(frame, picture) for frame, (_, picture) in zip(still, plain, strict=True))
            drawn = [seconds(puppet.frame, row, head) for row, head in zip(take.weights, take.head, strict=True)]
            ms = 1e3 * min(took for took, _ in drawn)
            rival = 1e3 * min(took for took, _ in plain)
            cells, bounds = {}, {}
            for suffix, pyav in KINDS:
                coding, size = encoded([frame for _, frame in drawn], suffix, pyav, folder)
                cells.setdefault(pyav, []).append(f"{1e3 * coding:.0f}, {size / 1e6:.2f}")
                bounds.setdefault(pyav, []).append(f"{2 / (1e-3 * ms + coding):.0f}")
            columns = [" / ".join(each.get(pyav, ["-"])) for each in (cells, bounds) for pyav in (True, False)]
            columns = [f"{ms:.0f}", f"{rival:.0f}", f"{ms / rival:.2f}", f"{near:.1f}", *columns]
            rows.append(f"| {name}{'' if avatar.hair is None else ' (hair)'} | " + " | ".join(columns) + " |")
            if options.drive:
                avatar.save(Path(folder) / "face.glb")
                write_live_link(Path(folder) / "take.csv", Take(take.times * 5, take.weights, take.head))
                start = time.perf_counter()
                source = TakeSource(weights=Path(folder) / "take.csv")
                drive.drive(Path(folder) / "face.glb", Path(folder) / "film.mp4", source, FilmOptions(SIZE, FPS))
                clock.append(
                    f"drive, {name}: {(5 * (COUNT - 1) + 1) / (time.perf_counter() - start):.1f} frames/s by the clock"
                )
    print("\n".join([HEAD, "|---" * 9 + "|", *rows, "", *clock, roles("films", names)]))


if __name__ == "__main__":
    main()
