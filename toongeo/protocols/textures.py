"""What paints a new skin."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from toongeo._brief_repr import brief_repr

__all__ = ["TextureGenerator", "TextureGeometry"]


@dataclass(frozen=True, eq=False)
class TextureGeometry:
    """A face in two expressions, and its texture coordinates.

    Attributes
    ----------
    source, target : (n, 3) float64, mm, model frame
        Vertices in the expression that the texture shows, and in the one that is wanted.
    faces : (m, 3) int
    uv : (t, 2) float64
        Origin bottom left.
    uv_faces : (m, 3) int
        Corners of the faces in ``uv``.

    Examples
    --------
    >>> import toongeo as tg
    >>> model = tg.default_model()
    >>> open_jaw = model.mean + model.expression[model.expression_index("jawOpen")]
    >>> geometry = tg.TextureGeometry(model.mean, open_jaw, model.faces, model.uv, model.uv_faces)
    >>> tg.attention_map(geometry, 64).shape
    (64, 64)
    """

    source: np.ndarray
    target: np.ndarray
    faces: np.ndarray
    uv: np.ndarray
    uv_faces: np.ndarray

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        if self.source.ndim != 2 or self.source.shape[1] != 3 or self.target.shape != self.source.shape:
            raise ValueError(
                f"target: expected vertices (n, 3) like the source, got {self.target.shape} and {self.source.shape}"
            )
        if self.uv_faces.shape != self.faces.shape:
            raise ValueError(f"uv_faces: expected shape {self.faces.shape} like faces, got {self.uv_faces.shape}")
        for name in ("source", "target", "faces", "uv", "uv_faces"):
            view = getattr(self, name).view()
            view.setflags(write=False)
            object.__setattr__(self, name, view)


class TextureGenerator(Protocol):
    """What an expression does to the colours of a face (Chen et al. 2020, section 3.3); a network, say.

    It need not know where lids close and lips part, nor draw lashes: :class:`toongeo.ExpressionEditor` does.
    :func:`toongeo.testing.check_texture_generator` checks one.

    Examples
    --------
    >>> from toongeo.testing import check_texture_generator
    >>> class Blush:
    ...     "The stronger the expression, the redder the skin."
    ...     def __call__(self, texture, source, target, geometry):
    ...         strength = float(np.clip(np.abs(target - source).max(), 0, 1))
    ...         red = np.minimum(texture * np.array([1.2, 0.9, 0.9]), 255)
    ...         return red, np.full(texture.shape[:2], 1 - 0.5 * strength)
    >>> check_texture_generator(Blush())
    """

    def __call__(
        self, texture: np.ndarray, source: np.ndarray, target: np.ndarray, geometry: TextureGeometry
    ) -> tuple[np.ndarray, np.ndarray]:
        """Colour C (S, S, 3), 0-255, and attention A (S, S) in [0, 1]; ``T* = A T + (1 - A) C`` (Eq. 12).

        The texture is (S, S, 3) uint8; source and target are weights (k,) of the expressions it shows and shall show.
        """
        ...
