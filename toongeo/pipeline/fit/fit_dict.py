"""A fit as plain numbers and texts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any

import numpy as np

from toongeo.model.model_checksum import model_checksum
from toongeo.model.morphable_model import MorphableModel
from toongeo.protocols import HeadCamera
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera

__all__ = ["camera_dict", "checked_model", "plain", "read_camera", "read_report", "report_dict"]

_CAMERAS: dict[str, Any] = {kind.__name__: kind for kind in (PerspectiveCamera, ScaledOrthographicCamera)}


def plain(value: Any) -> Any:
    """Arrays as lists, all else as it is."""
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def camera_dict(camera: HeadCamera) -> dict[str, Any]:
    """The fields of a camera of the library, and its ``kind``.

    Raises
    ------
    ValueError
        If it is of another class.
    """
    kind = type(camera).__name__
    if _CAMERAS.get(kind) is not type(camera):
        raise ValueError(f"camera: expected one of {', '.join(_CAMERAS)}, got {kind}")
    return {"kind": kind} | {field.name: plain(getattr(camera, field.name)) for field in fields(_CAMERAS[kind])}


def read_camera(content: Mapping[str, Any]) -> HeadCamera:
    """Inverse of `camera_dict`."""
    parts = {name: value for name, value in content.items() if name != "kind"}
    arrays = {name: np.array(value, np.float64) if isinstance(value, list) else value for name, value in parts.items()}
    camera: HeadCamera = _CAMERAS[content["kind"]](**arrays)
    return camera


def read_report(kind: type[Any], content: Mapping[str, Any] | None) -> Any:
    """A report from its fields; lists become tuples again."""
    if content is None:
        return None
    return kind(**{name: tuple(value) if isinstance(value, list) else value for name, value in content.items()})


def report_dict(report: Any) -> dict[str, Any] | None:
    """The fields of a report; None of None."""
    return None if report is None else {k: list(v) if isinstance(v, tuple) else v for k, v in asdict(report).items()}


def checked_model(content: Mapping[str, Any], model: MorphableModel) -> MorphableModel:
    """The model, if it is the one that the fit was made with; else ValueError."""
    if content["model"] != model_checksum(model):
        raise ValueError("model: expected the model that the fit was made with, got another")
    return model
