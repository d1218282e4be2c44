"""The file of results."""

import shutil
from pathlib import Path

from toongeo.app.bench.results.bench_all import assemble

FOLDER = Path(__file__).parents[2] / "benchmarks"


def test_the_file_of_results_is_made_of_its_texts_and_records(tmp_path):
    """If it was edited itself: python benchmarks/split_results.py."""
    for name in ("sections", "records"):
        shutil.copytree(FOLDER / name, tmp_path / name)
    assemble(tmp_path)
    assert (tmp_path / "RESULTS.md").read_text("utf-8") == (FOLDER / "RESULTS.md").read_text("utf-8")
