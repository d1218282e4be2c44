"""Each lesson's notebook is its script with outputs: complete, fresh, small, and free of traces of a machine."""

import ast
import base64
import io
import re

import pytest
from PIL import Image

from tests.conftest import ROOT

pytest.importorskip("jupytext")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("nbclient")

from execute_lessons import PRIVATE, caption_of, code_digest, paired, shows  # noqa: E402

# From the last: the tests beside this file begin with the first, and two processes shall not wait for the same lesson.
SCRIPTS = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"), reverse=True)
# A page of a code host shows a notebook of this size; larger ones make the repository heavy.
MOST_BYTES = 600_000

pytestmark = pytest.mark.parametrize("script", SCRIPTS, ids=[script.stem for script in SCRIPTS])


def _notebook(script):
    return nbformat.read(script.with_suffix(".ipynb"), as_version=4)


def _code(notebook):
    return [(i, cell) for i, cell in enumerate(notebook.cells) if cell.cell_type == "code"]


def _pictures(cell):
    return [output for output in cell.outputs if "image/png" in output.get("data", {})]


def test_the_notebook_is_the_script_cell_for_cell(script):
    kept, source = _notebook(script), paired(script)
    assert [(c.id, c.cell_type, c.source) for c in kept.cells] == [(c.id, c.cell_type, c.source) for c in source.cells]
    assert kept.metadata == source.metadata


def test_outputs_are_those_of_this_code_run_once_from_the_top(script):
    notebook = _notebook(script)
    assert notebook.metadata.toongeo.executed == code_digest(notebook)
    assert [cell.execution_count for _, cell in _code(notebook)] == list(range(1, len(_code(notebook)) + 1))


def test_what_shows_something_has_an_output_and_nothing_failed(script):
    for _, cell in _code(_notebook(script)):
        kinds = {output.output_type for output in cell.outputs}
        assert "error" not in kinds
        assert not any(output.output_type == "stream" and output.name == "stderr" for output in cell.outputs)
        wanted = shows(cell.source)
        assert "text" not in wanted or "stream" in kinds, cell.source
        assert "picture" not in wanted or _pictures(cell), cell.source


@pytest.mark.slow
def test_executed_from_clean_it_shows_what_is_kept(script, checked_lesson):
    assert checked_lesson(script.stem)[0] == []


def test_each_figure_has_an_alternative_text(script):
    notebook = _notebook(script)
    for i, cell in _code(notebook):
        for output in _pictures(cell):
            caption = caption_of(notebook, i)
            assert caption is not None, f"no paragraph '*Figure: ...*' beside:\n{cell.source}"
            assert output.metadata["image/png"]["alt"] == caption


def test_it_is_small_and_says_nothing_of_the_machine(script):
    text = script.with_suffix(".ipynb").read_text(encoding="utf-8")
    assert len(text.encode()) <= MOST_BYTES
    without_pictures = re.sub(r'"image/\w+": ".*?"', "", text)
    assert not PRIVATE.search(without_pictures)
    for _, cell in _code(_notebook(script)):
        assert "execution" not in cell.metadata
        for output in _pictures(cell):
            width, height = Image.open(io.BytesIO(base64.b64decode(output.data["image/png"]))).size
            assert max(width, height) <= 1600


def test_it_ends_with_numbers_that_a_test_asserts(script):
    code = [cell.source for _, cell in _code(_notebook(script))]
    assert any(
        isinstance(node, ast.AnnAssign | ast.Assign) and "numbers" in ast.unparse(node).split("=")[0]
        for node in ast.parse(code[-1]).body
    )
    test = ROOT / "tests" / "examples" / f"test_{script.stem}.py"
    assert f'numbers_of("{script.stem}")' in test.read_text(encoding="utf-8")


def test_it_asks_first_and_ends_with_exercises(script):
    words = [cell.source for cell in _notebook(script).cells if cell.cell_type == "markdown"]
    assert words[0].startswith("# ") and "?" in words[0]
    assert any(re.search(r"^#+ Exercises", source, re.MULTILINE) for source in words)
    assert any(re.search(r"^#+ Solutions", source, re.MULTILINE) for source in words)
