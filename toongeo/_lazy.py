"""Lazy public names, so that ``import toongeo`` does not import scipy, OpenCV or libigl."""

import importlib
import re
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

__all__ = ["attach"]

_LINE = re.compile(r"^from (\S+) import (\w+) as \2$", re.MULTILINE)


def attach(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Module-level ``__getattr__``, ``__dir__`` and ``__all__`` that import a name when it is first used (PEP 562).

    The names stand once, in the stub beside the package's ``__init__.py``, which type checkers read as well:
    a line ``from module import name as name`` each.

    Parameters
    ----------
    package, file
        ``__name__`` and ``__file__`` of the package. A module may bear the name of its verb: ``package.verb`` is the
        verb, whichever was imported first.
    """
    stub = Path(file).with_name("__init__.pyi").read_text(encoding="utf-8")
    modules = {name: module for module, name in _LINE.findall(stub)}
    names = sorted(modules)

    class Package(ModuleType):
        def __setattr__(self, name: str, value: object) -> None:
            # Importing a submodule binds it in its package, where it would hide the verb of the same name.
            if not (name in modules and isinstance(value, ModuleType)):
                super().__setattr__(name, value)

    sys.modules[package].__class__ = Package

    def load(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return getattr(importlib.import_module(modules[name]), name)

    return load, lambda: names, names
