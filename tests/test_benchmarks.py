"""The benchmarks are no part of the package: here they are only kept from falling behind it."""

import ast
import importlib
import sys

import pytest

from tests.conftest import ROOT

SCRIPTS = sorted((ROOT / "benchmarks").glob("*.py"))
ONLY_TIMES = ("kernels",)  # no figure of theirs depends on what a picture shows
OVER_PICTURES = [
    path
    for path in SCRIPTS
    if "from pictures import" in path.read_text(encoding="utf-8") and path.stem not in ONLY_TIMES
]


@pytest.fixture(scope="module")
def gate():
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        yield importlib.import_module("pictures")
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_what_a_script_imports_is_there(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module.split(".")[0] == "toongeo":
            module = importlib.import_module(node.module)
            for alias in node.names:
                if not hasattr(module, alias.name):  # a module rather than a name of it, or nothing
                    importlib.import_module(f"{node.module}.{alias.name}")


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_what_a_script_takes_from_another_is_there(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        beside = isinstance(node, ast.ImportFrom) and path.with_name(f"{node.module}.py")
        if beside and beside.exists():
            assert {alias.name for alias in node.names} <= defined(beside)


def defined(path):
    """Names of functions, classes and values at the top of a script."""
    names = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Assign):
            names |= {name.id for target in node.targets for name in ast.walk(target) if isinstance(name, ast.Name)}
    return names


def test_no_script_looks_for_the_examples_by_itself():
    own = [path.name for path in SCRIPTS if '/ "examples"' in path.read_text(encoding="utf-8")]
    assert own == ["pictures.py"]


@pytest.mark.parametrize("path", OVER_PICTURES, ids=lambda path: path.stem)
def test_each_script_over_pictures_says_which_ones_constants_were_chosen_on(path, gate):
    assert path.stem in gate.CHOSEN_ON
    assert f'roles("{path.stem}", ' in path.read_text(encoding="utf-8")


def test_the_halves_are_disjoint_and_have_all_kinds(gate):
    every = {*gate.EXAMPLES, *gate.CARICATURES, *gate.PORTRAITS}
    assert {*gate.CHOOSING} | {*gate.JUDGING} == every
    assert not {*gate.CHOOSING} & {*gate.JUDGING}
    for kind in (gate.EXAMPLES, gate.CARICATURES, gate.PORTRAITS):
        assert {*kind} & {*gate.CHOOSING} and {*kind} & {*gate.JUDGING}
    assert all({*names} <= every for names in gate.CHOSEN_ON.values())


def test_the_examples_are_those_of_the_project(gate):
    found = gate.pictures()
    assert [picture.name for picture in found] == list(gate.EXAMPLES)
    assert all(picture.image.exists() and picture.landmarks.suffix == ".pts" for picture in found)


def test_a_picture_that_nobody_knows_is_only_looked_at(gate, tmp_path):
    for name in ("new.txt", "new.png", "takeo.pts", "takeo.jpg", "LICENSE.txt", "none.png"):
        (tmp_path / name).touch()
    new, takeo = gate.pictures([tmp_path])
    assert (new.name, new.image) == ("new", tmp_path / "new.png")
    assert takeo.landmarks == tmp_path / "takeo.pts"
    said = gate.roles("landmarks", [new.name, takeo.name])
    assert said == "\nConstants were chosen on: takeo. Only looked at: new."


def test_every_section_of_the_results_over_pictures_says_so():
    text = (ROOT / "benchmarks" / "RESULTS.md").read_text(encoding="utf-8")
    scripts = [f"benchmarks/{path.name}" for path in OVER_PICTURES]
    for section in text.split("\n## ")[1:]:
        if "toongeo bench" in section or any(script in section for script in scripts):
            assert "Chosen on: " in section and "Only looked at: " in section, section.split("\n")[0]
