"""Which parts of the cascade a picture asks for."""

import numpy as np

__all__ = ["photo_share"]

# From where to where the share falls from 1 to 0; chosen on held-out renders.
_FLAT = 0.40, 0.50
_FIGURE = -0.5, 0.0


def photo_share(flat: float, figure: float) -> float:
    """The share in [0, 1] of the parts that were trained without figures, by how flat a face looks (see `flat_look`)
    and how much like a figure (see `FaceLook`); one that looks like either is left to those that saw figures.

    Examples
    --------
    >>> [photo_share(*look) for look in ((0.3, -1.0), (0.6, -1.0), (0.3, 0.5))], round(photo_share(0.3, -0.2), 3)
    ([1.0, 0.0, 0.0], 0.4)
    """
    return min(_falling(flat, *_FLAT), _falling(figure, *_FIGURE))


def _falling(value: float, first: float, last: float) -> float:
    return float(np.clip((last - value) / (last - first), 0, 1))
