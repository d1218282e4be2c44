"""How the examples in docstrings run: each in a folder of its own, and what many begin with is made once."""

import functools
import hashlib
import importlib.util

import pytest

# Stages that many examples call on the same picture, as ``tg.NAME``.
_KEPT = ("align_face", "build_rig", "find_hair", "fit_3dmm", "fit_lids", "make_avatar", "make_room", "photometric_fit")
# Examples that need an extra, and those that take more than five seconds however short they are.
_EXTRAS = {"AvatarWidget": "anywidget", "LandmarkEditor": "anywidget", "send_weights": "websockets"}
_SLOW = ("caricature_rig", "initial_blendshapes")

_made = {}


def _key(value):
    import numpy as np

    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, hashlib.sha256(np.ascontiguousarray(value)).hexdigest()
    return value if isinstance(value, str | int | float | None) else id(value)


def _once(function):
    @functools.wraps(function)
    def kept(*args, **kwargs):
        key = (function.__name__, *map(_key, args), *((name, _key(value)) for name, value in kwargs.items()))
        if key not in _made:
            # The arguments too: as long as they are there, nothing else has their id.
            _made[key] = function(*args, **kwargs), args, kwargs
        return _made[key][0]

    return kept


def _is_example(item) -> bool:
    return isinstance(item, pytest.DoctestItem)


def pytest_collection_modifyitems(items):
    for item in filter(_is_example, items):
        name = item.name.rpartition(".")[2]
        if name in _SLOW:
            item.add_marker(pytest.mark.slow)
        extra = _EXTRAS.get(name)
        if extra and importlib.util.find_spec(extra) is None:
            item.add_marker(pytest.mark.skip(reason=f"needs {extra}"))


@pytest.fixture(autouse=True)
def _example(request):
    """Examples write files by their bare names, and begin with a fit or an avatar of the same picture."""
    if not _is_example(request.node):
        yield
        return
    import toongeo

    patch = request.getfixturevalue("monkeypatch")
    patch.chdir(request.getfixturevalue("tmp_path"))
    for name in _KEPT:
        patch.setattr(toongeo, name, _once(getattr(toongeo, name)), raising=False)
    yield
