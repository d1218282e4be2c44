"""What the how-to pages and the README print runs: their Python, page by page, and the arguments of their commands."""

import ast
import re
import shlex
from types import ModuleType

import pytest

from tests.conftest import PORTRAITS, ROOT
from toongeo.app.cli import _parser

PAGES = sorted((ROOT / "docs" / "howto").glob("*.md"))
READ = [*PAGES, ROOT / "README.md"]
BLOCK = re.compile(r"^(?:<!-- (?P<note>.*?) -->\n)?```(?P<kind>\w+)\n(?P<code>.*?)^```$", re.MULTILINE | re.DOTALL)
SLOW = {"README", "own_mesh", "stylize", "batch", "edit", "own_model", "video"}  # more than five seconds
NEEDS_NAMES = ("needs", "runs inside")  # what a note may say of a block that is shown only


def blocks(page, kind):
    """(note, code) of the fenced blocks of a kind."""
    return [(m["note"], m["code"]) for m in BLOCK.finditer(page.read_text(encoding="utf-8")) if m["kind"] == kind]


def runnable(page):
    return [code for note, code in blocks(page, "python") if note is None]


def placed(page, code):
    """Code with its lines where the page has them, for tracebacks."""
    before = page.read_text(encoding="utf-8").partition(code)[0]
    return "\n" * before.count("\n") + code


@pytest.fixture
def desk(avatar, tmp_path, monkeypatch):
    """A folder with the files that the pages name."""
    for name, source in (("face", "moustache_man"), ("photo", "astronaut")):
        for suffix in (".png", ".pts"):
            (tmp_path / f"{name}{suffix}").write_bytes((PORTRAITS / f"{source}{suffix}").read_bytes())
    (tmp_path / "pictures").mkdir()
    for suffix in (".png", ".pts"):
        (tmp_path / "pictures" / f"one{suffix}").write_bytes((PORTRAITS / f"moustache_man{suffix}").read_bytes())
    avatar.save(tmp_path / "face.glb")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def params():
    """Pages with Python that runs; slow ones are marked."""
    pages = [page for page in READ if runnable(page)]
    return [pytest.param(p, id=p.stem, marks=[pytest.mark.slow] if p.stem in SLOW else []) for p in pages]


@pytest.mark.parametrize("page", params())
def test_the_python_of_a_page_runs(page, desk):
    names = ModuleType(page.stem).__dict__
    for code in runnable(page):
        exec(compile(placed(page, code), str(page), "exec"), names)


@pytest.mark.parametrize("page", READ, ids=lambda page: page.stem)
def test_what_is_shown_only_is_python_and_says_why(page):
    for note, code in blocks(page, "python"):
        ast.parse(code)
        assert note is None or (note.startswith("shown only: ") and any(word in note for word in NEEDS_NAMES)), note


@pytest.mark.parametrize("page", READ, ids=lambda page: page.stem)
def test_commands_know_their_arguments(page):
    for _, code in blocks(page, "sh"):
        for line in code.splitlines():
            for words in commands(line):
                _parser().parse_args(words)


def commands(line):
    """The arguments of each call of toongeo in a line of a shell."""
    words = shlex.split(line, comments=True)
    cuts = [-1, *(k for k, word in enumerate(words) if word == "&&"), len(words)]
    calls = [words[a + 1 : b] for a, b in zip(cuts[:-1], cuts[1:], strict=True)]
    return [call[1:] for call in calls if call[:1] == ["toongeo"]]


def test_commands_are_found():
    assert commands("pip install . && toongeo make 'a b.png' -o c.glb  # a face") == [
        ["make", "a b.png", "-o", "c.glb"]
    ]
    with pytest.raises(SystemExit):
        _parser().parse_args(commands("toongeo make face.png --nonsense -o c.glb")[0])


@pytest.mark.parametrize("page", READ, ids=lambda page: page.stem)
def test_links_lead_to_files(page):
    for target in re.findall(r"\]\((?!https?://)([^)#]+)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*/*.md")) + READ[-1:], ids=lambda page: page.stem)
def test_pictures_have_alternative_texts(page):
    for text, target in re.findall(r"!\[(.*?)\]\(([^)]+)\)", page.read_text(encoding="utf-8")):
        assert len(text) > 20, target


def test_captions_of_the_gallery_are_the_alternative_texts():
    page = (ROOT / "docs" / "gallery" / "index.md").read_text(encoding="utf-8")
    for text, target in re.findall(r"!\[(.*?)\]\(([^)]+)\)", page):
        beneath = " ".join(page.split(f"({target})\n\n", 1)[1].split())
        assert beneath.startswith(f"{text}."), target
