"""What the picker's page asks, and the answers."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import numpy as np

from toongeo.app.editor.editor_settings import editor_settings
from toongeo.app.picker.picked_mesh import PickedMesh
from toongeo.io import read_mesh_landmarks, write_mesh_landmarks
from toongeo.model import default_model
from toongeo.model.ibug68 import PARTS

__all__ = ["FORMATS", "PickerSession"]

FORMATS = (".json", ".txt")
# In this order parts are asked for: those first where everybody would click the same point.
_PARTS = ("eye_right", "eye_left", "nose", "mouth", "brow_right", "brow_left", "jaw")
_MIDDLE = 0.02  # of the distance of the eyes: points nearer to the plane of symmetry belong to neither side


class PickerSession:
    """Answers a page about one mesh and the vertices of its landmarks.

    Parameters
    ----------
    mesh : PickedMesh
    name : str
        What the page calls it.
    output : Path
        ``.json`` or ``.txt``; the page may choose the other of the two.
    start : Path, optional
        Where to start: see :func:`toongeo.io.read_mesh_landmarks`; else the output if it is there, else what the model
        has.

    Raises
    ------
    ValueError
        If ``start`` cannot be read as landmarks of the mesh.
    """

    n_pictures = 0

    def __init__(self, mesh: PickedMesh, name: str, output: Path, start: Path | None = None) -> None:
        self._mesh, self.title, self._output = mesh, name, output
        self._written: set[Path] = set()
        self._start, self._note = self._begun(start)
        self._answers = {"mesh": self._shown, "save": self._save}

    def settings(self) -> dict[str, Any]:
        """What the page knows from the beginning."""
        return editor_settings() | {"kind": "picker", "order": _order(), "formats": list(FORMATS)}

    def shown_picture(self, k: int) -> bytes:
        """There are none."""
        raise ValueError("picture: expected none of a mesh")

    def answer(self, question: str, message: dict[str, Any]) -> dict[str, Any]:
        """What a question asks, as JSON takes it.

        Raises
        ------
        ValueError
            If the question or its message is not understood.
        OSError
            If the file cannot be written.
        """
        if question not in self._answers:
            raise ValueError(f"question: expected one of {', '.join(self._answers)}, got {question[:40]!r}")
        return self._answers[question](message)

    def _shown(self, message: dict[str, Any]) -> dict[str, Any]:
        mesh = self._mesh
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        # Single precision about the middle: a mesh may stand far from its origin.
        centred = (mesh.vertices - (low + high) / 2) / max(float((high - low).max()), 1e-300)
        return {
            "name": self.title,
            "suffix": self._output.suffix.lower(),
            "vertices": _packed(centred.astype("<f4")),
            "faces": _packed(mesh.faces.astype("<u4")),
            "colours": None if mesh.colours is None else _packed(mesh.colours),
            "mirror": None if mesh.mirror is None else _packed(mesh.mirror.astype("<u4")),
            "start": self._start,
            "note": self._note,
        }

    def _begun(self, start: Path | None) -> tuple[list[int | None], str]:
        """Vertices to begin with, and what there is to say of them."""
        if start is not None:
            return _nearest(read_mesh_landmarks(start, self._mesh.vertices), self._mesh), ""
        if self._output.is_file():
            try:
                found = _nearest(read_mesh_landmarks(self._output, self._mesh.vertices), self._mesh)
            except (ValueError, OSError) as error:
                return [None] * 68, str(error)
            self._written.add(self._output)  # who goes on with it may replace it
            return found, ""
        known = self._mesh.landmarks
        return [None] * 68 if known is None else known.tolist(), ""

    def _save(self, message: dict[str, Any]) -> dict[str, Any]:
        vertices, suffix = _read_vertices(message.get("vertices"), len(self._mesh.vertices)), str(message.get("suffix"))
        if suffix not in FORMATS:
            raise ValueError(f"suffix: expected {' or '.join(FORMATS)}, got {suffix[:20]!r}")
        target = self._output.with_suffix(suffix)
        if message.get("replace") is not True and target.exists() and target not in self._written:
            return {"exists": target.name}
        write_mesh_landmarks(target, vertices)
        self._written.add(target)
        return {"file": target.name}


def _order() -> list[int]:
    """The points in the order in which they are asked for: the subject's right side and the middle, then the left."""
    model = default_model()
    face = model.mean[model.landmarks]
    unit = float(np.abs(face[:, 0]).max())
    points = [int(k) for part in _PARTS for k in PARTS[part]]
    is_left = {k: bool(face[k, 0] > _MIDDLE * unit) for k in points}
    return [k for k in points if not is_left[k]] + [k for k in points if is_left[k]]


def _nearest(points: np.ndarray, mesh: PickedMesh) -> list[int | None]:
    return [
        None if np.isnan(point).any() else int(((mesh.vertices - point) ** 2).sum(axis=1).argmin()) for point in points
    ]


def _read_vertices(value: object, n: int) -> list[int | None]:
    if not isinstance(value, list) or len(value) != 68:
        got = f"{len(value)} entries" if isinstance(value, list) else str(value)[:60]
        raise ValueError(f"vertices: expected a list of 68 vertices, got {got}")
    for k, vertex in enumerate(value):
        is_vertex = isinstance(vertex, int) and not isinstance(vertex, bool) and 0 <= vertex < n
        if vertex is not None and not is_vertex:
            raise ValueError(f"vertices: expected 0 to {n - 1} or null, got {str(vertex)[:40]} for point {k}")
    return value


def _packed(array: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")
