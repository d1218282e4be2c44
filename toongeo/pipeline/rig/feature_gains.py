"""How much farther the expressions of a face should go than plain transfer takes them.

Constants were judged on the seven examples (``benchmarks/rig.py``).
"""

from functools import lru_cache

import numpy as np

from toongeo.geometry import DeformationTransfer
from toongeo.model import MorphableModel
from toongeo.model.anatomy.still_vertices import still_vertices
from toongeo.model.expression_features import FEATURE_OF, FEATURES, Feature

__all__ = ["feature_gains"]

_RANGE = (0.5, 2.0)  # gains beyond would tear what lies between two features


def feature_gains(model: MorphableModel, neutral: np.ndarray, deltas: np.ndarray) -> np.ndarray:
    """Gain (k,) with which each expression travels in proportion to its feature, as it does on the template.

    Gradients are carried over triangle by triangle, so an expression gets as large as the skin around the feature is,
    whatever the feature's own size: plain deformation transfer is too weak on strong exaggerations (Chen et al. 2020,
    section 5.2), and too strong on a small mouth in a large face. With T the travel (root mean square motion of the
    feature's landmarks) and s the feature's size, the gain is ``(T_template / s_template) s / T``, within [0.5, 2].

    Parameters
    ----------
    model : MorphableModel
    neutral : (n, 3) float, mm
    deltas : (k, n, 3) float, mm
        The model's named expressions transferred to it.

    Returns
    -------
    (k,) float64
        1 for expressions without a feature; exactly 1 for all on the template itself.
    """
    gains = np.ones(len(deltas))
    travel = _template_travel(model)
    for k, name in enumerate(model.expression_names[: len(deltas)]):
        if name in FEATURE_OF and travel[k] > 0:
            feature = FEATURES[FEATURE_OF[name]]
            here = _travel(model, deltas[k], feature) / _size(model, neutral, feature)
            template = travel[k] / _size(model, model.mean, feature)
            gains[k] = np.clip(template / max(here, 1e-9), *_RANGE)
    return gains


def _size(model: MorphableModel, V: np.ndarray, feature: Feature) -> float:
    ends = V[model.landmarks[np.array(feature.size)]]
    return float(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).mean())


def _travel(model: MorphableModel, delta: np.ndarray, feature: Feature) -> float:
    moved = delta[model.landmarks[list(feature.travel)]].astype(np.float32)
    return float(np.sqrt((moved.astype(np.float64) ** 2).sum(1).mean()))


@lru_cache(maxsize=4)
def _template_travel(model: MorphableModel) -> np.ndarray:
    """Travel (k,) of each named expression's feature when it is transferred to the template itself."""
    transfer = DeformationTransfer(model.mean, model.faces, model.mean, pinned=still_vertices(model), align=True)
    travel = np.zeros(model.n_named)
    for k, name in enumerate(model.expression_names[: model.n_named]):
        if name in FEATURE_OF:
            delta = transfer(model.mean + model.expression[k]) - model.mean
            travel[k] = _travel(model, delta, FEATURES[FEATURE_OF[name]])
    travel.setflags(write=False)
    return travel
