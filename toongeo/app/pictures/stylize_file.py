"""``toongeo stylize``: a drawing of the face in a photograph."""

from pathlib import Path

from toongeo.app.landmark_source import LandmarkSource
from toongeo.app.pictures.faced_picture import check_picture_output, faced_picture
from toongeo.io import write_image
from toongeo.pipeline import stylize
from toongeo.pipeline.stylize.stylize import check_strength

__all__ = ["stylize_file"]


def stylize_file(image: Path, output: Path, source: LandmarkSource, *, style: str, strength: float) -> None:
    """Read, draw and write.

    Parameters
    ----------
    image, output : Path
    source : LandmarkSource
    style, strength
        Of :func:`toongeo.stylize`.

    Raises
    ------
    UnsureLandmarksError
        If landmarks were found that are not sure, and the source does not accept them.
    ValueError, OSError
        For bad input, or an output that cannot be written or is a file that is read; checked before the work.
    """
    check_picture_output(image, output, source)
    check_strength(strength)
    img, points = faced_picture(image, source)
    write_image(output, stylize(img, points, style, strength=strength).img)
    print(f"wrote {output}")
