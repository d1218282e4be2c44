"""What to install where an optional package is missing."""

__all__ = ["REQUIREMENTS", "missing_extra"]

# As in pyproject.toml, which a test compares. The packages themselves are named, not "toongeo[usd]": that works from a
# checkout too, and wherever the library came from.
REQUIREMENTS = {
    "usd": "usd-core>=24.11",
    "serve": "websockets>=14",
    "notebook": "anywidget>=0.9.13",
    "models": "h5py>=3.11",
    "video": "av>=14",
    "batch": "joblib>=1.4",
    "dlib": "dlib>=19.24",
    "mediapipe": "mediapipe>=0.10.14",
    "onnx": "onnxruntime>=1.18",
    "cluster": "distributed>=2024.1",
}


def missing_extra(what: str, extra: str) -> str:
    """What an ImportError says.

    Examples
    --------
    >>> missing_extra("USDZ", "usd")
    'USDZ needs the extra usd: pip install "usd-core>=24.11"'
    """
    return f'{what} needs the extra {extra}: pip install "{REQUIREMENTS[extra]}"'
