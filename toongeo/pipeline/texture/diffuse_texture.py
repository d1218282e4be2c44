"""Colour spread from known pixels over unknown ones, breadth first."""

from __future__ import annotations

from collections import deque
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import distance_transform_cdt

__all__ = ["diffuse_texture"]

_Pairs = tuple[tuple[tuple[int, int], tuple[int, int]], ...]

# Pairs of opposite neighbours (row, column). Opposite ones are added first, so that a mirrored or transposed
# picture gives the mirrored or transposed result to the last bit.
_PAIRS: dict[int, _Pairs] = {
    4: (((0, -1), (0, 1)), ((-1, 0), (1, 0))),
    8: (((0, -1), (0, 1)), ((-1, 0), (1, 0)), ((-1, -1), (1, 1)), ((-1, 1), (1, -1))),
}

_DTYPES = (np.uint8, np.uint16, np.float32, np.float64)


def diffuse_texture(
    img: ArrayLike,
    mask: ArrayLike,
    *,
    order: Literal["layers", "sequential"] = "layers",
    connectivity: Literal[4, 8] = 4,
) -> NDArray[Any]:
    """Replace unknown pixels by the colour of the known ones, breadth first (Pan et al. 2024, 3.2.3).

    Each unknown pixel takes the mean of its neighbours visited before it. Pixels are visited in the order of
    their distance to the known ones.

    Parameters
    ----------
    img : (H, W) or (H, W, C), uint8, uint16, float32 or float64
        The picture; values of unknown pixels are not used and may be NaN.
    mask : (H, W) bool
        True where the colour is known.
    order : {"layers", "sequential"}
        "layers" visits all pixels of one distance at once: they see the nearer layers only, and the result
        is as symmetric as the picture. "sequential" is the paper's queue, one pixel after another, where a
        pixel also sees those of its own layer that came before it: it drags colour along the raster
        direction and is slow; kept as a reference.
    connectivity : {4, 8}
        Neighbours of a pixel.

    Returns
    -------
    array of the shape and dtype of `img`
        Known pixels untouched; unknown ones within the range of the known values. Integers are rounded once,
        at the end.

    Raises
    ------
    ValueError
        If shapes or types do not fit, no pixel is known or none is unknown, a known value is not finite, or an
        option is unknown.

    Examples
    --------
    >>> import numpy as np
    >>> diffuse_texture(np.uint8([[10, 0, 0, 40]]), np.array([[True, False, False, True]]))
    array([[10, 10, 40, 40]], dtype=uint8)
    """
    img, mask = _checked(img, mask)
    if connectivity not in _PAIRS:
        raise ValueError(f"connectivity: expected 4 or 8, got {connectivity!r}")
    if order not in ("layers", "sequential"):
        raise ValueError(f"order: expected 'layers' or 'sequential', got {order!r}")
    if mask.all():
        return img.copy()
    # Float pictures are computed in float64: a sum of equal float32 values is exact there.
    work = np.float32 if img.dtype.kind == "u" else np.float64
    framed = _framed(img, mask, work)
    # A sum of eight of the largest floats is none; a power of two and back changes no digit of such.
    shrink = work(2.0**-4) if np.abs(framed).max() > np.finfo(work).max / 16 else work(1)
    framed[..., :-1] *= shrink
    (_layers if order == "layers" else _sequential)(framed, mask, _PAIRS[connectivity])
    framed[..., :-1] /= shrink
    if img.dtype.kind == "u":
        np.rint(framed, out=framed)
    # Known values went to a wider type and come back as they were.
    return framed[1:-1, 1:-1, :-1].astype(img.dtype).reshape(img.shape)


