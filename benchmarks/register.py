"""A head of another topology: how well the template is laid on it, and what its 46 expressions lose there and back.

usage: python benchmarks/register.py ICT [--rivals]   (ICT: ict_facekit_light.npz of ICT-FaceKit)

Table 1: registrations of the template's skin with the neutral head of ICT-FaceKit (11,248 vertices), which is turned,
moved and made smaller. Distances in percent of the distance of the outer eye corners: from the face of the template to the
head, from the face of the head to the template, and of the 51 inner landmarks; then triangles that have turned over.
Rivals: the closest point alone (the landmarks' similarity, then every vertex goes to the closest point); ARAP towards
closest points (libigl); and, with --rivals, trimesh's `nricp_amberg`.
Table 2: the template's expressions transferred to that head by `rig_mesh`, and from there back to the template. Error: mean
length of the difference over mean length of the motion, over the skin that the expression moves by more than a tenth of
its greatest motion.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import dataclasses
import time
from collections.abc import Callable

import igl
import numpy as np
from scipy.spatial.transform import Rotation

from toongeo import MorphableModel, default_model, nonrigid_register, rig_mesh
from toongeo.geometry.similarity import similarity
from toongeo.model.ibug68 import INNER, OUTER_EYES
from toongeo.model.load_ict_facekit import load_ict_facekit
from toongeo.pipeline.rig.register_face import hidden, register_face

SCALE, TURN, SHIFT = 0.37, Rotation.from_euler("xyz", [20, -50, 130], degrees=True).as_matrix(), np.array([5.0, 6, 7])
CLOSEST_STEPS = 10


def moved(V: np.ndarray) -> np.ndarray:
    return SCALE * V @ TURN.T + SHIFT


def round_trip(template: MorphableModel, head: MorphableModel) -> np.ndarray:
    """The template's expressions (46, n, 3) as they come back from a head of another topology."""
    there = rig_mesh(moved(head.mean), head.faces, head.landmarks, model=template)
    rigged = dataclasses.replace(
        head,
        expression=(there.deltas @ TURN / SCALE).astype(np.float32),
        expression_names=there.names,
        n_named=len(there.names),
    )
    return rig_mesh(template.mean, template.faces, template.landmarks, model=rigged).deltas


def relative_errors(template: MorphableModel, returned: np.ndarray) -> np.ndarray:
    """Error (46,) of each expression on the skin; NaN where none of it moves, as for the tongue."""
    skin = template.region("skin") | template.region("neck")
    errors = np.full(len(returned), np.nan)
    for k, (shape, back) in enumerate(zip(template.expression, returned, strict=False)):
        motion = np.linalg.norm(shape, axis=1)
        moves = skin & (motion > 0.1 * motion[skin].max()) & (motion > 1e-3 * motion.max())
        if moves.any():
            errors[k] = np.linalg.norm(back - shape, axis=1)[moves].mean() / motion[moves].mean()
    return errors
