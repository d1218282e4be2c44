# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 12 · Expression editing
#
# **How does a drawing smile, and stay the same drawing?**
#
# Lesson 10 makes a *head* smile. Here the *picture* shall: same paper, same lines, same hair, another expression. The
# method is that of Chen, Zheng, Cai and Zhang, *Modeling caricature expressions by 3D blendshape and dynamic
# texture*, 2020: geometry says where things go, and a second texture says what has to be painted that was not there.
# They train a network for the texture; the library does without, and one can be plugged in.

# %%
import matplotlib.pyplot as plt
import numpy as np

import toongeo as tg
from toongeo.model import data_path
from toongeo.render import interpolate, rasterize, sample_image, uv_to_px


def show(pictures, titles, *, rows=1, side=2.2, **options):
    """Pictures in rows, a title above each."""
    figure, axes = plt.subplots(rows, len(pictures) // rows, dpi=90, squeeze=False, layout="compressed")
    figure.set_size_inches(side * len(pictures) / rows, rows * (side + 0.3))
    for axis, picture, title in zip(axes.flat, pictures, titles, strict=True):
        axis.imshow(picture, **options)
        axis.set_title(title, fontsize=9)
        axis.axis("off")
    plt.show()


path = data_path("examples/portraits/moustache_man.png")
img, landmarks = tg.read_image(path), tg.read_landmarks(path.with_suffix(".pts"))
avatar = tg.make_avatar(img, landmarks, hair=False, texture_size=512)
face, rig, model = avatar.face, avatar.rig, avatar.face.model
low = np.maximum(landmarks.min(axis=0).astype(int) - [25, 60], 0)
CROP = np.s_[low[1] : int(landmarks[:, 1].max()) + 80, low[0] : int(landmarks[:, 0].max()) + 25]

# %% [markdown]
# ## First step: let the pixels travel
#
# The aligned mesh lies on the picture: each vertex $v$ has its pixel $\Pi v$. In the new expression it is at $v + d$,
# and its pixel at $\Pi(v + d)$. So for a pixel of the *new* picture we ask: which point of the moved skin is seen here,
# and where was that point in the *old* picture? Its colour is taken from there:
#
# $$ I'(\Pi(v + d)) = I(\Pi v) . $$
#
# In code: rasterise the moved mesh, interpolate the old pixels over it, and read the picture there.


# %%
def moved_vertices(weights):
    """The face of the picture (n, 3), moved by the difference to the expression that it shows."""
    return face.vertices + rig.vertices(weights) - rig.vertices(rig.pose)


def warped(weights):
    """The picture with its pixels moved along with the skin, and nothing else."""
    V = moved_vertices(weights)
    skin = face.faces[face.region("face")[face.faces].all(axis=1)]
    fragments = rasterize(np.column_stack([face.project(V), face.camera.depth(V)]), skin, *img.shape[:2])
    old = interpolate(fragments, skin, face.project(face.vertices))
    out = img.copy()
    out[fragments.mask] = np.rint(sample_image(img, old[fragments.mask]))
    return out


smile = {"mouthSmileLeft": 0.9, "mouthSmileRight": 0.9, "cheekSquintLeft": 0.5, "cheekSquintRight": 0.5}
surprise = {
    "jawOpen": 0.4,
    "browInnerUpLeft": 0.8,
    "browInnerUpRight": 0.8,
    "browOuterUpLeft": 0.8,
    "browOuterUpRight": 0.8,
}
show([img[CROP], warped(smile)[CROP], warped(surprise)[CROP]], ["the drawing", "smile", "surprise"], side=2.8)
still = np.abs(warped(dict(zip(rig.names, rig.pose, strict=True))).astype(int) - img).max()
print(f"without a change the warped picture differs by {still} of 255")

# %% [markdown]
# *Figure: The drawing of the man; his smile by moved pixels alone, good but for specks between the lips; and his
# surprise, with skin where the mouth should be open, and without the outline of its chin, which leaves the picture.*
#
# The smile nearly works: the skin is all there, it only moves. Lines stay lines, because nothing was painted. Surprise
# does not work, for two reasons. The mouth opens on something that *the picture never showed*. And what surrounds the
# face has to give way: the outline of the jaw is not skin, and stays behind.
#
# ## Second step: a texture that depends on the expression
#
# The texture $T$ of the head (lesson 8) holds the colours of the skin in the expression of the drawing. For a new
# expression we ask two things for each texel: *what* colour $C$ would be right, and *how far* the old one may be kept,
# the attention $A$ from 0 to 1. The new texture is (Eq. 12)
#
# $$ T^* = A \odot T + (1 - A) \odot C . $$
#
# **Attention.** Where nothing moves nothing changes, so $A = 1$. The paper's own "true" attention, on which its network
# is trained, is the displacement of the vertices, drawn into the atlas. We can just compute that: with a displacement
# of 3.5 % of the head's width nothing is kept.

# %%
V = moved_vertices(surprise)
geometry = tg.TextureGeometry(face.vertices, V, model.faces, model.uv, model.uv_faces)


def attention(source, target, size=256):
    """A (size, size) of the motion of vertices (n, 3), 1 between the islands of the atlas."""
    change = np.clip(np.linalg.norm(target - source, axis=1) / (0.035 * np.ptp(source[:, 0])), 0, 1)
    fragments = rasterize(uv_to_px(model.uv, size, size), model.uv_faces, size, size)
    return 1 - np.where(fragments.mask, interpolate(fragments, model.faces, change), 0)


ours = attention(face.vertices, V)
library = tg.attention_map(geometry, 256)
attention_gap = float(np.abs(ours - library).mean())
print(f"mean difference to tg.attention_map, which is smoothed a little: {attention_gap:.3f}")

# %% [markdown]
# **Colour.** `tg.ClassicalTextureGenerator` gives both. Its colours are the old texture in new light (skin that turns
# towards the light gets brighter: by the ratio of the shading of the new normals to that of the old, lesson 7), closed
# lids in the skin around them, and for what opens, teeth, tongue and the inside of the mouth from the template in the
# drawing's own palette.

# %%
texture = avatar.texture  # (512, 512, 3) uint8
generator = tg.ClassicalTextureGenerator(model, rig, texture)
weights = avatar.rig.weights(surprise)
colour, A = generator(texture, rig.pose, weights, geometry)
new = A[..., None] * texture + (1 - A[..., None]) * colour  # Eq. 12
compose_gap = float(np.abs(new - tg.compose_texture(texture, colour, A)).max())
assert compose_gap < 1e-3

unchanged = tg.TextureGeometry(face.vertices, face.vertices, model.faces, model.uv, model.uv_faces)
same_colour, same_attention = generator(texture, rig.pose, rig.pose, unchanged)
kept = float(np.abs(tg.compose_texture(texture, same_colour, same_attention) - texture).max())
print(f"with no change of expression the texture changes by {kept:.0f} of 255 at most")
HEAD = np.s_[:330, :]
maps = [texture, np.repeat(A[..., None], 3, axis=2), np.clip(colour, 0, 255) / 255, np.clip(new, 0, 255) / 255]
show([part[HEAD][::2, ::2] for part in maps], ["T", "A (white: keep)", "C", "T*"], side=2.6)

# %% [markdown]
# *Figure: Four atlases: the texture of the drawing; the attention, dark at mouth, chin and brows; the colours that
# should be there; and the mixture of both.*
#
# ## Third step: the neighbourhood gives way
#
# `tg.ExpressionEditor` puts it together. What the picture shows is taken from the picture; what it never showed from
# the new texture. Around the face the picture moves along and comes to rest a little farther out; beyond that, not one
# pixel is touched. The face is fitted once; each frame then takes a tenth of a second or two.

# %%
editor = tg.ExpressionEditor(img, landmarks, avatar=avatar)
looks = {
    "the drawing": None,
    "smile": smile,
    "surprise": surprise,
    "wink": tg.preset("wink"),
    "anger": tg.preset("anger"),
    "kiss": tg.preset("kiss"),
}
frames = {name: img if look is None else editor.frame(look) for name, look in looks.items()}
show([frame[CROP] for frame in frames.values()], frames, rows=2, side=2.8)

outside = ~editor.region
touched = max(int(np.abs(frame.astype(int) - img)[outside].max()) for frame in frames.values())
back = float((np.abs(editor.frame(editor.added({})).astype(int) - img).max(axis=2) > 8).mean())
print(f"outside of its region ({outside.mean():.0%} of the picture) an edit changes {touched} of 255")
print(f"with the expression of the drawing itself, {back:.2%} of the pixels change by more than 8 of 255")

# %% [markdown]
# *Figure: The drawing and five edits of it: smile, surprise with an open mouth, wink, anger and kiss, all in
# the lines and colours of the drawing.*
#
# The last number is not quite zero: the line between the lips is drawn anew, because the next moment it may open.
#
# ## Absolute or relative
#
# `frame(weights)` gives *that* expression, whatever the drawing shows. Often one wants *more*: `added` adds to what the
# picture shows and keeps each weight in [0, 1]. And the expression may be somebody else's: a fitted photograph lends
# its own.

# %%
path = data_path("examples/portraits/astronaut.png")
photo = tg.read_image(path)
lender = tg.fit_3dmm(photo, tg.read_landmarks(path.with_suffix(".pts")))
lent = lender.expression_weights()
strongest = sorted(lent, key=lent.get, reverse=True)[:4]
print("the astronaut's strongest:", ", ".join(f"{name} {lent[name]:.1f}" for name in strongest))
results = [editor.frame(editor.added(smile)), editor.frame(lender)]
show(
    [photo[50:280, 120:330], *(frame[CROP] for frame in results)],
    ["astronaut", "the man, more smile", "hers, lent"],
    side=2.8,
)

# %% [markdown]
# *Figure: The photograph of the smiling astronaut; the man with a smile added to his own expression; and the man with
# the astronaut's smile, teeth showing.*
#
# ## A texture generator of your own
#
# Colour and attention are a small protocol, `tg.TextureGenerator`: any function of texture, source weights, target
# weights and geometry that returns $C$ and $A$. A network would go here. So does a blush: the more smile, the redder
# the cheeks.


# %%
def blush(texture, source, target, geometry):
    """The stronger the smile, the redder the cheeks; everything else stays."""
    smiling = max(target[rig.names.index(f"mouthSmile{side}")] for side in ("Left", "Right"))
    cheeks = (model.region("cheek_left") | model.region("cheek_right")).astype(float)
    centre = [geometry.source[model.region(f"cheek_{side}")].mean(axis=0) for side in ("left", "right")]
    near = np.max([np.exp(-(((geometry.source - c) / 16) ** 2).sum(axis=1)) for c in centre], axis=0) * cheeks
    size = len(texture)
    fragments = rasterize(uv_to_px(geometry.uv, size, size), geometry.uv_faces, size, size)
    amount = np.where(fragments.mask, interpolate(fragments, geometry.faces, near), 0)
    red = np.broadcast_to(np.float32([225, 70, 60]), texture.shape)
    return red, (1 - 0.8 * np.clip(smiling, 0, 1) * amount).astype(np.float32)


shy = tg.ExpressionEditor(img, landmarks, avatar=avatar, generator=blush)
halves = [shy.frame({"mouthSmileLeft": w, "mouthSmileRight": w}) for w in (0.0, 0.5, 1.0)]
show([frame[CROP] for frame in halves], ["smile 0", "smile 0.5", "smile 1"], side=2.8)

# %% [markdown]
# *Figure: Three edits by a generator of our own: the more the man smiles, the redder his cheeks.*
#
# ## Exercises
#
# 1. How many pixels does a wink change? And how many of them lie on the other half of the face?
# 2. Landmarks of an edited picture are known without looking for them: `editor.landmarks(weights)`. Show that they move
#    on straight lines, at even speed, as a weight goes from 0 to 1. Why?
# 3. Write a generator that keeps everything ($A = 1$), and open the jaw. Where do the teeth come from now?
#
# ## Solutions

# %%
# 1. Pixels that differ from the drawing with its expression, left and right of the nose's bridge in the picture.
rest = editor.frame(editor.added({}))
wink = editor.frame(editor.added({"eyeBlinkLeft": 1.0}))
changed = (np.abs(wink.astype(int) - rest).max(axis=2) > 2).nonzero()
other = float((changed[1] < landmarks[27, 0]).mean())  # his right is on the left of the picture
print(f"{len(changed[0])} of {img.shape[0] * img.shape[1]} pixels, {other:.0%} of them on the other half")

# %%
# 2. Vertices are a sum of displacements times weights, and this camera only multiplies and shifts (lesson 4): so pixels
#    are a sum of displacements times weights, too.
steps = np.linspace(0, 1, 5)
tracks = np.array([editor.landmarks({"mouthSmileLeft": w, "jawOpen": 0.5 * w}) for w in steps])
even = float(np.abs(np.diff(tracks, axis=0) - (tracks[-1] - tracks[0]) / 4).max())
corner = tracks[-1, 54] - tracks[0, 54]
print(
    f"uneven by less than a thousandth of a pixel: {even < 1e-3}; the corner of the mouth moves by {corner.round(0)} px"
)


# %%
# 3. From the texture that was baked: where lips part the editor itself uses it, whatever the generator says.
def keep(texture, source, target, geometry):
    """Nothing changes."""
    return texture, np.ones(texture.shape[:2], np.float32)


kept_frame = tg.ExpressionEditor(img, landmarks, avatar=avatar, generator=keep).frame(surprise)
difference = float(np.abs(kept_frame.astype(float) - frames["surprise"]).max(axis=2)[editor.region].mean())
show([frames["surprise"][CROP], kept_frame[CROP]], ["classical generator", "A = 1"], side=2.8)
print(f"mean difference in the region: {difference:.1f} of 255")

# %% [markdown]
# *Figure: The surprised man twice, with the classical generator and with one that keeps the old texture: both mouths
# are open, and the first is darker inside.*

# %%
numbers: dict[str, float] = {
    "warp_still": float(still),
    "attention_gap": attention_gap,
    "compose_gap": compose_gap,
    "texture_kept": kept,
    "touched_outside": touched,
    "back_to_the_drawing": back,
    "outside_share": float(outside.mean()),
    "wink_pixels": len(changed[0]),
    "wink_other_half": other,
    "uneven_px": even,
    "corner_up_px": float(-(editor.landmarks(smile)[48, 1] - editor.landmarks(editor.added({}))[48, 1])),
    "keep_difference": difference,
    "blush": float(
        halves[2][..., 0].mean() - halves[2][..., 1].mean() - halves[0][..., 0].mean() + halves[0][..., 1].mean()
    ),
}
