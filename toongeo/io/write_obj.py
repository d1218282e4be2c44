"""A scene as Wavefront OBJ, for programs that keep no morph targets."""

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io.atomic_write import atomic_write
from toongeo.io.encode_image import encode_image
from toongeo.io.scene import Scene, SceneMesh

__all__ = ["write_obj"]


def write_obj(path: str | os.PathLike[str], scene: Scene) -> None:
    """Write ``face.obj``, ``face.mtl`` and the textures ``face.png``, ``face_1.png`` ... beside each other.

    Every mesh is an object; its vertices keep their order and number (no seam is split), in mm and the model
    frame. Coordinates read back as the same floats. Targets, pivots and the animation are left out.

    Parameters
    ----------
    path
        File to write, ``.obj``. Files of the other names are replaced.
    scene
        Meshes with or without uv and texture.

    Raises
    ------
    ValueError
        If the suffix is not ``.obj``.
    OSError
        If one of the files cannot be written; then none is.
    """
    path = Path(path)
    if path.suffix.lower() != ".obj":
        raise ValueError(f"path: expected a name that ends in .obj, got {path}")
    atomic_write(obj_files(path, scene))


def obj_files(path: Path, scene: Scene) -> dict[str | os.PathLike[str], bytes]:
    """The files by path; the ``.obj`` last: whoever sees it sees the files it names."""
    pictures: dict[bytes, str] = {}
    files: dict[str | os.PathLike[str], bytes] = {}
    materials: list[str] = []
    for number, mesh in enumerate(scene.meshes):
        materials += _material(f"material_{number}", mesh, path.stem, pictures, files, path.parent)
    files[path.with_suffix(".mtl")] = ("\n".join(materials) + "\n").encode()
    files[path] = obj_text(scene, f"{path.stem}.mtl", [mesh.vertices for mesh in scene.meshes])
    return files


def obj_text(scene: Scene, library: str, vertices: Sequence[NDArray[np.floating]]) -> bytes:
    """An ``.obj`` of the scene with these vertices for its meshes, and the materials of a library."""
    lines = ["# mm; +X the subject's left, +Y up, +Z out of the face", f"mtllib {library}"]
    first = uv = 1
    for number, (mesh, points) in enumerate(zip(scene.meshes, vertices, strict=True)):
        lines += [f"o {_token(mesh.name)}", f"usemtl material_{number}", *_geometry(mesh, points, first, uv)]
        first += len(points)
        uv += 0 if mesh.uv is None else len(mesh.uv)
    return ("\n".join(lines) + "\n").encode()


def _geometry(mesh: SceneMesh, vertices: NDArray[np.floating], vertex: int, uv: int) -> Iterator[str]:
    """Lines of one object whose first vertex and uv have these (1-based) numbers in the file."""
    yield from _rows("v", vertices)
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


def _material(
    name: str,
    mesh: SceneMesh,
    stem: str,
    pictures: dict[bytes, str],
    files: dict[str | os.PathLike[str], bytes],
    folder: Path,
) -> list[str]:
    lines = [f"newmtl {name}", f"Kd {' '.join(map(repr, mesh.color))}", "Ks 0 0 0", "d 1", "illum 1"]
    if mesh.texture is not None:
        key = str(mesh.texture.shape).encode() + mesh.texture.tobytes()
        if key not in pictures:
            pictures[key] = f"{stem}_{len(pictures)}.png" if pictures else f"{stem}.png"
            files[folder / pictures[key]] = encode_image(mesh.texture)
        lines.append(f"map_Kd {pictures[key]}")
    return lines


def _token(name: str) -> str:
    """A name that ends where its line ends."""
    return "_".join(name.split()) or "object"
