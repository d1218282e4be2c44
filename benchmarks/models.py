"""Loading and evaluating face models: seconds, and how far a template lies from the model it was laid on.

usage: python benchmarks/models.py [SHARED]

Times are CPU seconds of one thread, the least of several. SHARED holds ``data/models/ict_facekit`` and
``data/models/sfm``; without it only what ships is measured. No pictures.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from toongeo.geometry.facing_surface import FacingSurface
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.model import MorphableModel, default_model, load_model, save_model

N, K = 50_000, 200  # vertices, modes: as of the Basel Face Model


def least(call, repeats=5):
    times = []
    for _ in range(repeats):
        started = time.process_time()
        call()
        times.append(time.process_time() - started)
    return min(times)


def large_model(n, k):
    rng = np.random.default_rng(0)
    mean = 60 * rng.standard_normal((n, 3))
    faces = np.arange(n - n % 3).reshape(-1, 3)
    modes = rng.standard_normal((k, n, 3)).astype(np.float32)
    return MorphableModel(mean=mean, faces=faces, identity=modes, landmarks=np.arange(68), mirror=np.arange(n))


def fresh_template():
    default_model.cache_clear()
    return default_model()


def ict_folder(folder, archive):
    """The published folder of ICT-FaceKit, written from the archive; neutral mesh and indices are the originals."""
    original = archive.parent / "FaceXModel"
    for name in ("generic_neutral_mesh.obj", "vertex_indices.json"):
        (folder / name).write_bytes((original / name).read_bytes())
    rest = (original / "generic_neutral_mesh.obj").read_text().split("\n")
    tail = "\n".join(line for line in rest if not line.startswith("v "))
    with np.load(archive) as z:
        shapes = {f"identity{k:03d}": z["identity_q"][k] * z["identity_scale"][k] for k in range(len(z["identity_q"]))}
        for k, name in enumerate(z["expression_names"]):
            shapes[str(name)] = z["expression_q"][k] * z["expression_scale"][k]
        for name, shape in shapes.items():
            rows = "\n".join("v {:.6g} {:.6g} {:.6g}".format(*v) for v in z["neutral"] + shape)
            (folder / f"{name}.obj").write_text(rows + "\n" + tail)
    return len(shapes) + 1


def on_template(name, model):
    """How far the template's face lies from the model that it was laid on, and seconds."""
    started = time.process_time()
    laid = model.with_rig_of()
    seconds = time.process_time() - started
    front = laid.region("face") & ~laid.region("forehead")
    surface = FacingSurface(model.mean, model.faces)
    shift = model.mean[model.landmarks[17:]].mean(0) - laid.mean[laid.landmarks[17:]].mean(0)
    V = laid.mean + shift
    triangles, bary, _ = surface.closest(V[front], vertex_normals(V, laid.faces)[front])
    off = np.linalg.norm(surface.points(triangles, bary) - V[front], axis=1)
    spread = f"{np.median(off):.2f}, {np.quantile(off, 0.95):.2f}"
    print(f"| {name} on the template, distance of its face, median and 95 % | {spread} mm |")
    print(f"| {name} on the template, seconds | {seconds:.1f} |")


def main() -> None:
    print("| what | result |\n|---|---|")
    print(f"| default template, loaded | {least(fresh_template):.3f} s |")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.npz"
        save_model(large_model(N, 80), path)
        size = path.stat().st_size / 1e6
        print(f"| .npz of {size:.0f} MB, loaded | {least(lambda: load_model(path)):.3f} s |")
        model = large_model(N, K)
        c = np.random.default_rng(1).standard_normal(K)
        flat, single = model.identity.reshape(K, -1), c.astype(np.float32)
        bare, ours = (least(call, 15) for call in (lambda: single @ flat, lambda: model.vertices(c)))
        print(f"| {N} vertices of {K} coefficients, times the bare float32 product | {ours / bare:.2f} |")
        if len(sys.argv) < 2:
            return
        models = Path(sys.argv[1]) / "data" / "models"
        archive = models / "ict_facekit" / "ict_facekit_light.npz"
        files = ict_folder(Path(folder), archive)
        cache = Path(folder) / "cache.npz"
        first = least(lambda: load_model(folder, cache=cache), 1)
        print(f"| ICT-FaceKit, {files} files of 2.5 MB, the first time | {first:.1f} s |")
        print(f"| ICT-FaceKit, from its cache | {least(lambda: load_model(folder, cache=cache), 2):.2f} s |")
        off = np.abs(load_model(folder, cache=cache).identity - load_model(archive).identity).max()
        print(f"| ICT-FaceKit, folder against archive, the largest difference | {off:.4f} mm |")
    on_template("ICT-FaceKit", load_model(archive))
    on_template("Surrey", load_model(models / "sfm"))


if __name__ == "__main__":
    main()
