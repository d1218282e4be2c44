"""Skin in two or three tones, by the fitted light."""

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.stylize.appearance.pixels import antialiased, enlarged, soft_step
from toongeo.pipeline.stylize.appearance.subject import Subject
from toongeo.pipeline.stylize.style import Style

__all__ = ["skin_tone", "toned_skin"]

_AIM = 74.0  # L*: darker skin is lifted by a part of the distance, lighter skin by the least
_PART = 0.35
_MOST = 3.0  # L* above the photograph's skin: dark skin stays dark
_LIGHTEST = 92.0
_DARK, _BRIGHT = -0.75, 0.85  # of the shading, at which tones change
_PHOTO_SPREAD = 22.0  # L* from the median that counts as much as one unit of shading
_SOFT = 0.5  # of the step between tones, where they are soft
_KEPT = 0.85  # of what is no skin where beards grow
_FLAT_EDGE = 0.006  # of shading a pixel


@dataclass(frozen=True, eq=False)
class _Shading:
    dark: Singles
    bright: Singles
    mix: Singles


def skin_tone(subject: Subject, style: Style) -> Singles:
    """The skin's one colour (3,), CIELAB: its lighter half's, a little lighter and more colourful."""
    lit = subject.skin.lit
    lift = np.clip(_PART * (_AIM - lit[0]), 0.5 * style.lift, 1.6 * style.lift)
    lightness = min(lit[0] + lift, subject.skin.lightness + _MOST, _LIGHTEST)
    return np.array([lightness, *(lit[1:] * style.chroma)], np.float32)


def toned_skin(subject: Subject, style: Style) -> Singles:
    """Colours (h, w, 3) of the skin's box, CIELAB."""
    tone = skin_tone(subject, style)
    shading = _shading(subject, style)
    neutral = np.array([1, 0, 0] if subject.grey else [1, 1, 1], np.float32)
    flat = tone + shading.dark[..., None] * (neutral * np.array(style.shadow, np.float32))
    flat += shading.bright[..., None] * (neutral * np.array(style.light, np.float32))
    if style.tones > 3:
        flat[..., 0] += 5 * np.clip(shading.mix, -1.5, 1.5)
    own = subject.lab[subject.skin_box] * np.array([1, style.chroma, style.chroma], np.float32)
    own[..., 0] += tone[0] - subject.skin.lit[0]
    flatness = np.float32(style.flatness) * (1 - np.float32(_KEPT) * subject.unexplained[subject.skin_box])
    return np.asarray(own + flatness[..., None] * (flat - own))


def _shading(subject: Subject, style: Style) -> _Shading:
    """Covers of the dark and the bright tone, and the shading that they come from."""
    box = subject.skin_box
    photo = np.clip((subject.lab[box][..., 0] - subject.skin.median[0]) / _PHOTO_SPREAD, -1.5, 1.2)
    share = 0.0 if style.tones <= 2 else (0.35 + 0.65 * style.shading) * (1.0 if style.shading else 0.6)
    mix = (1 - 0.5 * style.shading) * enlarged(subject.light.shade, subject.shape)[box] + np.float32(share) * photo
    mix = np.asarray(mix, np.float32)
    if style.tones > 3:
        return _Shading(soft_step(np.float32(_DARK) - mix, _SOFT), soft_step(mix - np.float32(_BRIGHT), _SOFT), mix)
    none = np.zeros_like(mix)
    dark = antialiased(np.float32(_DARK) - mix, _FLAT_EDGE) if style.tones > 1 else none
    bright = antialiased(mix - np.float32(_BRIGHT), _FLAT_EDGE) if style.tones > 2 else none
    return _Shading(dark, bright, mix)
