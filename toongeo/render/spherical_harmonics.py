"""Second-order spherical harmonics as a light."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["irradiance", "sh_basis"]

# Lambert's cosine lobe in harmonics, degrees 0 to 2 (Ramamoorthi & Hanrahan 2001, Eq. 8)
_LOBE = np.repeat([np.pi, 2.0 * np.pi / 3.0, np.pi / 4.0], [1, 3, 5])


def sh_basis(normals: ArrayLike) -> NDArray[np.float64]:
    """Real spherical harmonics up to degree 2 of unit directions.

    Orthonormal over the sphere. Columns run by degree l and then order m = -l..l, without the
    Condon-Shortley sign:
    ``[1, y, z, x, xy, yz, 3 z^2 - 1, xz, x^2 - y^2]`` times
    ``[0.282095, 0.488603 (3 times), 1.092548 (twice), 0.315392, 1.092548, 0.546274]``.

    Parameters
    ----------
    normals : array_like, shape (k, 3)
        Unit vectors (not checked; a zero vector is no direction and gives no meaning).

    Returns
    -------
    ndarray, shape (k, 9)

    Raises
    ------
    ValueError
        If ``normals`` is not (k, 3).

    References
    ----------
    R. Ramamoorthi, P. Hanrahan: An efficient representation for irradiance environment maps.
    SIGGRAPH 2001, Eq. 3.

    Examples
    --------
    >>> sh_basis([[0.0, 0.0, 1.0]]).round(4) + 0.0
    array([[0.2821, 0.    , 0.4886, 0.    , 0.    , 0.    , 0.6308, 0.    ,
            0.    ]])
    """
    directions = np.asarray(normals, dtype=np.float64)
    if directions.ndim != 2 or directions.shape[1] != 3:
        raise ValueError(f"normals: expected shape (k, 3), got {directions.shape}")
    x, y, z = directions.T
    c0, c1 = np.sqrt(1.0 / (4.0 * np.pi)), np.sqrt(3.0 / (4.0 * np.pi))
    c2, c20 = np.sqrt(15.0 / (4.0 * np.pi)), np.sqrt(5.0 / (16.0 * np.pi))
    columns = [
        np.full_like(x, c0),
        c1 * y,
        c1 * z,
        c1 * x,
        c2 * x * y,
        c2 * y * z,
        c20 * (3.0 * z * z - 1.0),
        c2 * x * z,
        0.5 * c2 * (x * x - y * y),
    ]
    return np.stack(columns, axis=1)


def irradiance(normals: ArrayLike, light: ArrayLike) -> NDArray[np.float64]:
    """Light that falls on a Lambertian surface, from an environment in spherical harmonics.

    ``E(n) = sum_lm A_l L_lm Y_lm(n)`` with A_0 = pi, A_1 = 2 pi / 3, A_2 = pi / 4. A surface of reflectance
    (albedo) rho sends out ``rho * E / pi``: under a uniform environment of radiance 1, E = pi and the surface
    shows its albedo. Normals and light share a frame.

    Parameters
    ----------
    normals : array_like, shape (k, 3)
        Unit vectors.
    light : array_like, shape (9, 3)
        Radiance L_lm of the environment (linear light), a column a colour channel, ordered like `sh_basis`.

    Returns
    -------
    ndarray, shape (k, 3)
        Linear; may fall below 0 where nine terms do not suffice for a hard light.

    Raises
    ------
    ValueError
        If a shape is wrong, or ``light`` is not finite.

    References
    ----------
    R. Ramamoorthi, P. Hanrahan: An efficient representation for irradiance environment maps. SIGGRAPH 2001,
    Eqs. 7-9.

    Examples
    --------
    >>> uniform = np.zeros((9, 3))
    >>> uniform[0] = np.sqrt(4.0 * np.pi)  # radiance 1 from everywhere
    >>> irradiance([[0.0, 1.0, 0.0]], uniform) / np.pi
    array([[1., 1., 1.]])
    """
    coefficients = np.asarray(light, dtype=np.float64)
    if coefficients.shape != (9, 3) or not np.isfinite(coefficients).all():
        raise ValueError(f"light: expected finite coefficients of shape (9, 3), got {coefficients.shape}")
    return sh_basis(normals) @ (_LOBE[:, None] * coefficients)
