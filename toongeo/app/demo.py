"""``toongeo demo``: the main job on a bundled picture."""

import time
from pathlib import Path

from toongeo.app.contact_sheet import contact_sheet
from toongeo.app.make import make
from toongeo.io import read_image, read_landmarks, write_image
from toongeo.model import data_path

__all__ = ["demo"]

_PICTURE = "examples/portraits/moustache_man"


def demo(folder: Path) -> None:
    """Write ``avatar.glb``, ``avatar.obj`` with its material and texture, and a contact sheet into a folder."""
    started = time.perf_counter()
    folder.mkdir(parents=True, exist_ok=True)
    image, landmarks = data_path(f"{_PICTURE}.png"), data_path(f"{_PICTURE}.pts")
    avatar = make(image, landmarks, folder / "avatar.glb")
    avatar.save(folder / "avatar.obj")
    write_image(folder / "contact-sheet.png", contact_sheet(avatar, read_image(image), read_landmarks(landmarks)))
    for path in sorted(folder.iterdir()):
        print(f"{path.stat().st_size / 1e6:7.2f} MB  {path}")
    print(
        f"{time.perf_counter() - started:.1f} s in all; drop avatar.glb into any glTF viewer, or open contact-sheet.png"
    )
