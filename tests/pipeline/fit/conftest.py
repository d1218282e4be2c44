"""Taylor slopes."""

import numpy as np
import pytest


@pytest.fixture(scope="session")
def taylor_slope():
    """Order at which ``f(x + h d) - f(x) - h g.d`` vanishes: 2 if the gradient is right, 1 if not."""

    def slope(loss, x, direction, steps=(1e-2, 1e-3)):
        value, gradient = loss(x)
        rests = [abs(loss(x + h * direction)[0] - value - h * gradient @ direction) for h in steps]
        return float(np.log(rests[0] / rests[1]) / np.log(steps[0] / steps[1]))

    return slope
