"""Head and eyeballs as the editor shows them."""

import numpy as np

from toongeo.arrays import Bytes, Floats, Integers
from toongeo.model import default_model
from toongeo.pipeline.fit import FaceFit

__all__ = ["face_mesh", "seen_vertices"]


def face_mesh() -> tuple[Integers, Bytes]:
    """Triangles (m, 3) of the default model's head and then its eyeballs, and sRGB colours (n, 3) of their vertices."""
    model = default_model()
    faces, colours, count = [model.faces], [model.albedo_mean], len(model.mean)
    for eye in model.eyes:
        faces.append(eye.faces + count)
        colours.append(eye.colour)
        count += len(eye.vertices)
    return np.concatenate(faces), np.round(255 * np.concatenate(colours)).astype(np.uint8)


def seen_vertices(fit: FaceFit) -> Floats:
    """Vertices (n, 3) of `face_mesh` as the picture shows them, px: x right, y down, z towards the viewer."""
    parts = [fit.vertices]
    for eye in fit.model.eyes:
        centre, radius = eye.placed(fit.identity)
        parts.append(centre + radius * eye.vertices)
    V = np.concatenate(parts)
    px_per_mm = np.linalg.norm(fit.camera.jacobian(V[:1])) / np.sqrt(2)
    return np.column_stack([fit.project(V), px_per_mm * fit.camera.depth(V)])
