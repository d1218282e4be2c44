"""From a photograph to a drawing."""

import numbers
from dataclasses import replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Bytes, Floats, Singles
from toongeo.colour.cielab import cielab
from toongeo.io import check_image
from toongeo.pipeline.fit import FaceFit, fit_3dmm, ibug_landmarks
from toongeo.pipeline.landmarks.given_or_found import given_or_found
from toongeo.pipeline.parse.completed_landmarks import completed_landmarks
from toongeo.pipeline.parse.find_hair import seen_hair
from toongeo.pipeline.stylize.appearance.head_light import HeadLight, head_light
from toongeo.pipeline.stylize.appearance.pixels import placed_in, sampled
from toongeo.pipeline.stylize.appearance.subject import Subject, subject_of, working_factor
from toongeo.pipeline.stylize.coloured_drawing import Backdrop, coloured_drawing, surroundings
from toongeo.pipeline.stylize.exaggerated import exaggerated
from toongeo.pipeline.stylize.face_frame import face_frame
from toongeo.pipeline.stylize.ink_drawing import ink_drawing
from toongeo.pipeline.stylize.style import STYLES, Style
from toongeo.pipeline.stylize.style_rules import style_rules
from toongeo.pipeline.stylize.velocity_warp import VelocityWarp, velocity_warp
from toongeo.pipeline.texture import find_irises
from toongeo.pipeline.texture.find_rims import find_rims
from toongeo.protocols import HairMask, Stylized

__all__ = ["check_strength", "check_style", "reduced_fit", "stylize", "subject_for"]

_LARGEST = 2_000_000  # pixels that are drawn; larger pictures are drawn at this size and enlarged
_STRONGEST = 2.0
# Passes and colour tolerance (Lab) of the abstraction: paintings keep more.
_PASSES, _TOLERANCE = 3, 9.0
_PAINTED_PASSES, _PAINTED_TOLERANCE = 2, 7.0
# px of the head in which hair is looked for: it guides the cut of the skin, and colours. At 125 the white hair of
# einstein is not found.
_HAIR_VIEW = 150.0
_DOUBTFUL = 0.75  # how much a mask of hair that is not trusted says


def stylize(
    img: np.ndarray,
    landmarks: ArrayLike | None = None,
    style: str = "toon",
    *,
    strength: float = 1.0,
    scheme: Any = "ibug68",
) -> Stylized:
    """A drawing of the face in a photograph: warped as its style wants, smoothed along edges, in few colours, with
    lines along the landmarks (the first stage of Pan et al. 2024, without a network).

    The warp is the exponential of a velocity field, so it never folds. Skin takes two or three tones by the *fitted*
    light, not by the photograph's noise; eyes, lips, brows, nose and jaw are drawn along the landmarks; all else keeps
    to a small palette. All lengths are in face sizes: a larger picture gives the same drawing.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) array_like, px, optional
        iBUG-68; NaN rows are missing and taken from the fitted face. None: those that
        :func:`toongeo.detect_landmarks` finds.
    style : {"toon", "chibi", "caricature", "ink", "painted"}
        ``"caricature"`` exaggerates what is special about this face.
    strength : float in [0, 2]
        Of the warp; below 1 the photograph also shows through. 0 gives the picture back.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    Stylized
        The drawing, its landmarks, the warp, and the variant for textures.

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, the landmarks cannot belong to it or none are found, the style is
        unknown, or the strength is not in [0, 2].

    References
    ----------
    H. Winnemoeller, J. E. Kyprianidis, S. C. Olsen: XDoG. Computers & Graphics 2012. J. E. Kyprianidis, H. Kang: Image
    and video abstraction by coherence-enhancing filtering. CGF 2011. S. E. Brennan: Caricature generator.
    Leonardo 1985.

    Examples
    --------
    >>> from toongeo import read_image, read_landmarks
    >>> from toongeo.model import data_path
    >>> img = read_image(data_path("examples/portraits/astronaut.png"))
    >>> points = read_landmarks(data_path("examples/portraits/astronaut.pts"))
    >>> drawn = stylize(img, points, "toon")
    >>> eye = [36, 39]  # corners of one eye
    >>> bool(np.ptp(drawn.landmarks[eye, 0]) > 1.2 * np.ptp(points[eye, 0]))
    True
    """
    check_image(img)
    look = check_style(style)
    check_strength(strength)
    points = ibug_landmarks(given_or_found(img, landmarks, scheme), scheme)
    fit = fit_3dmm(img, points)
    points = completed_landmarks(points, fit)
    displacement = look.exaggeration * exaggerated(points, fit) if look.exaggeration else None
    warp = velocity_warp((img.shape[0], img.shape[1]), points, style_rules()[style], strength, displacement)
    if strength == 0:
        return Stylized(img, points, warp, img)
    factor = min(1.0, (_LARGEST / (img.shape[0] * img.shape[1])) ** 0.5)
    photo, placed = _reduced(img, factor), placed_in(points, factor)
    bent, there = warp.scaled(factor), reduced_fit(fit, factor)
    hair = seen_hair(photo, placed, there, _HAIR_VIEW)
    subject = subject_for(photo, placed, there, bent, look, hair)
    backdrop = None if look.ink else surroundings(subject, look)
    below = bent.picture(photo) if strength < 1 else None
    drawing, texture = (
        _drawn(subject, variant, backdrop, below, strength, img.shape) for variant in (look, look.for_texture())
    )
    return Stylized(drawing, warp.points(points), warp, texture, resized_hair(hair, (img.shape[0], img.shape[1])))


