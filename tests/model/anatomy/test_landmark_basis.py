import numpy as np

from toongeo.model.anatomy.landmark_basis import landmark_basis


def test_rows_are_those_of_the_model_gathered_or_not(model):
    """Vertices of a silhouette may lie beside the lines; a search among those gathered would take their neighbours."""
    basis = landmark_basis(model)
    gathered = basis.vertices[::7]
    others = np.setdiff1d(np.arange(len(model.mean)), basis.vertices)[::500]
    x = np.random.default_rng(0).normal(size=len(model.identity) + len(model.expression))
    whole = model.vertices(x[: len(model.identity)], x[len(model.identity) :])
    for vertices in (gathered, others, np.concatenate([others, gathered, [len(model.mean) - 1]])):
        mean, modes = basis.at(vertices)
        np.testing.assert_array_equal(mean, model.mean[vertices])
        np.testing.assert_allclose(mean + (modes @ x).reshape(-1, 3), whole[vertices], atol=1e-3)
