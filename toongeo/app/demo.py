"""``toongeo demo``: the main job on a bundled picture, whose landmarks are found."""

import time
from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.contact_sheet import contact_sheet
from toongeo.app.make import make
from toongeo.app.making.head_jobs import HeadJob
from toongeo.io import atomic_write, read_image
from toongeo.io.side_files import check_side_files, marked_picture
from toongeo.model import data_path
from toongeo.pipeline import detect_landmarks

__all__ = ["demo"]

_PICTURE = "examples/portraits/moustache_man.png"
_GLB, _OBJ, _SHEET = "avatar.glb", "avatar.obj", "contact-sheet.png"
_OWNER = "toongeo demo"


def demo(folder: Path) -> None:
    """Write ``avatar.glb``, ``avatar.obj`` with its material and texture, and a contact sheet into a folder.

    Raises
    ------
    FileExistsError
        If one of the files is there, but not from an earlier demo; looked at before the work.
    OSError
        If the folder cannot be made or written to.
    """
    started = time.perf_counter()
    folder.mkdir(parents=True, exist_ok=True)
    _check_folder(folder)
    image = data_path(_PICTURE)
    img = read_image(image)
    made = make(HeadJob(image, folder / _GLB))
    avatar = made.avatar
    avatar.save(folder / _OBJ)
    sheet = contact_sheet(avatar, img, detect_landmarks(img).points, lines=made.lines())
    atomic_write({folder / _SHEET: marked_picture(sheet, _OWNER)})
    for path in sorted(folder.iterdir()):
        print(f"{path.stat().st_size / 1e6:7.2f} MB  {path}")
    print(
        f"{time.perf_counter() - started:.1f} s in all; drop avatar.glb into any glTF viewer, or open contact-sheet.png"
    )


def _check_folder(folder: Path) -> None:
    """Names that the user did not give may stand for other files; the sheet's mark tells that a demo wrote them."""
    check_side_files([folder / _SHEET], _OWNER)
    if not (folder / _SHEET).exists():
        check_side_files([folder / _GLB, folder / _OBJ], _OWNER)
    check_output(folder / _OBJ, {})
