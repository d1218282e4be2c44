"""The picture and the landmarks that a command works on, checked before they are read."""

from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.commands.path_is import path_is
from toongeo.app.landmark_source import LandmarkSource
from toongeo.arrays import Bytes, Floats
from toongeo.io import LandmarkFile, read_image

__all__ = ["check_picture_output", "faced_picture"]

_OUTPUTS = (".png", ".jpg", ".jpeg", ".webp")


def check_picture_output(image: Path, output: Path, source: LandmarkSource) -> None:
    """Refuse a picture that could not be written, or would replace a file that is read.

    Raises
    ------
    ValueError, OSError
        As :func:`check_output`, and if the name is not that of a picture.
    """
    if output.suffix.lower() not in _OUTPUTS:
        raise ValueError(f"output: expected a name that ends in {', '.join(_OUTPUTS)}, got {output}")
    check_output(output, {"image": image, "landmarks": source.file})


def faced_picture(image: Path, source: LandmarkSource) -> tuple[Bytes, Floats]:
    """The picture (H, W, 3) and its landmarks (68, 2) px; says what a file of landmarks held.

    Raises
    ------
    UnsureLandmarksError
        If landmarks were found that are not sure, and the source does not accept them.
    ValueError, OSError
        If picture or landmarks cannot be read.
    """
    with path_is("image"):
        img = read_image(image)
    points, found = source.landmarks(image, img)
    if isinstance(found, LandmarkFile):
        print(found.message)
    return img, points
