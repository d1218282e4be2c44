"""``toongeo edit``: the same picture with another expression."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.commands.path_is import path_is
from toongeo.app.landmark_source import LandmarkSource
from toongeo.editing import ExpressionEditor
from toongeo.io import LandmarkFile, read_image, write_image
from toongeo.model import expression_weights

__all__ = ["edit"]

_OUTPUTS = (".png", ".jpg", ".jpeg", ".webp")


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
    if output.suffix.lower() not in _OUTPUTS:
        raise ValueError(f"output: expected a name that ends in {', '.join(_OUTPUTS)}, got {output}")
    check_output(output, {"image": image, "landmarks": source.file})
    if not weights and not absolute:
        raise ValueError("weights: expected an expression, such as --smile 0.5 or --weights jawOpen=0.3")
    wanted = expression_weights(weights)
    with path_is("image"):
        img = read_image(image)
    points, found = source.landmarks(image, img)
    if isinstance(found, LandmarkFile):
        print(found.message)
    editor = ExpressionEditor(img, points)
    write_image(output, editor.frame(wanted if absolute else editor.added(wanted)))
    print(f"wrote {output}")
