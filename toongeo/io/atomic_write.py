"""Whole files, or none."""

import errno
import os
import uuid
from collections.abc import Mapping
from pathlib import Path

__all__ = ["atomic_write"]


def atomic_write(files: Mapping[str | os.PathLike[str], bytes]) -> None:
    """Write files so that each is either complete or not there.

    Every content goes to a temporary file in the folder of its target first; only when all are on the disk
    are they renamed to their names. A file that existed keeps its old content until then. A symbolic link
    is followed.

    Parameters
    ----------
    files
        Path -> content. Several paths are one output (an ``.obj`` with its ``.mtl`` and ``.png``), renamed
        in order.

    Raises
    ------
    OSError
        If a target cannot be written (missing folder, a folder of that name, no permission, disk full);
        says which.

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
    try:
        for path, content in files.items():
            target = Path(path)
            staged.append((_staged(Path(os.path.realpath(path)), content), target))
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
