import numpy as np

from toongeo.pipeline.landmarks.looks_photographed import looks_photographed


def test_size_and_tilt_make_no_difference(cartoon):
    img, points = cartoon("astronaut")
    assert looks_photographed(img[::2, ::2], (points - 0.5) / 2 + 0.25)
    turned = np.column_stack([points[:, 1], img.shape[1] - 1 - points[:, 0]])
    assert looks_photographed(np.ascontiguousarray(np.rot90(img)), turned)
