"""Bones on which hair swings that hangs below the chin."""

import numpy as np

from toongeo.arrays import Reals
from toongeo.io import SpringChains
from toongeo.pipeline import AlignedFace, Hair

__all__ = ["hair_springs"]

_LEAST_MM = 10.0  # below the chin hair must reach: less does not swing
_JOINTS = 3  # of a chain: two bones bend a strand; file and player stay light
_HELD, _LOWER = 0.3, (0.35, 0.75)  # of the way down hair is held by the head above it, and goes over to the lower bone
_LOCKS = np.deg2rad([90.0, 180.0, -90.0])  # about the neck: the subject's left, behind, right
_CHIN, _BROWS = 8, list(range(17, 27))  # landmarks
_AIR_MM = 1.0  # between a capsule and the joints at rest, or rounding would push them
_SMALLEST_MM = 10.0  # radius: a smaller capsule keeps nothing out of a neck


def hair_springs(hair: Hair, face: AlignedFace) -> SpringChains | None:
    """Chains for hair on the left, behind and on the right; None if none hangs low enough.

    Each vertex below the chin follows the chains beside it, the more the lower it is. Above the chin hair is still, as
    on the skull, so that what was kept clear of the skin stays so.
    """
    chin = float(face.vertices[face.landmark_vertices[_CHIN], 1])
    low = float(hair.vertices[:, 1].min())
    if chin - low < _LEAST_MM:
        return None
    down = np.clip((chin - hair.vertices[:, 1]) / (chin - low), 0, 1)
    locks = _locks(hair.vertices, face)
    hanging = down > 0.5
    found = [k for k in range(len(_LOCKS)) if (locks[hanging, k] > 0.5).any()]
    joints = np.stack([_chain(hair.vertices, locks[:, k] * (down > 0), down, chin) for k in found])
    lower = _ramp(down, *_LOWER)
    bones = _ramp(down, 0.0, _HELD)[:, None] * np.column_stack([1 - lower, lower])
    return SpringChains(joints, locks[:, found, None] * bones[:, None], _capsules(face, joints))


def _capsules(face: AlignedFace, joints: Reals) -> Reals:
    """Neck and jaw (m, 7), as large as leaves the joints where they are: hair at rest is not pushed.

    Both are upright capsules about the middle of what they stand for, and within it: hair lies on the skin.
    """
    skin, neck = face.region("skin") & ~face.region("ears") & ~face.region("neck"), face.region("neck")
    chin = float(face.vertices[face.landmark_vertices[_CHIN], 1])
    brows = float(face.vertices[face.landmark_vertices[_BROWS], 1].mean())
    jaw = skin & (face.vertices[:, 1] > chin) & (face.vertices[:, 1] < brows)
    found = []
    for part, top in ((neck, chin), (jaw, brows)):
        rows = face.vertices[part]
        bottom = float(rows[:, 1].min(initial=top))
        if bottom >= top:
            continue
        middle = (rows.min(0) + rows.max(0))[[0, 2]] / 2
        radius = float(np.linalg.norm(rows[:, [0, 2]] - middle, axis=1).min())
        cap = min(radius, (top - bottom) / 2)
        ends = np.array([[middle[0], height, middle[1]] for height in (bottom + cap, top - cap)])
        free = _distance(joints[:, 1:].reshape(-1, 3), ends).min() - _AIR_MM
        if min(radius, free) > _SMALLEST_MM:
            found.append(np.r_[ends.ravel(), min(radius, free)])
    return np.array(found).reshape(-1, 7)


def _distance(P: Reals, ends: Reals) -> Reals:
    """From points (n, 3) to the line between two ends (2, 3)."""
    along = ends[1] - ends[0]
    share = np.clip((P - ends[0]) @ along / max(float(along @ along), 1e-12), 0, 1)
    return np.asarray(np.linalg.norm(P - ends[0] - share[:, None] * along, axis=1))


def _locks(V: Reals, face: AlignedFace) -> Reals:
    """Shares (n, 3) of the locks at points, by their direction from the neck; before it all are on one side."""
    neck = face.vertices[face.region("neck")]
    across, forward = (V - neck.mean(0))[:, [0, 2]].T
    angle = np.arctan2(across, forward)
    behind = np.clip(np.abs(angle) / (np.pi / 2) - 1, 0, 1)
    left = across > 0
    return np.column_stack([(1 - behind) * left, behind, (1 - behind) * ~left])


def _chain(V: Reals, share: Reals, down: Reals, chin: float) -> Reals:
    """Joints (k, 3) along the middle of a lock, from the height of the chin to its lowest point."""
    low = V[share > 0.5, 1].min()
    places = np.linspace(0.0, 1.0, _JOINTS)
    near = share[:, None] * np.exp(
        -0.5 * ((down[:, None] - places * (chin - low) / (chin - V[:, 1].min())) / 0.25) ** 2
    )
    joints = near.T @ V / near.sum(0)[:, None]
    joints[:, 1] = chin + (low - chin) * places
    return joints


def _ramp(values: Reals, low: float, high: float) -> Reals:
    t = np.clip((values - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))
