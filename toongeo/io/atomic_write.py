"""Whole files, or none."""

import errno
import os
import stat
import uuid
from collections.abc import Mapping
from pathlib import Path

__all__ = ["atomic_write"]


def atomic_write(files: Mapping[str | os.PathLike[str], bytes]) -> None:
    """Write files so that each is either complete or not there.

    Every content goes to a temporary file in the folder of its target first; only when all are on the disk
    are they renamed to their names. A file that existed keeps its old content until then. A symbolic link
    is followed. A device or a pipe of that name stays what it is: the content goes into it, after all files are on
    the disk.

    Parameters
    ----------
    files
        Path -> content. Several paths are one output (an ``.obj`` with its ``.mtl`` and ``.png``), renamed
        in order.

    Raises
    ------
    ValueError
        If a path is no name of a file.
    OSError
        If a target cannot be written (missing folder, a folder of that name, no permission, disk full, a pipe that
        nobody reads); says which.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> atomic_write({folder / "a.txt": b"hello"})
    >>> (folder / "a.txt").read_bytes()
    b'hello'
    """
    staged: list[tuple[str, Path]] = []
    target = Path()
    for path in files:
        _check_name(path)
    try:
        for path, content in files.items():
            target = Path(path)
            if not _is_special(target):
                staged.append((_staged(Path(os.path.realpath(path)), content), target))
        for path, content in files.items():
            target = Path(path)
            if _is_special(target):
                _pour(target, content)
        while staged:
            temporary, target = staged[0]
            os.replace(temporary, os.path.realpath(target))
            staged.pop(0)
    except OSError as error:
        reason = error.strerror or str(error)
        # The two-argument form picks the subclass (PermissionError, ...) from errno.
        raise OSError(error.errno, f"cannot write {target}: {reason}") from error
    finally:
        for temporary, _ in staged:
            os.unlink(temporary)


def _check_name(path: object) -> None:
    try:
        os.fsencode(path)  # type: ignore[arg-type]
    except (TypeError, UnicodeEncodeError) as error:  # no name at all, half a character
        raise ValueError(f"path: expected the name of a file, got {path!r} ({error})") from None
    if "\0" in os.fsdecode(path):  # type: ignore[arg-type]
        raise ValueError(f"path: expected the name of a file, got one with a zero byte: {path!r}")


def _is_special(target: Path) -> bool:
    """Whether a device, pipe or socket is there, whose place no file may take."""
    try:
        mode = target.stat().st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def _pour(target: Path, content: bytes) -> None:
    """Into a device, or into a pipe if somebody reads from it."""
    # Opening a pipe would wait for a reader; without waiting it fails where there is none.
    descriptor = os.open(target, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0))
    os.set_blocking(descriptor, True)
    with os.fdopen(descriptor, "wb") as stream:
        stream.write(content)


def _staged(target: Path, content: bytes) -> str:
    """Temporary file beside ``target`` that holds ``content``; removed again if that fails."""
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "it is a folder", str(target))
    # Its name does not repeat the target's, which may already be as long as the file system allows.
    temporary = str(target.parent / f".toongeo-{uuid.uuid4().hex}.tmp")
    # Not tempfile.mkstemp: its files are for the owner only, whatever the umask says.
    with open(temporary, "xb") as stream:
        try:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
            if target.exists():
                os.chmod(temporary, target.stat().st_mode & 0o777)
        except BaseException:
            os.unlink(temporary)
            raise
    return temporary
