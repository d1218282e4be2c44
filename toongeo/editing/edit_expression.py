"""The same picture with another expression."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from toongeo.editing.expression_editor import ExpressionEditor
from toongeo.model import MorphableModel
from toongeo.pipeline import fit_3dmm
from toongeo.pipeline.landmarks.given_or_found import given_or_found
from toongeo.protocols import TextureGenerator

__all__ = ["edit_expression", "reference_weights"]


def edit_expression(
    img: np.ndarray,
    landmarks: np.ndarray | None = None,
    weights: Mapping[str, float] | np.ndarray | None = None,
    *,
    relative: bool = False,
    reference: tuple[np.ndarray | None, np.ndarray] | None = None,
    generator: TextureGenerator | None = None,
    scheme: Any = "ibug68",
) -> np.ndarray:
    """Change the expression of a picture or drawing, and nothing else of it (Chen et al. 2020, section 4.4).

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px, optional
        iBUG-68 points; x right, y down, integer = pixel centre. NaN rows are missing. None: those of the largest face
        that :func:`toongeo.detect_landmarks` finds.
    weights : mapping of name to weight, (46,) array or (54,) array
        The expression of the result. 1 is the full expression; names that are left out are 0.
    relative : bool
        Add the weights to what the picture shows, each then kept in [0, 1]: a smiling face smiles more, and its eyes
        and mouth stay as they are drawn where nothing is named. A weight below 0 takes of it. For weights only.
    reference : (picture or None, landmarks), optional
        Instead of weights: a normal face whose expression is taken over.
    generator : TextureGenerator, optional
        What makes the new texture; :class:`toongeo.ClassicalTextureGenerator` unless another is given.
    scheme : str or table
        What the landmarks are, those of the reference too: see :func:`toongeo.make_avatar`.

    Returns
    -------
    (H, W, 3) uint8 RGB
        For many expressions of one picture, :class:`toongeo.ExpressionEditor` fits it only once.

    Raises
    ------
    ValueError
        If neither or both of weights and reference are given, relative with a reference, no face can be fitted to the
        reference, a name is unknown (the nearest are suggested), or for pictures and landmarks as
        :func:`toongeo.make_avatar`.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> smile = tg.edit_expression(img, landmarks, {"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8})
    >>> smile.shape == img.shape, bool((smile != img).any())
    (True, True)
    """
    if (weights is None) == (reference is None):
        raise ValueError("weights, reference: expected one of them, got " + ("neither" if weights is None else "both"))
    if relative and reference is not None:
        raise ValueError("relative: expected weights to add to the picture's, got a reference, whose are taken over")
    wanted = weights if reference is None else reference_weights(reference, scheme=scheme)
    landmarks = np.asarray(given_or_found(img, landmarks, scheme))
    editor = ExpressionEditor(img, landmarks, generator=generator, scheme=scheme)
    return editor.frame(editor.added(wanted) if relative else wanted)


def reference_weights(
    reference: tuple[np.ndarray | None, np.ndarray], model: MorphableModel | None = None, *, scheme: Any = "ibug68"
) -> dict[str, float]:
    """Named expression weights of a normal face, given as picture (or None) and landmarks.

    Raises
    ------
    ValueError
        If no face can be fitted to it.
    """
    try:
        img, landmarks = reference
    except (TypeError, ValueError):
        raise ValueError(f"reference: expected a picture and its landmarks, got {type(reference).__name__}") from None
    try:
        fit = fit_3dmm(img, landmarks, model=model, scheme=scheme)
    except ValueError as error:
        raise ValueError(f"reference: no face could be fitted ({error})") from error
    return fit.expression_weights()
