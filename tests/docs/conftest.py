"""What the pages of the API document."""

import importlib
import re
from functools import cache

from tests.conftest import ROOT

DOCS = ROOT / "docs"


@cache
def documented():
    """``{full name: object}`` of every page of the API, as ``docs/api/index.md`` lists them."""
    found, module = {}, None
    for line in (DOCS / "api" / "index.md").read_text(encoding="utf-8").splitlines():
        if match := re.fullmatch(r"\.\. currentmodule:: (\S+)", line):
            module = match[1]
        elif match := re.fullmatch(r"   (\w+)", line):
            name = f"{module}.{match[1]}"
            assert name not in found, f"{name} is listed twice"
            found[name] = getattr(importlib.import_module(module), match[1])
    return found
