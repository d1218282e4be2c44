"""What stages know of a face, and who builds hair for it."""

from typing import Any, Protocol

import numpy as np

from toongeo.protocols.cameras import HeadCamera

__all__ = ["FittedFace", "HairModeler"]


class HairModeler(Protocol):
    """Builds hair from the pixels that show it; a network, say, or :func:`toongeo.build_hair`.

    :func:`toongeo.testing.check_hair_modeler` checks one; ``make_avatar(img, hair=...)`` uses it.

    Examples
    --------
    >>> class OnlyLong:
    ...     "Builds hair if it hangs below the chin; short hair stays painted on the head."
    ...     def __call__(self, img, face, rig, mask):
    ...         from toongeo import build_hair
    ...         chin = face.project(face.vertices[face.landmark_vertices[8:9]])[0, 1]
    ...         return build_hair(img, face, rig, mask) if mask[int(chin) :].any() else None
    >>> from toongeo.testing import check_hair_modeler
    >>> check_hair_modeler(OnlyLong())
    """

    def __call__(self, img: np.ndarray, face: Any, rig: Any, mask: np.ndarray) -> Any:
        """Hair of the picture (H, W, 3) uint8, as a :class:`toongeo.Hair` in the model frame.

        ``face`` is a :class:`toongeo.AlignedFace` that has made room for hair, ``rig`` its :class:`toongeo.Rig`,
        ``mask`` (H, W) bool. None: there is no hair to build, and it stays painted on the head.
        """
        ...


class FittedFace(Protocol):
    """What the stages share: a face mesh in the model frame, and the camera that saw it."""

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3) mm, model frame."""
        ...

    @property
    def faces(self) -> np.ndarray:
        """(m, 3) int."""
        ...

    @property
    def camera(self) -> HeadCamera:
        """From the model frame to the picture."""
        ...

    def region(self, name: str) -> np.ndarray:
        """(n,) bool: which vertices belong to the region."""
        ...
