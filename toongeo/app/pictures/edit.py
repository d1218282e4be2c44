"""``toongeo edit``: the same picture with another expression."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from toongeo.app.landmark_source import LandmarkSource
from toongeo.app.pictures.faced_picture import check_picture_output, faced_picture
from toongeo.editing import ExpressionEditor
from toongeo.io import write_image
from toongeo.model import expression_weights

__all__ = ["edit"]


def edit(
    image: Path, output: Path, weights: Mapping[str, float], source: LandmarkSource, *, absolute: bool = False
) -> None:
    """Change the expression of a picture and write the result.

    Parameters
    ----------
    image, output : Path
    weights : name -> weight
        By any name that :func:`toongeo.expression_weights` knows; what several names move adds up.
    source : LandmarkSource
    absolute : bool
        The weights are the whole expression of the result; else they are added to what the picture shows.

    Raises
    ------
    UnsureLandmarksError
        If landmarks were found that are not sure, and the source does not accept them.
    ValueError, OSError
        For bad input, or an output that cannot be written or is a file that is read; checked before the work.
    """
    check_picture_output(image, output, source)
    if not weights and not absolute:
        raise ValueError("weights: expected an expression, such as --smile 0.5 or --weights jawOpen=0.3")
    wanted = expression_weights(weights)
    editor = ExpressionEditor(*faced_picture(image, source))
    write_image(output, editor.frame(wanted if absolute else editor.added(wanted)))
    print(f"wrote {output}")
