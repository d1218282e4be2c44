import numpy as np

from toongeo.pipeline.hair.colours.picture_colours import PictureColours
from toongeo.pipeline.hair.colours.quilted import quilted
from toongeo.pipeline.hair.colours.strand_frame import StrandFrame
from toongeo.pipeline.hair.colours.strand_patches import strand_patches


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
