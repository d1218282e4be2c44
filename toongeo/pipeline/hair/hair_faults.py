"""Why no hair can be built from a mask."""

import numpy as np

from toongeo.arrays import Mask
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.hair.plane.above_nape import above_nape
from toongeo.pipeline.hair.plane.depth_maps import silhouette
from toongeo.pipeline.hair.plane.hair_raster import hair_raster
from toongeo.pipeline.hair.plane.masks import dilated
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane, working_plane

__all__ = ["hair_faults"]

_REGIONS = ("scalp", "ears", "ear_left", "ear_right", "skin", "neck", "lips", "face")  # that hair needs to know of
_TOPPED = 0.5  # of the columns over the crown that hair tops: with less the head is bald, or the mask wrong
_INNER = np.r_[27:68]  # nose, eyes and mouth
_OVER_FACE = 0.3  # of these landmarks may lie under hair
_TOP_MM = 5.0  # below the top of head and hair there is hair, if any


def hair_faults(face: AlignedFace, mask: Mask) -> tuple[str, ...]:
    """What speaks against building hair from a mask, a sentence each; none if nothing does.

    Parameters
    ----------
    face : AlignedFace
    mask : (H, W) bool
        Pixels of hair in the picture.
    """
    missing = [name for name in _REGIONS if name not in face.model.regions]
    if missing:
        return (f"the model has no region {', '.join(missing)}",)
    if not mask.any():
        return ("the mask shows no hair",)
    px = np.rint(face.project(face.vertices[face.landmark_vertices[_INNER]])).astype(int)
    within = ((px >= 0) & (px < mask.shape[::-1])).all(1)
    covered = mask[px[within, 1], px[within, 0]]
    if covered.size and covered.mean() > _OVER_FACE:
        return ("the mask covers the face",)
    plane = working_plane(face, mask)
    F = face.faces
    crown = silhouette(plane, plane.of(face.vertices), F[above_nape(face.model)[F].all(1)])
    hair = hair_raster(plane, mask, crown).hair
    if not hair.any():
        return ("the mask shows no hair near the head",)
    topped = _topped(plane, hair, crown)
    if topped < _TOPPED:
        return (f"hair tops only {100 * topped:.0f} % of the crown",)
    return ()


def _topped(plane: WorkingPlane, hair: Mask, crown: Mask) -> float:
    """Share of the columns over the middle of the crown in which the uppermost of head and hair is hair.

    A crown that is taller than the head in the picture says nothing: down to the brows there is hair or none.
    """
    columns = np.flatnonzero(crown.any(0))
    columns = columns[len(columns) // 5 : len(columns) - len(columns) // 5]
    rows = np.flatnonzero(crown.any(1))
    upper = dilated(hair, _TOP_MM)[(rows[0] + rows[-1]) // 2 :, columns]
    return float(upper.any(0).mean())
