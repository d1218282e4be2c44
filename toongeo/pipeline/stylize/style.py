"""How a style looks."""

from dataclasses import dataclass, replace

__all__ = ["STYLES", "Style"]


@dataclass(frozen=True)
class Style:
    """The appearance of a drawing; every value was chosen by eye on the astronaut, image_0010, takeo and renders.

    Attributes
    ----------
    tones : int
        Of the skin: 1 flat, 2 with shadow, 3 with light as well, more: soft.
    levels : int
        Of lightness outside the skin.
    palette : int
        Colours outside the skin; 0 keeps those of the picture.
    chroma : float
        Times the picture's.
    lift : float
        About how much lighter skin becomes, L*; never more than 3 above its median.
    shadow, light : (L*, a*, b*)
        Of the dark and the light tone of skin, relative to it.
    line : float
        Width of a line, face sizes.
    line_lightness : float
        Of lines, times that of the skin.
    eyes : float
        How far eyes are drawn anew: 0 as in the picture, 1 wholly.
    iris : float
        Its diameter, eye widths.
    lips, brows, blush, nose, crease, outlines : float
        Strength of what is drawn: lips, brows, red cheeks, lines of the nose, the line above the upper lid, and lines
        outside the face. A crease would wobble when a textured lid closes.
    shading : float
        How much of the photograph's own light is in the tones.
    flatness : float
        How flat the skin is: 1 only in tones.
    big_eyes : bool
        Irises as tall as the opening, in tall ellipses.
    exaggeration : float
        Of what is special about the face, as a part of its deviation from the mean face: a caricature has more than all
        of it, and styles that make faces alike give some back.
    brush : float
        Strength of brush marks along the flow.
    ink : bool
        Black and white, with hatching for shadow; then only line, eyes, iris and nose count.
    """

    tones: int = 3
    levels: int = 6
    palette: int = 10
    chroma: float = 1.25
    lift: float = 6.0
    shadow: tuple[float, float, float] = (-15.0, 5.0, 3.0)
    light: tuple[float, float, float] = (7.0, -2.0, 1.0)
    line: float = 0.011
    line_lightness: float = 0.17
    eyes: float = 1.0
    iris: float = 0.56
    lips: float = 0.75
    brows: float = 0.85
    blush: float = 0.25
    nose: float = 0.75
    crease: float = 0.5
    outlines: float = 1.0
    shading: float = 0.0
    flatness: float = 0.9
    big_eyes: bool = False
    exaggeration: float = 0.0
    brush: float = 0.0
    ink: bool = False

    def for_texture(self) -> "Style":
        """The variant that an avatar is textured with: no light, and no line that is wrong once lids close."""
        soft = self.tones > 3
        return replace(
            self,
            tones=self.tones if soft else 1,
            crease=0.0,
            nose=0.45,
            line=0.8 * self.line,
            shading=0.5 if soft else 0.3 * self.shading,
        )


STYLES = {
    "toon": Style(big_eyes=True, exaggeration=0.15),
    "chibi": Style(
        tones=2,
        levels=4,
        palette=8,
        lift=8.0,
        shadow=(-11.0, 6.0, 2.0),
        light=(4.0, -1.0, 0.0),
        line=0.012,
        iris=0.66,
        lips=0.35,
        brows=0.8,
        blush=0.55,
        nose=0.4,
        crease=0.0,
        chroma=1.35,
        flatness=1.0,
        outlines=0.7,
        big_eyes=True,
        exaggeration=0.4,
    ),
    "caricature": Style(
        exaggeration=1.3,
        shading=0.6,
        flatness=0.8,
        line=0.010,
        eyes=0.7,
        iris=0.48,
        lips=0.6,
        blush=0.15,
        chroma=1.15,
        lift=3.0,
        brows=0.7,
        levels=8,
        palette=16,
    ),
    "ink": Style(line=0.013, iris=0.5, lips=0.0, brows=0.0, ink=True),
    "painted": Style(
        tones=5,
        levels=10,
        palette=0,
        chroma=1.2,
        lift=4.0,
        line=0.006,
        eyes=0.6,
        iris=0.5,
        lips=0.5,
        brows=0.4,
        shading=1.0,
        flatness=0.45,
        outlines=0.0,
        blush=0.2,
        brush=1.0,
    ),
}
