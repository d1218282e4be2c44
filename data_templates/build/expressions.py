"""Expression modes: 46 cleaned face units and 18 modes of what they miss of the other expression targets."""

from __future__ import annotations

import numpy as np
from cage import PARTS, Cage
from contacts import LIP_RIM, skin_walk
from identity import MILLIMETRES
from scipy.spatial import cKDTree
from source import FACE_UNITS, MPFB, Floats, Source
from thin_plate import softened

N_EXTRA = 18
_PEOPLE = ("african", "asian", "caucasian")
# Units split into a left and a right half, with the half width in mm of the blend across the middle.
_SPLIT = {"browInnerUp": 6.0, "cheekPuff": 5.0}
_CREASED = ("mouthSmile", "mouthDimple", "mouthLeft", "mouthRight")
_CHEEK_STIFFNESS = 300.0
_UPPER_FACE = ("eye", "brow", "cheekSquint", "nose")


def named_expressions(source: Source, cage: Cage, mean: Floats) -> dict[str, Floats]:
    """The 46 named units, name -> (n, 3) mm at weight 1, in alphabetical order.

    The source's stray edits go: upper-face units leave the neck and the inside of the mouth alone, eye units
    the other half of the face; each unit is averaged with the mirror image of its partner. Gaze units are
    dropped (the eyeballs turn), and two symmetric units are split into halves.
    """
    raw = {}
    for name in source.names(FACE_UNITS):
        if not name.startswith("eyeLook"):
            delta = source.target(f"faceunits/{name}", int(cage.source.max()) + 1)[cage.source]
            raw[name] = _without_stray_edits(name, delta * MILLIMETRES, cage, mean)
    out: dict[str, Floats] = {}
    for name, delta in raw.items():
        partner = name.replace("Left", "Right") if "Left" in name else name.replace("Right", "Left")
        out[name] = (delta + cage.mirrored(raw[partner])) / 2
    for name, width in _SPLIT.items():
        delta = out.pop(name)
        left = 1 / (1 + np.exp(-mean[:, :1] / width))
        out[f"{name}Left"], out[f"{name}Right"] = delta * left, delta * left[cage.mirror]
    return dict(sorted(out.items()))


def _without_stray_edits(name: str, delta: Floats, cage: Cage, mean: Floats) -> Floats:
    delta = delta.copy()
    if name.startswith(_UPPER_FACE):
        inside = [PARTS.index(p) for p in ("neck", "mouth_cavity", "teeth_upper", "teeth_lower", "tongue")]
        delta[np.isin(cage.part, inside)] = 0
    if name.startswith("eye"):
        side = 1 if name.endswith("Left") else -1
        delta[side * mean[:, 0] < 2] = 0
    delta[cage.part == PARTS.index("teeth_upper")] = 0
    return delta


def extra_expressions(source: Source, cage: Cage, named: Floats, weight: Floats) -> Floats:
    """Modes (18, n, 3) mm of what `named` (46, n, 3) cannot express of the 102 expression targets of three
    peoples.

    The residuals and their mirror images share their principal modes, each symmetric or antisymmetric; a mode
    is scaled to the root mean square of its coefficient over the targets.
    """
    units = []
    for people in _PEOPLE:
        folder = f"expression/units/{people}"
        for name in source.names(f"{MPFB}/targets/{folder}"):
            units.append(source.target(f"{folder}/{name}", int(cage.source.max()) + 1)[cage.source] * MILLIMETRES)
    deltas = np.array(units)
    deltas[:, cage.part >= PARTS.index("teeth_upper")] = 0
    root = np.sqrt(weight)[:, None]
    known = (named * root).reshape(len(named), -1)
    values, modes = [], []
    for sign in (1, -1):
        half = (deltas + sign * cage.mirrored(deltas)) / 2
        flat = (half * root).reshape(len(half), -1)
        rest = half - np.tensordot(np.linalg.lstsq(known.T, flat.T)[0].T, named, 1)
        left, s, _ = np.linalg.svd((rest * root).reshape(len(rest), -1), full_matrices=False)
        for k in range(N_EXTRA):
            mode = np.tensordot(left[:, k], rest, 1) / np.sqrt(len(rest))
            values.append(s[k])
            modes.append(mode * np.sign(mode.ravel()[np.abs(mode).argmax()]))
    return np.array(modes)[np.argsort(-np.array(values), kind="stable")[:N_EXTRA]]


def without_cheek_creases(cage: Cage, mean: Floats, named: dict[str, Floats]) -> dict[str, Floats]:
    """Named expressions whose smiles do not fold the cheek beside the mouth corner."""
    skin = cage.vertices_of("skin")
    rim = cage.local(skin_walk(cage).loop(*LIP_RIM))
    gap = np.full(len(mean), np.inf)
    gap[skin] = cKDTree(mean[rim]).query(mean[skin])[0]
    zone = np.clip((gap - 5) / 4, 0, 1) * np.clip((45 - gap) / 10, 0, 1) * np.clip((np.abs(mean[:, 0]) - 14) / 6, 0, 1)
    return {n: softened(cage, d, zone, _CHEEK_STIFFNESS) if n.startswith(_CREASED) else d for n, d in named.items()}
