"""Where the files are that travel with the library."""

from pathlib import Path

__all__ = ["data_path"]

_PACKAGE = Path(__file__).resolve().parent


def data_path(name: str) -> Path:
    """Path of a file that travels with the library, in a wheel and in an editable install alike.

    A wheel carries ``data_templates/`` and ``examples/portraits/`` inside the package; in a source tree they lie
    beside it.

    Parameters
    ----------
    name
        Path relative to the project, with forward slashes, such as ``"data_templates/head.npz"``.

    Raises
    ------
    FileNotFoundError
        If neither place holds the file.

    Examples
    --------
    >>> data_path("data_templates/landmarks.csv").name
    'landmarks.csv'
    """
    places = [_PACKAGE / name, _PACKAGE.parent / name]
    for path in places:
        if path.exists():
            return path
    raise FileNotFoundError(
        f"name: {name!r} is not among the installed data files (looked at {places[0]} and {places[1]})"
    )
