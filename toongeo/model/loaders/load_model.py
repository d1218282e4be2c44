"""A face model of anyone's, whatever its format."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal, get_args

from toongeo.model.loaders.landmark_tables import read_landmark_vertices
from toongeo.model.loaders.load_bfm2009 import is_bfm2009, load_bfm2009
from toongeo.model.loaders.load_bfm2017 import load_bfm2017
from toongeo.model.loaders.load_eos import load_eos
from toongeo.model.loaders.load_facescape import is_facescape, load_facescape
from toongeo.model.loaders.load_facewarehouse import is_facewarehouse, load_facewarehouse, testers
from toongeo.model.loaders.load_flame import is_flame, load_flame
from toongeo.model.loaders.load_gnm import is_gnm, load_gnm
from toongeo.model.loaders.load_ict_facekit import is_ict_facekit, load_ict_facekit
from toongeo.model.loaders.load_ict_folder import ict_folder, load_ict_folder
from toongeo.model.loaders.load_shapes import load_shapes
from toongeo.model.loaders.save_model import is_own_model, load_own_model
from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.check_file import check_kind

__all__ = ["FORMATS", "Format", "load_model", "model_format"]

Format = Literal[
    "toongeo", "bfm2009", "bfm2017", "flame", "ict", "eos", "facewarehouse", "facescape", "gnm", "blendshapes", "people"
]
FORMATS: tuple[str, ...] = get_args(Format)

_ARCHIVES: tuple[tuple[Format, Callable[[Path], bool]], ...] = (
    ("toongeo", is_own_model),
    ("ict", is_ict_facekit),
    ("flame", is_flame),
    ("gnm", is_gnm),
    ("facescape", is_facescape),
    ("facewarehouse", is_facewarehouse),
)
_HDF5 = b"\x89HDF\r\n\x1a\n"
_OF_EOS = "sfm_shape_*.bin", "ibug_to_sfm.txt", "expression_blendshapes_*.bin", "*model_contours.json"


def load_model(
    path: str | Path,
    *,
    format: Format | None = None,
    landmarks: str | Path | None = None,
    expression: str | Path | None = None,
    cache: str | Path | None = None,
) -> MorphableModel:
    """A morphable model from a file or folder, in the house frame: mm, +Y up, +Z out of the face.

    Nothing of the file is executed. Sizes that it declares are held against its own before memory is asked for, and
    numbers that are not finite or indices that are out of range are refused. What the file does not hold the model does
    not have (:meth:`MorphableModel.has`); it can be given: :meth:`MorphableModel.with_landmarks`, ``with_contours``,
    ``with_uv``, ``with_rig_of``.

    Parameters
    ----------
    path : str or Path
        ``toongeo``: an ``.npz`` of :func:`save_model`. ``bfm2009``: ``01_MorphableModel.mat``, face3d's ``BFM.mat``,
        Deep3D's ``BFM_model_front.mat``. ``bfm2017``: ``model2017-1_*.h5``, ``model2019_*.h5``. ``flame``: ``.pkl`` or
        ``.npz``. ``ict``: the folder ``FaceXModel``, or its cache. ``eos``: a shape model (``.bin``), or its folder,
        with the table of landmarks, and blendshapes and contours if they are there. ``facewarehouse``: the folder, or a
        tensor. ``facescape``, ``gnm``: ``.npz``. ``blendshapes``, ``people``: a folder of ``.obj``, or a ``.glb``.
    format : str, optional
        One of these; told by the content unless given.
    landmarks : str or Path, optional
        A file that says where the 68 landmarks are, in place of the model's own: vertices (``.json``, ``.txt``), points
        in the frame of the loaded model, or the embeddings of FLAME and GNM (``.npz``, ``.npy``, ``.pkl``).
        Contour lines are then found from the shape. For ``eos`` the ``[landmark_mappings]`` of a text file.
    expression : str or Path, optional
        ``eos``: the blendshapes of a ``.bin`` that has none beside it. ``bfm2009``: ``Exp_Pca.bin``, expressions for
        the original, with ``std_exp.txt`` and ``BFM_exp_idx.mat`` beside it; only the vertices that they move are kept.
    cache : str or Path, optional
        ``ict``: an ``.npz`` that is written the first time that the folder is read, and read from then on. Nothing is
        written unless it is given.

    Returns
    -------
    MorphableModel

    Raises
    ------
    OSError
        If a file is missing or cannot be read.
    ValueError
        If the format is not known or not as it should be.
    ImportError
        If ``bfm2017`` is read without h5py (the extra ``models``).

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from toongeo.model import default_model, save_model
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "head.npz"
    >>> save_model(default_model(), path)
    >>> load_model(path).has("eyes", "jawOpen", "uv")
    True
    """
    path = Path(path)
    kind = model_format(path) if format is None else format
    if kind not in FORMATS:
        raise ValueError(f"format: expected one of {', '.join(FORMATS)}, got {format!r}")
    if kind == "eos":
        return _eos(path, landmarks, expression)
    if expression is not None and kind != "bfm2009":
        raise ValueError(f"expression: expected a model of eos or the Basel Face Model of 2009, got {kind}")
    model = _loaded(path, kind, cache) if expression is None else load_bfm2009(path, None, expression)
    if landmarks is None:
        return model
    found = model.with_landmarks(read_landmark_vertices(Path(landmarks), model))
    return found if found.has("contours") else found.with_contours()


def model_format(path: Path) -> Format:
    """The format of a file or folder, from its content.

    Raises
    ------
    OSError
        If it is not there.
    ValueError
        If it is none that is known; says which are.
    """
    if path.is_dir():
        if ict_folder(path) is not None:
            return "ict"
        if testers(path):
            return "facewarehouse"
        if list(path.glob(_OF_EOS[0])):
            return "eos"
        if list(path.glob("*.obj")):
            return "blendshapes"
    else:
        check_kind(path)
        with open(path, "rb") as file:
            head = file.read(128)
        if head.startswith(b"PK"):
            for kind, belongs in _ARCHIVES:
                if belongs(path):
                    return kind
        elif head.startswith(b"MATLAB") and is_bfm2009(path):
            return "bfm2009"
        elif head.startswith(_HDF5):
            return "bfm2017"
        elif head.startswith(b"glTF"):
            return "blendshapes"
        elif path.suffix == ".pkl":
            return "flame"
        elif path.suffix == ".bin":
            return "eos"
    raise ValueError(f"path: expected a model in one of the formats {', '.join(FORMATS)}, got {path}")


def _loaded(path: Path, kind: str, cache: str | Path | None) -> MorphableModel:
    if kind == "ict":
        return load_ict_folder(path, cache) if path.is_dir() else load_ict_facekit(path)
    if kind == "people":
        return load_shapes(path, kind="people")
    loaders: dict[str, Callable[[Path], MorphableModel]] = {
        "toongeo": load_own_model,
        "bfm2009": load_bfm2009,
        "bfm2017": load_bfm2017,
        "flame": load_flame,
        "facewarehouse": load_facewarehouse,
        "facescape": load_facescape,
        "gnm": load_gnm,
        "blendshapes": load_shapes,
    }
    return loaders[kind](path)


def _eos(path: Path, landmarks: str | Path | None, expression: str | Path | None) -> MorphableModel:
    """A model of eos with what lies beside it."""
    folder = path if path.is_dir() else path.parent
    shape, table, blendshapes, contours = (next(iter(sorted(folder.glob(name))), None) for name in _OF_EOS)
    shape = shape if path.is_dir() else path
    table = table if landmarks is None else Path(landmarks)
    if shape is None or table is None:
        raise ValueError(f"landmarks: expected a table like {_OF_EOS[1]} for {path}, got none")
    return load_eos(shape, table, blendshapes if expression is None else expression, contours)
