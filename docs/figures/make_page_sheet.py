"""The page of an avatar on a desk and on a phone held both ways, as one small JPEG beside this script.

usage: python docs/figures/make_page_sheet.py
(needs Chromium, and `npm ci --prefix tests/web`)
"""

import json
import subprocess
import tempfile
from pathlib import Path

import cv2
import numpy as np

from toongeo import make_avatar, read_image, read_landmarks
from toongeo.io import write_image

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PORTRAITS = ROOT / "examples" / "portraits"
READY = {"wait": "document.documentElement.dataset.ready === 'true'"}
SMILE = {"click": "#presets button:text-is('Smile')"}
GROUND = 128
GAP = 12  # px
HEIGHT = 480  # px


def shots(page: Path, folder: Path) -> list[np.ndarray]:
    """Desk, upright phone with the sheet folded and unfolded, phone on its side."""
    steps = [
        *(READY, {"size": [1100, 700]}, SMILE, {"page": "desk.png"}),
        *({"size": [390, 844]}, {"page": "open.png"}, {"click": "#sheet"}, {"page": "folded.png"}),
        *({"size": [844, 390]}, {"click": "#sheet"}, {"page": "side.png"}),
    ]
    (folder / "steps.json").write_text(json.dumps(steps))
    script = ROOT / "tests" / "web" / "browse.mjs"
    subprocess.run(["node", script, page.as_uri(), folder / "steps.json", folder], check=True, capture_output=True)
    return [read_image(folder / f"{name}.png") for name in ("desk", "folded", "open", "side")]


def scaled(img: np.ndarray) -> np.ndarray:
    """Of one height, with a gap on its right."""
    small = cv2.resize(img, None, fx=HEIGHT / len(img), fy=HEIGHT / len(img), interpolation=cv2.INTER_AREA)
    return np.pad(small, ((0, 0), (0, GAP), (0, 0)), constant_values=GROUND)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        avatar = make_avatar(
            read_image(PORTRAITS / "moustache_man.png"), read_landmarks(PORTRAITS / "moustache_man.pts")
        )
        avatar.save(folder / "Moustache man.html", texture="jpeg")
        desk, folded, unfolded, side = shots(folder / "Moustache man.html", folder)
    phones = np.hstack([scaled(folded), scaled(unfolded)])
    desk = scaled(desk)
    flat = cv2.resize(side, (phones.shape[1] - GAP, round(len(side) * (phones.shape[1] - GAP) / side.shape[1])))
    flat = np.pad(flat, ((GAP, 0), (0, GAP), (0, 0)), constant_values=GROUND)
    right = np.vstack([phones, flat])
    left = cv2.resize(desk, None, fx=len(right) / len(desk), fy=len(right) / len(desk), interpolation=cv2.INTER_AREA)
    sheet = np.hstack([left, right])[:, :-GAP]
    write_image(HERE / "page.jpg", sheet, quality=68)


if __name__ == "__main__":
    main()
