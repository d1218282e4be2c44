"""Takes from files."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from toongeo.app.commands.path_is import path_is
from toongeo.driving import ArkitDriver, LandmarkDriver, Take, VideoDriver, read_live_link, unit_weights
from toongeo.io import read_landmark_frames, read_video
from toongeo.model.expression_schemes import EXPRESSIONS
from toongeo.reading.check_file import check_file
from toongeo.reading.npy_array import npy_array
from toongeo.reading.promise import promise

__all__ = ["TakeSource", "read_landmark_take", "read_take"]


@dataclass(frozen=True)
class TakeSource:
    """One file of a performance.

    Attributes
    ----------
    weights : Path, optional
        Live Link Face ``.csv``, or ``.npy`` of (f, 52) ARKit weights or (f, 54) of ours.
    landmarks : Path, optional
        Of a performer in each frame, the first of which is neutral: see :func:`toongeo.io.read_landmark_frames`.
    video : Path, optional
        A film of a performer, who looks neutral in some frames.
    fps : float, optional
        Frames a second, of a file that does not say it, or instead of what it says.
    scheme : str
        What the landmarks are: see :func:`toongeo.read_landmark_file`.
    gaps : {"interpolate", "hold"}
        What stands where a table has no numbers: see :func:`toongeo.driving.read_live_link`.
    neutral : float, optional
        Seconds to a frame of the video in which the performer is neutral: see :class:`toongeo.VideoDriver`.
    """

    weights: Path | None = None
    landmarks: Path | None = None
    video: Path | None = None
    fps: float | None = None
    scheme: str = "auto"
    gaps: Literal["interpolate", "hold"] = "interpolate"
    neutral: float | None = None

    def __post_init__(self) -> None:
        if sum(file is not None for file in self.files.values()) != 1:
            raise ValueError("weights, landmarks, video: expected one of the three")
        if self.neutral is not None and self.video is None:
            raise ValueError("neutral: expected a video with it")

    @property
    def files(self) -> dict[str, Path | None]:
        """The files by the name of their argument."""
        return {"weights": self.weights, "landmarks": self.landmarks, "video": self.video}

    def take(self) -> Take:
        """The performance.

        Raises
        ------
        OSError, ValueError
            If the file cannot be read or is not what it should be.
        """
        with path_is(next(name for name, file in self.files.items() if file is not None)):
            if self.weights is not None:
                return read_take(self.weights, self.fps, gaps=self.gaps)
            if self.landmarks is not None:
                return read_landmark_take(self.landmarks, self.fps, scheme=self.scheme)
            video = read_video(str(self.video))
        return VideoDriver(neutral=self.neutral).take(video if self.fps is None else replace(video, fps=self.fps))


def read_take(path: Path, fps: float | None = None, *, gaps: Literal["interpolate", "hold"] = "interpolate") -> Take:
    """A take of weights: a Live Link Face ``.csv``, or an ``.npy`` of (f, 52) ARKit weights or (f, 54) of ours.

    Raises
    ------
    OSError, ValueError
        If the file cannot be read or is not one of these; says what is wrong where.
    """
    suffix = path.suffix.lower()
    if suffix == ".csv":
        return read_live_link(path, fps=fps, gaps=gaps)
    if suffix != ".npy":
        raise ValueError(f"weights: expected a .csv or .npy file, got {path}")
    frames, notes = unit_weights(_array(path), str(path))
    if frames.ndim == 2 and frames.shape[1] == len(EXPRESSIONS):
        take = Take.of_frames(frames, fps or 30.0)
    else:
        take = ArkitDriver().take(frames, fps or 30.0)
    return replace(take, notes=notes)


def read_landmark_take(path: Path, fps: float | None = None, *, scheme: str = "auto") -> Take:
    """A take from landmarks in px of each frame, the first of which shows the neutral face.

    Raises
    ------
    OSError, ValueError
        As of :func:`toongeo.io.read_landmark_frames`.
    """
    frames = read_landmark_frames(path, scheme=scheme)
    lost = ~(np.nanmax(frames, axis=1, initial=-np.inf) > np.nanmin(frames, axis=1, initial=np.inf)).any(axis=1)
    if lost.all():
        raise ValueError(f"{path}: expected a face in at least one frame, got none in {len(frames)}")
    frames = np.where(lost[:, None, None], np.nan, frames)  # programs write zeros where they saw no face
    weights = LandmarkDriver(frames[~lost][0]).frames(frames, fps or 30.0)
    notes = (f"{lost.sum()} of {len(frames)} frames show no face and were held",) if lost.any() else ()
    return replace(Take.of_frames(weights, fps or 30.0), notes=notes)


def _array(path: Path) -> NDArray[np.float64]:
    check_file(path)
    with path.open("rb") as stream, promise(path, "an array of numbers in NumPy's format"):
        return np.array(npy_array(stream, path.stat().st_size, kinds="biuf"), np.float64)
