"""``toongeo make``: a picture into a file."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tqdm import tqdm

from toongeo.app.check_output import check_output
from toongeo.app.landmark_source import LandmarkSource
from toongeo.avatar.avatar import Avatar
from toongeo.avatar.crop_faces import Crop
from toongeo.avatar.make_avatar import STAGES, make_avatar
from toongeo.avatar.save_avatar import writer_for
from toongeo.io import LandmarkFile, read_image
from toongeo.model.ibug68 import INNER
from toongeo.pipeline.align.denoise_landmarks import Noise

__all__ = ["make"]


def make(
    image: Path,
    output: Path,
    source: LandmarkSource,
    *,
    texture_size: int = 1024,
    crop: Crop = "head",
    noise: Noise = "auto",
    snap: bool = False,
    photometric: bool = False,
    hair: bool = True,
    hair_mask: Path | None = None,
    format: str | None = None,
    options: Mapping[str, Any] | None = None,
) -> Avatar:
    """Read, build, save and report, with a progress line a stage.

    The source gives the landmarks. The other parameters are those of :func:`toongeo.make_avatar` and of
    :meth:`toongeo.Avatar.save`, whose other options are in ``options``.

    Raises
    ------
    UnsureLandmarksError
        If landmarks were found that are not sure, and the source does not accept them.
    ValueError, OSError, ImportError
        For bad input or an output that cannot be written, or would replace a file that is read or was not written for
        it; the output is checked before the work.
    """
    saving = {"crop": crop, **(options or {})}
    writer_for(output, format, saving)
    check_output(output, {"image": image, "landmarks": source.file, "hair_mask": hair_mask}, format)
    img = read_image(image)
    points, found = source.landmarks(image, img)
    if isinstance(found, LandmarkFile):
        print(found.message)
    else:
        trust = 100 * found.confidence[INNER].mean()
        print(f"landmarks found: face {100 * found.score:.0f} %, points {trust:.0f} % sure")
    with tqdm(total=len(STAGES), unit="stage", bar_format="{desc:<12}{bar:24} {n_fmt}/{total_fmt} {elapsed}") as bar:

        def announce(stage: str) -> None:
            bar.update(STAGES.index(stage) - bar.n)
            bar.set_description(stage)

        avatar = make_avatar(
            img,
            points,
            noise=noise,
            snap=snap,
            photometric=photometric,
            hair=hair,
            hair_mask=hair_mask,
            texture_size=texture_size,
            progress=announce,
        )
        bar.update(len(STAGES) - bar.n)
        bar.set_description("done")
    avatar.save(output, format=format, **saving)
    print("\n".join(avatar.report.lines()))
    print(f"wrote {output}")
    return avatar
