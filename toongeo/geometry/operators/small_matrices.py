"""Products of many 3 x 3 matrices that stand along the last axis."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["product"]


def product(A: NDArray[np.float64], B: NDArray[np.float64]) -> NDArray[np.float64]:
    """``A_i B_i`` (a, c, n) of matrices (a, 3, n) and (3, c, n); faster than einsum or matmul at this size."""
    return A[:, 0, None] * B[0] + A[:, 1, None] * B[1] + A[:, 2, None] * B[2]
