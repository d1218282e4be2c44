import numpy as np

from toongeo.pipeline.texture.slant_limits import slant_limits


def test_the_sides_of_a_face_must_be_seen_more_squarely_than_its_middle(model):
    low, high = slant_limits(model)
    assert (low < high).all()
    np.testing.assert_allclose([low[model.region("lips")].max(), high[model.region("nose")].max()], [0.15, 0.45])
    sides = np.abs(model.mean[:, 0]) > np.abs(model.mean[model.landmarks[[36, 45]], 0]).max()
    np.testing.assert_allclose([low[sides].min(), high[sides].min()], [0.3, 0.65])
    np.testing.assert_allclose(high, high[model.mirror], atol=1e-6)
