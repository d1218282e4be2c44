"""Morphable models: the container, the default template and its tables."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(
    __name__,
    {
        "MorphableModel": "morphable_model",
        "EyeballTemplate": "eyeball_template",
        "default_model": "default_model",
        "data_path": "data_path",
    },
)
