"""Colours of lids that are shut, for pictures that show them open."""

import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.texture.lids.lid_membrane import lid_membrane
from toongeo.pipeline.texture.lids.lid_zones import skin_edges

__all__ = ["closed_lids"]


def closed_lids(
    model: MorphableModel, rig: Rig, zones: np.ndarray, colours: np.ndarray, relief: float = 1.0
) -> np.ndarray:
    """Colours (n, 3) of vertices with both lids shut: skin as around the eyes, shaded by how a closed lid is bent.

    Parameters
    ----------
    model : MorphableModel
    rig : Rig
        With both blinks.
    zones : (2, n) float in [0, 1]
        For the left and the right eye, how far a vertex is skin that only a closed eye shows.
    colours : (n, 3) float, sRGB, 0-255
        Of the texture.
    relief : float
        How much of the shading there is, of that of a painted face.
    """
    edges, painted = skin_edges(model), np.array(colours, float)
    for side, zone in zip(SIDES, zones, strict=True):
        closed = rig.neutral + rig.deltas[rig.names.index(f"eyeBlink{side.capitalize()}")]
        painted = lid_membrane(model, side, zone, edges, painted, closed, relief)
    return painted
