"""Few colours for many."""

import numpy as np

from toongeo.arrays import Singles

__all__ = ["in_palette", "palette_of"]

_BIN = 4.0  # Lab; colours nearer than this are one
_ROUNDS = 12  # of k-means; what moves later is not seen
_BINS = (26, 64, 64)  # L 0..100, a and b -128..127
# Of the softmax between colours of the palette, squared Lab: borders between two fields are a pixel or two wide.
_SHARPNESS = np.float32(12.0)
_ROWS = 32  # at once: they stay in the cache


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


def in_palette(fields: Singles, palette: Singles, hairy: Singles) -> Singles:
    """Colours (h, w, 3) of a palette (k, 3): a softmax of squared distances.

    Only what differs between the palette's colours is computed: ``|c|^2 - 2 c s`` for a picture's s, so distances
    that are means over a neighbourhood are those of the mean.

    Parameters
    ----------
    fields : (h, w, 4) float32
        CIELAB, and how surely a pixel is hair.
    palette : (k, 3) float32
    hairy : (k,) float32
        Squared distance that is added to each colour where hair is sure; negative for colours of hair, of which it is
        added where there is none.
    """
    weights = np.column_stack([-2 * palette, hairy]) / -_SHARPNESS
    start = (np.square(palette).sum(axis=1) + np.maximum(-hairy, 0)) / -_SHARPNESS
    weights, start = np.asarray(weights, np.float32), np.asarray(start, np.float32)[:, None]
    result = np.empty((*fields.shape[:2], 3), np.float32)
    for first in range(0, len(fields), _ROWS):
        part = fields[first : first + _ROWS]
        shares = weights @ part.reshape(-1, 4).T + start
        shares -= shares.max(axis=0)
        np.exp(shares, out=shares)
        shares /= shares.sum(axis=0)
        result[first : first + _ROWS] = (shares.T @ palette).reshape(*part.shape[:2], 3)
    return result
