"""A scene into a binary glTF 2.0 file."""

import os
from typing import Any

from toongeo.io.atomic_write import atomic_write
from toongeo.io.encode_glb import encode_glb
from toongeo.io.scene import Scene

__all__ = ["write_glb"]


def write_glb(path: str | os.PathLike[str], scene: Scene, **options: Any) -> None:
    """Write a ``.glb``; atomically, and the same bytes for the same scene.

    Parameters
    ----------
    path
        File to write.
    scene, **options
        As of :func:`encode_glb`.

    Raises
    ------
    OSError
        If the path cannot be written; nothing half-written remains.
    ValueError
        As of :func:`encode_glb`.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> import numpy as np
    >>> from toongeo.io import Scene, SceneMesh, read_glb
    >>> up = {"targets": np.ones((1, 3, 3)), "target_names": ("up",)}
    >>> triangle = SceneMesh("triangle", np.eye(3), np.array([[0, 1, 2]]), **up)
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "t.glb"
    >>> write_glb(path, Scene((triangle,)))
    >>> read_glb(path).json["meshes"][0]["extras"]
    {'targetNames': ['up']}
    """
    atomic_write({path: encode_glb(scene, **options)})
