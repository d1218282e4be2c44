import numpy as np
import pytest

from toongeo.geometry.mirror_partners import mirror_partners
from toongeo.geometry.rotations.rotation_exp import rotation_exp


@pytest.mark.parametrize("turn", [(0, 0, 0), (0.2, 0.4, -0.1), (-1.5, 0.3, 0.6)])
def test_a_symmetric_mesh_anywhere_has_its_twins(model, turn):
    """Whatever its frame, unit and place, the partners are those of the template."""
    moved = 0.02 * model.mean @ rotation_exp(np.array(turn, float)).T + [3, -7, 50]
    partners = mirror_partners(moved)
    np.testing.assert_array_equal(partners, model.mirror)


def test_noise_and_a_missing_piece_leave_the_plane(model):
    """As in a scan: partners are near to where the plane of the face has them."""
    rng = np.random.default_rng(0)
    kept = ~((model.mean[:, 0] > 30) & (model.mean[:, 1] > 40))
    V = model.mean[kept] + rng.normal(0, 0.3, (kept.sum(), 3))
    partners = mirror_partners(V)
    both = np.abs(V[:, 0]) < 30
    away = np.linalg.norm(V[partners][both] - V[both] * [-1, 1, 1], axis=1)
    assert np.median(away) < 2.0


def test_what_has_no_sides_has_no_partners():
    t = np.linspace(0, 1, 500)
    snail = np.column_stack([t * np.cos(9 * t), 0.6 * t**2 * np.sin(9 * t), t + 0.2 * np.sin(4 * t)])
    assert mirror_partners(snail) is None
    assert mirror_partners(np.zeros((9, 3))) is None
