"""``toongeo drive``: a performance on the face of an avatar, as a video, a GLB that plays it, or a table."""

import sys
from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.read_take import TakeSource
from toongeo.app.write_video import write_video
from toongeo.avatar.load_avatar import load_avatar
from toongeo.driving import ScenePuppet, Take, target_columns, write_live_link
from toongeo.io import GlbDocument, animate_glb, glb_scene, morph_targets, read_glb

__all__ = ["drive"]

_OUTPUTS = (".mp4", ".glb", ".csv")
_SIZE, _FPS = 512, 30.0


def drive(avatar: Path, output: Path, source: TakeSource, *, size: int = _SIZE, fps: float = _FPS) -> None:
    """Play a take on an avatar and write it down.

    Parameters
    ----------
    avatar : Path
        A GLB that ``toongeo make`` or ``rig`` wrote, or of another program, with morph targets named as ARKit does.
    output : Path
        ``.mp4``; ``.glb`` with the take as its animation; or ``.csv`` of Live Link Face with the weights alone.
    source : TakeSource
    size : int
        Side of the video, px, even.
    fps : float
        Of the video, the keys, or the lines.

    Raises
    ------
    OSError
        If a file cannot be read or written; nothing half-written is left.
    ValueError
        If a file is not what it should be, the output is a file that is read, or an option has no such value.
    """
    suffix = output.suffix.lower()
    if suffix not in _OUTPUTS:
        raise ValueError(f"output: expected a name that ends in {', '.join(_OUTPUTS)}, got {output}")
    check_output(output, {"avatar": avatar, **source.files})
    take = source.take().resampled(fps)
    for note in take.notes:
        print(f"note: {note}", file=sys.stderr)
    document = read_glb(avatar)
    if suffix == ".csv":
        write_live_link(output, take)
    elif document.attachment is None or not document.intact:
        _drive_any(avatar, document, output, take, size=size, fps=fps)
    elif suffix == ".glb":
        load_avatar(avatar).save(output, animation=(take.times, take.weights))
    else:
        face = load_avatar(avatar)
        write_video(output, (face.render(frame, size=size) for frame in take.weights), size, fps, len(take.times))
    print(f"wrote {output}: {len(take.times)} frames, {take.seconds:.2f} s")


def _drive_any(avatar: Path, document: GlbDocument, output: Path, take: Take, *, size: int, fps: float) -> None:
    """Play a take on the morph targets of a file that is no avatar of ours, by their names."""
    targets = dict.fromkeys(name for names in morph_targets(document.json).values() for name in names)
    try:
        columns = target_columns(take, targets)
    except ValueError as error:
        raise ValueError(f"{avatar}: {error}") from None
    if output.suffix.lower() == ".glb":
        animate_glb(avatar, output, take.times, columns)
        return
    try:
        puppet = ScenePuppet(glb_scene(document))
    except ValueError as error:
        raise ValueError(f"{avatar}: {error}; -o {output.stem}.glb plays on it all the same") from None
    frames = (puppet.render({n: float(c[k]) for n, c in columns.items()}, size) for k in range(len(take.times)))
    write_video(output, frames, size, fps, len(take.times))
