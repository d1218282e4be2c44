"""A shell of hair from the pixels of a picture that show it."""

import numpy as np
from numpy.typing import NDArray

from toongeo.io import check_image
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.hair.colours.hair_texture import hair_texture
from toongeo.pipeline.hair.colours.picture_colours import picture_colours
from toongeo.pipeline.hair.colours.strand_frame import StrandFrame
from toongeo.pipeline.hair.colours.strands import strands
from toongeo.pipeline.hair.hair import Hair
from toongeo.pipeline.hair.plane.above_nape import above_nape
from toongeo.pipeline.hair.plane.depth_maps import silhouette
from toongeo.pipeline.hair.plane.hair_raster import hair_raster
from toongeo.pipeline.hair.plane.masks import signed
from toongeo.pipeline.hair.plane.skin_reach import skin_reach
from toongeo.pipeline.hair.plane.working_plane import working_plane
from toongeo.pipeline.hair.shell.regions import Regions, head_raster, regions
from toongeo.pipeline.hair.shell.shell_mesh import shell_mesh
from toongeo.pipeline.rig.rig import Rig

__all__ = ["build_hair"]

_STRANDS, _LONG_MM = 1.25, 300.0  # texels per mm of strands behind, and so long they are: farther down they come again
_FINEST = 2.5  # texels per mm; more is more than a file of an avatar should hold


def build_hair(img: NDArray[np.uint8], face: AlignedFace, rig: Rig, mask: NDArray[np.bool_]) -> Hair:
    """Hair as a closed shell: a sheet over the hair of the picture and one behind the head, on one rim.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
        With room for hair: see :func:`toongeo.make_room`.
    rig : Rig
        Of that face; the hair keeps clear of the skin in all its expressions.
    mask : (H, W) bool
        Pixels of hair, some above the brows; see :func:`toongeo.find_hair`.

    Returns
    -------
    Hair

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, or the mask is not of its size or shows no hair on the head.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig = tg.build_rig(face)
    >>> hair = tg.find_hair(img, landmarks, face.fit)
    >>> face, rig = tg.make_room(face, rig, hair.mask)
    >>> tg.build_hair(img, face, rig, hair.mask).vertices.shape[1]
    3
    """
    check_image(img)
    if mask.shape != img.shape[:2] or mask.dtype != np.bool_:
        raise ValueError(f"mask: expected {img.shape[:2]} bool, got {mask.shape} {mask.dtype}")
    plane = working_plane(face, mask)
    F = face.faces
    crown = silhouette(plane, plane.of(face.vertices), F[above_nape(face.model)[F].all(1)])
    raster = hair_raster(plane, mask, crown)
    if not raster.hair.any():
        raise ValueError("mask: expected hair on the head, got none near it")
    head = head_raster(face, plane, skin_reach(face, rig))
    parts = regions(face, plane, raster, head)
    mesh = shell_mesh(plane, parts, head)
    density = min(plane.scale, _FINEST)
    inside = signed(parts.pictured)
    colours = picture_colours(plane, img, inside, _to_rim(parts), density)
    frame = _strand_frame(face)
    lowest = float(frame.at(plane.back(mesh.vertices))[1].max())
    drawn = strands(colours, (min(lowest, _LONG_MM), frame.breadth), _STRANDS)
    texture, uv, uv_faces = hair_texture(plane, mesh, colours, frame, drawn)
    vertices = plane.back(mesh.vertices).astype(np.float32).astype(np.float64)
    return Hair(vertices, mesh.faces, uv.astype(np.float32).astype(np.float64), uv_faces, texture)


def _to_rim(parts: Regions) -> NDArray[np.floating]:
    """mm (rows, columns) to the outline of the whole shell."""
    return np.abs(signed(parts.whole))


def _strand_frame(face: AlignedFace) -> StrandFrame:
    scalp = face.vertices[above_nape(face.model)]
    low, high = scalp.min(0), scalp.max(0)
    radius = float((high - low)[[0, 2]].mean() / 2)
    centre = (low + high) / 2
    centre[1] = high[1] - radius
    return StrandFrame(centre, radius)
