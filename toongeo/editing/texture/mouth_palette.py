"""Teeth, tongue and cavity in the colours of a drawing.

Constants were judged on the seven examples (``benchmarks/editing.py``).
"""

import numpy as np

from toongeo.editing.texture.match_colours import match_colours, to_lab
from toongeo.editing.texture.openings import inner_rims
from toongeo.geometry import vertex_normals
from toongeo.model import MorphableModel
from toongeo.model.anatomy.parts import MOUTH_PARTS

__all__ = ["mouth_palette"]

_DEEP = 0.3  # of the mouth's width: over this depth behind the lips the light falls to 1/e
_DIMMEST = 0.22  # of the light, at the back of the mouth
_TEETH_LIGHT = 0.6  # of the light on teeth that does not depend on how deep they stand
_STREWN = 9.0  # L: spread of the lightness of shaded skin; a flatter drawing gets flatter teeth
_COLOURED = 8.0  # chroma by which lips must differ from the skin to tell the hue of the tongue
_TONGUE_HUE = np.array([22.0, 10.0])  # a*, b* of a tongue beside those of skin, where lips say nothing
_TEETH = np.array([88.0, 0.5, 5.0])  # CIELAB


def mouth_palette(
    model: MorphableModel, V: np.ndarray, colours: np.ndarray, lip: np.ndarray, skin: np.ndarray
) -> np.ndarray:
    """Colours (n, 3), 0-255, of the inner parts of the mouth; those of other vertices are returned as they are.

    Region by region the mean colour is chosen from the drawing's own, and the spread about it from the drawing's
    contrast (:func:`match_colours`): teeth are nearly as light as the lightest that is drawn, the tongue has the hue
    of the lips, the cavity is the darkest. What lies deeper behind the lips is darker.

    Parameters
    ----------
    model : MorphableModel
    V : (n, 3) float, mm
    colours : (n, 3) float, 0-255
        Of all vertices, as the texture has them.
    lip, skin : (n,) bool
        Vertices whose colours are those of lips and of skin.
    """
    lab = to_lab(colours)
    skin_lab, lip_lab = np.median(lab[skin], axis=0), np.median(lab[lip], axis=0)
    lightness = lab[skin | model.region("eye_left") | model.region("eye_right") | lip, 0]
    darkest, lightest = np.percentile(lightness, [2, 99])
    contrast = float(np.clip(lab[skin, 0].std() / _STREWN, 0.2, 1.0))
    hue = lip_lab[1:] if np.linalg.norm(lip_lab[1:] - skin_lab[1:]) > _COLOURED else skin_lab[1:] + _TONGUE_HUE
    tint = 0.15 * (skin_lab[1:] - _TEETH[1:])
    teeth = np.r_[min(max(lightest, skin_lab[0] + 4), _TEETH[0] + 6), _TEETH[1:] + tint]
    tongue = np.r_[np.clip(0.75 * lip_lab[0], 32, 60), hue]
    cavity = np.r_[np.clip(0.5 * darkest + 10, 8, 28), 0.6 * hue]
    filled = np.array(colours, np.float32)
    for region, mean in (("mouth_cavity", cavity), ("teeth_upper", teeth), ("teeth_lower", teeth), ("tongue", tongue)):
        where = model.region(region)
        filled[where] = match_colours(255.0 * model.albedo_mean[where], mean, contrast)
    inner = np.any([model.region(name) for name in MOUTH_PARTS], axis=0)
    light = _light_inside(model, V)
    teeth_region = model.region("teeth_upper") | model.region("teeth_lower")
    light[teeth_region] = _TEETH_LIGHT + (1 - _TEETH_LIGHT) * light[teeth_region]
    filled[inner] *= light[inner, None]
    return filled


def _light_inside(model: MorphableModel, V: np.ndarray) -> np.ndarray:
    """Share (n,) of the light that reaches vertices behind the lips, and how they face it."""
    rims = np.concatenate(inner_rims(model))
    width = float(np.ptp(V[rims, 0]))
    depth = np.maximum(np.median(V[rims, 2]) - V[:, 2], 0) / (_DEEP * max(width, 1e-9))
    facing = 0.8 + 0.2 * np.clip(vertex_normals(V, model.faces)[:, 2], 0, 1)
    return np.asarray(facing * np.maximum(np.exp(-0.5 * depth), _DIMMEST))
