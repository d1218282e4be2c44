"""From a photograph to a drawing."""

import numbers
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Bytes, Floats, Singles
from toongeo.io import check_image
from toongeo.pipeline.fit import FaceFit, fit_3dmm, ibug_landmarks, photometric_fit
from toongeo.pipeline.landmarks.given_or_found import given_or_found
from toongeo.pipeline.parse.completed_landmarks import completed_landmarks
from toongeo.pipeline.parse.find_hair import find_hair
from toongeo.pipeline.stylize.appearance.head_light import HeadLight, head_light
from toongeo.pipeline.stylize.appearance.pixels import placed_in, reduced, sampled
from toongeo.pipeline.stylize.appearance.subject import WORKING_SIZE, Subject, subject_of
from toongeo.pipeline.stylize.coloured_drawing import coloured_drawing, surroundings
from toongeo.pipeline.stylize.exaggerated import exaggerated
from toongeo.pipeline.stylize.face_frame import face_frame
from toongeo.pipeline.stylize.ink_drawing import ink_drawing
from toongeo.pipeline.stylize.style import STYLES, Style
from toongeo.pipeline.stylize.style_rules import style_rules
from toongeo.pipeline.stylize.velocity_warp import VelocityWarp, velocity_warp
from toongeo.pipeline.texture import find_irises
from toongeo.protocols import Stylized

__all__ = ["check_strength", "check_style", "stylize", "subject_for"]

_LARGEST = 2_000_000  # pixels that are drawn; larger pictures are drawn at this size and enlarged
_STRONGEST = 2.0
# Passes and colour tolerance (Lab) of the abstraction: paintings keep more.
_PASSES, _TOLERANCE = 4, 9.0
_PAINTED_PASSES, _PAINTED_TOLERANCE = 3, 7.0
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
    subject = subject_for(photo, placed, warp.scaled(factor), look)
    backdrop = None if look.ink else surroundings(subject, look)
    drawing, texture = (
        _drawn(subject, variant, backdrop, strength, img.shape) for variant in (look, look.for_texture())
    )
    return Stylized(drawing, warp.points(points), warp, texture)


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


def subject_for(photo: Bytes, points: Floats, warp: VelocityWarp, look: Style) -> Subject:
    """The warped photograph, and all that is measured on it."""
    fit = photometric_fit(photo, fit_3dmm(photo, points), points)
    sources = warp.sources((photo.shape[0], photo.shape[1]))
    moved, irises = warp.points(points), find_irises(photo, points)
    size = face_frame(moved).size
    before = face_frame(points).size
    smaller = WORKING_SIZE / before
    shape = (round(smaller * photo.shape[0]), round(smaller * photo.shape[1]))
    light = head_light(fit, shape, smaller, before * smaller)
    places = np.asarray(reduced(sources, WORKING_SIZE / size), np.float64)  # of the reduced drawing's pixels
    there = placed_in(places, smaller)
    head, face, shade = (_taken(plane, there) for plane in (light.head, light.face, light.shade))
    right, left = (None if iris is None else warp.points(iris.centre) for iris in irises[::-1])
    painted = look.palette == 0
    return subject_of(
        np.asarray(warp.picture(photo, sources)),
        moved,
        size,
        HeadLight(head, face, shade, light.from_right),
        _taken(_hair(photo, points, fit), places),
        (right, left),
        passes=_PAINTED_PASSES if painted else _PASSES,
        tolerance=_PAINTED_TOLERANCE if painted else _TOLERANCE,
    )


def _reduced(img: Bytes, factor: float) -> Bytes:
    if factor >= 1:
        return img
    return np.asarray(cv2.resize(img, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA), np.uint8)


def _hair(photo: Bytes, points: Floats, fit: FaceFit) -> Singles:
    """How surely each pixel (h, w) is hair or a hat."""
    found = find_hair(photo, points, fit)
    alpha = found.mask.astype(np.float32) if found.alpha is None else found.alpha
    hat = np.zeros_like(alpha) if found.hat is None else found.hat
    return np.maximum(alpha * np.float32(1.0 if found.trusted else _DOUBTFUL), hat)


def _taken(plane: Singles, places: Floats) -> Singles:
    """A plane at places (h, w, 2) px."""
    return np.asarray(sampled(plane, np.asarray(places, np.float32), cv2.INTER_LINEAR, cv2.BORDER_REPLICATE))


def _drawn(subject: Subject, look: Style, backdrop: Singles | None, strength: float, shape: tuple[int, ...]) -> Bytes:
    """The drawing at the size of the picture; below strength 1 the warped photograph shows through."""
    rgb = ink_drawing(subject, look) if backdrop is None else coloured_drawing(subject, look, backdrop)
    if strength < 1:
        rgb = subject.picture + np.float32(strength) * (rgb - subject.picture)
    drawing = np.clip(np.rint(rgb), 0, 255).astype(np.uint8)
    return (
        drawing
        if drawing.shape == shape
        else np.asarray(cv2.resize(drawing, shape[1::-1], interpolation=cv2.INTER_CUBIC))
    )
