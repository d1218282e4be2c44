"""Few colours for many."""

import numpy as np

from toongeo.arrays import Singles

__all__ = ["in_palette", "palette_of"]

_BIN = 4.0  # Lab; colours nearer than this are one
_ROUNDS = 25  # of k-means; it has converged before
_BINS = (26, 64, 64)  # L 0..100, a and b -128..127
# Of the softmax between colours of the palette, squared Lab: borders between two fields are a pixel or two wide.
_SHARPNESS = np.float32(12.0)


def palette_of(lab: Singles, weight: Singles, count: int) -> Singles:
    """At most ``count`` colours (k, 3) that stand for those of a picture: k-means over its histogram in CIELAB.

    Over the histogram, not the pixels: so a mirrored picture has the same palette, and the order does not count. The
    first colour is the commonest, each further one the bin that is worst stood for.

    Parameters
    ----------
    lab : (h, w, 3) float32
    weight : (h, w) float32
        How much each pixel counts.
    """
    indices = np.floor((lab.reshape(-1, 3) + [0.0, 128.0, 128.0]) / _BIN).astype(np.int64)
    cells = np.ravel_multi_index(tuple(np.clip(indices, 0, np.array(_BINS) - 1).T), _BINS)
    share = weight.reshape(-1).astype(np.float64)
    counted = np.bincount(cells, share, int(np.prod(_BINS)))
    used = np.flatnonzero(counted)
    mass = counted[used]
    sums = np.stack([np.bincount(cells, share * part, int(np.prod(_BINS)))[used] for part in lab.reshape(-1, 3).T])
    colours = np.asarray((sums / mass).T)
    centres = colours[[int(np.argmax(mass))]]
    while len(centres) < min(count, len(used)):
        distance = np.square(colours[:, None] - centres[None]).sum(axis=2).min(axis=1)
        centres = np.vstack([centres, colours[int(np.argmax(mass * distance))]])
    for _ in range(_ROUNDS):
        nearest = np.square(colours[:, None] - centres[None]).sum(axis=2).argmin(axis=1)
        held = np.bincount(nearest, mass, len(centres))[:, None]
        sums = np.stack([np.bincount(nearest, mass * part, len(centres)) for part in colours.T], axis=1)
        centres = np.where(held > 0, sums / np.maximum(held, 1e-12), centres)
    return centres.astype(np.float32)


def in_palette(distances: Singles, palette: Singles) -> Singles:
    """Colours (h, w, 3) by squared distances (k, h, w) to those of a palette (k, 3): a softmax."""
    weights = np.exp((distances.min(axis=0) - distances) / _SHARPNESS)
    weights /= weights.sum(axis=0)
    return np.asarray(np.stack([np.tensordot(channel, weights, 1) for channel in palette.T], axis=-1))
