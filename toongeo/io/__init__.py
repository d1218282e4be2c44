"""Files: pictures, landmarks, and meshes as GLB, VRM, OBJ, PLY and USDZ.

Axes and units are converted here and nowhere else. Every writer is atomic: on any error nothing
half-written remains.
"""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
