"""What tests of the lessons share: a lesson executed once, and the numbers that it ends with."""

import json
import os
import subprocess
import sys

import pytest

from tests.conftest import ROOT

EXAMPLES = ROOT / "examples"
sys.path.insert(0, str(ROOT / "docs"))  # execute_lessons, by a name that no installed package has
_RUN = """
import json, sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
from execute_lessons import checked
print(json.dumps(checked(Path(sys.argv[1]))))
"""


@pytest.fixture(scope="session")
def checked_lesson(once):
    """``checked_lesson("05_fitting")`` -> what that lesson shows that its notebook does not, and its `numbers`.

    A new kernel executes it, once in a run of tests. Tests that use this are slow: ``pytestmark = pytest.mark.slow``.
    """
    pytest.importorskip("matplotlib")
    pytest.importorskip("nbclient")
    pytest.importorskip("jupytext")

    def run(stem):
        done = subprocess.run(
            [sys.executable, "-c", _RUN, str(EXAMPLES / f"{stem}.py"), str(ROOT / "docs")],
            cwd=ROOT,
            env=os.environ | {"PYTHONIOENCODING": "utf-8"},
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, done.stderr[-4000:]
        return json.loads(done.stdout.splitlines()[-1])

    return lambda stem: once(f"lesson-{stem}", lambda: run(stem))


@pytest.fixture(scope="session")
def numbers_of(checked_lesson):
    """``numbers_of("05_fitting")`` -> the dict `numbers` of that lesson, as :func:`checked_lesson` executed it."""
    return lambda stem: checked_lesson(stem)[1]
