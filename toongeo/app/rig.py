"""``toongeo rig``: a neutral head from anywhere into a file with its expressions."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from toongeo.app.check_output import check_output
from toongeo.app.commands.path_is import path_is
from toongeo.io import MESH_SUFFIXES, Scene, read_image, read_mesh, read_mesh_landmarks, write_glb
from toongeo.io.scene import METRES
from toongeo.pipeline import Rig, rig_mesh

__all__ = ["rig"]

_TOLERANCE = 1e-6  # of the head's size: displacements below it are not stored
_FAR = 10.0  # head sizes from the origin: beyond, its place goes into the nodes, since float32 would lose its shape
_UNCUT = (".obj", ".off")  # say which corners are one vertex; the others repeat vertices along seams


def rig(mesh: Path, landmarks: Path, output: Path, *, texture: Path | None = None) -> Rig:
    """Read a mesh and its landmarks, rig it, and write it with its morph targets.

    Parameters
    ----------
    mesh : Path
        ``.obj``, ``.ply``, ``.stl``, ``.off`` or ``.glb`` of a neutral head; see :func:`toongeo.io.read_mesh`.
    landmarks : Path
        See :func:`toongeo.io.read_mesh_landmarks`. Vertices are counted through all meshes of the file.
    output : Path
        ``.glb``. Its coordinates are those of the mesh file, and so are its texture coordinates, textures, and the
        order of its vertices.
    texture : Path, optional
        Picture for the texture coordinates, in place of that of the file.

    Raises
    ------
    ValueError, OSError
        For bad input or an output that cannot be written or is a file that is read; the output is checked before the
        work.
    """
    if output.suffix.lower() != ".glb":
        raise ValueError(f"output: expected a name that ends in .glb, got {output}")
    check_output(output, {"mesh": mesh, "landmarks": landmarks, "texture": texture})
    if mesh.suffix.lower() not in MESH_SUFFIXES:
        raise ValueError(f"mesh: expected a name that ends in {', '.join(MESH_SUFFIXES)}, got {mesh}")
    with path_is("mesh"):
        parts = read_mesh(mesh).meshes
    if texture is not None:
        if any(part.uv is None for part in parts):
            raise ValueError(f"texture: expected a mesh with texture coordinates at every corner, got {mesh} without")
        with path_is("texture"):
            picture = read_image(texture)
        parts = tuple(replace(part, texture=picture) for part in parts)
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    vertices = np.vstack([part.vertices for part in parts])
    faces = np.vstack([part.faces + start for part, start in zip(parts, starts, strict=False)])
    weld = mesh.suffix.lower() not in _UNCUT
    with path_is("landmarks"):
        points = read_mesh_landmarks(landmarks, vertices)
    found = rig_mesh(vertices, faces, points, weld=weld)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    middle, size = (low + high) / 2, float(np.linalg.norm(high - low))
    near = np.abs(middle).max() <= _FAR * size
    rigged = [
        replace(
            part,
            name="head" if len(parts) == 1 else part.name,
            vertices=part.vertices / METRES,
            pivot=None if near else middle / METRES,
            targets=found.deltas[:, start : start + len(part.vertices)].astype(np.float64) / METRES,
            target_names=found.names,
        )
        for part, start in zip(parts, starts, strict=False)
    ]
    write_glb(output, Scene(tuple(rigged)), tolerance_mm=_TOLERANCE * size / METRES)
    report = found.report
    print(f"{len(found.names)} expressions on {len(vertices)} vertices in {report.seconds:.1f} s")
    print(f"{report.matched:.1%} of the template's face found a partner, mean distance {report.distance:.3g}")
    if report.mouth_opens is False:
        print("warning: the mouth does not open: upper and lower lip are one surface, which expressions stretch")
    print(f"wrote {output}")
    return found
