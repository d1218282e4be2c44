"""A network in ONNX that guesses coefficients (the extra ``onnx``)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.protocols import Coefficients

__all__ = ["OnnxRegressor"]

_PARTS = ("identity", "expression", "albedo", "light")


class OnnxRegressor:
    """A `Regressor`: any network that takes a square picture of a face, its 68 points, or both.

    The square is centred on the landmarks; the picture goes in as RGB, (1, 3, size, size) float32, and the points as
    (1, 68, 2) float32, shares of the square, NaN where missing are 0. Which input is which is told by its number of
    dimensions.

    Parameters
    ----------
    path : str or Path
        ``.onnx``.
    outputs : part -> name
        Which output of the network is which of ``identity``, ``expression``, ``albedo`` and ``light``.
    size : int
        Side of the picture, px.
    margin : float
        Side of the square in that of the box about the landmarks.
    mean, std : (3,) array_like
        Of the network's pictures: ``(rgb / 255 - mean) / std`` goes in.

    Raises
    ------
    OSError
        If the file is missing.
    ValueError
        If an output has no such name, or an input is neither picture nor points.
    ImportError
        If onnxruntime is not installed.

    Examples
    --------
    >>> regressor = OnnxRegressor("face.onnx", {"identity": "id"})  # doctest: +SKIP
    >>> tg.fit_3dmm(img, landmarks, regressor=regressor)  # doctest: +SKIP
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        outputs: Mapping[str, str],
        *,
        size: int = 224,
        margin: float = 1.6,
        mean: ArrayLike = (0.0, 0.0, 0.0),
        std: ArrayLike = (1.0, 1.0, 1.0),
    ) -> None:
        try:
            import onnxruntime
        except ImportError as error:
            raise ImportError("networks in ONNX need onnxruntime: pip install toongeo[onnx]") from error
        if not Path(path).is_file():
            raise FileNotFoundError(f"path: no network {path}")
        unknown = sorted(set(outputs) - set(_PARTS))
        if unknown or not outputs:
            raise ValueError(f"outputs: expected some of {', '.join(_PARTS)}, got {', '.join(unknown) or 'none'}")
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1  # the same digits on every machine
        self._session: Any = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
        there = [output.name for output in self._session.get_outputs()]
        missing = [name for name in outputs.values() if name not in there]
        if missing:
            raise ValueError(f"outputs: expected names of {', '.join(there)}, got {', '.join(missing)}")
        self._inputs = {node.name: len(node.shape) for node in self._session.get_inputs()}
        if not all(rank in (3, 4) for rank in self._inputs.values()):
            raise ValueError(f"path: expected inputs (1, 3, size, size) or (1, 68, 2), got {self._inputs}")
        self._outputs, self._size, self._margin = dict(outputs), size, margin
        self._mean, self._std = (np.asarray(part, np.float32).reshape(3) for part in (mean, std))

    def __call__(self, img: NDArray[np.uint8] | None, landmarks: ArrayLike) -> Coefficients:
        """Coefficients of the face with landmarks (68, 2) px, NaN where missing.

        Raises
        ------
        ValueError
            If the network needs a picture and there is none.
        """
        points = np.asarray(landmarks, np.float64)
        low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
        side = self._margin * float((high - low).max())
        corner = (low + high) / 2 - side / 2
        given = {}
        for name, rank in self._inputs.items():
            if rank == 3:
                given[name] = np.nan_to_num((points - corner) / side).astype(np.float32)[None]
            else:
                given[name] = self._square(img, corner, side)
        found = self._session.run(list(self._outputs.values()), given)
        parts: dict[str, Any] = {part: np.ravel(value) for part, value in zip(self._outputs, found, strict=True)}
        return Coefficients(**parts)

    def _square(self, img: NDArray[np.uint8] | None, corner: NDArray[np.float64], side: float) -> NDArray[np.float32]:
        if img is None:
            raise ValueError("img: expected a picture, which this network looks at, got None")
        scale = self._size / side
        shift = np.array([[scale, 0, -corner[0] * scale], [0, scale, -corner[1] * scale]])
        method = cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR
        square = cv2.warpAffine(img, shift, (self._size, self._size), flags=method, borderMode=cv2.BORDER_REPLICATE)
        colours = (square.astype(np.float32) / 255 - self._mean) / self._std
        return np.ascontiguousarray(colours.transpose(2, 0, 1), np.float32)[None]
