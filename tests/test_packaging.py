"""The library as users have it: imported, in a wheel, installed in place."""

import json
import re
import subprocess
import sys
import zipfile

import pytest

import toongeo
from tests.conftest import ROOT

PROBE = "from toongeo.model import data_path; print(data_path('data_templates/head.npz')); print(data_path('{}'))"
PORTRAIT = "examples/portraits/moustache_man.png"


def run(*command, **options):
    done = subprocess.run(
        [str(c) for c in command], capture_output=True, text=True, check=False, timeout=300, **options
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_importing_the_library_imports_no_heavy_package():
    heavy = ["numpy", "scipy", "cv2", "igl", "skimage", "nlopt", "trimesh"]
    code = f"import sys, toongeo; print([name for name in {heavy} if name in sys.modules])"
    assert run(sys.executable, "-c", code, cwd=ROOT).strip() == "[]"


def test_every_public_name_exists_and_is_documented():
    for name in toongeo.__all__:
        verb = getattr(toongeo, name)
        assert callable(verb) and len(verb.__doc__) > 60, name


def test_a_verb_wins_over_the_module_of_its_name():
    code = "import toongeo.geometry.laplacian_align, toongeo.avatar.avatar, toongeo as t; "
    code += "print(callable(t.geometry.laplacian_align), t.Avatar.__name__)"
    assert run(sys.executable, "-c", code, cwd=ROOT).split() == ["True", "Avatar"]


def test_the_bill_of_materials_is_what_the_requirements_say():
    assert run(sys.executable, ROOT / "benchmarks" / "sbom.py", "--check") == ""
    content = json.loads((ROOT / "docs" / "sbom.cdx.json").read_text())
    licences = {part["name"]: json.dumps(part["licenses"]) for part in content["components"]}
    assert {"numpy", "scipy", "libigl", "joblib", "three.js"} < set(licences)
    # GPL is for tests alone: nothing that ships needs it. (nlopt's LGPL parts are linked, in its own wheel.)
    assert not [name for name, licence in licences.items() if re.search(r"(?<!L)GPL|NOASSERTION", licence)]
    assert "pymeshlab" not in licences


@pytest.fixture(scope="module")
def pip():
    pytest.importorskip("pip", reason="needs pip to build the wheel")
    return [sys.executable, "-m", "pip", "--disable-pip-version-check", "-q"]


def test_a_wheel_carries_its_data(pip, tmp_path):
    run(*pip, "wheel", "--no-deps", "-w", tmp_path, ROOT)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
        names = archive.namelist()
    assert {"toongeo/io/landmark_layout.csv", "toongeo/io/humanoid_bones.csv"} < set(names)
    tables = [path.name for kind in ("csv", "npz", "md") for path in (ROOT / "data_templates").glob(f"*.{kind}")]
    assert {f"toongeo/data_templates/{name}" for name in tables} <= set(names)
    pages = ("viewer.js", "page.html", "page.css", "editor.js", "editor.html", "editor.css")
    assert {f"toongeo/io/page/{name}" for name in pages} < set(names)
    assert {f"toongeo/app/editor/{name}" for name in ("clicks.csv", "contours.csv")} < set(names)
    assert "toongeo/sbom.cdx.json" in names
    assert not [name for name in names if "node_modules" in name]
    assert not [name for name in names if "/build/" in name or name.startswith("tests")]
    found = run(
        sys.executable,
        "-P",
        "-c",
        PROBE.format(PORTRAIT),
        cwd=tmp_path,
        env={"PYTHONPATH": str(tmp_path / "site")},
    )
    assert all(line.startswith(str(tmp_path / "site")) for line in found.split())


def test_an_editable_install_finds_its_data(pip, tmp_path):
    run(*pip, "install", "--no-deps", "--target", tmp_path / "site", "-e", ROOT)
    # The new site folder goes first: the environment may hold an ordinary install of the library.
    code = f"""
import site, sys
before = list(sys.path)
site.addsitedir({str(tmp_path / "site")!r})
sys.path.sort(key=before.__contains__)
{PROBE.format(PORTRAIT)}"""
    found = run(sys.executable, "-P", "-c", code, cwd=tmp_path)
    assert all(line.startswith(str(ROOT)) for line in found.split())


def test_a_file_that_does_not_travel_is_named():
    from toongeo.model import data_path

    with pytest.raises(
        FileNotFoundError, match="name: 'data_templates/none.npz' is not among the installed data files"
    ):
        data_path("data_templates/none.npz")


def test_the_stub_names_what_the_package_has():
    stub = (ROOT / "toongeo" / "__init__.pyi").read_text()
    named = {line.split(" as ")[1] for line in stub.splitlines() if " as " in line}
    assert named == set(toongeo.__all__)
