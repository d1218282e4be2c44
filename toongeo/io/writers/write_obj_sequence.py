"""A scene as a folder of OBJ files, one a target."""

import os
import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io.atomic_write import atomic_write
from toongeo.io.scene import Scene
from toongeo.io.side_files import check_side_files, side_mark
from toongeo.io.writers.write_obj import material_files, obj_frames, obj_text

__all__ = ["SEQUENCE", "write_obj_sequence"]

SEQUENCE = "a sequence of OBJ files"  # that the files of the folder were written for
_DECIMALS = 5  # of a mm, as float32 has at the crown of a head


def write_obj_sequence(folder: str | os.PathLike[str], scene: Scene, *, stem: str = "face") -> None:
    """Write ``000_neutral.obj`` and ``001_jawOpen.obj`` ... for every target, ``face.mtl`` and ``face_texture.png`` ...

    All files have the same vertices and faces in the same order, so programs can blend between them. Of a target that
    several meshes have, all move. Coordinates are rounded to 1e-5 mm. Characters of names that are not letters, digits,
    ``-`` or ``_`` become ``_``.

    Parameters
    ----------
    folder
        Is made if it is not there. All files in it bear a mark, and of those that are there under their names only
        marked ones are replaced.
    scene
        Model frame, mm.
    stem
        Of the ``.mtl`` and the textures.

    Raises
    ------
    ValueError
        If the stem is not of letters, digits, ``-`` and ``_``.
    FileExistsError
        If a file of one of the names is there that no such sequence has.
    OSError
        If the folder cannot be made or a file cannot be written; then none is.

    Examples
    --------
    >>> import tempfile
    >>> from toongeo.io import SceneMesh
    >>> up = {"targets": np.ones((1, 3, 3)), "target_names": ("up",)}
    >>> folder = Path(tempfile.mkdtemp())
    >>> write_obj_sequence(folder, Scene((SceneMesh("triangle", np.eye(3), np.array([[0, 1, 2]]), **up),)))
    >>> sorted(path.name for path in folder.iterdir())
    ['000_neutral.obj', '001_up.obj', 'face.mtl']
    """
    if not re.fullmatch(r"[\w-]+", stem, re.ASCII):
        raise ValueError(f"stem: expected letters, digits, - and _, got {stem!r}")
    folder = Path(folder)
    files = _files(folder, scene, stem)
    check_side_files(files, SEQUENCE)
    new = not folder.exists()
    try:
        folder.mkdir(exist_ok=True)
        atomic_write(files)
    except OSError as error:
        if new and folder.is_dir():
            folder.rmdir()
        raise OSError(error.errno, f"cannot write to {folder}: {error.strerror}") from error


def _files(folder: Path, scene: Scene, stem: str) -> dict[str | os.PathLike[str], bytes]:
    files = material_files(folder / f"{stem}.obj", scene, SEQUENCE)
    frames = obj_frames(scene, f"{stem}.mtl")
    names = list(dict.fromkeys(name for mesh in scene.meshes for name in mesh.target_names))
    for number, name in enumerate(["neutral", *names]):
        weights = {} if number == 0 else {name: 1.0}
        safe = re.sub(r"[^\w-]", "_", name, flags=re.ASCII)[:80]
        lines = (_vertices(mesh.moved(weights)) for mesh in scene.meshes)
        text = obj_text(frames, lines)
        files[folder / f"{number:03}_{safe}.obj"] = f"# {side_mark(SEQUENCE)}\n".encode() + text
    return files


def _vertices(points: NDArray[np.floating]) -> str:
    row = f"v %.{_DECIMALS}f %.{_DECIMALS}f %.{_DECIMALS}f"
    return "\n".join([row] * len(points)) % tuple(points.ravel().tolist())
