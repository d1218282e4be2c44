"""The mean albedo of the default head, from skin to the inside of the mouth, and nine modes around it.

Nothing here was photographed. A thousand appearances are drawn from a small generator (skin tone, blood,
lips, lids, hair, beard), and their principal components in sRGB are the modes. Sources of the numbers:

* Skin and hair: see ``skin_colour.py`` and ``skin_tones.csv``.
* Blood: forehead and cheek (L 58.2, a 11.5, b 15.9) minus inner arm (61.6, 6.6, 15.7) of 960 people (Xiao
  et al., Skin Res. Technol. 23 (2017) 21-29, group means as in ``skin_tones.csv``) give the direction in
  which skin changes where it is flushed, (-3.4, +4.9, +0.2); cheek minus forehead gives (+2.2, 0, -0.9).
* Lips: darker and redder than the skin about them, least so in dark skin (914 women in three countries,
  reported from a L'Oréal symposium by The Hospitalist); the lower lip lighter and redder than the upper (19
  women, PMC10410235). The amounts were chosen by eye.
* Gums: L 56 a 26 b 18, between clusters 1 and 2 of Ito et al., J. Prosthodont. (120 adults; 51.0 27.7 18.3
  and 61.4 24.3 17.6).
* Teeth: L 80.5 b 15.1 (lower central incisor) to L 73.6 b 21.3 (upper canine) in 640 young adults (Turgut
  et al., Niger. J. Clin. Pract., ajol.info article 174563). Chosen from there: 3 to 7 lighter, 5 to 8 less
  yellow and a little redder, as the teeth of portraits and cartoons are, with half the measured difference
  between incisor and canine.

The distributions (which tone, how much hair, beard, flush), hair, tongue, mouth, sockets, and the shapes of
all areas (``face_paint.py``) were chosen by eye. It is no statistic of any population.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from face_paint import FacePaint, mirror_map, smoothing
from numpy.typing import NDArray
from skin_colour import draw_appearance, hair_colour, lab_to_srgb, skin_tone
from teeth import teeth_shade

Array = NDArray[np.float64]
Index = NDArray[np.int64]

SAMPLES = 1000
MODES = 9
SKIN, NECK, CAVITY, SOCKET_LEFT, SOCKET_RIGHT, UPPER, LOWER, TONGUE = range(8)
_RIM = {  # the regions that are read, and how many edges wide their rims are made
    "lips": 1, "lip_lower": 1, "ears": 4, "neck": 8,
    "eyelid_upper_left": 1, "eyelid_upper_right": 1, "eyelid_lower_left": 1, "eyelid_lower_right": 1,
}  # fmt: skip

_BLOOD = np.array([-3.4, 4.9, 0.2])  # CIELAB change from the inner arm to the face
_CHEEK = np.array([2.2, 0.0, -0.9])  # CIELAB change from forehead to cheek
_GUM = np.array([56.0, 26.0, 18.0])


class _Painter:
    """Weights of every area, and the colours of one appearance on the skin."""

    def __init__(self, paint: FacePaint, soft: dict[str, Array], smooth: sp.csr_matrix, index: Index) -> None:
        lips = np.clip(1.15 * soft["lips"], 0, 1)
        weights = paint.flush() | {
            "lips": lips,
            "lower": soft["lip_lower"],
            "ears": soft["ears"],
            "neck": soft["neck"],
            "upper_lid": soft["eyelid_upper_left"] + soft["eyelid_upper_right"],
            "lower_lid": soft["eyelid_lower_left"] + soft["eyelid_lower_right"],
            "brow": smooth @ paint.brow(),
            "beard": smooth @ paint.beard(lips),
            "lash": paint.lash(),
            "nostril": paint.nostril(),
        }
        self.w = {k: v[index, None] for k, v in weights.items()}

    def colours(self, a: dict[str, float]) -> Array:
        """sRGB (k, 3) of the appearance `a` at the painter's vertices."""
        w = self.w
        base = skin_tone(a["tone"]) + np.array([0.0, a["red"], a["yellow"]])
        depth = np.clip((a["tone"] - 30) / 36, 0.25, 1.1)  # contrasts shrink in dark skin
        blood = 1.1 * w["cheek"] + 0.9 * w["nose"] + 0.35 * w["chin"] + 0.8 * w["ears"] - 0.5 * w["neck"]
        lab = base + depth * (a["flush"] * blood * _BLOOD + 0.5 * (w["cheek"] - w["forehead"]) * _CHEEK)
        lower_lid = w["under_eye"] + 0.5 * w["lower_lid"]
        lab = lab + depth * a["lid"] * (w["upper_lid"] * [-3.0, 1.5, -0.5] + lower_lid * [-2.6, 1.0, -1.5])
        lip = base + depth * np.array([-a["lip_dark"], a["lip_red"], -2.5])
        lip = lip + depth * (2 * w["lower"] - 1) * [1.0, 0.7, 0.0]
        lab = lab + w["lips"] * (lip - lab)
        rgb = lab_to_srgb(lab)
        hair = hair_colour(a["dark_hair"], a["red_hair"])
        # stubble greys the skin it grows from
        shadow = lab_to_srgb(0.55 * base + 0.45 * np.array([30.0, 2.0, 2.0]))
        beard = a["beard"] * w["beard"]
        rgb = rgb + 0.6 * beard * (0.5 * (hair + shadow) - rgb)
        rgb = rgb + a["brow"] * w["brow"] * (hair - rgb)
        rgb = rgb + 0.75 * w["lash"] * (np.array([0.16, 0.10, 0.08]) - rgb)
        return rgb + 0.65 * w["nostril"] * (np.array([0.24, 0.10, 0.08]) - rgb)


