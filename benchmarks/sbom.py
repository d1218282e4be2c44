"""Write docs/sbom.cdx.json: what the library is made of and needs, in CycloneDX 1.5.

    python benchmarks/sbom.py           # after a change of the dependencies
    python benchmarks/sbom.py --check   # exit code 1 if the file is not what pyproject.toml says

Requirements and extras are those of pyproject.toml, licences those that the installed packages state. The same
requirements give the same bytes.
"""

import argparse
import json
import re
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, metadata
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
SBOM = ROOT / "docs" / "sbom.cdx.json"
_SHIPPED = ("usd", "serve", "notebook", "video", "batch", "cluster")
# Of packages that need not be installed where this runs, and of those that state a whole text.
_LICENCES = {
    "anywidget": "MIT",
    "av": "BSD-3-Clause",
    "distributed": "BSD-3-Clause",
    "joblib": "BSD-3-Clause",
    "libigl": "MPL-2.0",
    "nlopt": "MIT AND LGPL-2.1-or-later",
    "numpy": "BSD-3-Clause",
    "opencv-contrib-python-headless": "Apache-2.0",
    "pillow": "MIT-CMU",
    "scikit-image": "BSD-3-Clause",
    "scipy": "BSD-3-Clause",
    "threadpoolctl": "BSD-3-Clause",
    "tqdm": "MPL-2.0 AND MIT",
    "trimesh": "MIT",
    "usd-core": "LicenseRef-TOST-1.0",
    "websockets": "BSD-3-Clause",
}
# What travels inside the wheel and is not Python.
_BUNDLED = (
    ("three.js", "MIT", "in the viewer's and the editor's page"),
    ("MakeHuman base mesh and targets", "CC0-1.0", "data_templates/head.npz"),
    ("ICT-FaceKit, statistics of", "MIT", "data_templates/prior.npz"),
)


def sbom() -> dict[str, Any]:
    """The document."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    components = [_component(need, "required") for need in project["dependencies"]]
    for extra in _SHIPPED:
        needs = project["optional-dependencies"][extra]
        components += [_component(need, "optional", extra) for need in needs if not need.startswith("toongeo")]
    components += [
        {"type": "data" if "." in place else "library", "name": name, "scope": "required", "description": place}
        | {"licenses": [{"license": {"name": licence}}]}
        for name, licence, place in _BUNDLED
    ]
    about = {"type": "library", "name": project["name"], "version": project["version"]}
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": about | {"licenses": [{"license": {"id": project["license"]}}]}},
        "components": sorted(components, key=lambda component: component["name"].lower()),
    }


def _component(need: str, scope: str, extra: str | None = None) -> dict[str, Any]:
    name, versions = re.fullmatch(r"([A-Za-z0-9_.-]+)(.*)", need).groups()
    found = {
        "type": "library",
        "name": name,
        "purl": f"pkg:pypi/{name}",
        "scope": scope,
        "licenses": [{"expression": _licence(name)}],
        "properties": [{"name": "toongeo:versions", "value": versions}],
    }
    if extra:
        found["properties"].append({"name": "toongeo:extra", "value": extra})
    return found


def _licence(name: str) -> str:
    if name in _LICENCES:
        return _LICENCES[name]
    try:
        return metadata(name).get("License-Expression") or "NOASSERTION"
    except PackageNotFoundError:
        return "NOASSERTION"


def main() -> int:
    """Write or check."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true")
    text = json.dumps(sbom(), indent=1) + "\n"
    if parser.parse_args().check:
        return int(SBOM.read_text() != text)
    SBOM.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
