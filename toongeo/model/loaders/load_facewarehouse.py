"""FaceWarehouse."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io import read_obj
from toongeo.model.loaders.principal_modes import principal_modes
from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.promise import promise
from toongeo.reading.read_npz import npz_names, read_npz

__all__ = ["is_facewarehouse", "load_facewarehouse", "testers"]

_KEYS, _MORE = ("tensor", "faces"), ("landmarks", "expression_names", "uv", "uv_faces")
_N_MODES = 50  # of 150 people, as the authors use


def is_facewarehouse(path: Path) -> bool:
    """Whether a path is the folder of the data set, or its tensor."""
    return bool(testers(path)) if path.is_dir() else set(_KEYS) <= set(npz_names(path))


def load_facewarehouse(path: str | Path, landmarks: NDArray[np.int64] | None = None) -> MorphableModel:
    """FaceWarehouse's people and expressions, linear about their mean.

    Parameters
    ----------
    path : str or Path
        The folder of the data set, with ``Tester_*/Blendshape/shape.bs`` and, for the triangles,
        ``Tester_*/TrainingPose/pose_0.obj``; or an ``.npz`` with ``tensor`` (people, expressions, n, 3), the neutral
        first, ``faces`` (m, 3) from 0 and, if wanted, ``landmarks`` (68,), ``expression_names``, ``uv``, ``uv_faces``.
        A head of the data set has 11,510 vertices, a person 47 shapes. The unit is the power of ten that makes a head.
    landmarks : (68,) int, optional

    Returns
    -------
    MorphableModel
        Identity: the first 50 principal components of the neutral faces. Expressions: the mean over people of each
        shape less its neutral.

    Raises
    ------
    ValueError
        If files are missing, sizes do not fit, numbers are not finite or indices out of range.

    References
    ----------
    C. Cao et al., "FaceWarehouse: a 3D facial expression database for visual computing", TVCG 2014.
    """
    path = Path(path)
    with promise(path, "FaceWarehouse", alone=True):
        if path.is_dir():
            tensor, z = _folder(path)
        else:
            z = read_npz(path, _KEYS, _MORE, expected="FaceWarehouse")
            tensor = z["tensor"]
        if tensor.ndim != 4 or tensor.shape[3] != 3 or min(tensor.shape[:2]) < 1:
            raise ValueError(f"expected a tensor (people, expressions, n, 3), got {tensor.shape}")
        mean, modes = principal_modes(tensor[:, 0].astype(np.float64), _N_MODES)
        if landmarks is None and "landmarks" in z:
            landmarks = z["landmarks"]
        return MorphableModel.from_arrays(
            mean,
            z["faces"],
            identity=modes,
            expression=(tensor[:, 1:] - tensor[:, :1]).mean(axis=0, dtype=np.float64),
            expression_names=[str(name) for name in z.get("expression_names", ())],
            landmarks=landmarks,
            unit="auto",
            uv=z.get("uv"),
            uv_faces=z.get("uv_faces"),
        )


def testers(folder: Path) -> list[Path]:
    """Folders of the people, in their order."""
    found = [(int(match[1]), path) for path in folder.iterdir() if (match := re.fullmatch(r"Tester_(\d+)", path.name))]
    return [path for _, path in sorted(found) if (path / "Blendshape" / "shape.bs").is_file()]


def _folder(folder: Path) -> tuple[NDArray[np.float32], dict[str, NDArray]]:
    people = testers(folder)
    meshes = [path for person in people if (path := person / "TrainingPose" / "pose_0.obj").is_file()]
    if not meshes:
        raise ValueError("no TrainingPose/pose_0.obj gives the triangles")
    tensor = np.stack([_shapes(person / "Blendshape" / "shape.bs") for person in people])
    mesh = read_obj(meshes[0])
    faces, uv_faces, _ = mesh.triangles()
    found: dict[str, NDArray] = {"faces": faces}
    if len(mesh.uv) and (uv_faces >= 0).all():
        found |= {"uv": mesh.uv, "uv_faces": uv_faces}
    return tensor, found


def _shapes(path: Path) -> NDArray[np.float32]:
    """Neutral and blendshapes (s + 1, n, 3) of a file: counts of shapes, vertices, faces, then the numbers."""
    content = path.read_bytes()
    shapes, vertices, _ = struct.unpack_from("<3i", content)
    count = (shapes + 1) * vertices * 3
    if min(shapes, vertices) < 1 or len(content) != 12 + 4 * count:
        raise ValueError(f"{path.name} of {len(content)} bytes speaks of {shapes} shapes of {vertices} vertices")
    return np.frombuffer(content, "<f4", count, 12).reshape(shapes + 1, vertices, 3)
