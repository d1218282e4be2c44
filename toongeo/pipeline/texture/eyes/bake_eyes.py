"""The drawn eyes on the eyeballs.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import cv2
import numpy as np

from toongeo.io import check_image
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig import Eyes
from toongeo.pipeline.texture.eyes.eye_disc import EyeDisc, eye_disc
from toongeo.pipeline.texture.eyes.find_irises import Iris
from toongeo.pipeline.texture.eyes.sclera import (
    LIGHTEST_WHITE,
    Sclera,
    smooth_step,
    white_of,
    white_of_lightest,
)
from toongeo.pipeline.texture.eyes.whole_iris import whole_iris

__all__ = ["bake_eyes"]

_RIM = (1.04, 0.08)  # radii: where the iris ends, and over how much it passes into the white
_OUTSIDE = 1.08  # radii: from here on what is seen must look like white
# sRGB: what is farther off the white is a lash, a lid or a second line; about a faint iris only what is farther.
_STRANGE, _STRANGE_FAINT, _STRANGE_RAMP = 28.0, 45.0, 25.0
_CLEAR = 0.55  # contrast of an iris that is surely one
_SHUT = 0.3  # of the iris: an eye that shows less of where it should be is nearly shut
_SEAM = 0.02  # of the disc's width: s.d. of the blur that joins seen and completed
_FADE = 0.006  # of the disc's width: s.d. of the transition at the lids


def bake_eyes(
    img: np.ndarray,
    face: AlignedFace,
    eyes: Eyes,
    texture: np.ndarray,
    irises: tuple[Iris | None, Iris | None] = (None, None),
) -> np.ndarray:
    """Atlas whose eye discs show the eyes of the picture where they are seen; what lids hide is completed.

    A texel is seen if it projects between the lids, that is inside the smooth curves through the eye landmarks, with
    the eyes turned as in the picture. An iris is completed about its middle, and around it the eye is white as the
    drawn white is, with its shading; lashes, lines and scraps of lid in it are left out. The white of an eye that shows
    none is the other eye's. An eye whose iris was not found, beside one whose was, takes that, mirrored; where no iris
    is seen at all, eyes that are drawn nearly shut have the model's behind their lids.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
    eyes : Eyes
    texture : (size, size, 3) uint8 RGB
        From :func:`toongeo.bake_texture`; not written to.
    irises : left and right Iris or None, optional
        From :func:`find_irises`.

    Returns
    -------
    (size, size, 3) uint8 RGB

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, or the texture not square uint8 RGB.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> avatar = tg.make_avatar(img, landmarks, hair=False)
    >>> texture = tg.bake_texture(img, avatar.face, size=256)
    >>> irises = tg.find_irises(img, landmarks)
    >>> with_eyes = tg.bake_eyes(img, avatar.face, avatar.eyes, texture, irises)
    >>> with_eyes.shape, bool((with_eyes != texture).any())
    ((256, 256, 3), True)
    """
    check_image(img)
    if texture.dtype != np.uint8 or texture.ndim != 3 or texture.shape[0] != texture.shape[1] or texture.shape[2] != 3:
        raise ValueError(f"texture: expected (size, size, 3) uint8, got {texture.dtype} of shape {texture.shape}")
    atlas = texture.copy()
    sides = range(len(eyes.templates))
    discs = [eye_disc(img, face, eyes, side, irises[side], len(texture)) for side in sides]
    whites = [white_of(disc) for disc in discs]
    for side, disc in enumerate(discs):
        white = _white(disc, whites[side], whites[1 - side] if len(discs) > 1 else None)
        whole, trust = _whole(disc, white, irises[side])
        rows, columns = disc.rows - disc.rows.min(), disc.columns - disc.columns.min()
        atlas[_box(disc)] = _joined(rows, columns, disc.colours, trust, whole)
    for side in sides:
        if irises[side] is None and len(discs) > 1 and irises[1 - side] is not None:
            mirrored = atlas[_box(discs[1 - side])][:, ::-1]
            box = _box(discs[side])
            atlas[box] = cv2.resize(mirrored, atlas[box].shape[1::-1], interpolation=cv2.INTER_LINEAR)
    return atlas


def _white(disc: EyeDisc, own: Sclera | None, other: Sclera | None) -> np.ndarray:
    if own is not None:
        return own.at(disc.unit)
    return white_of_lightest(disc) if other is None else other.at(disc.unit, mirrored=True)


def _whole(disc: EyeDisc, white: np.ndarray, iris: Iris | None) -> tuple[np.ndarray, np.ndarray]:
    """Colours (k, 3) of an eye without lids, and how far (k,) in [0, 1] the picture is to be believed instead."""
    colours = whole_iris(disc)
    if iris is None or colours is None:
        shut = disc.seen[disc.iris].mean() < _SHUT
        return disc.default if shut else white, disc.seen.astype(float)
    within = smooth_step((_RIM[0] - disc.away) / _RIM[1])[:, None]
    off = np.linalg.norm(disc.colours - white, axis=1)
    limit = _STRANGE if iris.contrast > _CLEAR else _STRANGE_FAINT
    like = np.where(disc.away > _OUTSIDE, 1 - smooth_step((off - limit) / _STRANGE_RAMP), 1.0)
    return within * colours + (1 - within) * white, disc.seen * like


def _box(disc: EyeDisc) -> tuple[slice, slice]:
    """The square of the atlas about a disc."""
    return slice(disc.rows.min(), disc.rows.max() + 1), slice(disc.columns.min(), disc.columns.max() + 1)


def _joined(
    rows: np.ndarray, columns: np.ndarray, colours: np.ndarray, trust: np.ndarray, whole: np.ndarray
) -> np.ndarray:
    """The square about a disc: seen colours as far as they are trusted, and beyond them the completed ones.

    The difference of the two is carried a little beyond what is seen, so that no seam shows.
    """
    shape = rows.max() + 1, columns.max() + 1
    drawn = np.tile(LIGHTEST_WHITE, (*shape, 1))
    drawn[rows, columns] = whole
    completed, known = drawn.copy(), np.zeros(shape)
    drawn[rows, columns], known[rows, columns] = colours, trust
    near = cv2.GaussianBlur(known, (0, 0), _SEAM * shape[1])
    off = cv2.GaussianBlur((drawn - completed) * known[..., None], (0, 0), _SEAM * shape[1])
    completed += off / np.maximum(near, 1e-4)[..., None] * np.clip(1.6 * near, 0, 1)[..., None]
    inner = np.minimum(known, cv2.erode(known, np.ones((3, 3))))
    share = cv2.GaussianBlur(inner, (0, 0), _FADE * shape[1])[..., None]
    return np.clip(np.rint(share * drawn + (1 - share) * completed), 0, 255).astype(np.uint8)
