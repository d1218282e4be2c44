"""``toongeo drive``: a performance on the face of an avatar, as a video, a GLB that plays it, or a table."""

import sys
from dataclasses import replace
from pathlib import Path

from toongeo._extras import missing_extra
from toongeo.app.check_output import check_output
from toongeo.app.read_take import TakeSource
from toongeo.app.video.film_options import FilmOptions
from toongeo.app.video.sound import Sound
from toongeo.app.video.write_film import write_film
from toongeo.app.video.write_video import VIDEO_SUFFIXES
from toongeo.avatar.load_avatar import load_avatar
from toongeo.driving import Take, head_quaternions, target_columns, write_live_link
from toongeo.io import (
    GlbDocument,
    Video,
    animate_glb,
    glb_scene,
    has_pyav,
    has_sound,
    head_bone,
    morph_targets,
    read_glb,
    read_video,
)

__all__ = ["check_performance", "drive", "perform"]

_OUTPUTS = (*VIDEO_SUFFIXES, ".glb", ".csv")


def drive(
    avatar: Path,
    output: Path,
    source: TakeSource,
    options: FilmOptions | None = None,
    *,
    sound: Path | None = None,
) -> None:
    """Play a take on an avatar and write it down.

    Parameters
    ----------
    avatar : Path
        A GLB that ``toongeo make`` or ``rig`` wrote, or of another program, with morph targets named as ARKit does.
    output : Path
        ``.mp4`` or ``.webm``; ``.glb`` with the take as its animation; or ``.csv`` of Live Link Face with the weights
        alone.
    source : TakeSource
    options : FilmOptions, optional
    sound : Path, optional
        A sound, or a film with one, for a video; that of the film of the actor unless given.

    Raises
    ------
    OSError
        If a file cannot be read or written; nothing half-written is left.
    ValueError
        If a file is not what it should be, the output is a file that is read, or an option has no such value.
    ImportError
        If a sound is asked for without PyAV.
    """
    options = FilmOptions() if options is None else options
    check_performance(avatar, output, options, {**source.files, "sound": sound})
    if options.actor is not None and source.video is None:
        raise ValueError("actor: expected a film of an actor (video) to show, got none")
    heard = _sound(source, sound, options) if output.suffix.lower() in VIDEO_SUFFIXES else None
    perform(avatar, output, source.take(), options, source=source, sound=heard)


def check_performance(avatar: Path, output: Path, options: FilmOptions, files: dict[str, Path | None]) -> None:
    """Refuse before the work what could not be written after it."""
    suffix = output.suffix.lower()
    if suffix not in _OUTPUTS:
        raise ValueError(f"output: expected a name that ends in {', '.join(_OUTPUTS)}, got {output}")
    check_output(output, {"avatar": avatar, **files})
    if suffix in VIDEO_SUFFIXES:
        options.check(output)


def perform(
    avatar: Path,
    output: Path,
    take: Take,
    options: FilmOptions,
    *,
    source: TakeSource | None = None,
    sound: Sound | None = None,
) -> None:
    """Play a take, as it was read, on a face and write it down."""
    suffix = output.suffix.lower()
    take = take.between(options.start, options.end).resampled(options.fps)
    for note in take.notes:
        print(f"note: {note}", file=sys.stderr)
    document = read_glb(avatar)
    own = document.attachment is not None and document.intact
    turns = None if take.head is None else head_quaternions(take.head)
    if suffix == ".csv":
        write_live_link(output, take)
    elif not own:
        _perform_any(avatar, document, output, take, options, source, sound)
    elif suffix == ".glb":
        animation = (take.times, take.weights) if turns is None else (take.times, take.weights, turns)
        load_avatar(avatar).save(output, animation=animation)
    else:
        write_film(output, load_avatar(avatar), take, options, actor=_film(source, options), sound=sound)
    print(f"wrote {output}: {len(take.times)} frames, {take.seconds:.2f} s")


def _perform_any(
    avatar: Path,
    document: GlbDocument,
    output: Path,
    take: Take,
    options: FilmOptions,
    source: TakeSource | None,
    sound: Sound | None,
) -> None:
    """Play a take on the morph targets of a file that is no avatar of ours, by their names."""
    targets = dict.fromkeys(name for names in morph_targets(document.json).values() for name in names)
    try:
        columns = target_columns(take, targets)
    except ValueError as error:
        raise ValueError(f"{avatar}: {error}") from None
    if output.suffix.lower() == ".glb":
        turns = None if take.head is None else head_quaternions(take.head)
        if turns is not None and head_bone(document.json) is None:
            print("note: the file has no bone named head or neck: its head does not turn", file=sys.stderr)
            turns = None
        animate_glb(avatar, output, take.times, columns, turns=turns)
        return
    try:
        scene = glb_scene(document)
    except ValueError as error:
        raise ValueError(f"{avatar}: {error}; -o {output.stem}.glb plays on it all the same") from None
    write_film(output, scene, take, options, columns=columns, actor=_film(source, options), sound=sound)


def _film(source: TakeSource | None, options: FilmOptions) -> Video | None:
    return read_video(source.video) if source is not None and source.video is not None and options.actor else None


def _sound(source: TakeSource, sound: Path | None, options: FilmOptions) -> Sound | None:
    """That which is asked for, or that of the film, where it can be heard."""
    heard = Sound(Path() if sound is None else sound, options.start or 0.0)
    if sound is not None:
        if not has_pyav():
            raise ImportError(missing_extra("sound in a video", "video"))
        if not has_sound(sound):
            raise ValueError(f"sound: expected a file with a sound, got {sound}")
        return heard
    if source.video is None:
        return None
    if not has_pyav():
        print(f"note: the video is silent; {missing_extra('its sound', 'video')}", file=sys.stderr)
        return None
    return replace(heard, path=source.video) if has_sound(source.video) else None
