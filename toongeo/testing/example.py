"""What checks are made on: a bundled picture and the face in it."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["aligned_example", "example", "fitted_example", "require", "unchanged"]

_PICTURE = "examples/portraits/moustache_man"


@cache
def example() -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """A drawing (H, W, 3) uint8 and its landmarks (68, 2) px; neither can be written to."""
    from toongeo.io import read_image, read_landmarks
    from toongeo.model import data_path

    img, landmarks = read_image(data_path(f"{_PICTURE}.png")), read_landmarks(data_path(f"{_PICTURE}.pts"))
    img.setflags(write=False)
    landmarks.setflags(write=False)
    return img, landmarks


@cache
def fitted_example() -> Any:
    """The FaceFit of the example."""
    from toongeo.pipeline import fit_3dmm

    return fit_3dmm(None, example()[1])


@cache
def aligned_example() -> tuple[Any, Any, NDArray[np.bool_]]:
    """Aligned face with room for hair, its rig, and a mask of hair."""
    from toongeo.pipeline import align_face, build_rig, find_hair, make_room

    img, landmarks = example()
    fit = fitted_example()
    mask = find_hair(img, landmarks, fit).mask
    face = align_face(fit, landmarks)
    return *make_room(face, build_rig(face), mask), mask


def require(holds: object, message: str) -> None:
    """Fail with what was expected and what came.

    Raises
    ------
    AssertionError
    """
    if not holds:
        raise AssertionError(message)


def unchanged(name: str, before: NDArray, after: NDArray) -> None:
    """Fail if an argument was written to."""
    require(np.array_equal(before, after, equal_nan=before.dtype.kind == "f"), f"{name}: expected not to be written to")
