"""The same bytes from every process, however many threads BLAS has."""

import hashlib
import os
import subprocess
import sys

import pytest

from tests.conftest import PORTRAITS, ROOT

CODE = """
import sys, toongeo
img, landmarks = toongeo.read_image(sys.argv[1] + ".png"), toongeo.read_landmarks(sys.argv[1] + ".pts")
toongeo.make_avatar(img, landmarks).save(sys.argv[2])
"""


@pytest.mark.slow
def test_processes_and_threads_make_no_difference(tmp_path):
    digests = set()
    for threads in ("1", "2"):
        path = tmp_path / f"{threads}.glb"
        environment = os.environ | {"OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads}
        command = [sys.executable, "-c", CODE, str(PORTRAITS / "beethoven"), str(path)]
        subprocess.run(command, check=True, cwd=ROOT, env=environment, timeout=300)
        digests.add(hashlib.sha256(path.read_bytes()).hexdigest())
    assert len(digests) == 1
