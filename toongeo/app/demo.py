"""``toongeo demo``: the main job on a bundled picture, whose landmarks are found."""

import time
from pathlib import Path

from toongeo.app.contact_sheet import contact_sheet
from toongeo.app.landmark_source import LandmarkSource
from toongeo.app.make import make
from toongeo.io import read_image, write_image
from toongeo.model import data_path
from toongeo.pipeline import detect_landmarks

PICTURE = "examples/portraits/moustache_man.png"


def demo(folder: Path) -> None:
    """Write ``avatar.glb``, ``avatar.obj`` with its material and texture, and a contact sheet into a folder."""
    started = time.perf_counter()
    folder.mkdir(parents=True, exist_ok=True)
    image = data_path(PICTURE)
    img = read_image(image)
    avatar = make(image, folder / "avatar.glb", LandmarkSource())
    avatar.save(folder / "avatar.obj")
    write_image(folder / "contact-sheet.png", contact_sheet(avatar, img, detect_landmarks(img).points))
    for path in sorted(folder.iterdir()):
        print(f"{path.stat().st_size / 1e6:7.2f} MB  {path}")
    print(
        f"{time.perf_counter() - started:.1f} s in all; drop avatar.glb into any glTF viewer, or open contact-sheet.png"
    )