def _inside_colours(vertices: Array, part: Index) -> Array:
    """sRGB (n, 3) of mouth, sockets, teeth and tongue, the same in every appearance; zero on the skin."""
    out = np.zeros((len(vertices), 3))
    # darker towards the throat, over so many mm
    for k, near, far, reach in (
        (CAVITY, (0.56, 0.28, 0.26), (0.20, 0.07, 0.07), 20.0),
        (TONGUE, (0.68, 0.39, 0.38), (0.36, 0.15, 0.15), 40.0),
    ):
        z = vertices[part == k, 2]
        t = np.clip((z.max(initial=-np.inf) - z) / reach, 0, 1)[:, None]
        out[part == k] = (1 - t) * np.array(near) + t * np.array(far)
    out[(part == SOCKET_LEFT) | (part == SOCKET_RIGHT)] = (0.78, 0.56, 0.51)
    shade = teeth_shade()
    for k in (UPPER, LOWER):
        found, expected = int((part == k).sum()), len(shade["gum"])
        if found not in (0, expected):
            raise ValueError(f"part: expected {expected} vertices of teeth_quads in part {k}, got {found}")
        if found:
            out[part == k] = _tooth_colours(**shade)
    return out


def _tooth_colours(gum: Array, contact: Array, tooth: Array, inside: Array) -> Array:
    # L, a, b of the two incisors, canine, first premolar and second molar
    known = ([84, 83.5, 81, 81.5, 80], [1.0, 1.0, 1.4, 1.3, 1.5], [10.5, 11, 13, 12.5, 13.5])
    lab = np.column_stack([np.interp(tooth, [0, 1, 2, 3, 6], k) for k in known])
    neck = np.clip(2.5 * gum, 0, 1)[:, None] * (gum < 0.3)[:, None]  # enamel thins towards the gum
    lab = lab + neck * [-4.0, 0.5, 3.0]
    enamel, dark = lab_to_srgb(lab), np.array([0.36, 0.21, 0.17])
    enamel = enamel + (0.65 * contact[:, None] ** 1.5) * (dark - enamel)
    weight = np.clip((gum - 0.3) / 0.35, 0, 1)[:, None]
    colour = enamel + weight * (lab_to_srgb(_GUM) - enamel)
    # little light reaches the back of the mouth
    depth = 1 - tooth[:, None] * [0.05, 0.065, 0.07] - 0.2 * inside[:, None]
    return colour * depth


