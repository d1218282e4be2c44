"""Weights under names of other systems, as weights of our own expressions."""

import difflib
import math
import numbers
from collections.abc import Mapping
from functools import cache

from toongeo.model.expression_schemes import EXPRESSIONS, PRESETS, SCHEMES

__all__ = ["expression_weights", "preset"]

_OWN = {name: {name: 1.0} for name in EXPRESSIONS}


def expression_weights(weights: Mapping[str, float], scheme: str | None = None) -> dict[str, float]:
    """Weights by any known name, as weights of the 46 expressions and the eight ``eyeLook*`` directions.

    Known are our own names, those of ARKit, MediaPipe, Live Link Face and VRM 1.0, FACS action units (``"AU12"``, or
    one side of it, ``"AU12L"``), Oculus visemes (``"viseme_aa"`` or ``"aa"``) and presets (:func:`preset`). What
    several names move adds up; nothing is clipped.

    Parameters
    ----------
    weights : mapping of name to weight
    scheme : {"arkit", "mediapipe", "live_link", "facs", "oculus", "vrm", "preset"}, optional
        Only names of this scheme, such as of one source of capture; None: all names. A name means the same in every
        scheme.

    Returns
    -------
    dict
        Only what moves: names with weight 0 are left out.

    Raises
    ------
    ValueError
        If a name is unknown (the nearest are suggested), a weight is not a finite number, or the scheme is unknown.

    Examples
    --------
    >>> expression_weights({"AU1": 0.5, "jawOpen": 0.2})
    {'browInnerUpLeft': 0.5, 'browInnerUpRight': 0.5, 'jawOpen': 0.2}
    >>> expression_weights({"HeadYaw": 0.3, "TongueOut": 1}, scheme="live_link")
    {'tongueOut': 1.0}
    """
    known = _known(scheme)
    total: dict[str, float] = {}
    for name, weight in weights.items():
        if name not in known:
            raise ValueError(f"weights: no expression {name!r}{_in(scheme)}{nearest(name, known)}")
        if not isinstance(weight, numbers.Real) or not math.isfinite(weight):
            raise ValueError(f"weights: expected a finite number for {name}, got {weight!r}")
        for own, amount in known[name].items():
            total[own] = total.get(own, 0.0) + amount * float(weight)
    return {name: weight for name, weight in total.items() if weight}


def preset(name: str, strength: float = 1.0) -> dict[str, float]:
    """Weights of a whole expression, such as ``"smile"``, or of a viseme, such as ``"viseme_aa"``.

    Parameters
    ----------
    name
        One of ``neutral smile laugh anger surprise sadness fear disgust relaxed wink wink_left wink_right kiss``, or a
        viseme: ``viseme_`` and one of ``sil PP FF TH DD kk CH SS nn RR aa E ih oh ou``.
    strength : float
        By which all weights are multiplied.

    Returns
    -------
    dict
        Weights by name, as :meth:`toongeo.Avatar.vertices` takes them.

    Raises
    ------
    ValueError
        If there is no such preset (the nearest are suggested) or the strength is not a finite number.

    Examples
    --------
    >>> preset("kiss")
    {'mouthPucker': 1.0, 'eyeBlinkLeft': 0.3, 'eyeBlinkRight': 0.3}
    """
    if name not in PRESETS:
        raise ValueError(f"name: no preset {name!r}{nearest(name, PRESETS)}; known: {', '.join(PRESETS)}")
    if not isinstance(strength, numbers.Real) or not math.isfinite(strength):
        raise ValueError(f"strength: expected a finite number, got {strength!r}")
    return {own: weight * float(strength) for own, weight in PRESETS[name].items()}


def nearest(name: object, known: Mapping[str, object]) -> str:
    """``"; did you mean ...?"`` with the known names that are nearest, or nothing."""
    near = difflib.get_close_matches(str(name), list(known), n=3, cutoff=0.4)
    return f"; did you mean {', '.join(near)}?" if near else ""


@cache
def _known(scheme: str | None) -> Mapping[str, Mapping[str, float]]:
    schemes = {**SCHEMES, "preset": PRESETS}
    if scheme is None:
        every: dict[str, Mapping[str, float]] = {}
        for names in (*schemes.values(), _OWN):
            every.update(names)
        return every
    if scheme not in schemes:
        raise ValueError(f"scheme: expected one of {', '.join(schemes)}, got {scheme!r}")
    return schemes[scheme]


def _in(scheme: str | None) -> str:
    return f" in {scheme}" if scheme else ""
