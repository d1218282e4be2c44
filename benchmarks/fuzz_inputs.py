"""Hostile inputs by number: good files and meshes with faults in them. See ``fuzz.py``."""

import io
import json
import re
import struct
import sys
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from toongeo.app.read_take import read_take
from toongeo.caricature import DeformationSpace
from toongeo.io import read_glb, read_image, read_landmarks, read_mesh, read_mesh_landmarks, read_obj
from toongeo.model.expression_schemes import SCHEMES

NUMBERS = tuple(b"nan inf -1 0 1e9999999 1e308 -0.0 99999999999 0x10 1e-320".split()) + (b"9" * 400, b"")
WORDS = (*(b'{ " null \0 \xff\xfe , # true \xf0\x9f\x98\x80'.split(b" ")), b"[" * 2000, b"\n", b"1 2 3 " * 99)
V = np.random.default_rng(0).normal(size=(99, 3))


@dataclass(frozen=True)
class Target:
    """A reader, what good files of it are, and what must hold of what it gives."""

    suffix: str
    read: Callable[[Path], Any]
    good: tuple[bytes, ...]
    arrays: Callable[[Any], list[np.ndarray]]
    may_be_nan: bool = False


def mutated(content: bytes, rng: np.random.Generator) -> bytes:
    """A few faults in a file."""
    data = bytearray(content)
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        kind, at = rng.integers(9), int(rng.integers(len(data) + 1))
        length = int(rng.choice([1, 2, 4, 16, 64, max(1, len(data) // 4)]))
        if kind == 0 and data:
            data[at % len(data)] ^= 1 << int(rng.integers(8))
        elif kind == 1:
            data[at : at + length] = rng.integers(0, 256, length, dtype=np.uint8).tobytes()
        elif kind == 2:
            del data[at : at + length]
        elif kind == 3:
            del data[at:]
        elif kind == 4:
            data[at:at] = data[: min(length, 4096)] * int(rng.choice([1, 2, 50]))
        elif kind == 5:
            data[at : at + 4] = struct.pack("<I", int(rng.choice([0, 1, 2**31 - 1, 2**31, 2**32 - 1, 65536])))
        elif kind == 6:
            data = _other_number(data, rng)
        elif kind == 7:
            data[at:at] = WORDS[rng.integers(len(WORDS))]
        else:
            data[at : at + length] = bytes([int(rng.choice([0, 255, 127]))]) * length
    return bytes(data)


def _other_number(data: bytearray, rng: np.random.Generator) -> bytearray:
    found = list(re.finditer(rb"-?\d+\.?\d*", bytes(data)))
    if not found:
        return data
    match = found[rng.integers(len(found))]
    return data[: match.start()] + bytearray(NUMBERS[rng.integers(len(NUMBERS))]) + data[match.end() :]


def targets() -> dict[str, Target]:
    """Every reader by name."""
    obj = b"o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
    obj += b"f 1/1 2/2 3/1 4/2\nf -4 -3 -2\ng x\nf 1//1 2//1 3//1\n"
    off = b"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"
    numbers = np.random.default_rng(1).normal(size=(2, 12))
    stl = bytes(80) + struct.pack("<I", 2) + b"".join(struct.pack("<12fH", *row, 0) for row in numbers)
    ply, glb = (_exported(off, kind) for kind in ("ply", "glb"))
    on_mesh = json.dumps([1, [0.5, 0, 0], None] + [3] * 65).encode()
    takes = _npy(np.full((5, 52), 0.5)), _npy(np.zeros((5, 54), "f4"))
    found = {
        "mesh_landmarks": Target(".json", lambda p: read_mesh_landmarks(p, V), (on_mesh,), _only, may_be_nan=True),
        "picture": Target(".png", read_image, tuple(_pictures()), _only),
        "obj": Target(".obj", read_obj, (obj,), _fields("vertices", "uv", "faces")),
        "off": Target(".off", read_mesh, (off,), _scene),
        "stl": Target(".stl", read_mesh, (stl,), _scene),
        "ply": Target(".ply", read_mesh, (ply,), _scene),
        "glb": Target(".glb", read_glb, (glb,), lambda found: []),
        "glb_mesh": Target(".glb", read_mesh, (glb,), _scene),
        "take": Target(".csv", read_take, (_take(),), _fields("times", "weights")),
        "take_npy": Target(".npy", read_take, takes, _fields("times", "weights")),
        "space": Target(".npz", DeformationSpace.load, tuple(_spaces()), _fields("rotations")),
    }
    for end, good in _landmarks().items():
        found[f"landmarks{end}"] = Target(end, read_landmarks, good, _only, may_be_nan=True)
    return found


def _fields(*names: str) -> Callable[[Any], list[np.ndarray]]:
    return lambda found: [np.asarray(getattr(found, name)) for name in names]


def _scene(found: Any) -> list[np.ndarray]:
    return [np.asarray(array) for part in found.meshes for array in (part.vertices, part.faces)]


def _only(found: Any) -> list[np.ndarray]:
    return [np.asarray(found)]


def _landmarks() -> dict[str, tuple[bytes, ...]]:
    """Good files of every format by the end of its name."""
    points = np.column_stack([100 + 50 * np.cos(np.arange(68)), 120 + 60 * np.sin(np.arange(68))])
    lines = "\n".join(f"{x} {y}" for x, y in points)
    part = "".join(f"<part name='{k:02}' x='{int(x)}' y='{int(y)}'/>" for k, (x, y) in enumerate(points))
    box = f"<image file='a'><box top='1' left='1' width='9' height='9'>{part}</box></image>"
    ljson = {"version": 2, "labels": [], "landmarks": {"points": points.tolist()}}
    listed = json.dumps(points.tolist()).encode()
    return {
        ".pts": (f"version: 1\nn_points: 68\n{{\n{lines}\n}}\n".encode(),),
        ".txt": (lines.encode(),),
        ".csv": (lines.replace(" ", ",").encode(),),
        ".npy": (_npy(points), _npy(points.astype("f4"))),
        ".json": (listed, json.dumps({"faceLandmarks": [points.tolist()]}).encode()),
        ".ljson": (json.dumps(ljson).encode(),),
        ".xml": (f"<dataset><images>{box}</images></dataset>".encode(),),
    }


def _take() -> bytes:
    names = list(SCHEMES["live_link"])
    rows = [",".join(["Timecode", "BlendShapeCount", *names])]
    rows += [",".join([f"10:00:00:{k:02}.0", "61", *["0.25"] * len(names)]) for k in range(9)]
    return "\n".join(rows).encode()


def _exported(off: bytes, kind: str) -> bytes:
    import trimesh

    content = trimesh.load(io.BytesIO(off), file_type="off", process=False).export(file_type=kind)
    return content if isinstance(content, bytes) else b""


def _npy(array: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


def _pictures() -> Iterator[bytes]:
    pixels = np.random.default_rng(2).integers(0, 255, (24, 20, 3), np.uint8)
    for look in ("RGB PNG", "RGBA PNG", "P PNG", "RGB JPEG", "RGB WEBP", "RGB GIF", "RGB BMP", "RGB TIFF"):
        mode, kind = look.split()
        stream = io.BytesIO()
        Image.fromarray(pixels).convert(mode).save(stream, kind)
        yield stream.getvalue()


def _spaces() -> Iterator[bytes]:
    W = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    F = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "space.npz"
        DeformationSpace.from_meshes(W, F, [W * 2, W * [1, 1, 3]], align=False).save(path)
        yield path.read_bytes()


def sealed(content: bytes, suffix: str) -> bytes:
    """Checksums made right again, so that faults get past them."""
    if suffix == ".png" and content[:8] == b"\x89PNG\r\n\x1a\n":
        data, at = bytearray(content), 8
        while at + 12 <= len(data):
            size = struct.unpack(">I", data[at : at + 4])[0]
            if at + 12 + size > len(data):
                break
            data[at + 8 + size : at + 12 + size] = struct.pack(">I", zlib.crc32(bytes(data[at + 4 : at + 8 + size])))
            at += 12 + size
        return bytes(data)
    return content


def resealed_npz(content: bytes, rng: np.random.Generator) -> bytes:
    """An archive whose members are damaged, and not the archive."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(out, "w") as new:
        names = old.namelist()
        chosen = names[rng.integers(len(names))]
        for name in names:
            data = old.read(name)
            new.writestr(name, mutated(data, rng) if name == chosen else data)
    return out.getvalue()


def hostile(target: Target, number: int, name: str) -> bytes:
    """The file of a number."""
    rng = np.random.default_rng([zlib.crc32(name.encode()), number])
    good = target.good[number % len(target.good)]
    if target.suffix == ".npz" and rng.random() < 0.6:
        return resealed_npz(good, rng)
    content = mutated(good, rng)
    return sealed(content, target.suffix) if rng.random() < 0.6 else content


def bad_mesh(number: int) -> tuple[np.ndarray, np.ndarray]:
    """A mesh that something is wrong with, at a scale of 1e-9 to 1e9."""
    rng = np.random.default_rng([77, number])
    n = int(rng.integers(4, 30))
    V, F = rng.normal(size=(n, 3)), rng.integers(0, n, (int(rng.integers(1, 3 * n)), 3))
    if rng.random() < 0.5:  # a strip that is a surface
        F = np.array([[k, k + 1, k + 2] if k % 2 else [k + 1, k, k + 2] for k in range(n - 2)])
    kind = number % 10
    if kind == 0:
        V[:, 2] = 0
    elif kind == 1:
        V[rng.integers(n)] = V[rng.integers(n)]
    elif kind == 2:
        V = np.outer(rng.normal(size=n), [1, 2, 3])
    elif kind == 3:
        V[rng.integers(n)] = rng.choice([np.nan, np.inf, 1e300])
    elif kind == 4:
        F = np.vstack([F, F[:, ::-1]])
    elif kind == 5:
        F = np.vstack([F, [[0, 1, int(rng.choice([-1, n, 2**40]))]]])
    elif kind == 6:
        V = V + 1e6
    elif kind == 7:
        V[F[0, 0]] = (V[F[0, 1]] + V[F[0, 2]]) / 2 + 10.0 ** -rng.integers(3, 14) * rng.normal(size=3)
    return V * 10.0 ** rng.integers(-9, 10), F
