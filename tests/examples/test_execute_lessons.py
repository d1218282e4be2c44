"""What makes notebooks of scripts, on a small lesson of its own."""

import json

import pytest

pytest.importorskip("jupytext")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("nbclient")

from execute_lessons import PRIVATE, caption_of, code_digest, executed, paired, same_text, shows  # noqa: E402

LESSON = """# %% [markdown]
# # Why?

# %%
print("one")
print(f"{1 / 3:.3f}")

# %%
import matplotlib.pyplot as plt

plt.plot([0, 1])
plt.show()

# %% [markdown]
# *Figure: A line that
# goes up.*
#
# More.

# %%
print("one")
"""


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "01_small.py"
    path.write_text(LESSON)
    return path


def test_cells_and_ids_follow_from_the_text_alone(script):
    notebook = paired(script)
    assert [cell.cell_type for cell in notebook.cells] == ["markdown", "code", "code", "markdown", "code"]
    assert len({cell.id for cell in notebook.cells}) == 5
    script.write_text(LESSON.replace("# # Why?", "# # How?"))
    assert [cell.id for cell in paired(script).cells][1:] == [cell.id for cell in notebook.cells][1:]
    assert code_digest(paired(script)) == code_digest(notebook)
    script.write_text(LESSON.replace("1 / 3", "2 / 3"))
    assert code_digest(paired(script)) != code_digest(notebook)


@pytest.mark.slow
def test_executing_twice_gives_the_same_bytes_with_captions(script):
    import nbformat

    script.write_text(LESSON + "numbers = {'one': 1}\n")
    notebook, numbers = executed(script)
    first, second = nbformat.writes(notebook), nbformat.writes(executed(script)[0])
    assert first == second and numbers == {"one": 1.0}
    cells = notebook.cells
    assert len(cells) == 5
    assert cells[1].outputs[0].text == "one\n0.333\n"
    assert cells[2].outputs[0].metadata["image/png"]["alt"] == "A line that goes up."
    assert "iopub" not in first and 'execution"' not in first


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("import warnings; warnings.warn('odd')", "wrote to stderr"),
        ("print('/home/someone/file')", "path or an address"),
        ("print(object())", "path or an address"),
        ("1 / 0", "ZeroDivisionError"),
    ],
)
def test_what_no_reader_should_see_is_refused(script, code, message):
    script.write_text(f"# %%\n{code}\n")
    with pytest.raises(Exception, match=message):
        executed(script)


def test_captions_stand_after_a_cell_or_before_it(script):
    notebook = paired(script)
    assert caption_of(notebook, 2) == caption_of(notebook, 4) == "A line that goes up."
    assert caption_of(notebook, 1) is None


def test_what_a_cell_must_show():
    assert shows("x = 1\nprint(x)") == {"text"}
    assert shows("fig, axis = plt.subplots()\nplt.show()") == {"picture"}
    assert shows("def f():\n    print(1)") == set()


def test_numbers_may_differ_in_their_last_digits_and_words_not():
    assert same_text("off by 1.62 %", "off by 1.63 %")
    assert same_text("1e-16", "1.01e-16")
    assert not same_text("off by 1.62 %", "off by 1.72 %")
    assert not same_text("off by 1.62 %", "on by 1.62 %")
    assert not same_text("1 2", "1 2 3")


def test_paths_and_addresses_are_seen_and_fractions_are_not():
    assert PRIVATE.search("in /home/me/x") and PRIVATE.search("<object at 0x7f3a2b1c>")
    assert not PRIVATE.search("RMS / usr, a/b, examples/portraits, https://host.org/home/page")


@pytest.mark.parametrize("text", ["C:\\Users\\me", "at D:\\new\\x", "E:\\table.txt"])
def test_a_windows_path_is_seen_as_text_and_in_json(text):
    assert PRIVATE.search(text) and PRIVATE.search(json.dumps(text)) and PRIVATE.search(repr(text))


def test_a_line_of_code_that_ends_in_a_capital_and_a_colon_is_no_drive():
    cell = nbformat.v4.new_code_cell("class C:\n    pass\nwith A as B:\n\tpass\nprint('C:\\n')")
    assert not PRIVATE.search(nbformat.writes(nbformat.v4.new_notebook(cells=[cell])))
    assert not PRIVATE.search(cell.source)
