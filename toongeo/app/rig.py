"""``toongeo rig``: a neutral head from anywhere into a file with its expressions."""

from pathlib import Path

import numpy as np

from toongeo.app.check_output import check_output
from toongeo.io import Scene, SceneMesh, read_image, read_mesh_landmarks, read_obj, write_glb
from toongeo.io.scene import METRES
from toongeo.pipeline import Rig, rig_mesh

__all__ = ["rig"]

_TOLERANCE = 1e-6  # of the head's size: displacements below it are not stored


def rig(mesh: Path, landmarks: Path, output: Path, *, texture: Path | None = None) -> Rig:
    """Read a mesh and its landmarks, rig it, and write it with its morph targets.

    Parameters
    ----------
    mesh : Path
        ``.obj`` of a neutral head; polygons are cut into triangles.
    landmarks : Path
        See :func:`toongeo.io.read_mesh_landmarks`.
    output : Path
        ``.glb``. Its coordinates are those of the mesh file, its texture coordinates too.
    texture : Path, optional
        Picture for the texture coordinates.

    Raises
    ------
    ValueError, OSError
        For bad input or an output that cannot be written or is a file that is read; the output is checked before the
        work.
    """
    if output.suffix.lower() != ".glb":
        raise ValueError(f"output: expected a name that ends in .glb, got {output}")
    check_output(output, {"mesh": mesh, "landmarks": landmarks, "texture": texture})
    if mesh.suffix.lower() != ".obj":
        raise ValueError(f"mesh: expected a name that ends in .obj, got {mesh}")
    read = read_obj(mesh)
    faces, uv_faces, _ = read.triangles()
    uv = read.uv if len(read.uv) and (uv_faces >= 0).all() else None
    if texture is not None and uv is None:
        raise ValueError(f"texture: expected a mesh with texture coordinates at every corner, got {mesh} without")
    picture = None if texture is None else read_image(texture)
    found = rig_mesh(read.vertices, faces, read_mesh_landmarks(landmarks, read.vertices))
    head = SceneMesh(
        name="head",
        vertices=found.neutral / METRES,
        faces=faces,
        uv=uv,
        uv_faces=None if uv is None else uv_faces,
        texture=picture,
        targets=found.deltas.astype(np.float64) / METRES,
        target_names=found.names,
    )
    size = float(np.linalg.norm(np.ptp(head.vertices, axis=0)))
    write_glb(output, Scene((head,)), tolerance_mm=_TOLERANCE * size)
    report = found.report
    print(f"{len(found.names)} expressions on {len(read.vertices)} vertices in {report['seconds']:.1f} s")
    print(f"{report['matched']:.1%} of the template's face found a partner, mean distance {report['distance']:.3g}")
    print(f"wrote {output}")
    return found
