"""The written pages name what exists, and their pictures are there and small enough."""

import importlib
import re
from functools import reduce

import pytest
from PIL import Image

import toongeo
from tests.conftest import ROOT

DOCS = ROOT / "docs"
PAGES = [page for folder in ("howto", "theory", "gallery") for page in sorted((DOCS / folder).glob("*.md"))]
PAGES += [DOCS / f"{name}.md" for name in ("choose", "comparison", "accessibility")]
WORD = re.compile(r"`((?:tg\.|toongeo\.)?[A-Za-z_][\w.]*)(?:\([^`]*\))?`")
# Words of code that are no public names: options, fields, names of expressions, files and parts of others.
ELSEWHERE = re.compile(
    r"^[a-z]+$|=|^(jaw|mouth|eye|brow|viseme)[A-Z_]|\.(py|md|csv|glb|vrm|html|obj|npz|json|jsonl|webp)$"
)


def found(name):
    """What a name with dots stands for; None if there is nothing of that name."""
    parts = name.split(".")
    for cut in range(len(parts), 0, -1):
        try:
            module = importlib.import_module(".".join(parts[:cut]))
        except ImportError:
            continue
        return reduce(lambda part, step: getattr(part, step, None), parts[cut:], module)
    return None


@pytest.mark.parametrize("page", [*PAGES, ROOT / "README.md"], ids=lambda page: page.stem)
def test_names_with_a_prefix_exist(page):
    for name in WORD.findall(page.read_text(encoding="utf-8")):
        if name.startswith(("tg.", "toongeo.")):
            assert found(re.sub(r"^tg\.", "toongeo.", name)) is not None, name


@pytest.mark.parametrize("page", [p for p in PAGES if p.parent.name == "theory"], ids=lambda page: page.stem)
def test_functions_beside_equations_exist(page):
    """On pages of theory every snake_case or CamelCase word is public, or a member of a public name."""
    text = page.read_text(encoding="utf-8")
    public = [getattr(toongeo, name) for name in toongeo.__all__]
    for name in WORD.findall(text):
        first, _, rest = name.partition(".")
        if ELSEWHERE.search(name) or not re.search(r"_|[a-z][A-Z]", first):
            continue
        if hasattr(toongeo, first):
            assert not rest or hasattr(getattr(toongeo, first), rest) or rest in dataclass_fields(first), name
        else:
            assert any(hasattr(part, first) for part in public), name


def dataclass_fields(name):
    return getattr(getattr(toongeo, name), "__dataclass_fields__", {})


def test_the_moving_heads_move_and_are_small():
    path = DOCS / "figures" / "moving_heads.webp"
    with Image.open(path) as picture:
        assert picture.n_frames > 20 and picture.width <= 1000
    assert path.stat().st_size <= 3_000_000


def test_every_figure_of_the_gallery_is_there():
    page = DOCS / "gallery" / "index.md"
    for target in re.findall(r"\]\((\.\./figures/[^)]+)\)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).stat().st_size > 10_000, target
