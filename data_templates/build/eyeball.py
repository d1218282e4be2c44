"""A unit eyeball with rings where the iris needs them.

A cornea is 11.71 mm wide from white to white (sd 0.42; 390 people: Rüfer, Schröder and Erb, Cornea 24 (2005)
259-261). On a human eye, 24 mm long, that puts the limbus at a polar angle of ``arcsin(11.71 / 24)`` = 29.2
degrees. The default head's lids are modelled around eyeballs of 15.1 mm radius in a face of human size, so
its limbus must lie at ``arcsin(5.855 / 15.1)`` = 22.8 degrees for an iris of the right size. Pupils of 3.0 to
4.7 mm were measured in daylight (379 young adults, Surg. Radiol. Anat. 2011, doi 10.1007/s00276-011-0889-4);
3.8 mm is taken. The cornea's bulge is left out. The other rings, the map to the disc and the colours were
chosen by eye.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_IRIS_MM = 11.71  # diameter
_PUPIL_MM = 3.8
_HEAD_RADIUS_MM = 15.1  # of the default head's eyeballs
# Disc radius of the limbus and of two polar angles: a person's iris gets 13 % of the disc's area for 4 % of the
# sphere's, and what the wide eyes of drawings show beside it most of the rest.
_IRIS_DISC = 0.36
_SHOWN, _SHOWN_DISC = np.radians([75.0, 105.0]), (0.8, 0.92)

# sRGB, chosen by eye: a brown iris, since the white of the eye should not turn blue in the mean face
_PUPIL = (0.04, 0.035, 0.035)
_COLLAR = (0.50, 0.36, 0.22)  # the lighter ring around the pupil
_IRIS = (0.38, 0.26, 0.16)
_LIMBUS = (0.17, 0.12, 0.09)
_SCLERA = (0.90, 0.88, 0.86)
_BACK = (0.80, 0.62, 0.57)  # never seen, reddish so that a gap in a lid does not flash white


def _ring_angles(p: float, i: float) -> NDArray[np.float64]:
    """Polar angles of the rings between the poles, rad; pairs of them keep the pupil and limbus sharp."""
    inner = [0.6 * p, 0.97 * p, 1.06 * p, p + 0.30 * (i - p), p + 0.60 * (i - p), p + 0.84 * (i - p)]
    outer = [i, 1.07 * i, *np.radians([37.0, 46.0, 57.0, 70.0, 85.0, 102.0, 122.0, 145.0])]
    return np.array(inner + outer)


def _disc_radius(polar: NDArray[np.float64], iris: float) -> NDArray[np.float64]:
    """Monotone map of the polar angle [0, pi] to [0, 1], linear inside the limbus and in steps outside it."""
    return np.interp(polar, [0.0, iris, *_SHOWN, np.pi], [0.0, _IRIS_DISC, *_SHOWN_DISC, 1.0])


def _ring_colours(polar: NDArray[np.float64], p: float, i: float) -> NDArray[np.float64]:
    stops = [0.0, p, 1.05 * p, p + 0.30 * (i - p), p + 0.75 * (i - p), i, 1.06 * i, np.radians(85.0), np.pi]
    colours = np.array([_PUPIL, _PUPIL, _COLLAR, _COLLAR, _IRIS, _LIMBUS, _SCLERA, _SCLERA, _BACK])
    return np.stack([np.interp(polar, stops, colours[:, k]) for k in range(3)], 1)


def _directions(sectors: int) -> NDArray[np.float64]:
    """Unit vectors ``(sectors, 2)`` around the gaze axis, mirror symmetric in x to the last bit."""
    j = np.arange(sectors)
    angle = 2 * np.pi * j / sectors
    d = np.column_stack([np.cos(angle), np.sin(angle)])
    other = (sectors // 2 - j) % sectors  # the meridian with x negated
    d[:, 0] = 0.5 * (d[:, 0] - d[other, 0])
    d[:, 1] = 0.5 * (d[:, 1] + d[other, 1])
    return d


def eyeball_sphere(sectors: int = 24, *, radius_mm: float = _HEAD_RADIUS_MM) -> dict[str, NDArray | float]:
    """Unit sphere that looks along +Z, with rings at the pupil and at the limbus.

    Parameters
    ----------
    sectors : int
        Number of meridians, a multiple of 4 (so that no face straddles x = 0), at least 8.
    radius_mm : float
        Radius of the eyeball that the unit sphere stands for, at least 11: a larger one has a narrower iris.

    Returns
    -------
    dict
        ``vertices`` (k, 3), unit length; ``faces`` (f, 3), counter-clockwise from outside; ``disc`` (k, 2),
        azimuthal coordinates in the unit disc (the gaze pole at its centre, azimuth kept, the limbus at
        radius 0.36); ``colour`` (k, 3) sRGB in [0, 1]; ``iris_angle`` and ``pupil_angle``, polar angles in
        radians. The back pole stands once per sector, so that every vertex has one disc position; vertices,
        faces and disc are mirror symmetric in x.

    Raises
    ------
    ValueError
        If `sectors` is no multiple of 4 or below 8, or `radius_mm` is below 11.

    Examples
    --------
    >>> ball = eyeball_sphere(24, radius_mm=12.0)
    >>> round(float(np.degrees(ball["iris_angle"])), 1)
    29.2
    >>> bool(np.allclose(np.linalg.norm(ball["vertices"], axis=1), 1.0))
    True
    """
    if sectors < 8 or sectors % 4:
        raise ValueError(f"sectors: expected a multiple of 4, at least 8, got {sectors}")
    if not radius_mm >= 11:
        raise ValueError(f"radius_mm: expected at least 11, got {radius_mm}")
    iris_angle, pupil_angle = (float(np.arcsin(0.5 * d / radius_mm)) for d in (_IRIS_MM, _PUPIL_MM))
    polar = _ring_angles(pupil_angle, iris_angle)
    around = _directions(sectors)
    rings = len(polar)
    height = np.broadcast_to(np.cos(polar)[:, None, None], (rings, sectors, 1))
    ring = np.concatenate([np.sin(polar)[:, None, None] * around, height], 2)
    pole = np.array([[0.0, 0.0, 1.0]])
    vertices = np.concatenate([pole, ring.reshape(-1, 3), -pole.repeat(sectors, 0)])
    angle = np.concatenate([[0.0], polar.repeat(sectors), np.full(sectors, np.pi)])
    # a back-pole copy belongs to the sector after its meridian: its azimuth lies half a sector further
    between = 0.5 * (around + np.roll(around, -1, axis=0))
    between /= np.linalg.norm(between, axis=1, keepdims=True)
    azimuth = np.concatenate([np.zeros((1, 2)), np.tile(around, (rings, 1)), between])
    j = np.arange(sectors)
    k = (j + 1) % sectors
    a, b = 1 + np.arange(rings - 1)[:, None] * sectors + j, 1 + np.arange(rings - 1)[:, None] * sectors + k
    last = 1 + (rings - 1) * sectors
    # the diagonal of every ring quad mirrors at x = 0
    flip = np.broadcast_to(around[j, 0] + around[k, 0] < -1e-9, a.shape)
    near, far = _split(a, b, sectors, flip)
    front = np.column_stack([np.zeros(sectors, int), 1 + j, 1 + k])
    back = np.column_stack([last + j, last + sectors + j, last + k])
    return {
        "vertices": vertices,
        "faces": np.vstack([front, near, far, back]).astype(np.int64),
        "disc": _disc_radius(angle, iris_angle)[:, None] * azimuth,
        "colour": _ring_colours(angle, pupil_angle, iris_angle),
        "iris_angle": iris_angle,
        "pupil_angle": pupil_angle,
    }


def _split(
    a: NDArray[np.int64], b: NDArray[np.int64], step: int, flip: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Two triangles of each quad a, a + step, b + step, b; `flip` takes the diagonal a, b + step."""
    c, d = a + step, b + step
    one = np.where(flip[..., None], np.stack([a, c, d], -1), np.stack([a, c, b], -1))
    two = np.where(flip[..., None], np.stack([a, d, b], -1), np.stack([b, c, d], -1))
    return one.reshape(-1, 3), two.reshape(-1, 3)
