"""The faults that the mutation script makes."""

import ast
import importlib.util
import sys

import pytest

from tests.conftest import ROOT


@pytest.fixture(scope="module")
def mutants():
    spec = importlib.util.spec_from_file_location("mutants", ROOT / "benchmarks" / "mutants.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["mutants"] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    yield module.mutants
    del sys.modules["mutants"]


def changed(mutants, source):
    """The last line of a piece of code with each of its faults."""
    return [mutant.applied(source.encode()).decode().splitlines()[-1] for mutant in mutants(source.encode())]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("a < b", ["(a <= b)"]),
        ("a == b != c", ["(a != b != c)", "(a == b == c)"]),
        ("a is None", ["(a is not None)"]),
        ("a + b * c", ["(a - b * c)", "a + (b / c)"]),
        ("a and b", ["(a or b)"]),
        ("not a", ["(a)"]),
        ("-a", ["(a)"]),
        ("x = 3", ["x = 4"]),
        ("x = 1", ["x = 0"]),
        ("x = 0.5", ["x = 1.0"]),
        ("x = 0.0", ["x = 1.0"]),
        ("x = True", ["x = False"]),
        ("x = 'word'", []),
        ("np.max((a, b)).any()", ["pass", "np.max((a, b)).all()", "np.min((a, b)).any()"]),
        ("max(a, b)", ["pass", "min(a, b)"]),
        ("a[b] = c", ["pass"]),
        ("a += b", ["a -= b", "pass"]),
        ("ä = b < c", ["ä = (b <= c)"]),
        ("x = f'{a + b}'", []),
        ("raise ValueError(a + b)", []),
        ("import a.b", []),
        ("__all__ = ['a'] + b", []),
        ("x: int = a + b", ["x: int = (a - b)"]),
        ("if TYPE_CHECKING: a(1)", []),
        ("while a: b", ["while False: b"]),
    ],
)
def test_the_faults_of_a_line(mutants, line, expected):
    assert sorted(changed(mutants, f"# é\n{line}")) == sorted(expected)


def test_the_faults_of_a_function(mutants):
    source = '''@lru_cache(maxsize=2)
def f(self, a: int = None, *, b=None):
    """Gives 1 + 1."""
    if a:
        return b
    return a'''
    found = mutants(source.encode())
    assert [(m.line, m.kind, m.before, m.after) for m in found] == [
        (4, "branch", "a", "False"), (4, "branch", "a", "True"), (5, "return", "b", "a"),
    ]  # fmt: skip


def test_every_fault_of_the_library_is_python(mutants):
    for path in sorted((ROOT / "toongeo" / "geometry").rglob("*.py")):
        source = path.read_bytes()
        found = mutants(source)
        assert len({mutant.applied(source) for mutant in found}) == len(found)
        for mutant in found[::7]:
            ast.parse(mutant.applied(source))
