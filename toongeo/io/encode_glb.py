"""A scene as the bytes of a binary glTF 2.0 file."""

from typing import Literal, get_args

from toongeo.io.gltf.glb_builder import GlbBuilder
from toongeo.io.gltf.mixamo_body import add_mixamo_body
from toongeo.io.gltf.scene_parts import GlbOptions, Picture, add_scene
from toongeo.io.scene import Scene

__all__ = ["encode_glb"]


def encode_glb(
    scene: Scene,
    *,
    normal_deltas: bool = False,
    tolerance_mm: float = 1e-3,
    quantize: bool = False,
    picture: Picture = "png",
    sparse: bool = True,
    body: Literal["mixamo"] | None = None,
    attachment: bytes | None = None,
) -> bytes:
    """Binary glTF: a node a mesh, sparse float32 morph targets, embedded textures, one animation.

    Written by hand because no Python library writes sparse morph targets that the Khronos validator
    accepts. Vertices are repeated along uv seams as by :func:`split_seams`; those in no face are left out.

    Parameters
    ----------
    scene
        Model frame, mm; the file is in metres, with the same axes.
    normal_deltas
        Whether the targets also bend the normals (doubles the file; viewers that compute normals need it
        not).
    tolerance_mm
        Displacements with no coordinate above this are not stored, unless they cost nothing.
    quantize
        Displacements, normals and uv as integers (``KHR_mesh_quantization``): less than half the size. Displacements
        are off by at most 1/4,096 of the largest coordinate of their mesh, or by the tolerance; positions are not.
    picture
        ``"png"``, or ``"jpeg"``, which is smaller and not exact.
    sparse
        False: every target stores every vertex, for readers that know no sparse accessors.
    body
        "mixamo": the meshes hang from the head of the 67 bones of Mixamo's humanoids, below a node ``Armature``,
        without a skin; :func:`glb_scene` does not read such files.
    attachment
        Bytes that :func:`read_glb` gives back and other programs do not look at.

    Returns
    -------
    bytes
        The same for the same scene.

    Raises
    ------
    ValueError
        If ``tolerance_mm`` is negative, or ``picture`` or ``body`` is none of these.
    """
    if not tolerance_mm >= 0:
        raise ValueError(f"tolerance_mm: expected >= 0, got {tolerance_mm}")
    if picture not in get_args(Picture):
        raise ValueError(f"picture: expected 'png' or 'jpeg', got {picture!r}")
    if body not in ("mixamo", None):
        raise ValueError(f"body: expected 'mixamo' or None, got {body!r}")
    builder = GlbBuilder()
    add_scene(builder, scene, GlbOptions(normal_deltas, tolerance_mm, quantize, picture, sparse))
    if body is not None:
        add_mixamo_body(builder, scene)
    return builder.encode(attachment)
