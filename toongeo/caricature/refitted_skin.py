"""A caricature's skin, for landmarks that moved a little."""

from toongeo.arrays import Floats
from toongeo.caricature.alternation import WEIGHT, Alternation
from toongeo.caricature.caricature_fit import CaricatureFit
from toongeo.caricature.caricature_options import CaricatureOptions

__all__ = ["refitted_skin"]


def refitted_skin(start: CaricatureFit, pixels: Floats, options: CaricatureOptions) -> Floats:
    """Vertices (k, 3) of the space after one turn of `fit_caricature` to other landmarks (68, 2) px.

    Mouth and sockets, which would follow, are left alone.
    """
    solver = Alternation(start.space, pixels, WEIGHT, options)
    return solver.run(solver.resumed(start), 1)[0]
