"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.adapters.dlib_detector import DlibDetector as DlibDetector
from toongeo.adapters.mediapipe_detector import MediapipeDetector as MediapipeDetector
from toongeo.adapters.onnx_regressor import OnnxRegressor as OnnxRegressor
