"""Which pictures become which files."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.making.make_options import MakeOptions

__all__ = ["HeadJob", "check_jobs", "head_jobs"]

_PICTURES = (".png", ".jpg", ".jpeg", ".webp", ".bmp", ".gif", ".tif", ".tiff")
_LANDMARKS = (".pts", ".json", ".csv", ".txt", ".npy", ".ljson", ".xml")  # the first that is there counts
_SHEETS = (".png", ".jpg", ".jpeg", ".webp")
_NAME = "{name}"


@dataclass(frozen=True)
class HeadJob:
    """A picture, the file that becomes of it, and perhaps its landmarks and a contact sheet."""

    image: Path
    output: Path
    landmarks: Path | None = None
    sheet: Path | None = None


def head_jobs(
    images: Sequence[Path],
    output: Path,
    landmarks: Path | None = None,
    sheet: Path | None = None,
    *,
    suffix: str = ".glb",
) -> list[HeadJob]:
    """The heads that a command asks for.

    Parameters
    ----------
    images : sequence of Path
        Pictures, and folders of pictures.
    output : Path
        A file for one picture; for several a folder, or a name in which ``{name}`` stands for theirs.
    landmarks : Path, optional
        A file for one picture, a folder with a file of its stem for each of several.
    sheet : Path, optional
        As the output.
    suffix : str
        Of the files in a folder; empty for folders in it.

    Raises
    ------
    OSError, ValueError
        If a folder holds no pictures, several would become one file, or a name does not fit their number.

    Examples
    --------
    >>> [job.output.as_posix() for job in head_jobs([Path("a.png"), Path("b.png")], Path("heads/{name}.vrm"))]
    ['heads/a.vrm', 'heads/b.vrm']
    """
    pictures = [picture for image in images for picture in _pictures(image)]
    several = len(images) > 1 or images[0].is_dir()
    jobs: list[HeadJob] = []
    for picture in pictures:
        job = HeadJob(
            picture,
            _named(output, picture, "output", several, suffix),
            _landmarks(landmarks, picture, several),
            None if sheet is None else _named(sheet, picture, "sheet", several, _SHEETS[0]),
        )
        for other in jobs:
            if other.output == job.output:
                raise ValueError(f"output: {other.image} and {picture} would both become {job.output}")
        jobs.append(job)
    return jobs


def check_jobs(jobs: Sequence[HeadJob], options: MakeOptions, *, one: bool = False) -> None:
    """Refuse what could not be written, or would replace a file that is read, before any head is made.

    Parameters
    ----------
    jobs : sequence of HeadJob
    options : MakeOptions
    one : bool
        Whether all pictures show the same person.

    Raises
    ------
    OSError, ValueError, ImportError
        As :func:`~toongeo.app.check_output.check_output` and `MakeOptions.check`.
    """
    if one and len(jobs) < 2:
        raise ValueError(f"same_person: expected several pictures, got {len(jobs)}")
    if one and (options.snap or options.photometric is True or options.style):
        raise ValueError("same_person: expected no --snap, --photometric or --style, which fit every picture by itself")
    for job in jobs:
        options.check(job.output)
    with _new_folders(jobs):
        _check_files(jobs, options)


def _check_files(jobs: Sequence[HeadJob], options: MakeOptions) -> None:
    reads = {f"image {job.image.name}" if len(jobs) > 1 else "image": job.image for job in jobs}
    for job in jobs:
        inputs = {**reads, "landmarks": job.landmarks, "hair_mask": options.hair_mask}
        check_output(job.output, inputs, options.format)
        if job.sheet is not None:
            if job.sheet.suffix.lower() not in _SHEETS:
                raise ValueError(f"sheet: expected a name that ends in {', '.join(_SHEETS)}, got {job.sheet}")
            check_output(job.sheet, inputs, name="sheet")


@contextlib.contextmanager
def _new_folders(jobs: Sequence[HeadJob]) -> Iterator[None]:
    """Make the folders for several heads that are not there; they are gone again if something is refused."""
    wanted = (
        {path.parent for job in jobs for path in (job.output, job.sheet) if path is not None}
        if len(jobs) > 1
        else set()
    )
    made = [folder for folder in wanted if not folder.exists() and folder.parent.is_dir()]
    for folder in made:
        folder.mkdir()
    try:
        yield
    except BaseException:
        for folder in made:
            folder.rmdir()
        raise


def _pictures(image: Path) -> list[Path]:
    if not image.is_dir():
        return [image]
    found = sorted(path for path in image.iterdir() if path.suffix.lower() in _PICTURES and path.is_file())
    if not found:
        raise ValueError(f"image: expected a folder with pictures ({', '.join(_PICTURES)}), got none in {image}")
    return found


def _named(output: Path, picture: Path, parameter: str, several: bool, suffix: str) -> Path:
    if _NAME in str(output):
        return Path(str(output).replace(_NAME, picture.stem))
    if not several:
        return output
    if output.suffix and not output.is_dir():
        raise ValueError(
            f"{parameter}: expected a folder for several pictures, or a name with {_NAME} in it, got {output}"
        )
    return output / f"{picture.stem}{suffix}"


def _landmarks(landmarks: Path | None, picture: Path, several: bool) -> Path | None:
    if landmarks is None or not (several or landmarks.is_dir()):
        return landmarks
    if not landmarks.is_dir():
        raise ValueError(f"landmarks: expected a folder of files for several pictures, got {landmarks}")
    for suffix in _LANDMARKS:
        if (file := landmarks / f"{picture.stem}{suffix}").is_file():
            return file
    raise ValueError(
        f"landmarks: expected a file for {picture.name} ({', '.join(_LANDMARKS)}), got none in {landmarks}"
    )
