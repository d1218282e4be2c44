"""The pictures of an editing session and their files of landmarks."""

from __future__ import annotations

from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.commands.path_is import path_is
from toongeo.arrays import Bytes, Floats
from toongeo.io import read_image, read_landmarks, write_landmarks
from toongeo.io.readers.picture_files import pictures_in

__all__ = ["FORMATS", "PictureList"]

FORMATS = (".pts", ".json", ".csv", ".txt", ".npy", ".ljson")  # first the one that other tools know best


class PictureList:
    """One picture, or those of a folder in order of their names, each with the file of its landmarks.

    Parameters
    ----------
    path : Path
        Picture or folder.
    given : Path, optional
        Where a single picture's landmarks are read; else from the file beside it that bears its name.
    output : Path, optional
        Where a single picture's landmarks are saved; else beside it under its name.
    face : int
        Which face of a file that holds several.

    Raises
    ------
    OSError
        If there is no such file or folder.
    ValueError
        If the folder holds no picture, a folder comes with a file of landmarks or an output, or the output is of an
        unknown format or is the picture.
    """

    def __init__(self, path: Path, given: Path | None = None, output: Path | None = None, *, face: int = 0) -> None:
        self._given, self._output, self._face = given, output, face
        self._written: set[Path] = set()
        if path.is_dir():
            if given is not None or output is not None:
                raise ValueError(f"path: expected one picture to go with a file of landmarks, got the folder {path}")
            self._paths = pictures_in(path, "path")
            return
        self._paths = [path]
        img = read_image(path)
        if given is not None:
            with path_is("landmarks"):
                read_landmarks(given, size=img, face=face)
        if output is not None:
            self._check(path, output)

    def __len__(self) -> int:
        return len(self._paths)

    def name(self, k: int) -> str:
        """File name of a picture."""
        return self._paths[k].name

    def picture(self, k: int) -> Bytes:
        """Pixels (H, W, 3) of a picture; raises what :func:`toongeo.read_image` does."""
        return read_image(self._paths[k])

    def landmarks(self, k: int, img: Bytes) -> Floats | None:
        """Landmarks (68, 2) px of a picture, None if it has no file; raises as :func:`toongeo.read_landmarks` does.

        The picture tells what shares of its size mean.
        """
        file = self._file(k)
        if file is None:
            return None
        return read_landmarks(file, size=img, face=0 if file in self._written else self._face)

    def is_done(self, k: int) -> bool:
        """Whether a picture has a file of landmarks."""
        return self._file(k) is not None

    def target(self, k: int, suffix: str | None = None) -> Path:
        """Where landmarks of a picture are saved: in the format asked for, else that of the output or of its file."""
        named = self._output or self._paths[k].with_suffix(self._suffix(k))
        return named if suffix is None else named.with_suffix(suffix)

    def would_replace(self, k: int, suffix: str) -> bool:
        """Whether saving would replace a file that was not written in this session."""
        target = self.target(k, suffix)
        return target.exists() and target not in self._written

    def save(self, k: int, landmarks: Floats, suffix: str) -> Path:
        """Write landmarks (68, 2) px, NaN where missing, and tell where; the file is whole or not there.

        Raises
        ------
        ValueError
            If the format is unknown, all points are missing, or the file is the picture under another name.
        OSError
            If it cannot be written.
        """
        target = self.target(k, suffix)
        self._check(self._paths[k], target)
        write_landmarks(target, landmarks)
        self._written.add(target)
        return target

    def _file(self, k: int) -> Path | None:
        """What was saved here, else what was given, else what lies beside the picture under its name."""
        beside = [self._paths[k].with_suffix(suffix) for suffix in FORMATS]
        named = [path for path in (self._output, self._given) if path is not None]
        here = [path for path in (*named, *beside) if path.is_file()]
        return next((path for path in here if path in self._written), here[0] if here else None)

    def _suffix(self, k: int) -> str:
        file = self._file(k)
        return FORMATS[0] if file is None else file.suffix.lower()

    def _check(self, picture: Path, target: Path) -> None:
        if target.suffix.lower() not in FORMATS:
            raise ValueError(f"output: expected one of {', '.join(FORMATS)}, got {target}")
        check_output(target, {"picture": picture})
