"""Adapters beside tiny stand-ins of what they adapt; none of them is loaded before it is asked for."""

import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from tests.adapters.tiny_onnx import tiny_onnx
from toongeo.adapters import DlibDetector, MediapipeDetector, OnnxRegressor
from toongeo.model.mediapipe478 import VERTICES
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.testing import check_landmark_detector, check_regressor
from toongeo.testing.example import example


@pytest.fixture
def points():
    return np.array(example()[1])


def test_nothing_is_imported_before_it_is_made():
    code = (
        "import sys, toongeo, toongeo.adapters; toongeo.adapters.DlibDetector, toongeo.adapters.MediapipeDetector, "
        "toongeo.adapters.OnnxRegressor; print([n for n in ('dlib', 'mediapipe', 'onnxruntime') if n in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("module", "adapter", "extra"),
    [
        ("dlib", DlibDetector, "dlib"),
        ("mediapipe", MediapipeDetector, "mediapipe"),
        ("onnxruntime", lambda path: OnnxRegressor(path, {"identity": "id"}), "onnx"),
    ],
)
def test_the_message_names_the_extra(monkeypatch, module, adapter, extra):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=rf"pip install toongeo\[{extra}\]"):
        adapter("model")


def fake_dlib(points, parts=68):
    class Faces:
        def run(self, img, upsample, threshold):
            if np.ptp(img) == 0:
                return [], [], []
            return ["small", "large"], [-0.5, 2.0], [0, 0]

    def predictor(path):
        def shape(img, box):
            scale = 1.0 if box == "large" else 0.5
            found = [SimpleNamespace(x=int(x * scale), y=int(y * scale)) for x, y in points]
            return SimpleNamespace(num_parts=parts, part=lambda k: found[k])

        return shape

    return SimpleNamespace(get_frontal_face_detector=Faces, shape_predictor=predictor)


def test_dlib(monkeypatch, points, tmp_path):
    (tmp_path / "points.dat").write_bytes(b"weights")
    monkeypatch.setitem(sys.modules, "dlib", fake_dlib(points))
    detector = DlibDetector(tmp_path / "points.dat", confidence=0.8)
    check_landmark_detector(detector)
    large, small = detector(np.array(example()[0]))
    np.testing.assert_array_equal(large.points, points.astype(int))
    assert large.score == pytest.approx(1 / (1 + np.exp(-2))) and small.score < 0.5
    assert (large.confidence == 0.8).all()
    with pytest.raises(OSError, match="no shape predictor"):
        DlibDetector(tmp_path / "missing.dat")
    with pytest.raises(ValueError, match="confidence: expected"):
        DlibDetector(tmp_path / "points.dat", confidence=2)
    monkeypatch.setitem(sys.modules, "dlib", fake_dlib(points, parts=5))
    with pytest.raises(ValueError, match="expected a predictor of 68 points, got 5"):
        DlibDetector(tmp_path / "points.dat")(np.array(example()[0]))


def fake_mediapipe(points):
    class Landmarker:
        @classmethod
        def create_from_options(cls, options):
            made = cls()
            made.options = options
            return made

        def detect(self, image):
            height, width = image.data.shape[:2]
            if np.ptp(image.data) == 0:
                return SimpleNamespace(face_landmarks=[], face_blendshapes=[])
            mesh = np.zeros((478, 3))
            mesh[VERTICES, :2] = (points + 0.5) / [width, height]
            face = [SimpleNamespace(x=x, y=y, z=z) for x, y, z in mesh]
            shapes = [SimpleNamespace(category_name="jawOpen", score=0.25)]
            return SimpleNamespace(face_landmarks=[face], face_blendshapes=[shapes])

    vision = SimpleNamespace(FaceLandmarker=Landmarker, FaceLandmarkerOptions=lambda **options: options)
    return SimpleNamespace(
        tasks=SimpleNamespace(vision=vision, BaseOptions=lambda **options: options),
        Image=lambda image_format, data: SimpleNamespace(data=data),
        ImageFormat=SimpleNamespace(SRGB=1),
    )


def test_mediapipe(monkeypatch, points, tmp_path):
    (tmp_path / "face.task").write_bytes(b"task")
    monkeypatch.setitem(sys.modules, "mediapipe", fake_mediapipe(points))
    detector, img = MediapipeDetector(tmp_path / "face.task"), np.array(example()[0])
    check_landmark_detector(detector)
    np.testing.assert_allclose(detector(img)[0].points, points, atol=1e-9)
    assert detector.points(img)[0].shape == (478, 3)
    assert detector.expressions(img) == [{"jawOpen": 0.25}]
    with pytest.raises(OSError, match="no task"):
        MediapipeDetector(tmp_path / "missing.task")
    with pytest.raises(ValueError, match="confidence: expected"):
        MediapipeDetector(tmp_path / "face.task", confidence=-1)


@pytest.fixture(scope="module")
def network(tmp_path_factory):
    pytest.importorskip("onnxruntime")
    rng = np.random.default_rng(0)
    weights = {"id": 0.1 * rng.standard_normal((136, 80)), "exp": rng.uniform(0, 0.01, (192, 64))}
    path = tmp_path_factory.mktemp("onnx") / "tiny.onnx"
    shapes = {"id": ("points", (1, 68, 2), weights["id"]), "exp": ("picture", (1, 3, 8, 8), weights["exp"])}
    path.write_bytes(tiny_onnx(shapes))
    return path, weights


def test_onnx(network, points):
    path, weights = network
    regressor = OnnxRegressor(path, {"identity": "id", "expression": "exp"}, size=8, margin=1.5)
    check_regressor(regressor)
    img = np.full((400, 400, 3), 51, np.uint8)
    found = regressor(img, points)
    low, high = points.min(0), points.max(0)
    side = 1.5 * (high - low).max()
    shares = (points - ((low + high) / 2 - side / 2)) / side
    np.testing.assert_allclose(found.identity, shares.ravel() @ weights["id"], rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(found.expression, np.full(192, 0.2) @ weights["exp"], rtol=1e-4, atol=1e-5)
    with pytest.raises(ValueError, match="img: expected a picture"):
        regressor(None, points)
    fit = fit_3dmm(img, points, regressor=lambda *given: regressor(*given))
    assert fit.report.rms_percent < 10


def test_onnx_that_does_not_fit(network):
    path, _ = network
    with pytest.raises(ValueError, match="outputs: expected names of id, exp, got nose"):
        OnnxRegressor(path, {"identity": "nose"})
    with pytest.raises(ValueError, match="outputs: expected some of identity, expression, albedo, light, got pose"):
        OnnxRegressor(path, {"pose": "id"})
    with pytest.raises(OSError, match="no network"):
        OnnxRegressor(path.with_name("missing.onnx"), {"identity": "id"})
    flat = path.with_name("flat.onnx")
    flat.write_bytes(tiny_onnx({"id": ("points", (1, 136), np.zeros((136, 80)))}))
    with pytest.raises(ValueError, match="path: expected inputs"):
        OnnxRegressor(flat, {"identity": "id"})
