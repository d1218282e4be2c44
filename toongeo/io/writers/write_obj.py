"""A scene as Wavefront OBJ, for programs that keep no morph targets."""

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io.atomic_write import atomic_write
from toongeo.io.scene import Scene, SceneMesh
from toongeo.io.side_files import check_side_files, marked_picture, side_mark
from toongeo.reading.check_file import file_name

__all__ = ["write_obj"]


def write_obj(path: str | os.PathLike[str], scene: Scene) -> None:
    """Write ``face.obj`` and beside it ``face.mtl`` and the textures ``face_texture.png``, ``face_texture_1.png`` ...

    Every mesh is an object; its vertices keep their order and number (no seam is split), in mm and the model
    frame. Coordinates read back as the same floats. Targets, pivots and the animation are left out.

    Parameters
    ----------
    path
        File to write, ``.obj``. The names of the others have ``_`` for line breaks, with which a name would end inside
        the ``.obj``, and other characters that are not seen. They bear a mark, and of files that are there under their
        names only those with the mark of this ``.obj`` are replaced.
    scene
        Meshes with or without uv and texture.

    Raises
    ------
    ValueError
        If the suffix is not ``.obj``.
    FileExistsError
        If a material or texture would replace a file that was not written for this ``.obj``.
    OSError
        If one of the files cannot be written; then none is.
    """
    path = file_name(path)
    if path.suffix.lower() != ".obj":
        raise ValueError(f"path: expected a name that ends in .obj, got {path}")
    files = material_files(path, scene, path.name)
    check_side_files(files, path.name)
    vertices = ("\n".join(_rows("v", mesh.vertices)) for mesh in scene.meshes)
    # The .obj comes last: whoever sees it sees the files it names.
    atomic_write({**files, path: obj_text(obj_frames(scene, side_paths(path)[0].name), vertices)})


def side_paths(path: Path) -> list[Path]:
    """The files beside an ``.obj`` that every scene with one texture has: its materials and its texture."""
    stem = _visible(path.stem)
    return [path.with_name(f"{stem}.mtl"), path.with_name(f"{stem}_texture.png")]


def material_files(path: Path, scene: Scene, owner: str) -> dict[str | os.PathLike[str], bytes]:
    """Textures and materials beside an ``.obj``, with the mark of their owner."""
    library, texture = side_paths(path)
    pictures: dict[bytes, Path] = {}
    files: dict[str | os.PathLike[str], bytes] = {}
    materials = [f"# {side_mark(owner)}"]
    for number, mesh in enumerate(scene.meshes):
        materials += [f"newmtl material_{number}", f"Kd {' '.join(map(repr, mesh.color))}"]
        materials += ["Ks 0 0 0", "d 1", f"illum {0 if mesh.unlit else 1}"]
        if mesh.texture is None:
            continue
        key = str(mesh.texture.shape).encode() + mesh.texture.tobytes()
        if key not in pictures:
            pictures[key] = texture.with_stem(f"{texture.stem}_{len(pictures)}") if pictures else texture
            files[pictures[key]] = marked_picture(mesh.texture, owner)
        materials.append(f"map_Kd {pictures[key].name}")
    return {**files, library: ("\n".join(materials) + "\n").encode()}


def obj_text(frames: Iterable[tuple[str, str]], vertices: Iterable[str]) -> bytes:
    """An ``.obj``: the lines of the vertices of each mesh in their frame."""
    parts = [f"{before}{lines}\n{after}" for (before, after), lines in zip(frames, vertices, strict=True)]
    return "".join(parts).encode()


def obj_frames(scene: Scene, library: str) -> list[tuple[str, str]]:
    """What stands before and after the vertices of each mesh; ``library`` is the file of the materials."""
    frames: list[tuple[str, str]] = []
    start = f"# mm; +X the subject's left, +Y up, +Z out of the face\nmtllib {library}\n"
    vertex = uv = 1
    for number, mesh in enumerate(scene.meshes):
        before = f"{start}o {_token(mesh.name)}\nusemtl material_{number}\n"
        frames.append((before, "\n".join(_faces(mesh, vertex, uv)) + "\n"))
        start = ""
        vertex += len(mesh.vertices)
        uv += 0 if mesh.uv is None else len(mesh.uv)
    return frames


def _faces(mesh: SceneMesh, vertex: int, uv: int) -> Iterator[str]:
    """Lines of uv and faces of an object whose first vertex and uv have these (1-based) numbers in the file."""
    corners = (mesh.faces + vertex).tolist()
    yield "s 1"  # smooth shading, as no normals are written
    if mesh.uv is None or mesh.uv_faces is None:
        yield from (f"f {a} {b} {c}" for a, b, c in corners)
        return
    yield from _rows("vt", mesh.uv)
    for (a, b, c), (d, e, f) in zip(corners, (mesh.uv_faces + uv).tolist(), strict=True):
        yield f"f {a}/{d} {b}/{e} {c}/{f}"


def _rows(keyword: str, array: NDArray[np.floating]) -> Iterator[str]:
    for row in array.astype(np.float64).tolist():
        yield f"{keyword} {' '.join(map(repr, row))}"


def _visible(name: str) -> str:
    return "".join(letter if letter.isprintable() else "_" for letter in name)


def _token(name: str) -> str:
    """A name that ends where its line ends."""
    return "_".join(name.split()) or "object"
