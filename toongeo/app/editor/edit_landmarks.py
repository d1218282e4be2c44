"""``toongeo landmarks``: the editor in the browser."""

from functools import partial
from pathlib import Path

from toongeo.app.editor.editor_session import EditorSession
from toongeo.app.editor.picture_list import PictureList
from toongeo.app.editor.serve_session import serve_session
from toongeo.pipeline import detect_landmarks

__all__ = ["edit_landmarks"]


def edit_landmarks(
    path: Path,
    *,
    landmarks: Path | None = None,
    output: Path | None = None,
    face: int = 0,
    port: int = 0,
    show: bool = True,
) -> None:
    """Serve the editor on the loopback interface until interrupted.

    Parameters
    ----------
    path : Path
        A picture, or a folder of pictures.
    landmarks : Path, optional
        Where to start; else the file beside the picture, else what is detected.
    output : Path, optional
        Where to save; else beside the picture.
    face : int
        Which face of the file or, by size, of the picture.
    port : int
        0 takes a free one.
    show : bool
        Open the page in a browser; its address is printed anyway.

    Raises
    ------
    OSError, ValueError
        If a file cannot be read or is not what it should be, the output would be the picture, the port is taken, or
        `face` is negative.
    """
    if face < 0:
        raise ValueError(f"face: expected 0 for the largest face, 1 for the next, ..., got {face}")
    session = EditorSession(PictureList(path, landmarks, output, face=face), partial(detect_landmarks, face=face))
    serve_session(session, port, "editor", "Ctrl+C ends", show=show)
