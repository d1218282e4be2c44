"""An iris of which lids hide a part, completed about its middle.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import numpy as np

from toongeo.pipeline.texture.eyes.eye_disc import EyeDisc

__all__ = ["whole_iris"]

_RINGS, _SECTORS = 16, 48  # of an iris
_FEWEST = 8  # texels of a ring that must be seen for a colour
_LIKE = 0.7  # how far the other side of an iris tells of this one
_MOST = 18.0  # sRGB: by how much it may differ from its ring; a highlight is not repeated


def whole_iris(disc: EyeDisc) -> np.ndarray | None:
    """Colours (k, 3) that an iris has at each texel; None if none of it is seen.

    The median of the ring at this distance from the middle, and a part of what differs from it at the places that
    mirror this one across both axes and through the middle, as far as they are seen: light from above and a lid's
    shadow stay, rays go around.
    """
    edges = np.linspace(0, 1, _RINGS + 1)
    ring = np.clip(np.digitize(disc.away, edges) - 1, 0, _RINGS - 1)
    seen = disc.seen & (disc.away < 1)
    known = [k for k in range(_RINGS) if (seen & (ring == k)).sum() >= _FEWEST]
    if not known:
        return None
    medians = np.array([np.median(disc.colours[seen & (ring == k)], axis=0) for k in known])
    middles = (0.5 * (edges[:-1] + edges[1:]))[known]
    of_ring = np.column_stack([np.interp(disc.away, middles, column) for column in medians.T])

    sector = (np.floor((disc.angle + np.pi) / (2 * np.pi) * _SECTORS)).astype(int) % _SECTORS
    total, count = np.zeros((_RINGS, _SECTORS, 3)), np.zeros((_RINGS, _SECTORS))
    np.add.at(total, (ring[seen], sector[seen]), (disc.colours - of_ring)[seen])
    np.add.at(count, (ring[seen], sector[seen]), 1)
    off = np.clip(total / np.maximum(count, 1)[..., None], -_MOST, _MOST)
    alike, votes = np.zeros_like(of_ring), np.zeros(len(of_ring))
    for mirrored in (_SECTORS - 1 - sector, _SECTORS // 2 - 1 - sector, sector + _SECTORS // 2):
        there = ring, mirrored % _SECTORS
        alike += off[there]
        votes += count[there] > 0
    return of_ring + _LIKE * alike / np.maximum(votes, 1)[:, None]
