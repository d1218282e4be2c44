"""The colours of lines and features of one drawing."""

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.stylize.appearance.skin_tones import skin_tone
from toongeo.pipeline.stylize.appearance.subject import Subject
from toongeo.pipeline.stylize.strokes.canvas import colour
from toongeo.pipeline.stylize.style import Style

__all__ = ["Pens", "pens_of"]

_INK = (18.0, 16.0, 20.0)  # RGB: a black that is not harder than print
_PAPER_TONE = (96.0, 0.0, 0.0)  # CIELAB of skin that is paper


@dataclass(frozen=True, eq=False)
class Pens:
    """What features are drawn with.

    Attributes
    ----------
    width : float, px
        Of a line.
    line : (3,) RGB in 0..255
    tone : (3,) CIELAB
        Of the skin.
    hue : float
        0 in pictures without colour, else 1: times every a* and b* that is not the picture's.
    light_side : float
        1 if light comes from the right of the picture, else -1.
    """

    width: float
    line: Singles
    tone: Singles
    hue: float
    light_side: float

    def colour(self, lightness: float, a: float = 0.0, b: float = 0.0) -> Singles:
        """RGB of a colour; grey in grey pictures."""
        return colour(lightness, self.hue * a, self.hue * b)


def pens_of(subject: Subject, style: Style) -> Pens:
    """Lines are a dark tone of the skin; those of ink are black."""
    width, side = style.line * subject.size, 1.0 if subject.light.from_right else -1.0
    if style.ink:
        return Pens(width, np.array(_INK, np.float32), np.array(_PAPER_TONE, np.float32), 0.0, side)
    tone = skin_tone(subject, style)
    line = colour(tone[0] * style.line_lightness, 0.8 * tone[1], 0.5 * tone[2])
    return Pens(width, line, tone, 0.0 if subject.grey else 1.0, side)
