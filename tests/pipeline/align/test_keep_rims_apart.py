import numpy as np

from toongeo.model.anatomy.rims import rim_path
from toongeo.pipeline.align.keep_rims_apart import GAP_MM, keep_rims_apart
from toongeo.render import ScaledOrthographicCamera

CAMERA = ScaledOrthographicCamera.look(size=512)


def lids(model):
    upper, lower = rim_path(model, "lid_upper_left"), rim_path(model, "lid_lower_left")
    return upper, lower, np.unique(np.r_[upper, lower])


def test_rims_in_order_are_left_alone(model):
    _, _, anchors = lids(model)
    px = CAMERA.project(model.mean[anchors])
    for given in (np.ones(len(anchors), bool), np.zeros(len(anchors), bool)):
        targets, depth = keep_rims_apart(model, CAMERA, model.mean, anchors, px, given)
        np.testing.assert_allclose(targets, px, atol=1e-9)
        np.testing.assert_allclose(depth, CAMERA.depth(model.mean[anchors]), atol=1e-9)


def crossed(model):
    """Targets that take the lower lid 1 mm above the upper one; where the middle of each is among them."""
    upper, lower, anchors = lids(model)
    px = CAMERA.project(model.mean)
    inner = lower[1:-1]
    px[inner, 1] = np.interp(px[inner, 0], px[upper, 0], px[upper, 1]) - CAMERA.scale
    middle, opposite = (np.flatnonzero(anchors == rim[len(rim) // 2])[0] for rim in (lower, upper))
    return anchors, px[anchors], middle, opposite


def test_what_is_free_gives_way_in_the_picture(model):
    anchors, px, middle, opposite = crossed(model)
    targets, _ = keep_rims_apart(model, CAMERA, model.mean, anchors, px, np.zeros(len(anchors), bool))
    down = (targets - px)[:, 1] / CAMERA.scale
    np.testing.assert_allclose([down[middle], down[opposite]], np.array([0.5, -0.5]) * (1 + GAP_MM), atol=0.1)


def test_landmarks_keep_their_place_and_part_in_depth(model):
    anchors, px, middle, opposite = crossed(model)
    targets, depth = keep_rims_apart(model, CAMERA, model.mean, anchors, px, np.ones(len(anchors), bool))
    np.testing.assert_array_equal(targets, px)
    forward = depth - CAMERA.depth(model.mean[anchors])
    np.testing.assert_allclose([forward[opposite], forward[middle]], np.array([1, -1]) * (1 + GAP_MM), atol=0.2)


def test_arguments_are_not_written_to(model):
    anchors, px, *_ = crossed(model)
    copies = anchors.copy(), px.copy(), model.mean.copy()
    keep_rims_apart(model, CAMERA, model.mean, anchors, px, np.zeros(len(anchors), bool))
    for now, then in zip((anchors, px, model.mean), copies, strict=True):
        np.testing.assert_array_equal(now, then)
