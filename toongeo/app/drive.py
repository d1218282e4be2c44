"""``toongeo drive``: a performance on the face of an avatar, as a video or a GLB that plays it."""

from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.read_take import read_landmark_take, read_take
from toongeo.app.write_video import write_video
from toongeo.avatar.load_avatar import load_avatar

__all__ = ["drive"]

_OUTPUTS = (".mp4", ".glb")
_SIZE, _FPS = 512, 30.0


def drive(
    avatar: Path,
    output: Path,
    *,
    weights: Path | None = None,
    landmarks: Path | None = None,
    size: int = _SIZE,
    fps: float = _FPS,
    take_fps: float | None = None,
    scheme: str = "auto",
) -> None:
    """Play a take on an avatar and write it down.

    Parameters
    ----------
    avatar : Path
        A GLB that ``toongeo make`` wrote.
    output : Path
        ``.mp4``, or ``.glb`` with the take as its animation.
    weights : Path, optional
        Live Link Face ``.csv``, or ``.npy`` of (f, 52) ARKit weights or (f, 54) of ours.
    landmarks : Path, optional
        ``.npy`` of (f, 68, 2) px of a performer, whose first frame is neutral. Either this or ``weights``.
    size : int
        Side of the video, px, even.
    fps : float
        Of the video, or of the keys.
    take_fps : float, optional
        Of a take that does not say it.
    scheme : str
        What the landmarks are: see :func:`toongeo.read_landmark_file`.

    Raises
    ------
    OSError
        If a file cannot be read or written; nothing half-written is left.
    ValueError
        If a file is not what it should be, the output is a file that is read, or an option has no such value.
    """
    suffix = output.suffix.lower()
    if suffix not in _OUTPUTS:
        raise ValueError(f"output: expected a name that ends in {' or '.join(_OUTPUTS)}, got {output}")
    check_output(output, {"avatar": avatar, "weights": weights, "landmarks": landmarks})
    if (weights is None) == (landmarks is None):
        raise ValueError("weights, landmarks: expected one of the two")
    take = (
        read_take(weights, take_fps) if weights else read_landmark_take(Path(str(landmarks)), take_fps, scheme=scheme)
    )
    take = take.resampled(fps)
    face = load_avatar(avatar)
    if suffix == ".glb":
        face.save(output, animation=(take.times, take.weights))
    else:
        write_video(output, (face.render(frame, size=size) for frame in take.weights), size, fps, len(take.times))
    print(f"wrote {output}: {len(take.times)} frames, {take.seconds:.2f} s")
