"""Where a command takes a performance from."""

from dataclasses import dataclass, replace
from pathlib import Path

from toongeo.app.read_take import read_landmark_take, read_take
from toongeo.driving import Take, VideoDriver
from toongeo.io import read_video

__all__ = ["TakeSource"]


@dataclass(frozen=True)
class TakeSource:
    """One file of a performance.

    Attributes
    ----------
    weights : Path, optional
        Live Link Face ``.csv``, or ``.npy`` of (f, 52) ARKit weights or (f, 54) of ours.
    landmarks : Path, optional
        ``.npy`` of (f, 68, 2) px of a performer, whose first frame is neutral.
    video : Path, optional
        A film of a performer, who looks neutral in some frames.
    fps : float, optional
        Frames a second, of a file that does not say it, or instead of what it says.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.
    """

    weights: Path | None = None
    landmarks: Path | None = None
    video: Path | None = None
    fps: float | None = None
    scheme: str = "ibug68"

    def __post_init__(self) -> None:
        if sum(file is not None for file in self.files.values()) != 1:
            raise ValueError("weights, landmarks, video: expected one of the three")

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
        if self.weights is not None:
            return read_take(self.weights, self.fps)
        if self.landmarks is not None:
            return read_landmark_take(self.landmarks, self.fps, scheme=self.scheme)
        video = read_video(str(self.video))
        return VideoDriver().take(video if self.fps is None else replace(video, fps=self.fps))
