"""``toongeo stylize``: a drawing of the face in a photograph."""

from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.landmark_source import LandmarkSource
from toongeo.io import LandmarkFile, read_image, write_image
from toongeo.pipeline import stylize
from toongeo.pipeline.stylize.stylize import check_strength

__all__ = ["stylize_file"]

_OUTPUTS = (".png", ".jpg", ".jpeg", ".webp")


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
    if output.suffix.lower() not in _OUTPUTS:
        raise ValueError(f"output: expected a name that ends in {', '.join(_OUTPUTS)}, got {output}")
    check_output(output, {"image": image, "landmarks": source.file})
    check_strength(strength)
    img = read_image(image)
    points, found = source.landmarks(image, img)
    if isinstance(found, LandmarkFile):
        print(found.message)
    write_image(output, stylize(img, points, style, strength=strength).img)
    print(f"wrote {output}")
