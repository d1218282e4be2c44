"""``toongeo model pick`` and ``toongeo landmarks`` of a mesh: the picker in the browser."""

from pathlib import Path

from toongeo.app.check_output import check_output
from toongeo.app.commands.path_is import path_is
from toongeo.app.editor.serve_session import serve_session
from toongeo.app.picker.picked_mesh import picked_mesh, picked_model
from toongeo.app.picker.picker_session import FORMATS, PickerSession

__all__ = ["pick_landmarks"]


def pick_landmarks(
    path: Path,
    *,
    landmarks: Path | None = None,
    output: Path | None = None,
    as_model: bool = False,
    format: str | None = None,
    expression: Path | None = None,
    cache: Path | None = None,
    port: int = 0,
    show: bool = True,
) -> None:
    """Serve the picker on the loopback interface until interrupted.

    Parameters
    ----------
    path : Path
        A mesh file or, with ``as_model``, a model.
    landmarks : Path, optional
        Where to start.
    output : Path, optional
        ``.json`` or ``.txt``; else ``.json`` beside the mesh, under its name.
    as_model : bool
        Whether vertices are counted as :func:`toongeo.load_model` counts them; else as ``toongeo rig`` does.
    format, expression, cache
        As of :func:`toongeo.load_model`.
    port : int
        0 takes a free one.
    show : bool
        Open the page in a browser; its address is printed anyway.

    Raises
    ------
    OSError, ValueError
        If a file cannot be read or is not what it should be, the output is a file that is read or of another kind, or
        the port is taken.
    """
    target = path.resolve().with_suffix(FORMATS[0]) if output is None else output
    if target.suffix.lower() not in FORMATS:
        raise ValueError(f"output: expected a name that ends in {' or '.join(FORMATS)}, got {target}")
    check_output(target, {"path": path})
    mesh = picked_model(path, format=format, expression=expression, cache=cache) if as_model else picked_mesh(path)
    with path_is("landmarks"):
        session = PickerSession(mesh, path.name, target, landmarks)
    serve_session(session, port, "picker", f"it saves {target}; Ctrl+C ends", show=show)
