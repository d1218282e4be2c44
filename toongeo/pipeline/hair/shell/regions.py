"""Where the shell's sheets are seen: from the front, and from behind."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Integers, Mask, Reals
from toongeo.model.anatomy.neck import neck_rim
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.hair.plane.above_nape import above_nape
from toongeo.pipeline.hair.plane.depth_maps import ball_offset, depth_maps, silhouette
from toongeo.pipeline.hair.plane.hair_raster import HairRaster
from toongeo.pipeline.hair.plane.masks import closed, depth_inside, dilated, eroded, large_pieces, opened, without_holes
from toongeo.pipeline.hair.plane.working_plane import CELL_MM, WorkingPlane
from toongeo.pipeline.hair.shell.temples import behind_temples, beside_hair
from toongeo.pipeline.hair.shell.tufts import between_tufts
from toongeo.render import rasterize

__all__ = ["HeadRaster", "Regions", "head_raster", "regions"]


CLEAR_MM = 2.0  # between skin, in all expressions, and hair
_AROUND_MM = 3.0  # by which hair behind the head is larger than the scalp, where the face or ears hide it
_GAP_MM = 10.0  # between scalp and hair behind the neck, or in that: below, none
_TOUCH_MM = 10.0  # breadth of the overlap with the outline of a head, where the fit may be off by so much
_END_MM = 3.0  # about the end of the neck there is no hair but that before it: a rim of both would go through it
_SLIVER_MM = 1.25  # half the breadth of what is no gap between front and back
_CALM_MM = 1.0  # smooths the hairline; not the outer outline, whose corners are drawn
_DRAWN_IN = 0.65  # level of the smoothed hairline, 0.4 mm inside, as the folded edge of hair covers so much skin
_ASKEW = 5.0  # degrees of yaw beyond which the outlines of the cheeks are not the same lines on both sides
_SHRUNKEN = 0.5  # of its size in the fit: a hidden ear has a quarter of it
_TURNED = 12.0  # degrees of yaw beyond which one side of the hair is hidden


@dataclass(frozen=True, eq=False)
class HeadRaster:
    """A head over the plane; depths z (rows, columns) in mm, masks (rows, columns) bool.

    Attributes
    ----------
    front, back
        Skin in its farthest reach; -inf and +inf beside the head.
    front_off, back_off
        The same with 2 mm of air all around.
    crown, neck, end
        Silhouettes of the scalp above the nape, of skin and neck, and of the lower end of the neck.
    rim_z : float
        Depth at which the crown turns from front to back.
    back_z : float
        The rearmost point of the crown.
    """

    front: Reals
    back: Reals
    front_off: Reals
    back_off: Reals
    crown: Mask
    neck: Mask
    end: Mask
    rim_z: float
    back_z: float

    @property
    def head(self) -> Mask:
        return np.isfinite(self.front)

    @property
    def aired(self) -> Mask:
        return np.isfinite(self.front_off) | np.isfinite(self.back_off)


@dataclass(frozen=True, eq=False)
class Regions:
    """Cells (rows, columns) bool of hair.

    Attributes
    ----------
    front, back
        Where hair shows from the front and from behind.
    hanging
        Between strands that hang on both sides of the neck, behind it.
    over_skin
        Where hair of the front lies on the head, and does not come from behind it.
    pictured
        What of the front the picture shows as hair.
    """

    front: Mask
    back: Mask
    hanging: Mask
    over_skin: Mask
    pictured: Mask

    @property
    def whole(self) -> Mask:
        return self.front | self.back


def head_raster(face: AlignedFace, plane: WorkingPlane, reach: Reals) -> HeadRaster:
    """A head whose skin reaches to ``reach`` (n, 3), model frame, in some expression."""
    F, model = face.faces, face.model
    skin = model.region("skin") | model.region("neck")
    front, back = depth_maps(plane, plane.of(reach), F[skin[F].all(1)])
    X, scalp = plane.of(face.vertices), above_nape(model)
    rim = neck_rim(model)
    facing = face.normals @ plane.rotation[2]
    turning = scalp & (np.abs(facing) < 0.25)
    return HeadRaster(
        front=front,
        back=back,
        front_off=ball_offset(front, CLEAR_MM),
        back_off=-ball_offset(-back, CLEAR_MM),
        crown=silhouette(plane, X, F[scalp[F].all(1)]),
        neck=silhouette(plane, X, F[skin[F].all(1)]),
        end=np.zeros_like(front, bool) if rim is None else silhouette(plane, X, _fan(rim)),
        rim_z=float(np.median(X[turning if turning.any() else scalp, 2])),
        back_z=float(X[scalp, 2].min()),
    )


def _fan(rim: Integers) -> Integers:
    """Triangles that close a hole."""
    return np.column_stack([np.full(len(rim) - 2, rim[0]), rim[1:-1], rim[2:]])


def regions(face: AlignedFace, plane: WorkingPlane, raster: HairRaster, head: HeadRaster) -> Regions:
    """Front: the hair of the picture. Back: behind the scalp, behind hair beside the head, and between strands."""
    covered = _covered(face, plane, raster.hair)
    front = raster.hair | covered
    ending = dilated(head.end, _END_MM)  # below the neck there is nothing that hair could hang on
    hanging = _between_strands(face, front, head) & ~ending
    covered = front | eroded(head.neck, CELL_MM)  # what is behind these is not seen from the front
    back = head.crown | (dilated(head.crown, _AROUND_MM) & covered)
    back |= (front & ~head.aired) | hanging
    back = without_holes(closed(back, _GAP_MM) & covered) & ~ending
    back &= ~(between_tufts(back & ~front, front) & hanging & ~dilated(head.crown, _AROUND_MM))
    back = large_pieces(back, 0.02)
    whole = front | back
    calm = cv2.GaussianBlur(front.astype(np.float32), (0, 0), _CALM_MM / CELL_MM) > _DRAWN_IN
    front = np.where(depth_inside(whole) > 4.0, calm, front)
    front = front | _slivers(whole & ~front, front)
    back = back | _slivers(whole & ~back, back)
    pictured = front & (raster.hair | ~covered)
    return Regions(front, back, hanging, _over_skin(face, plane, front, head), pictured)


def _over_skin(face: AlignedFace, plane: WorkingPlane, hair: Mask, head: HeadRaster) -> Mask:
    """Hair before the head. If it is turned at all, what only touches the outline of the jaw comes from behind.

    On the far side of a head that is turned further so does all that touches the outline, and all that is below the
    eyes: there the nose, of which a fit may fall short, stands before it.
    """
    over = hair & head.head
    if abs(face.camera.yaw) < _ASKEW:
        return over
    touching = over & ~opened(over, _TOUCH_MM / 2) & (depth_inside(head.head) < _TOUCH_MM)
    (column, bridge), (_, tip) = plane.cells(plane.of(face.vertices[face.landmark_vertices[[27, 30]]])[:, :2])
    rows = np.arange(len(hair))[:, None]
    behind = touching & (rows < tip)
    if abs(face.camera.yaw) > _TURNED:
        far = np.sign(face.camera.yaw) * (np.arange(hair.shape[1]) - column) > 0
        behind |= far & (touching | (rows < bridge))
    return over & ~behind


def _covered(face: AlignedFace, plane: WorkingPlane, hair: Mask) -> Mask:
    """Skin behind the temples with hair beside it, where hair lies on it though the picture shows none."""
    F, X = face.faces, plane.of(face.vertices)
    seen = rasterize(np.column_stack([plane.cells(X[:, :2]), X[:, 2]]), F, *plane.shape)
    standing = np.any([face.region(ear) for ear in _standing_ears(face)] or [np.zeros(len(X), bool)], axis=0)
    ahead = face.normals @ plane.rotation[2] > 0  # not the inside of the head, which shows between open lids
    behind = behind_temples(face.model) & ahead
    skin, ears = (seen.mask & kind[F].all(1)[seen.face_ids] for kind in (behind, standing))
    middle = float(plane.cells(X[face.landmark_vertices[[27]], :2])[0, 0])
    return beside_hair(hair, skin, ears, int(np.clip(round(middle), 0, hair.shape[1])))


def _standing_ears(face: AlignedFace) -> list[str]:
    """Ears that were not shrunken to make room for hair."""
    ears = [name for name in ("ear_left", "ear_right") if face.model.has(name)]
    sizes = {name: [np.ptp(V[face.region(name), 1]) for V in (face.vertices, face.fit.vertices)] for name in ears}
    return [name for name, (size, fitted) in sizes.items() if size > _SHRUNKEN * fitted]


def _slivers(gap: Mask, region: Mask) -> Mask:
    """Thin parts of a gap along a region."""
    return gap & ~opened(gap, _SLIVER_MM) & dilated(region, 2 * _SLIVER_MM)


def _between_strands(face: AlignedFace, hair: Mask, head: HeadRaster) -> Mask:
    """Rows between hair on both sides of the neck; of a turned head, whose far side is hidden, from one side on."""
    between = np.zeros_like(hair)
    lowest = int(np.flatnonzero(head.crown.any(1))[0]) if head.crown.any() else 0
    for row in np.flatnonzero(hair.any(1) & head.neck.any(1)):
        columns, behind = np.flatnonzero(hair[row]), np.flatnonzero(head.neck[row])
        middle, breadth = (behind[0] + behind[-1]) / 2, behind[-1] - behind[0]
        left, right = columns[columns < middle - 0.1 * breadth], columns[columns > middle + 0.1 * breadth]
        if len(left) and len(right):
            between[row, left[0] : right[-1] + 1] = True
        elif abs(face.camera.yaw) > _TURNED and row < lowest and (hair[row] & ~head.neck[row]).any():
            ends = (columns[0], behind[-1]) if len(left) else (behind[0], columns[-1])
            between[row, ends[0] : ends[1] + 1] = True
    return opened(between, 4.0)