def _checked(img: ArrayLike, mask: ArrayLike) -> tuple[NDArray[Any], NDArray[np.bool_]]:
    img, mask = np.asarray(img), np.asarray(mask)
    if img.ndim not in (2, 3) or img.size == 0 or img.dtype not in _DTYPES:
        raise ValueError(
            f"img: expected uint8, uint16, float32 or float64 of shape (H, W) or (H, W, C), got {img.dtype} {img.shape}"
        )
    if mask.shape != img.shape[:2] or mask.dtype != bool:
        raise ValueError(f"mask: expected bool of shape {img.shape[:2]}, got {mask.dtype} {mask.shape}")
    if not mask.any():
        raise ValueError("mask: expected at least one known pixel (True), got none")
    if mask.all():
        raise ValueError("mask: expected at least one unknown pixel (False), got none")
    if img.dtype.kind == "f" and not np.isfinite(img).all() and not np.isfinite(img[mask]).all():
        raise ValueError("img: expected finite values where mask is True, got NaN or infinity")
    return img, mask


def _framed(img: NDArray[Any], mask: NDArray[np.bool_], dtype: type[np.floating[Any]]) -> NDArray[Any]:
    """(H + 2, W + 2, C + 1): the colours, 0 where unknown, then 1 where known; a frame of unknown around."""
    h, w = mask.shape
    colours = img.reshape(h, w, -1)
    framed = np.zeros((h + 2, w + 2, colours.shape[2] + 1), dtype)
    np.copyto(framed[1:-1, 1:-1, :-1], colours, where=mask[:, :, None], casting="unsafe")
    framed[1:-1, 1:-1, -1] = mask
    return framed


def _offsets(pairs: _Pairs, width: int) -> list[tuple[int, int]]:
    return [(a * width + b, c * width + d) for (a, b), (c, d) in pairs]


def _layers(framed: NDArray[Any], mask: NDArray[np.bool_], pairs: _Pairs) -> None:
    """Fill `framed` in place, all pixels of one breadth-first layer at once."""
    # The layer of a pixel is its distance in steps; that of the frame is 0, like that of known pixels.
    distance = distance_transform_cdt(~mask, metric="taxicab" if len(pairs) == 2 else "chessboard")
    distance = np.pad(distance, 1).ravel()
    pixels = np.flatnonzero(distance)
    layer = distance[pixels]
    layer = layer.astype(np.uint16 if layer.max() < 2**16 else np.int64)  # 16 bits are sorted by radix
    pixels = pixels[np.argsort(layer, kind="stable")]
    ends = np.cumsum(np.bincount(layer)[1:])

    flat = framed.reshape(-1, framed.shape[2])
    offsets = _offsets(pairs, framed.shape[1])
    for start, end in zip(np.r_[0, ends[:-1]], ends, strict=True):
        here = pixels[start:end]
        total = [flat.take(here + a, 0) + flat.take(here + b, 0) for a, b in offsets]
        mean = total[0] + total[1] if len(total) == 2 else (total[0] + total[1]) + (total[2] + total[3])
        mean /= mean[:, -1:]  # sums of unknown pixels are 0; the last channel counts the known ones
        flat[here] = mean


def _sequential(framed: NDArray[Any], mask: NDArray[np.bool_], pairs: _Pairs) -> None:
    """Fill `framed` in place by one queue, seeded with the first ring in raster order."""
    # Plain lists: indexing single elements of an array costs several times more.
    steps = sorted(step for pair in _offsets(pairs, framed.shape[1]) for step in pair)
    channels = [framed[:, :, c].ravel().tolist() for c in range(framed.shape[2] - 1)]
    known = framed[:, :, -1].astype(bool).ravel().tolist()
    waiting = np.pad(~mask, 1, constant_values=False).ravel().tolist()
    candidates = np.flatnonzero(np.pad(~mask, 1, constant_values=False)).tolist()
    queue = deque(pixel for pixel in candidates if any(known[pixel + step] for step in steps))
    for pixel in queue:
        waiting[pixel] = False
    while queue:
        pixel = queue.popleft()
        visited = [pixel + step for step in steps if known[pixel + step]]
        for values in channels:
            values[pixel] = sum([values[p] for p in visited]) / len(visited)
        known[pixel] = True
        for step in steps:
            if waiting[pixel + step]:
                waiting[pixel + step] = False
                queue.append(pixel + step)
    for c, values in enumerate(channels):
        framed[:, :, c] = np.reshape(values, framed.shape[:2])
