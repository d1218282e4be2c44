"""The docstring of every public name says what goes in, what comes out, and shows it by an example that runs."""

import ast
import builtins
import dataclasses
import doctest
import inspect
import re
from functools import cache

import pytest

import toongeo
from tests.docs.conftest import documented

NAMES = sorted(documented())
# A heading and its line; numpydoc's sections.
_SECTION = re.compile(r"^(\w[\w ]*)\n-+$", re.MULTILINE)
_ASSUMED = {"np", "tg", "img", "landmarks"}  # import numpy as np, import toongeo as tg, a picture and its points


def _sections(doc):
    parts = _SECTION.split(doc)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def _listed(section):
    """Names that a section of parameters or attributes describes, in its order."""
    heads = [line.split(" : ")[0] for line in section.splitlines() if line and not line.startswith(" ")]
    return [name.strip().lstrip("*") for head in heads for name in head.split(",")]


@cache
def _shown(module):
    return {test.name for test in doctest.DocTestFinder().find(module) if test.examples}


def _source(name):
    doc = inspect.getdoc(documented()[name]) or ""
    return "".join(example.source for example in doctest.DocTestParser().get_examples(doc))


def test_every_public_name_has_a_page():
    pages = {name.removeprefix("toongeo.") for name in NAMES}
    assert set(toongeo.__all__) <= pages


@pytest.mark.parametrize("name", NAMES)
def test_sections(name):
    """Parameters are those of the signature, attributes those of the dataclass; a result has its section."""
    thing = documented()[name]
    sections = _sections(inspect.getdoc(thing) or "")
    assert "Examples" in sections
    if not inspect.isclass(thing):
        signature = inspect.signature(thing)
        assert _listed(sections.get("Parameters", "")) == list(signature.parameters)
        assert "Returns" in sections or signature.return_annotation in (None, "None")
    elif dataclasses.is_dataclass(thing):
        fields = {field.name for field in dataclasses.fields(thing) if not field.name.startswith("_")}
        told = set(_listed(sections.get("Attributes", "") + sections.get("Parameters", "")))
        assert fields <= told <= fields | set(dir(thing))


@pytest.mark.parametrize("name", NAMES)
def test_examples_can_be_pasted(name):
    """An example brings what it uses, but for ``np``, ``tg``, a picture and public names."""
    tree = ast.parse(_source(name))
    nodes = list(ast.walk(tree))
    bound = {node.id for node in nodes if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)}
    bound |= {node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    bound |= {node.arg for node in nodes if isinstance(node, ast.arg)}
    imports = [alias for node in nodes if isinstance(node, ast.Import | ast.ImportFrom) for alias in node.names]
    bound |= {alias.asname or alias.name.split(".")[0] for alias in imports}
    used = {node.id for node in nodes if isinstance(node, ast.Name)}
    assert tree.body, "an example without a statement"
    assert used <= bound | _ASSUMED | set(dir(builtins)) | set(toongeo.__all__) | {name.rpartition(".")[2]}


@pytest.mark.parametrize("name", NAMES)
def test_examples_are_found(name):
    """The run of all doctests finds each in its module: no decorator hides it."""
    thing = inspect.unwrap(documented()[name])
    assert f"{thing.__module__}.{thing.__name__}" in _shown(inspect.getmodule(thing))
