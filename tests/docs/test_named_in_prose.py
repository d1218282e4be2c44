"""Every public name is used in the prose or the lessons, beyond its own page of the API."""

import re
from functools import cache

import toongeo
from tests.conftest import ROOT
from tests.docs.conftest import DOCS

# Lists of everything do not count, nor do figures' scripts and pages that the build writes.
_NOT = {"api", "project", "learn", "_build", "figures"}


@cache
def _prose():
    pages = [path for path in DOCS.rglob("*.md") if not _NOT & set(path.relative_to(DOCS).parts[:-1])]
    return [ROOT / "README.md", *pages, *(ROOT / "examples").glob("*.py"), *(ROOT / "examples").glob("*.md")]


def test_every_public_name_is_used():
    text = "\n".join(path.read_text(encoding="utf-8") for path in _prose())
    words = set(re.findall(r"\w+", text))
    assert sorted(set(toongeo.__all__) - words) == []
