"""About what a head turns."""

import numpy as np

__all__ = ["NECK_MM"]

# Model frame: the bone of the head, as in humanoid_bones.csv.
NECK_MM = np.array([0.0, -85.0, -80.0])
NECK_MM.flags.writeable = False
