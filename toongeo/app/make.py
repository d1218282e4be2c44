"""``toongeo make``: a picture and its landmarks into a file."""

from pathlib import Path

from tqdm import tqdm

from toongeo.avatar import Avatar
from toongeo.crop_faces import Crop
from toongeo.io import read_image, read_landmarks
from toongeo.make_avatar import STAGES, make_avatar
from toongeo.save_avatar import SUFFIXES


def make(
    image: Path,
    landmarks: Path,
    output: Path,
    *,
    texture_size: int = 1024,
    crop: Crop = "head",
    snap: bool = False,
    photometric: bool = False,
) -> Avatar:
    """Read, build, save and report, with a progress line a stage.

    The options are those of :func:`toongeo.make_avatar` and of :meth:`toongeo.Avatar.save`.

    Raises
    ------
    ValueError, OSError
        For bad input or an output that cannot be written; the output is checked before the work.
    """
    if output.suffix.lower() not in SUFFIXES:
        raise ValueError(f"output: expected a name that ends in {', '.join(SUFFIXES)}, got {output}")
    if not output.parent.is_dir():
        raise OSError(f"output: no folder {output.parent} to write {output.name} to")
    img, points = read_image(image), read_landmarks(landmarks)
    with tqdm(total=len(STAGES), unit="stage", bar_format="{desc:<12}{bar:24} {n_fmt}/{total_fmt} {elapsed}") as bar:

        def announce(stage: str) -> None:
            bar.update(STAGES.index(stage) - bar.n)
            bar.set_description(stage)

        avatar = make_avatar(
            img, points, snap=snap, photometric=photometric, texture_size=texture_size, progress=announce
        )
        bar.update(len(STAGES) - bar.n)
        bar.set_description("done")
    avatar.save(output, crop=crop)
    print("\n".join(avatar.report.lines()))
    print(f"wrote {output}")
    return avatar
