"""Pictures with landmarks beside them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io import read_image, read_landmarks
from toongeo.io.readers.picture_files import pictures_in

__all__ = ["BenchPicture", "bench_folder"]

_LANDMARKS = (".pts", ".txt", ".csv", ".npy")


@dataclass(frozen=True)
class BenchPicture:
    """One picture of the folder; read when it is used, so that a folder may be larger than the memory."""

    picture: Path
    landmarks: Path

    @property
    def name(self) -> str:
        return self.picture.name

    def read(self) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
        """Picture (H, W, 3) and landmarks (68, 2), px."""
        return read_image(self.picture), read_landmarks(self.landmarks)


def bench_folder(folder: Path) -> list[BenchPicture]:
    """The pictures of a folder, by name, each with the landmark file of the same stem.

    Of several landmark files the first suffix of ``.pts``, ``.txt``, ``.csv``, ``.npy`` counts; `read_landmarks` says
    what each holds.

    Raises
    ------
    OSError
        If there is no such folder.
    ValueError
        If it holds no picture, landmarks are missing for one, or two pictures share a stem and so the landmarks.
    """
    if not folder.is_dir():
        raise NotADirectoryError(f"folder: expected a folder of pictures, got {folder}")
    pictures = pictures_in(folder)
    stems: dict[str, Path] = {}
    found = []
    for picture in pictures:
        if picture.stem in stems:
            raise ValueError(
                f"folder: expected one picture for the landmarks of {picture.stem}, "
                f"got {stems[picture.stem].name} and {picture.name} in {folder}"
            )
        stems[picture.stem] = picture
        beside = [path for path in (picture.with_suffix(suffix) for suffix in _LANDMARKS) if path.is_file()]
        if not beside:
            raise ValueError(
                f"folder: expected landmarks ({', '.join(_LANDMARKS)}) beside each picture, "
                f"got none for {picture.name} in {folder}"
            )
        found.append(BenchPicture(picture, beside[0]))
    return found
