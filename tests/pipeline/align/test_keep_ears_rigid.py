import numpy as np

from toongeo.geometry.rotations.similarity import similarity
from toongeo.pipeline.align.keep_ears_rigid import keep_ears_rigid


def shape_error(model, before, after):
    """How far ears are from a similar copy of themselves, the worse of both, as a share of their size."""
    errors = []
    for name in ("ear_left", "ear_right"):
        ear = model.region(name)
        scale, rotation, shift = similarity(before[ear], after[ear])
        off = after[ear] - (scale * before[ear] @ rotation.T + shift)
        errors.append(np.sqrt((off**2).sum(1).mean()) / np.ptp(before[ear, 1]))
    return max(errors)


def test_a_head_that_moves_as_a_whole_keeps_every_vertex(model):
    turn = np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1.0]])
    after = 1.4 * model.mean @ turn.T + [3, -5, 2]
    np.testing.assert_allclose(keep_ears_rigid(model, model.mean, after), after, atol=1e-9)


def test_a_flap_becomes_an_ear_again(model):
    """A pull towards the chin that grows downwards, as of a long jaw."""
    after = model.mean.copy()
    after[:, 1] -= 1.5 * np.clip(-model.mean[:, 1], 0, None)
    kept = keep_ears_rigid(model, model.mean, after)
    assert shape_error(model, model.mean, kept) < 0.5 * shape_error(model, model.mean, after)
    ears = model.region("ear_left") | model.region("ear_right")
    np.testing.assert_array_equal(kept[~ears], after[~ears])


def test_ears_stay_joined_to_the_head(model):
    after = model.mean.copy()
    after[:, 1] -= 1.5 * np.clip(-model.mean[:, 1], 0, None)
    kept = keep_ears_rigid(model, model.mean, after)
    F = model.faces
    edges = np.vstack([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    ear = model.region("ears")
    across = edges[ear[edges].any(1) & ~ear[edges].all(1)]
    lengths = [np.linalg.norm(np.subtract(*V[across].transpose(1, 0, 2)), axis=1) for V in (after, kept)]
    assert (lengths[1] < 3 * lengths[0] + 1.5).all()


def test_nothing_is_written_to(model):
    after = model.mean * [1, 2, 1]
    copy = after.copy()
    keep_ears_rigid(model, model.mean, after)
    np.testing.assert_array_equal(after, copy)
