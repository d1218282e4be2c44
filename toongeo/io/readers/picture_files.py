"""Which files of a folder are pictures."""

from pathlib import Path

__all__ = ["PICTURE_SUFFIXES", "is_picture_file", "pictures_in"]

PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg", ".webp", ".bmp", ".gif", ".tif", ".tiff")


def is_picture_file(path: Path) -> bool:
    """By its name, whatever its case.

    Hidden files are none: a Mac leaves ``._face.jpg`` beside ``face.jpg`` on other systems' disks, which is no picture.

    Examples
    --------
    >>> [is_picture_file(Path(name)) for name in ("face.JPG", "._face.jpg", "face.pts")]
    [True, False, False]
    """
    return path.suffix.lower() in PICTURE_SUFFIXES and not path.name.startswith(".")


def pictures_in(folder: Path, argument: str = "folder") -> list[Path]:
    """Those of a folder, by name.

    Raises
    ------
    ValueError
        If there is none.
    """
    found = sorted(path for path in folder.iterdir() if is_picture_file(path) and path.is_file())
    if not found:
        kinds = ", ".join(PICTURE_SUFFIXES)
        raise ValueError(f"{argument}: expected pictures ({kinds}), got none in {folder}")
    return found
