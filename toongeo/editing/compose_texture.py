"""A texture of two: what stays, and what an expression puts in its place."""

import cv2
import numpy as np

__all__ = ["compose_texture"]


def compose_texture(texture: np.ndarray, colour: np.ndarray, attention: np.ndarray) -> np.ndarray:
    """``T* = A T + (1 - A) C`` (Chen et al. 2020, Eq. 12).

    Parameters
    ----------
    texture : (S, S, 3) uint8 or float, 0-255
        T, of the source expression.
    colour : (S, S, 3) uint8 or float, 0-255
        C, what colours should change to.
    attention : (S, S) float in [0, 1]
        A. 1 keeps the texture, 0 takes the colour, as in the equation.

    Returns
    -------
    (S, S, 3) float32, 0-255

    Raises
    ------
    ValueError
        If the shapes do not go together, or the attention leaves [0, 1] or is not finite.

    Examples
    --------
    >>> T, C = np.full((1, 2, 3), 100, np.uint8), np.full((1, 2, 3), 50, np.uint8)
    >>> compose_texture(T, C, np.array([[1.0, 0.5]]))[0, :, 0]
    array([100.,  75.], dtype=float32)
    """
    if texture.ndim != 3 or texture.shape[2] != 3:
        raise ValueError(f"texture: expected (S, S, 3), got {texture.shape}")
    if colour.shape != texture.shape:
        raise ValueError(f"colour: expected the texture's shape {texture.shape}, got {colour.shape}")
    if attention.shape != texture.shape[:2]:
        raise ValueError(f"attention: expected shape {texture.shape[:2]} as the texture has, got {attention.shape}")
    if not (attention.min() >= 0 and attention.max() <= 1):
        raise ValueError("attention: expected numbers in [0, 1], got others or NaN")
    A = np.asarray(attention, np.float32)
    C = np.asarray(colour, np.float32)
    return np.asarray(C + cv2.merge([A, A, A]) * (texture - C))  # Eq. 12
