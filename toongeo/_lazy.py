"""Lazy public names, so that ``import toongeo`` does not import scipy, OpenCV or libigl."""

import importlib
import sys
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any


def attach(package: str, modules: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Module-level ``__getattr__``, ``__dir__`` and ``__all__`` that import a name when it is first used (PEP 562).

    Parameters
    ----------
    package
        ``__name__`` of the package.
    modules
        Public name -> module, relative to the package, that defines it. A module may bear the name of its verb:
        ``package.verb`` is the verb, whichever was imported first.
    """
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
        return getattr(importlib.import_module(f"{package}.{modules[name]}"), name)

    return load, lambda: names, names