def albedo_basis(
    vertices_l1: Array,
    normals_l1: Array,
    landmarks: Index,
    regions: dict[str, NDArray[np.bool_]],
    part: Index,
    faces: Index,
    rng: np.random.Generator,
) -> tuple[Array, Array]:
    """Mean albedo of the head and its nine principal modes.

    Parameters
    ----------
    vertices_l1, normals_l1 : (n, 3) float
        The mean head after one Catmull-Clark step, mm in the model frame, and its unit normals.
    landmarks : (68,) int
        Vertices of the iBUG landmarks.
    regions : dict of str to (n,) bool
        ``lips lip_lower mouth_cavity ears neck`` and the four ``eyelid_*`` are read.
    part : (n,) int
        Index into skin, neck, mouth_cavity, socket_left, socket_right, teeth_upper, teeth_lower, tongue.
        Teeth are those of `teeth_quads` in its own order (or there are none).
    faces : (m, 3) int
        Triangles, for the soft rims of the regions.
    rng : numpy.random.Generator
        Draws the appearances: same state, same basis.

    Returns
    -------
    mean : (n, 3) float
        sRGB in [0, 1].
    modes : (9, n, 3) float
        Orthogonal, largest first; one unit is one standard deviation, and adding a mode brightens the face.
        Zero off skin and neck. On the default head one mode at 2.5 deviations stays within (0, 1); sums of
        several may leave it and are clipped by who uses them. Mean and modes are exactly symmetric where
        `vertices_l1` is symmetric to 0.1 mm.

    Raises
    ------
    ValueError
        If a shape or an index does not fit, a region is missing, or the teeth are not those of `teeth_quads`.
    """
    n = len(vertices_l1)
    _check(n, normals_l1, landmarks, regions, part, faces)
    skin = (part == SKIN) | (part == NECK)
    mirror = mirror_map(vertices_l1, normals_l1, part)
    smooth = smoothing(faces, n)
    # the inner side of the lips counts as mouth cavity, but it is skin and has their colour
    areas = regions | {"lips": regions["lips"] | regions["mouth_cavity"]}
    soft = {k: _softened(areas[k], smooth, steps) * skin for k, steps in _RIM.items()}
    paint = FacePaint(vertices_l1, normals_l1, vertices_l1[landmarks], skin)
    # one side stands for both, so the basis is symmetric to the last bit; in the PCA a pair counts twice
    half = np.flatnonzero(skin & (np.arange(n) <= mirror))
    twice = 1.0 + (mirror[half] != half)
    painter = _Painter(paint, soft, smooth, half)
    samples = np.stack([painter.colours(draw_appearance(rng)) for _ in range(SAMPLES)])
    inside = _inside_colours(vertices_l1, part)
    mean, modes = 0.5 * (inside + inside[mirror]), np.zeros((MODES, n, 3))
    mean[half] = samples.mean(0)
    modes[:, half] = _principal_modes(samples - mean[half], twice)
    mean[mirror[half]], modes[:, mirror[half]] = mean[half], modes[:, half]
    return mean, modes


def _softened(region: NDArray[np.bool_], smooth: sp.csr_matrix, steps: int) -> Array:
    value = region.astype(float)
    for _ in range(steps):
        value = smooth @ value
    return value


def _principal_modes(deviations: Array, weights: Array) -> Array:
    """Modes (9, k, 3) of `deviations` (samples, k, 3), the vertices counted with `weights` (k,)."""
    flat = (deviations * np.sqrt(weights)[:, None]).reshape(len(deviations), -1)
    vectors = np.linalg.eigh(flat @ flat.T / len(flat))[1]
    vectors = vectors[:, ::-1][:, :MODES]
    modes = (vectors.T @ flat / np.sqrt(len(flat))).reshape(MODES, -1, 3) / np.sqrt(weights)[:, None]
    sign = np.sign((modes * weights[:, None]).sum((1, 2)))
    return modes * np.where(sign == 0, 1.0, sign)[:, None, None]


def _check(
    n: int, normals: Array, landmarks: Index, regions: dict[str, NDArray[np.bool_]],
    part: Index, faces: Index,
) -> None:  # fmt: skip
    if np.shape(normals) != (n, 3):
        raise ValueError(f"normals_l1: expected {(n, 3)} as the vertices, got {np.shape(normals)}")
    if np.shape(landmarks) != (68,) or np.min(landmarks) < 0 or np.max(landmarks) >= n:
        raise ValueError(f"landmarks: expected (68,) vertices below {n}, got {np.shape(landmarks)}")
    if np.shape(part) != (n,) or np.min(part) < SKIN or np.max(part) > TONGUE:
        raise ValueError(f"part: expected ({n},) indices from 0 to {TONGUE}, got {np.shape(part)}")
    if np.ndim(faces) != 2 or np.shape(faces)[1] != 3 or np.min(faces) < 0 or np.max(faces) >= n:
        raise ValueError(f"faces: expected (m, 3) vertices below {n}, got {np.shape(faces)}")
    for name in (*_RIM, "mouth_cavity"):
        shape = regions[name].shape if name in regions else None
        if shape != (n,):
            raise ValueError(f"regions: expected {name!r} of shape ({n},), got {shape}")
