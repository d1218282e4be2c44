"""What an avatar lacks because its model does."""

from __future__ import annotations

from toongeo.model import MorphableModel
from toongeo.model.anatomy.lid_rings import lids_of
from toongeo.model.anatomy.parts import TEETH_AND_TONGUE

__all__ = ["missing_parts"]

# What is asked of a model, and what its avatar is without.
_PARTS: tuple[tuple[tuple[str, ...], str], ...] = (
    (("expression",), "expressions: the rig moves nothing"),
    (("eyes",), "eyeballs: nothing turns with the gaze"),
    ((*lids_of("left"), *lids_of("right")), "rings of quads around the eyes: no contact of lids is looked after"),
    (("eyeBlinkLeft", "eyeBlinkRight"), "blinks that close"),
    (("mouth_cavity",), "inside of the mouth: no contact of lips is looked after"),
    (TEETH_AND_TONGUE, "teeth and tongue"),
    (("scalp", "forehead", "ears"), "regions of scalp, forehead and ears: no hair is painted"),
    (("uv", "uv_faces"), "texture coordinates: longitude and latitude stand in"),
)


def missing_parts(model: MorphableModel) -> list[str]:
    """A sentence for each part of a face that a model does not have.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from toongeo.model import default_model
    >>> missing_parts(default_model())
    []
    >>> missing_parts(replace(default_model(), eyes=()))
    ['the model has no eyeballs: nothing turns with the gaze']
    """
    return [f"the model has no {what}" for names, what in _PARTS if not model.has(*names)]
