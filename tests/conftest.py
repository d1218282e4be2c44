"""Fixtures for all tests; BLAS is pinned to one thread before numpy is imported."""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import contextlib
import http.server
import json
import shutil
import subprocess
import threading
import urllib.parse
from pathlib import Path

import numpy as np
import pytest

from tests.sharing import Once

ROOT = Path(__file__).parents[1]
WEB = ROOT / "tests" / "web"
PORTRAITS = ROOT / "examples" / "portraits"
CARTOONS = sorted(path.stem for path in PORTRAITS.glob("*.png"))


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(0)


@pytest.fixture(scope="session")
def shared() -> Path:
    """Data that may not travel with the project; tests that need it are skipped where it is absent."""
    folder = ROOT.parent / "shared"
    if not folder.is_dir():
        pytest.skip("needs the folder `shared` beside the checkout")
    return folder


@pytest.fixture(scope="session")
def model():
    from toongeo.model import default_model

    return default_model()


@pytest.fixture(scope="session")
def artist():
    """The template without a prior of people: its mean is the likeliest face, so exact landmarks give it back."""
    from toongeo.model.artist_model import artist_model

    return artist_model()


@pytest.fixture(scope="session")
def random_face(model):
    """Function ``seed -> (identity, expression)`` of a plausible face within the bounds."""

    def draw(seed):
        rng = np.random.default_rng(seed)
        expression = np.zeros(len(model.expression))
        chosen = rng.choice(model.n_named, 4, replace=False)
        expression[chosen] = rng.uniform(0.1, 0.6, 4)
        expression[model.expression_index("mouthClose")] = 0
        return 0.5 * rng.standard_normal(len(model.identity)), expression

    return draw


@pytest.fixture(scope="session")
def annotated():
    """Function ``(model, camera, identity, expression) -> (68, 2) px``, jaw points on the outline."""
    from toongeo.model.anatomy.landmark_basis import landmark_basis
    from toongeo.model.anatomy.visible_landmarks import visible_landmarks

    def project(model, camera, identity=None, expression=None):
        identity = np.zeros(len(model.identity)) if identity is None else identity
        expression = np.zeros(len(model.expression)) if expression is None else expression
        coefficients = np.concatenate([identity, expression])
        vertices = visible_landmarks(landmark_basis(model), coefficients, camera.rotation)
        return camera.project(model.vertices(identity, expression)[vertices])

    return project


@pytest.fixture(scope="session")
def cartoon():
    """``cartoon(name)`` -> picture and landmarks of a bundled example."""
    from toongeo.io import read_image, read_landmarks

    return lambda name: (read_image(PORTRAITS / f"{name}.png"), read_landmarks(PORTRAITS / f"{name}.pts"))


@pytest.fixture(scope="session")
def once(tmp_path_factory):
    """``once(key, make)`` -> what ``make()`` gives, made once for a run, also if it has several processes."""
    alone = "PYTEST_XDIST_WORKER" not in os.environ
    return Once(None if alone else tmp_path_factory.getbasetemp().parent)


@pytest.fixture(scope="session")
def avatars(once, cartoon):
    """``avatars(name)`` -> `make_avatar` of a bundled picture, with hair painted on the head."""
    from toongeo import make_avatar

    return lambda name: once(f"avatar-{name}", lambda: make_avatar(*cartoon(name), hair=False))


@pytest.fixture(scope="session")
def avatar(avatars):
    """The avatar of one bundled picture."""
    return avatars("moustache_man")


@pytest.fixture(scope="session")
def performance(once, avatar):
    """A short film of that avatar, hidden for a while."""
    from tests.filmed import filmed

    return once("performance", lambda: filmed(avatar, 2.4, fps=10, size=240, hidden=(1.0, 1.4)))


@pytest.fixture(scope="session")
def fits(once, cartoon):
    """``fits(name)`` -> `fit_3dmm` of a bundled picture."""
    from toongeo import fit_3dmm

    return lambda name: once(f"fit-{name}", lambda: fit_3dmm(*cartoon(name)))


@pytest.fixture(scope="session")
def aligned(once, cartoon, fits):
    """``aligned(name)`` -> `align_face` of its fit, as drawn: no expression is taken out of it."""
    from toongeo import align_face

    return lambda name: once(f"aligned-{name}", lambda: align_face(fits(name), cartoon(name)[1]))


@pytest.fixture(scope="session")
def transferred(once, aligned):
    """``transferred(name)`` -> `build_rig` of its aligned face, before lids and mouth are fitted."""
    from toongeo import build_rig

    return lambda name: once(f"rig-{name}", lambda: build_rig(aligned(name)))


@pytest.fixture(scope="session")
def node():
    """Runs a script of tests/web on files and gives what it prints.

    Skips without node or its packages (``npm ci --prefix tests/web``); fails if TOONGEO_REQUIRE_WEB=1.
    """
    missing = None
    if shutil.which("node") is None:
        missing = "node is not installed"
    elif not (WEB / "node_modules" / "gltf-validator").is_dir():
        missing = "run `npm ci --prefix tests/web` first"
    if missing and os.environ.get("TOONGEO_REQUIRE_WEB") == "1":
        pytest.fail(missing)
    if missing:
        pytest.skip(missing)

    def run(script, *files):
        command = ["node", str(WEB / script), *map(str, files)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run


@pytest.fixture(scope="session")
def browse(node, tmp_path_factory):
    """``browse(url, steps)`` -> what headless Chromium tells (tests/web/browse.mjs), and the folder of its pictures.

    Skips without Chromium or playwright-core; fails if TOONGEO_REQUIRE_WEB=1.
    """
    chromium = os.environ.get("TOONGEO_CHROMIUM") or shutil.which("chromium")
    missing = None
    if chromium is None:
        missing = "chromium is not installed"
    elif not (WEB / "node_modules" / "playwright-core").is_dir():
        missing = "run `npm ci --prefix tests/web` first"
    if missing and os.environ.get("TOONGEO_REQUIRE_WEB") == "1":
        pytest.fail(missing)
    if missing:
        pytest.skip(missing)

    def run(url, steps):
        folder = tmp_path_factory.mktemp("browse")
        (folder / "steps.json").write_text(json.dumps(steps))
        return node("browse.mjs", url, folder / "steps.json", folder), folder

    return run


@pytest.fixture(scope="session")
def serve():
    """``with serve(folder) as site:`` has tests/web and the files of a folder at ``site``, on this machine."""

    @contextlib.contextmanager
    def serving(folder):
        class Handler(http.server.SimpleHTTPRequestHandler):
            extensions_map = http.server.SimpleHTTPRequestHandler.extensions_map | {".mjs": "text/javascript"}

            def translate_path(self, path):
                name = urllib.parse.unquote(urllib.parse.urlsplit(path).path).lstrip("/")
                near = Path(folder) / name
                return str(near if near.is_file() else WEB / name)

            def log_message(self, *_):
                pass

        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}"
        finally:
            server.shutdown()
            thread.join()
            server.server_close()

    return serving
