"""The pictures of a batch and where their files go."""

from __future__ import annotations

import hashlib
import os
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from toongeo.io.readers.picture_files import PICTURE_SUFFIXES, is_picture_file
from toongeo.reading.check_file import file_bytes

__all__ = ["STATE", "PictureJob", "input_digest", "picture_jobs"]

STATE = ".toongeo-batch"  # folder of the workers' marks, beside the files
_LANDMARKS = (".pts", ".json", ".csv", ".txt", ".npy", ".ljson")


@dataclass(frozen=True)
class PictureJob:
    """One picture: its name in the manifest, its files, and where a worker marks that it is at it."""

    name: str
    picture: Path
    landmarks: Path | None
    output: Path
    thumbnail: Path
    mark: Path


def picture_jobs(folder: Path, output: Path, suffix: str) -> list[PictureJob]:
    """All pictures of a folder and those beneath it, in order of their names; landmarks lie beside under their names.

    Raises
    ------
    OSError
        If the folder cannot be read.
    ValueError
        If it holds no picture.
    """
    pictures = sorted(_pictures(folder, output.resolve()))
    if not pictures:
        raise ValueError(f"folder: expected pictures ({', '.join(PICTURE_SUFFIXES)}), but there are none in {folder}")
    shared = Counter(path.relative_to(folder).with_suffix("") for path in pictures)
    jobs = []
    for picture in pictures:
        name = picture.relative_to(folder)
        twins = shared[name.with_suffix("")] > 1  # face.png and face.jpg
        stem = name if twins else name.with_suffix("")
        beside = (picture.with_suffix(end) for end in _LANDMARKS)
        key = hashlib.sha256(name.as_posix().encode("utf-8", "surrogateescape")).hexdigest()[:32]
        jobs.append(
            PictureJob(
                name=name.as_posix(),
                picture=picture,
                landmarks=next((path for path in beside if path.is_file()), None),
                output=output / f"{stem}{suffix}",
                thumbnail=output / "thumbnails" / f"{stem}.jpg",
                mark=output / STATE / key,
            )
        )
    return jobs


def _pictures(folder: Path, output: Path) -> Iterator[Path]:
    def fail(error: OSError) -> None:
        raise error

    for place, folders, files in os.walk(folder, onerror=fail):
        folders[:] = sorted(name for name in folders if Path(place, name).resolve() != output)
        yield from (path for name in files if is_picture_file(path := Path(place, name)))


def input_digest(job: PictureJob) -> str:
    """SHA-256 of the bytes of a picture and of its landmarks.

    Raises
    ------
    OSError
        If one cannot be read.
    ValueError
        If one is a device or a pipe, or larger than any picture.
    """
    digest = hashlib.sha256()
    for path in (job.picture, job.landmarks):
        digest.update(b"none" if path is None else hashlib.sha256(file_bytes(path)).digest())
    return digest.hexdigest()
