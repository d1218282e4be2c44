"""XML as a sequence of elements."""

from collections.abc import Callable
from pathlib import Path
from xml.parsers import expat

from toongeo.reading.check_file import file_bytes

__all__ = ["xml_elements"]

_MOST_MB = 64


def xml_elements(path: Path, visit: Callable[[str, dict[str, str], int], None]) -> None:
    """Call ``visit`` with name, attributes and line of each element, in the order of the file.

    Entities are refused, since they may stand for gigabytes.

    Raises
    ------
    ValueError, OSError
        If it is no XML, or declares entities.
    """
    parser = expat.ParserCreate()

    def start(element: str, attributes: dict[str, str]) -> None:
        visit(element, attributes, parser.CurrentLineNumber)

    def refuse(*_: object) -> None:
        raise ValueError(f"path: expected XML without entities of its own, but {path} has some")

    parser.StartElementHandler = start
    parser.EntityDeclHandler = refuse
    try:
        parser.Parse(file_bytes(path, _MOST_MB), True)
    except (expat.ExpatError, LookupError) as error:  # also of an unknown encoding
        raise ValueError(f"path: expected XML, but in {path}: {error}") from error
