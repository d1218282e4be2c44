"""A morphable model of others, from the file that a command names."""

from pathlib import Path

from toongeo.model import MorphableModel, load_eos, load_ict_facekit

__all__ = ["read_model"]

# Beside a shape model of eos, as its project ships them.
_EOS_LANDMARKS, _EOS_EXPRESSION = "ibug_to_sfm.txt", "expression_blendshapes_3448.bin"


def read_model(path: Path) -> MorphableModel:
    """The model in a file, by its suffix.

    Parameters
    ----------
    path : Path
        ``.npz`` for :func:`toongeo.load_ict_facekit`; ``.bin`` for :func:`toongeo.load_eos`, with ``ibug_to_sfm.txt``
        and, if it is there, ``expression_blendshapes_3448.bin`` beside it.

    Raises
    ------
    OSError, ValueError
        If there is no such file, or it is none of these.
    """
    if not path.is_file():
        raise FileNotFoundError(f"model: no file {path}")
    suffix = path.suffix.lower()
    try:
        if suffix == ".npz":
            return load_ict_facekit(path)
        if suffix == ".bin":
            expression = path.with_name(_EOS_EXPRESSION)
            return load_eos(path, path.with_name(_EOS_LANDMARKS), expression if expression.is_file() else None)
    except (ValueError, KeyError, OSError) as error:
        raise ValueError(f"model: {path} cannot be read: {error}") from error
    raise ValueError(f"model: expected .npz (ICT-FaceKit) or .bin (eos), got {path}")