def check_strength(strength: object) -> None:
    """Refuse what is no strength.

    Raises
    ------
    ValueError
        If it is not a number in [0, 2].
    """
    if not (isinstance(strength, numbers.Real) and 0 <= float(strength) <= _STRONGEST):
        raise ValueError(f"strength: expected a number in [0, {_STRONGEST:g}], got {strength!r}")


def check_style(style: object) -> Style:
    """The appearance of a style.

    Raises
    ------
    ValueError
        If it is unknown.
    """
    if not (isinstance(style, str) and style in STYLES):
        raise ValueError(f"style: expected one of {', '.join(STYLES)}, got {style!r}")
    return STYLES[style]


def subject_for(photo: Bytes, points: Floats, fit: FaceFit, warp: VelocityWarp, look: Style, hair: HairMask) -> Subject:
    """What is measured on a photograph (H, W, 3) whose face has landmarks (68, 2) px and a fit, after the warp."""
    shape = (photo.shape[0], photo.shape[1])
    moved, irises = warp.points(points), find_irises(photo, points)
    rims = find_rims(photo, points)
    size, before = face_frame(moved).size, face_frame(points).size
    factor = working_factor(shape, size)
    small = _reduced(photo, min(factor, 1.0))
    light = head_light(photo, fit, points, before)
    places = warp.scaled(factor).sources((round(factor * shape[0]), round(factor * shape[1])))
    seen = cielab(small)

    def taken(plane: Singles) -> Singles:
        there = placed_in(np.asarray(places, np.float64), plane.shape[1] / (factor * shape[1]))
        return np.asarray(sampled(plane, there.astype(np.float32), cv2.INTER_LINEAR, cv2.BORDER_REPLICATE))

    right, left = (None if iris is None else warp.points(iris.centre) for iris in irises[::-1])
    painted = look.palette == 0
    return subject_of(
        shape,
        taken(seen),
        moved,
        size,
        HeadLight(taken(light.head), taken(light.face), taken(light.shade), light.from_right),
        taken(_cover(hair)),
        (right, left),
        None if rims is None else replace(rims, lines=tuple(warp.points(line) for line in rims.lines)),
        passes=_PAINTED_PASSES if painted else _PASSES,
        tolerance=_PAINTED_TOLERANCE if painted else _TOLERANCE,
    )


def reduced_fit(fit: FaceFit, factor: float) -> FaceFit:
    """The fit in a picture that was resized by a factor."""
    return replace(fit, camera=fit.camera.cropped(np.full(2, 0.5 / factor - 0.5), factor))


def _reduced(img: Bytes, factor: float) -> Bytes:
    if factor >= 1:
        return img
    return np.asarray(cv2.resize(img, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA), np.uint8)


def resized_hair(hair: HairMask, shape: tuple[int, int]) -> HairMask:
    """Hair of a picture that was resized to a shape (h, w)."""
    if hair.mask.shape == shape:
        return hair

    def large(plane: np.ndarray) -> Singles:
        return np.asarray(cv2.resize(plane.astype(np.float32), shape[::-1], interpolation=cv2.INTER_LINEAR))

    mask = large(hair.mask) > 0.5
    alpha = None if hair.alpha is None else np.clip(large(hair.alpha), 0, 1)
    return replace(hair, mask=mask, alpha=alpha, hat=None if hair.hat is None else (large(hair.hat) > 0.5) & ~mask)


def _cover(found: HairMask) -> Singles:
    """How surely each pixel (h, w) is hair or a hat."""
    alpha = found.mask.astype(np.float32) if found.alpha is None else found.alpha
    hat = np.zeros_like(alpha) if found.hat is None else found.hat
    return np.maximum(alpha * np.float32(1.0 if found.trusted else _DOUBTFUL), hat)


def _drawn(
    subject: Subject,
    look: Style,
    backdrop: Backdrop | None,
    below: np.ndarray | None,
    strength: float,
    shape: tuple[int, ...],
) -> Bytes:
    """The drawing at the size of the picture; the warped photograph ``below`` it shows through if there is one."""
    rgb = ink_drawing(subject, look) if backdrop is None else coloured_drawing(subject, look, backdrop)
    if below is not None:
        rgb = below + np.float32(strength) * (rgb - below)
    drawing = cv2.convertScaleAbs(rgb)
    return np.asarray(
        drawing if drawing.shape == shape else cv2.resize(drawing, shape[1::-1], interpolation=cv2.INTER_CUBIC),
        np.uint8,
    )
