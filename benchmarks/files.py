"""Sizes of an avatar's files, and what saving and loading takes.

usage: python benchmarks/files.py [PICTURE ...]     (default: every picture of examples/portraits)

Each picture has its landmarks beside it (.pts). Sizes are in 10^6 bytes, the largest and the smallest of the pictures.
"46 + eyes" is a file of all targets, without texture, clip and what only load_avatar reads. The rival is the same
file with every displacement stored, which is what trimesh or pygltflib users write; times are CPU seconds, the best of
three, of the last picture. Beside a file that loads stands how far (mm) the farthest vertex of any expression is off.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import importlib.util
import tempfile
import time
from pathlib import Path

import numpy as np
from pictures import FOLDER, roles

from toongeo import load_avatar, make_avatar, read_image, read_landmarks

BARE = {"texture": None, "animation": None, "loadable": False}
FILES = {
    "46 + eyes, sparse (goal 8)": ("a.glb", BARE),
    "46 + eyes, quantized (goal 3.5)": ("a.glb", {**BARE, "quantize": True}),
    "46 + eyes, dense (rival)": ("a.glb", {**BARE, "sparse": False}),
    "the same, loadable, sparse": ("a.glb", {"texture": None, "animation": None}),
    "the same, loadable, quantized": ("a.glb", {"texture": None, "animation": None, "quantize": True}),
    "default .glb": ("a.glb", {}),
    "quantized, JPEG": ("a.glb", {"quantize": True, "texture": "jpeg"}),
    "with normals": ("a.glb", {"normals": True}),
    "52 names of ARKit": ("a.glb", {"names": "arkit"}),
    "TalkingHead's 72": ("a.glb", {"names": "talkinghead"}),
    ".vrm": ("a.vrm", {}),
    ".usdz": ("a.usdz", {}),
    ".html": ("a.html", {}),
    ".obj": ("a.obj", {}),
    ".ply": ("a.ply", {}),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("pictures", nargs="*", type=Path, default=sorted(FOLDER.glob("*.png")))
    paths = parser.parse_args().pictures
    avatars = [make_avatar(read_image(p), read_landmarks(p.with_suffix(".pts"))) for p in paths]
    print("| file | MB, most | MB, least | save s | load s | off mm |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for label, (name, options) in FILES.items():
            if name.endswith(".usdz") and importlib.util.find_spec("pxr") is None:
                continue
            print(row(label, avatars, Path(folder) / name, options), flush=True)
    print(roles("files", [path.stem for path in paths]))


def row(label: str, avatars: list, path: Path, options: dict) -> str:
    sizes = []
    for avatar in avatars:
        avatar.save(path, **options)
        sizes.append(path.stat().st_size / 1e6)
    saving = seconds(lambda: avatar.save(path, **options))
    line = f"| {label} | {max(sizes):.2f} | {min(sizes):.2f} | {saving:.2f} |"
    if path.suffix != ".glb" or options.get("loadable") is False or "names" in options:
        return f"{line} | |"
    loaded = load_avatar(path)
    pairs = ((avatar.rig.neutral, loaded.rig.neutral), (avatar.rig.deltas, loaded.rig.deltas))
    off = sum(np.linalg.norm(a - b, axis=-1).max() for a, b in pairs)
    return f"{line} {seconds(lambda: load_avatar(path)):.2f} | {off:.5f} |"


def seconds(work, repeats: int = 3) -> float:
    best = np.inf
    for _ in range(repeats):
        started = time.process_time()
        work()
        best = min(best, time.process_time() - started)
    return best


if __name__ == "__main__":
    main()
