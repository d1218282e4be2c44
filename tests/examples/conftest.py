"""What tests of the lessons share: the numbers that a lesson ends with, and the lessons themselves."""

import json
import os
import subprocess
import sys

import pytest

from tests.conftest import ROOT

EXAMPLES = ROOT / "examples"
# Shows what a person sees who runs the script by hand, and then its numbers on a line of their own.
_RUN = """
import json, runpy, sys
numbers = runpy.run_path(sys.argv[1], run_name="__main__")["numbers"]
print("\\n" + json.dumps({name: float(value) for name, value in numbers.items()}))
"""


@pytest.fixture(scope="session")
def numbers_of(once, tmp_path_factory):
    """``numbers_of("05_fitting")`` -> the dict `numbers` of that lesson, run as a plain script, once in a run of tests.

    The script runs in a process of its own, in an empty folder, without a display. Warnings are errors. Tests that use
    this are slow: ``pytestmark = pytest.mark.slow``.
    """
    pytest.importorskip("matplotlib")

    def run(stem):
        # Where a display is missing, plt.show() says so on some systems.
        command = [sys.executable, "-W", "error", "-W", "ignore:FigureCanvasAgg is non-interactive:UserWarning"]
        environment = os.environ | {"MPLBACKEND": "Agg", "PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "utf-8"}
        done = subprocess.run(
            [*command, "-c", _RUN, str(EXAMPLES / f"{stem}.py")],
            cwd=tmp_path_factory.mktemp("elsewhere"),
            env=environment,
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, done.stderr[-4000:]
        return json.loads(done.stdout.splitlines()[-1])

    return lambda stem: once(f"lesson-{stem}", lambda: run(stem))
