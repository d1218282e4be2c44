"""Types of arrays, for annotations."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["Bytes", "Floats", "Integers", "Mask", "Reals", "Singles"]

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Reals = NDArray[np.floating]  # of either precision
Integers = NDArray[np.int64]
Mask = NDArray[np.bool_]
Bytes = NDArray[np.uint8]
