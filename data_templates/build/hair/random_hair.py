"""Hair of many kinds on a random head: where it is, before and behind the head, and how it looks."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from noise import Floats, Rng, chance, clouds, smooth_field, wavy
from random_head import Head, Mask

__all__ = ["HairShape", "hair_colour", "random_hair", "strands"]

# sRGB; natural colours from black to white, then dyed ones
_COLOURS = np.array(
    [
        [22, 19, 18],
        [48, 33, 24],
        [84, 56, 34],
        [122, 84, 48],
        [168, 130, 80],
        [216, 188, 130],
        [150, 148, 146],
        [226, 224, 220],
        [140, 62, 28],
        [196, 96, 40],
    ],
    float,
)
_SHARES = np.array([0.2, 0.15, 0.12, 0.1, 0.09, 0.09, 0.08, 0.08, 0.05, 0.04])


def hair_colour(rng: Rng, drawn: bool, skin: Floats) -> Floats:
    """sRGB (3,), 0-255; natural, dyed, or near the colour of the skin (3,), where outlines are hard to tell."""
    if chance(rng, 0.16):
        return np.clip(skin * rng.uniform(0.45, 1.0) + rng.normal(0, 10, 3), 3, 250).astype(np.float32)
    if chance(rng, 0.22 if drawn else 0.03):
        return np.asarray(rng.uniform(0, 255, 3), np.float32)
    colour = _COLOURS[rng.choice(len(_COLOURS), p=_SHARES)] * rng.uniform(0.75, 1.15) + rng.normal(0, 5, 3)
    return np.clip(colour, 3, 250).astype(np.float32)


@dataclass(frozen=True, eq=False)
class HairShape:
    """Hair on and around the head, and behind head and neck, (h, w) bool; how curly it is, in [0, 1], and how
    broad (px) its hairline fades."""

    front: Mask
    behind: Mask
    curl: float
    fade: float

    @property
    def any(self) -> bool:
        return bool(self.front.any() or self.behind.any())

    def below(self, up: Floats, rim: float) -> HairShape:
        """What a hat leaves: the hair under a height of the head frame."""
        return HairShape(self.front & (up < rim), self.behind & (up < rim), self.curl, self.fade)


_KINDS = {
    "bald": 0.07,
    "horseshoe": 0.04,
    "cropped": 0.17,
    "short": 0.26,
    "quiff": 0.1,
    "bob": 0.11,
    "long": 0.17,
    "curly": 0.08,
}


def random_hair(rng: Rng, head: Head, exaggeration: float) -> HairShape:
    """A random kind of hair; bald heads and bare crowns among them."""
    kind = str(rng.choice(list(_KINDS), p=list(_KINDS.values())))
    empty = np.zeros(head.seen.shape, bool)
    if kind == "bald":
        return HairShape(empty, empty, 0.0, 1.0)
    long = kind in ("bob", "long")
    line = _hairline(rng, head, kind)
    on_head = head.seen & ~head.neck & (head.height > line)
    if kind == "horseshoe":
        on_head &= np.abs(head.turn) > rng.uniform(0.75, 1.3)
        on_head &= head.height < rng.uniform(55, 95)
    if not (long or chance(rng, 0.3)):
        on_head &= ~head.ears
    outside = _crown(rng, head, kind, exaggeration)
    front = on_head | (outside & ~head.seen)
    behind = empty.copy()
    if long:
        curtain, back = _curtains(rng, head, kind)
        front |= curtain
        behind |= back
    elif chance(rng, 0.35):  # the nape
        low = (head.up < 0.05) & (head.up > -rng.uniform(0.35, 0.75))
        behind |= low & (np.abs(head.across) < rng.uniform(0.2, 0.36))
    if kind != "horseshoe":
        _locks(rng, head, front, kind)
    _buns(rng, head, front, behind, kind)
    curl = 1.0 if kind == "curly" or chance(rng, 0.1) else float(rng.uniform(0, 0.5))
    return HairShape(front, behind, curl, float(rng.uniform(0.8, 5)) if kind == "cropped" else 1.0)


def _hairline(rng: Rng, head: Head, kind: str) -> Floats:
    """Height (mm, on the template) above which there is hair, at each pixel of the head."""
    turn = np.abs(head.turn)
    front = rng.uniform(52, 84) if chance(rng, 0.68) else rng.uniform(22, 52)
    line = front + rng.normal(0, 9) * head.turn
    if chance(rng, 0.35):  # receding temples
        line = line + rng.uniform(5, 35) * np.exp(-0.5 * ((turn - rng.uniform(0.45, 0.75)) / 0.18) ** 2)
    if chance(rng, 0.3):  # a fringe that parts
        away = (head.turn - rng.normal(0, 0.3)) / rng.uniform(0.1, 0.4)
        line = line + rng.uniform(5, 45) * np.exp(-0.5 * away**2)
    low = rng.uniform(-45, 25) if kind not in ("bob", "long") else rng.uniform(-120, -40)
    at, soft = rng.uniform(0.8, 1.2), rng.uniform(0.03, 0.12)
    share = 1 / (1 + np.exp(-(turn - at) / soft))
    teeth = wavy(rng, head.turn * rng.uniform(2, 9), 6, 0.85) * rng.choice([0, 3, 9], p=[0.35, 0.4, 0.25])
    grain = smooth_field(rng, head.seen.shape, 60) * rng.uniform(0, 3)
    return (line * (1 - share) + low * share + teeth + grain).astype(np.float32)


def _crown(rng: Rng, head: Head, kind: str, exaggeration: float) -> Mask:
    """Hair (h, w) bool that stands off the skull, above some height; covers the skull too."""
    away = cv2.distanceTransform((~head.skull).astype(np.uint8), cv2.DIST_L2, 5) / head.size
    angle = np.arctan2(head.across, head.up)  # 0 at the crown
    thin = {"cropped": (0.0, 0.025), "horseshoe": (0.0, 0.07), "curly": (0.1, 0.42)}.get(kind, (0.02, 0.16))
    thick = np.full(away.shape, rng.uniform(*thin), np.float32)
    thick *= 1 + rng.uniform(0, 0.5) * wavy(rng, angle, 5)
    thick *= np.clip(1 + rng.uniform(-0.3, 1.2) * np.cos(angle), 0.2, None)
    if kind == "quiff" or (kind == "short" and chance(rng, 0.3 + 0.3 * exaggeration)):
        place, width = rng.normal(0, 0.45), rng.uniform(0.25, 0.8)
        thick += rng.uniform(0.08, 0.25 + 0.3 * exaggeration) * np.exp(-0.5 * ((angle - place) / width) ** 2)
    if kind == "horseshoe":
        thick *= np.clip((np.abs(angle) - rng.uniform(0.5, 0.9)) * 4, 0, 1)
    if chance(rng, 0.6):  # a jagged rim
        frequency = rng.uniform(8, 30)
        saw = np.abs((angle * frequency / np.pi + rng.random() + 0.3 * wavy(rng, angle, 8)) % 2 - 1)
        thick += saw.astype(np.float32) * rng.uniform(0.01, 0.09 if kind != "cropped" else 0.012)
    thick += smooth_field(rng, away.shape, 90) * rng.uniform(0, 0.012)
    reach = rng.uniform(1.35, 2.1) if kind not in ("bob", "long") else 1.9
    return (away < thick) & (np.abs(angle) < reach)


def _curtains(rng: Rng, head: Head, kind: str) -> tuple[Mask, Mask]:
    """Long hair: beside and before the cheeks, and behind the neck."""
    length = rng.uniform(0.35, 0.7) if kind == "bob" else rng.uniform(0.7, 1.6)
    half = float(np.abs(head.across[head.skull]).max())
    down = np.clip(-head.up, 0, None)
    shape = head.seen.shape
    front, back = np.zeros(shape, bool), np.zeros(shape, bool)
    flare, wave = rng.normal(0.08, 0.18), rng.uniform(0, 0.06)
    for side in (-1, 1):
        x = side * head.across
        end = length * (1 + rng.normal(0, 0.08) + rng.uniform(-0.3, 0.3) * (x - half))
        end = end + 0.05 * wavy(rng, x * rng.uniform(10, 60), 4, 0.8) * rng.uniform(0, 1)
        outer = half * rng.uniform(1.02, 1.5) + flare * down + wave * wavy(rng, down * rng.uniform(3, 12), 3)
        outer *= np.clip((end - down) / 0.25, 0, 1) ** rng.uniform(0.05, 0.5)
        reach = (head.up < rng.uniform(0.1, 0.35)) & (down < end)
        inner = half * rng.uniform(0.62, 1.05) + rng.uniform(-0.1, 0.2) * down + 0.02 * wavy(rng, down * 9, 3)
        if chance(rng, 0.75):
            front |= reach & (x > inner) & (x < outer)
        back |= reach & (x >= 0) & (x < outer)
    return front, back


def _locks(rng: Rng, head: Head, front: Mask, kind: str) -> None:
    """Tapered locks over forehead and outline, in place."""
    canvas = front.astype(np.uint8)
    count = int(rng.integers(0, 16)) if kind != "cropped" else 0
    lean = rng.normal(0, 0.12)
    for _ in range(count):
        if chance(rng, 0.6):  # of the fringe
            a = rng.uniform(-0.3, 0.3)
            root = np.array([a, rng.uniform(0.16, 0.34)])
            tip = root + [lean + rng.normal(0, 0.05), -rng.uniform(0.08, 0.3)]
        else:  # off the outline
            angle = rng.uniform(-1.7, 1.7)
            way = np.array([np.sin(angle), np.cos(angle)])
            root, tip = 0.34 * way, rng.uniform(0.42, 0.65) * way + [rng.normal(0, 0.08), -rng.uniform(0, 0.12)]
        breadth = rng.uniform(0.02, 0.09)
        side = np.array([tip[1] - root[1], root[0] - tip[0]])
        side *= breadth / max(float(np.linalg.norm(side)), 1e-6)
        middle = (root + tip) / 2 + rng.normal(0, 0.03, 2)
        ring = head.place(np.array([root - side, middle - 0.7 * side, tip, middle + 0.7 * side, root + side]))
        cv2.fillPoly(canvas, [np.rint(ring * 8).astype(np.int32)], 1, shift=3)
    allowed = ~(head.face & (head.height < -30))
    front |= (canvas > 0) & allowed


def _buns(rng: Rng, head: Head, front: Mask, behind: Mask, kind: str) -> None:
    """A bun on the crown, bunches, or a pony tail, in place."""
    if kind in ("cropped", "horseshoe") or not chance(rng, 0.13):
        return
    canvas = np.zeros(front.shape, np.uint8)
    style = rng.integers(3)
    if style == 0:
        places = [(rng.normal(0, 0.12), rng.uniform(0.42, 0.6))]
        radius = rng.uniform(0.1, 0.24)
        for place in places:
            x, y = head.place(np.array([place]))[0]
            cv2.circle(canvas, (int(x), int(y)), int(radius * head.size), 1, -1)
    else:
        for side in (-1, 1) if style == 1 else (rng.choice([-1, 1]),):
            t = np.linspace(0, 1, 12)
            path = np.column_stack([side * (0.33 + 0.25 * np.sin(2.2 * t)), 0.2 - rng.uniform(0.5, 1.2) * t**1.3])
            breadth = rng.uniform(0.07, 0.16) * np.sin(np.pi * (0.15 + 0.8 * t)) * head.size
            for (x, y), r in zip(head.place(path), breadth, strict=True):
                cv2.circle(canvas, (int(x), int(y)), max(2, int(r)), 1, -1)
    behind |= canvas > 0


def strands(rng: Rng, head: Head, hair: Floats, curl: float, drawn: bool) -> Floats:
    """The look of hair (h, w, 3), 0-255, everywhere: fibres that run down from the crown, locks, shine and shade."""
    shape = head.seen.shape
    root = rng.uniform(0.0, 0.9)
    x, y = head.across - rng.normal(0, 0.08), head.up - 0.35
    warp = clouds(rng, shape, 0.6)
    x = x + curl * 0.05 * warp + rng.uniform(0, 0.02) * np.sin(y * rng.uniform(10, 50))
    turn = np.arctan2(x, np.abs(y - root) + 0.05) if root > 0.15 else np.arctan2(x, -y)
    along = np.hypot(x, y - root)
    sheet = rng.normal(size=(16, 512)).astype(np.float32)
    fine = cv2.GaussianBlur(sheet, (0, 0), sigmaX=rng.uniform(0.4, 1.2), sigmaY=2.0)
    broad = cv2.GaussianBlur(sheet, (0, 0), sigmaX=rng.uniform(2, 6), sigmaY=2.0)
    u = ((turn / (2 * np.pi) + 0.5) * rng.uniform(400, 1100) % 511).astype(np.float32)
    v = (along * rng.uniform(4, 14) % 15).astype(np.float32)
    fibres = cv2.remap(fine / fine.std(), u, v, cv2.INTER_LINEAR)
    locks = cv2.remap(broad / broad.std(), u, v, cv2.INTER_LINEAR)
    if curl > 0.7:
        locks, fibres = clouds(rng, shape, 0.95), smooth_field(rng, shape, 100)
    depth = rng.uniform(0, 0.1) if drawn and chance(rng, 0.6) else rng.uniform(0.03, 0.3)
    tone = 1 + depth * (0.7 * fibres + rng.uniform(0.1, 0.8) * locks)
    shine = np.exp(-0.5 * ((along - rng.uniform(0.2, 0.9)) / rng.uniform(0.05, 0.2)) ** 2) * rng.uniform(0, 1)
    tone *= 1 - rng.uniform(0, 0.4) * np.clip(-head.up, 0, 1)
    tone *= 1 + rng.normal(0, 0.5) * head.across * (not drawn)
    if drawn and chance(rng, 0.5):
        steps = rng.integers(1, 4)
        tone, shine = np.round(tone * steps) / steps, (shine > 0.45) * 0.8
    colour = hair * np.clip(tone, 0.15, 2.2)[..., None]
    light = 60 * rng.uniform(0, 1) + 0.5 * hair
    return np.clip(colour + (shine * np.clip(0.5 + 0.3 * fibres, 0, 1))[..., None] * light, 0, 255).astype(np.float32)
