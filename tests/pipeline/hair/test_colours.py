import numpy as np
import pytest

from toongeo.pipeline.hair.colours.other_side import other_side
from toongeo.pipeline.hair.colours.picture_colours import PictureColours, picture_colours
from toongeo.pipeline.hair.colours.quilted import quilted
from toongeo.pipeline.hair.colours.strand_frame import StrandFrame
from toongeo.pipeline.hair.colours.strand_patches import strand_patches
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane


def test_quilt_is_made_of_patches(rng):
    """Each pixel is one of the patches' at the same place modulo the step, never a mixture."""
    patches = rng.integers(0, 255, (7, 8, 8, 3)).astype(np.float32)
    texture = quilted(patches, (33, 50), 2, rng)
    assert texture.shape == (33, 50, 3)
    known = {tuple(p) for p in patches.reshape(-1, 3)}
    assert {tuple(p) for p in texture.reshape(-1, 3)} <= known


def test_quilt_continues_stripes(rng):
    """Upright stripes, cut anywhere, are put together without a break."""
    wave = np.sin(np.arange(200) * 2 * np.pi / 10).astype(np.float32)
    picture = np.repeat(wave[None], 200, 0)[..., None] * 100
    patches = np.stack([picture[:20, k : k + 20] for k in range(40)])
    texture = quilted(patches, (60, 90), 6, rng)[..., 0]
    assert np.abs(np.diff(texture, axis=0)).max() < 15
    assert np.abs(np.diff(texture, axis=1)).max() < 100 * 2 * np.pi / 10 + 15


def test_ground_that_shows_between_curls_is_not_the_colour_of_hair():
    """Blue flecks along the edge of brown hair before a blue wall are left out, dark ones of the hair itself stay."""
    plane = WorkingPlane(np.eye(3), np.eye(2), 1.0, np.array([0.0, 79.0]), np.zeros(2), (64, 64))
    y, x = np.mgrid[:80, :80]
    inside = (30 - np.hypot(*np.mgrid[-32:32, -32:32])) * 1.25
    deep = plane.scale * (30 * 1.25 - np.hypot(x - 40, (79 - y) - 40))
    img = np.where((deep > 0)[..., None], (120, 70, 30), (40, 90, 200)).astype(np.uint8)
    img[(deep > 0) & (x % 12 < 3)] = 70, 40, 20
    flecks = (deep > 3) & (deep < 7) & (np.arctan2(79 - y - 40, x - 40) % 0.5 < 0.15)
    img[flecks] = 40, 90, 200
    colours = picture_colours(plane, img, inside, np.abs(inside), 1.0)
    warped = plane.warp(flecks.astype(np.float32), colours.cell_mm) > 0.9
    strands = plane.warp(((deep > 8) & (x % 12 == 1)).astype(np.float32), colours.cell_mm) > 0.9
    assert warped.sum() > 50 and strands.sum() > 50
    assert not colours.known[warped].any() and colours.known[strands].mean() > 0.95
    assert (colours.drawn[warped][:, 0] > colours.drawn[warped][:, 2]).mean() > 0.95


def turned(degrees):
    """A plane whose viewer stands on the subject's left by so many degrees."""
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    rotation = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
    return WorkingPlane(rotation, np.eye(2), 1.0, np.zeros(2), np.zeros(2), (9, 9))


@pytest.mark.parametrize("degrees", [25.0, -25.0])
def test_the_hidden_side_is_told_what_the_other_side_shows(degrees, rng):
    """Far off the middle wholly, on the side that is seen not at all; twice mirrored is where it was."""
    plane, model = turned(degrees), rng.uniform(-90, 90, (200, 3))
    points = plane.of(model)
    mirrored, hidden = other_side(plane, points)
    np.testing.assert_allclose(plane.back(mirrored), model * [-1, 1, 1], atol=1e-9)
    np.testing.assert_allclose(other_side(plane, mirrored)[0], points, atol=1e-9)
    beyond = -np.sign(degrees) * model[:, 0]
    assert (hidden[beyond > 25] == 1).all() and (hidden[beyond <= 0] == 0).all()
    assert ((hidden > 0) & (hidden < 1)).any()


def test_a_head_seen_from_before_hides_no_side(rng):
    assert not other_side(turned(8.0), rng.uniform(-90, 90, (50, 3)))[1].any()


def test_strands_run_down_and_nothing_is_squeezed_at_the_crown():
    frame = StrandFrame(np.zeros(3), 90.0)
    down = np.array([[90.0, -10.0, 0.0], [90.0, -50.0, 0.0]])
    across, along = frame.at(down)
    assert along[1] - along[0] > 30
    # A step across the crown is about as long on the map; on a globe's map it would be endless.
    c, s = np.cos(np.deg2rad(20)), np.sin(np.deg2rad(20))
    crown = 90 * np.array([0.0, c, -s])
    across, along = frame.at(np.array([crown, crown + [5.0, 0, 0]]))
    assert 5.0 <= np.hypot(across[1] - across[0], along[1] - along[0]) <= 10.0
    assert 0 <= across.min() <= across.max() <= frame.breadth


def test_grain_becomes_strands_of_its_own_contrast(rng):
    """White noise 2 mm apart along strands becomes alike; 3 mm apart across them it stays unlike."""
    noise = (128 + 20 * rng.standard_normal((120, 120, 1))).repeat(3, 2).astype(np.float32)
    flat = np.full_like(noise, 128)
    inside = np.full(noise.shape[:2], 40, np.float32)
    colours = PictureColours(noise, flat, flat, inside > 0, inside, 1.0)
    patches = strand_patches(colours, 1.0, rng)[..., 0]
    patches -= patches.mean((1, 2), keepdims=True)
    power = (patches**2).mean()
    assert (patches[:, 2:] * patches[:, :-2]).mean() > 0.6 * power
    assert abs((patches[:, :, 3:] * patches[:, :, :-3]).mean()) < 0.15 * power
    assert 10 < power**0.5 < 22
