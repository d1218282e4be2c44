"""What many tests need is made once for a whole run, also when the run is spread over processes."""

import pickle
from pathlib import Path

from filelock import FileLock


class Once:
    """``once(key, make)`` -> what ``make()`` gives, made by whoever asks first and kept for all others.

    Processes of one run hand it on by a file, which comes back bit for bit, read-only arrays as read-only ones. Nobody
    may write to it.
    """

    def __init__(self, folder: Path | None):
        """``folder`` is what the processes of the run have in common, None if there is only one."""
        self._folder = folder
        self._made = {}

    def __call__(self, key, make):
        if key not in self._made:
            self._made[key] = make() if self._folder is None else self._from_all(key, make)
        return self._made[key]

    def _from_all(self, key, make):
        path = self._folder / f"{key}.pickle"
        with FileLock(f"{path}.lock"):
            if path.exists():
                return _load(path)
            made = make()
            _dump(made, path)
            return made


def _template():
    from toongeo.model import default_model

    return (default_model(), *default_model().eyes)


class _Pickler(pickle.Pickler):
    """Leaves out the template: every process has its own, and it is known by its identity."""

    def persistent_id(self, obj):
        return next((k for k, part in enumerate(_template()) if obj is part), None)


class _Unpickler(pickle.Unpickler):
    def persistent_load(self, pid):
        return _template()[pid]


def _dump(obj, path):
    views = []
    with path.with_suffix(".body").open("wb") as stream:
        _Pickler(stream, protocol=5, buffer_callback=views.append).dump(obj)
    # An array on bytes cannot be written to, one on a bytearray can.
    raw = [bytes(v.raw()) if v.raw().readonly else bytearray(v.raw()) for v in views]
    path.write_bytes(pickle.dumps(raw, protocol=5))


def _load(path):
    with path.with_suffix(".body").open("rb") as stream:
        return _Unpickler(stream, buffers=pickle.loads(path.read_bytes())).load()
