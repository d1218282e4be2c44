"""Whether something is a `HairModeler`."""

from __future__ import annotations

import numpy as np

from toongeo.protocols import HairModeler
from toongeo.testing.example import aligned_example, example, require, unchanged

__all__ = ["check_hair_modeler"]


def check_hair_modeler(modeler: HairModeler) -> None:
    """Call a modeler for a face that has made room for hair.

    Parameters
    ----------
    modeler : HairModeler

    Raises
    ------
    AssertionError
        If it returns something else than Hair or None, with vertices that are not finite or triangles out of range,
        or writes to its arguments.

    Examples
    --------
    >>> check_hair_modeler(lambda img, face, rig, mask: None)
    """
    from toongeo.pipeline import Hair

    img, _ = example()
    face, rig, mask = aligned_example()
    given = np.array(img), np.array(mask)
    found = modeler(given[0], face, rig, given[1])
    unchanged("img", img, given[0])
    unchanged("mask", mask, given[1])
    require(found is None or isinstance(found, Hair), f"modeler: expected Hair or None, got {type(found).__name__}")
    if isinstance(found, Hair):
        require(np.isfinite(found.vertices).all(), "vertices: expected finite numbers")
        inside = 0 <= found.faces.min() <= found.faces.max() < len(found.vertices)
        require(inside, f"faces: expected vertices below {len(found.vertices)}, got {found.faces.max()}")
