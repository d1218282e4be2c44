"""What the build of the site does to links, titles and tables."""

import sys

import pytest

from tests.docs.conftest import DOCS


@pytest.fixture(autouse=True)
def extensions(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(DOCS / "_ext"), *sys.path])


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("[a](../benchmarks/RESULTS.md)", "[a](project/results.md)"),
        ("[a](../benchmarks/RESULTS.md#rig)", "[a](project/results.md#rig)"),
        ("[a](../README.md)", "[a](index.md)"),
        ("[a](../examples)", "[a](learn/index.md)"),
        ("[a](../examples/01_face_in_ten_lines.ipynb)", "[a](learn/01_face_in_ten_lines.ipynb)"),
        ("[a](models.md) and [b](#there)", "[a](models.md) and [b](#there)"),
        ("[![words](figures/hair.jpg)](../CHANGELOG.md)", "[![words](figures/hair.jpg)](project/changelog.md)"),
        ("[gone](nowhere/at_all.py)", "[gone](nowhere/at_all.py)"),
        ("[gone](../nowhere/at_all.py)", "gone"),
        ("[a](https://example.org/x) and [b](mailto:a@example.org)", None),
    ],
)
def test_links_of_the_repository_are_links_of_the_site(text, shown):
    from repository_links import repository_links

    assert repository_links(text, "docs/page.md", "docs/page.md") == (text if shown is None else shown)


def test_links_of_a_page_that_moves():
    from repository_links import repository_links

    moved = repository_links("[a](../docs/models.md) [b](LICENSE.md)", "data_templates/README.md", "docs/project/x.md")
    assert moved == "[a](../models.md) [b](licences.md)"


def test_a_page_has_one_title():
    from gathered_pages import _one_title

    assert _one_title("# A\n```sh\n# no title\n```\n# B\n## C") == "# A\n```sh\n# no title\n```\n## B\n## C"


def test_charts_show_the_numbers_of_the_results():
    """Every chart finds its table, and nothing but numbers of it."""
    from result_plots import CHARTS, drawn_charts

    charts = drawn_charts()
    assert [chart.name for chart, _, _ in charts] == [chart.name for chart in CHARTS]
    results = (DOCS.parent / "benchmarks" / "RESULTS.md").read_text(encoding="utf-8")
    for chart, labels, values in charts:
        assert all(label in results.replace("`", "") for label in labels)
        assert all(len(row) == len(chart.values) for row in values)
        assert len(set(chart.without) & set(labels)) == 0


def test_the_plot_of_ratios_tells_all_runs_of_the_history(tmp_path):
    from ratio_plot import draw_ratios, ratio_runs, told_ratios

    path = tmp_path / "history.csv"
    rows = [f'2026-01-0{day},c{day},"{case}",{day + k}' for day in (1, 2) for k, case in enumerate(("a, b", "c"))]
    path.write_text("\n".join(["date,commit,case,ratio", *rows]), encoding="utf-8")
    runs, cases = ratio_runs(path)
    assert runs == ["2026-01-01 c1", "2026-01-02 c2"]
    assert cases == {"a, b": [1.0, 2.0], "c": [2.0, 3.0]}
    assert told_ratios(runs, cases).endswith("2026-01-02 c2: a, b 1, 2; c 2, 3.")
    pytest.importorskip("matplotlib")
    draw_ratios(tmp_path / "plot.svg", runs, cases, "#000000", "#0a7d91")
    assert (tmp_path / "plot.svg").read_text(encoding="utf-8").count("<!-- c1 -->") == 2  # an axis for each case


@pytest.mark.parametrize(
    ("latex", "within"),
    [
        (r"a &= b \\ &\quad c", "<mtable"),
        (r"\begin{aligned} a &= b \end{aligned}", "<mtable"),
        (r"\begin{gathered} a \\ b \end{gathered}", 'displaystyle="true"'),
        (r"\arg\min_x f", "arg"),
        (r"\mathcal L(x)", "<mi>\N{SCRIPT CAPITAL L}</mi>"),
        (r"\begin{pmatrix}1&0\\0&1\end{pmatrix}", "<mtd>"),
    ],
)
def test_equations_are_mathml(latex, within):
    pytest.importorskip("latex2mathml")
    pytest.importorskip("sphinx")
    from docutils.nodes import math_block
    from mathml import _mathml

    found = _mathml(latex, math_block(), "block")
    assert found.startswith("<math") and within in found
    assert "\\" not in found and ">&<" not in found
