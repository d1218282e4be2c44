"""A head that fits under its hair."""

import dataclasses

import numpy as np

from toongeo.arrays import Mask
from toongeo.geometry import vertex_normals
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.hair.plane.above_nape import above_nape
from toongeo.pipeline.hair.plane.depth_maps import silhouette
from toongeo.pipeline.hair.plane.hair_raster import hair_raster
from toongeo.pipeline.hair.plane.masks import closed, depth_inside, dilated, opened, signed
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane, working_plane
from toongeo.pipeline.hair.room.drawn_inside import drawn_inside
from toongeo.pipeline.hair.room.hidden_ears import hidden_ears, shrunken_ears
from toongeo.pipeline.hair.room.lowered_crown import lowered_crown
from toongeo.pipeline.rig.rig import Rig
from toongeo.protocols import FaceLabel, FaceParse

__all__ = ["make_room"]

_SKIN = tuple(
    label for label in FaceLabel if label not in (FaceLabel.BACKGROUND, FaceLabel.HAIR, FaceLabel.OTHER, FaceLabel.HAT)
)
_COVERED_MM = 1.0  # so far inside the hair a vertex is covered
# Chosen on the seven examples and two caricatures: with more overlap bars reach from ear to cheek, with less the head
# gives way beside skin that is seen.
_BESIDE_MM = 10.0  # breadth along the head's outline below which hair hangs beside a face narrower than the fit
_OVERLAP_MM = 3.5  # of such hair that may lie over skin
_SIDEWAYS = 0.6  # cosine to the viewer below which a covered side of the head gives way


def make_room(face: AlignedFace, rig: Rig, mask: Mask, parse: FaceParse | None = None) -> tuple[AlignedFace, Rig]:
    """The face and its rig, skull and covered ears drawn inside the outline of hair and skin in the picture.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        Of that face.
    mask : (H, W) bool
        Hair in the picture.
    parse : FaceParse, optional
        Of the picture; without it all that is not hair counts as skin.

    Returns
    -------
    face, rig
        Both moved by the same displacement; what the picture shows of the face stays where it is.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> hair = tg.find_hair(img, landmarks, face.fit)
    >>> narrower, rig = tg.make_room(face, tg.build_rig(face), hair.mask)
    >>> narrower.vertices.shape == face.vertices.shape
    True
    """
    plane = working_plane(face, mask)
    F, model = face.faces, face.model
    crown_faces = F[above_nape(model)[F].all(1)]
    crown = silhouette(plane, plane.of(face.vertices), crown_faces)
    raster = hair_raster(plane, mask, crown)
    hair = raster.hair
    if not hair.any():
        return face, rig
    moved = plane.back(lowered_crown(face, plane, hair, crown))
    face = dataclasses.replace(face, vertices=face.vertices + moved)
    skin, shown = _shown(plane, hair, mask, parse)
    X = plane.of(face.vertices)
    ears = hidden_ears(face, plane, skin, hair)
    shift = shrunken_ears(face, X, ears)
    outline = _outline(face, plane, X, (hair, skin), shown | ~raster.pictured)
    shift += drawn_inside(face, plane, X + shift, outline, _moving(face, plane, hair, ears))
    shift = plane.back(shift)
    face = dataclasses.replace(face, vertices=face.vertices + shift)
    return face, dataclasses.replace(rig, neutral=rig.neutral + moved + shift)


def _shown(plane: WorkingPlane, hair: Mask, mask: Mask, parse: FaceParse | None) -> tuple[Mask, Mask]:
    """Cells that show skin, and cells that show the head."""
    skin = ~mask if parse is None else parse.mask(*_SKIN) & ~mask
    head = np.ones_like(mask) if parse is None else ~parse.mask(FaceLabel.BACKGROUND)
    layers = (plane.warp(layer.astype(np.float32)) > 0.5 for layer in (skin, head))
    skin_cells, head_cells = layers
    return skin_cells & ~hair, head_cells


def _outline(face: AlignedFace, plane: WorkingPlane, X: np.ndarray, seen: tuple[Mask, Mask], shown: Mask) -> Mask:
    """Cells within which the head is to lie: hair and skin, and all that the head has below the chin."""
    F = face.faces
    hair, skin = seen
    front = silhouette(plane, X, F[(face.region("face") & ~face.region("ears"))[F].all(1)])
    chin, lids = (int(plane.cells(X[face.landmark_vertices[k], :2])[:, 1].max()) for k in ([8], [40, 41, 46, 47]))
    outline = hair | skin | (front & shown)
    outline[:lids] &= ~_beside(hair, skin, front)[:lids]
    outline[:chin] |= silhouette(plane, X, F)[:chin]
    return closed(outline, 4.0)


def _beside(hair: Mask, skin: Mask, head: Mask) -> Mask:
    """Cells of a strand along the head's outline and of the hair beside it, but for those next to skin that is seen.

    On the steep sides of a face such a strand would reach from the ear far forward to its edge.
    """
    over = hair & head
    strand = over & ~opened(over, _BESIDE_MM / 2) & (depth_inside(head) < _BESIDE_MM) & ~dilated(skin, _OVERLAP_MM)
    return strand | (hair & ~head & dilated(strand, 2 * _BESIDE_MM))


def _moving(face: AlignedFace, plane: WorkingPlane, hair: Mask, ears: tuple[str, ...]) -> Mask:
    """Vertices (n,) that may give way: the scalp, hidden ears, and sides of the head under hair."""
    X, regions = plane.of(face.vertices), face.model.regions
    inside = plane.sample(signed(hair), X[:, :2])
    facing = np.abs(vertex_normals(face.vertices, face.faces) @ plane.rotation[2])
    moving = above_nape(face.model) | (regions["skin"] & (inside > _COVERED_MM) & (facing < _SIDEWAYS))
    for name in ears:
        moving = moving | regions[name]
    seen = face.landmark_vertices[inside[face.landmark_vertices] < _COVERED_MM]
    moving[seen] = False
    return np.asarray(moving)
