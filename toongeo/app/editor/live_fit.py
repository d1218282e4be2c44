"""The face that goes with landmarks while they move."""

import threading

from toongeo.arrays import Bytes, Floats
from toongeo.pipeline.fit import FaceFit, fit_3dmm
from toongeo.protocols import Coefficients

__all__ = ["LiveFit"]

# Of the loss, while points move: a third of the evaluations, and the error of the landmarks (of the example pictures)
# changes by less than 0.1 % of the outer-eye distance.
_LIVE_TOLERANCE = 1e-4


class LiveFit:
    """Fits of landmarks, each of which may begin where the last one ended."""

    def __init__(self) -> None:
        self._last: Coefficients | None = None
        self._lock = threading.Lock()

    def fit(self, img: Bytes, landmarks: Floats, *, final: bool) -> FaceFit:
        """A fit of landmarks (68, 2) px, NaN where missing; raises what :func:`toongeo.fit_3dmm` does.

        ``final`` fits from the beginning, as ``toongeo make`` will; else the fit goes on from the last one, less finely
        and in a fraction of the time.
        """
        with self._lock:
            start = self._last
            if final or start is None:
                fit = fit_3dmm(img, landmarks)
            else:
                fit = fit_3dmm(img, landmarks, regressor=lambda *_: start, tolerance=_LIVE_TOLERANCE)
            self._last = Coefficients(identity=fit.identity, expression=fit.expression, pose=fit.camera)
            return fit
