"""Which model a file was made with."""

import hashlib

import numpy as np

from toongeo.model.morphable_model import MorphableModel

__all__ = ["model_checksum"]


def model_checksum(model: MorphableModel) -> str:
    """SHA-256 of the arrays of a model that fits and avatars depend on."""
    digest = hashlib.sha256()
    for array in (model.mean, model.faces, model.uv, model.uv_faces, model.identity, model.expression):
        digest.update(f"{array.dtype.str}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).data)
    digest.update("\n".join(model.expression_names).encode())
    return digest.hexdigest()
