"""Height and width of a picture that is to be drawn."""

from __future__ import annotations

import operator

__all__ = ["picture_size"]

_MOST_PIXELS = 2**27  # that are looked at: some 3 GB; 5,792 px square with four to each pixel


def picture_size(size: object, supersample: int = 1) -> tuple[int, int]:
    """(height, width) px out of a side or of both.

    Parameters
    ----------
    size : int, or (height, width)
    supersample : int
        Samples a side of each pixel.

    Raises
    ------
    ValueError
        If it is no such size, not positive, or larger than memory should hold.

    Examples
    --------
    >>> picture_size(3), picture_size((2, 3))
    ((3, 3), (2, 3))
    >>> picture_size(512.0)
    Traceback (most recent call last):
        ...
    ValueError: size: expected positive (height, width) in px, or an integer, got 512.0
    """
    try:
        sides = tuple(size) if isinstance(size, tuple | list) else (size, size)
        height, width = (operator.index(side) for side in sides if not isinstance(side, bool))
    except (TypeError, ValueError):
        raise ValueError(f"size: expected positive (height, width) in px, or an integer, got {size!r}") from None
    if height < 1 or width < 1:
        raise ValueError(f"size: expected positive (height, width) in px, got {size!r}")
    if height * width * supersample**2 > _MOST_PIXELS:
        most = int((_MOST_PIXELS / supersample**2) ** 0.5)
        raise ValueError(f"size: expected at most as many pixels as {most} x {most}, got {height} x {width}")
    return height, width
