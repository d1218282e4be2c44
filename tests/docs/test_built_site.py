"""The site as it was built: links lead somewhere, pictures have words, pages can be used by everyone.

``sphinx-build -W -n docs docs/_build/html`` builds it; these tests are left out where nobody did.
"""

import os
import urllib.parse
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

import pytest

from tests.docs.conftest import DOCS

MAIN = ["index", "learn/index", "howto/index", "choose", "theory/pan", "api/index", "api/toongeo.make_avatar"]
MAIN += ["gallery/index", "benchmarks", "comparison", "licences", "accessibility", "project/changelog"]
# The page of the head has tests of its own (tests/web); in a frame axe would only look at it again.
AXE = "{exclude: ['iframe']}"
_CHOSEN = "['mode', 'theme'].forEach((key) => localStorage.setItem(key, '{}'))"


@pytest.fixture(scope="module")
def site():
    folder = Path(os.environ.get("TOONGEO_SITE", DOCS / "_build" / "html"))
    if not (folder / "index.html").is_file():
        pytest.skip("build the site first: sphinx-build -W -n docs docs/_build/html")
    return folder


class _Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.anchors, self.unnamed, self.headings = [], set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        self.links += [given[key] for key in ("href", "src", "poster") if given.get(key)]
        if (tag == "img" and not given.get("alt")) or (tag == "iframe" and not given.get("title")):
            self.unnamed.append(given.get("src"))
        if tag == "h1":
            self.headings.append(tag)


@cache
def _page(path):
    return _Page(path)


def _pages(site):
    # Static pages are not Sphinx's.
    return [path for path in site.rglob("*.html") if "_static" not in path.parts]


def test_no_dead_internal_link(site):
    dead = []
    for path in _pages(site):
        for link in _page(path).links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc or link == "#":
                continue
            there = path
            if parts.path:
                there = (path.parent / urllib.parse.unquote(parts.path)).resolve()
            missing = not there.is_file()
            if not missing and parts.fragment and there.suffix == ".html" and "_static" not in there.parts:
                missing = urllib.parse.unquote(parts.fragment) not in _page(there).anchors
            if missing:
                dead.append(f"{path.relative_to(site)}: {link}")
    assert sorted(set(dead)) == []


def test_pictures_have_words_and_pages_a_heading(site):
    pages = [path for path in _pages(site) if path.name not in ("genindex.html", "search.html")]
    assert {str(path.relative_to(site)): _page(path).unnamed for path in pages if _page(path).unnamed} == {}
    assert [str(path.relative_to(site)) for path in pages if len(_page(path).headings) != 1] == []


@pytest.mark.slow
@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_main_pages_are_accessible(site, browse, serve, theme, width):
    """axe finds nothing, and nothing is wider than the screen."""
    pages = [name for name in MAIN if (site / f"{name}.html").is_file()]
    steps = [{"size": [width, 844 if width < 500 else 800]}, {"run": _CHOSEN.format(theme)}]
    for name in pages:
        steps += [{"open": f"{name}.html"}, {"axe": AXE}]
        steps += [{"run": "document.documentElement.scrollWidth - innerWidth"}]
        steps += [{"run": "document.documentElement.dataset.theme"}, {"page": f"{name.replace('/', '_')}.png"}]
    with serve(site) as home:
        told, _ = browse(f"{home}/index.html", steps)
    results = told["results"][1:]
    for name, violations, over, shown in zip(pages, *(results[k::3] for k in range(3)), strict=True):
        assert violations == [], f"{name}, {theme}, {width} px"
        assert over <= 0, f"{name} is {over} px wider than {width} px"
        assert shown == theme
