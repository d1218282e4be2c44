# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 10 · Rigging expressions
#
# **How many knobs does a face need, what are they called, and what must they never do?**
#
# A *rig* is what an animator holds in the hand: a few dozen knobs that move 19 000 vertices. This lesson looks at the
# 46 of the library, gives them the names that anatomists use, mixes them, reads them off a face again, and then turns
# to the two places where a sum of displacements is not enough: lips and lids that must meet, and eyes that must turn.

# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import lsq_linear
from scipy.spatial.transform import Rotation

import toongeo as tg
from toongeo.model import data_path
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh


def show(pictures, titles, *, rows=1, side=2.2, fontsize=9):
    """Pictures in rows, a title above each."""
    figure, axes = plt.subplots(rows, len(pictures) // rows, dpi=90, squeeze=False, layout="compressed")
    figure.set_size_inches(side * len(pictures) / rows, rows * (side + 0.3))
    for axis, picture, title in zip(axes.flat, pictures, titles, strict=True):
        axis.imshow(picture)
        axis.set_title(title, fontsize=fontsize)
        axis.axis("off")
    plt.show()


portrait = data_path("examples/portraits/moustache_man.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
avatar = tg.make_avatar(img, landmarks, hair=False, texture_size=512)
rig, model = avatar.rig, avatar.face.model
print(f"{len(rig.names)} expressions of {len(rig.neutral)} vertices: deltas {rig.deltas.shape}")

# %% [markdown]
# ## A rig is a matrix
#
# The face at rest is $S_0$. Each expression $j$ is an array of displacements $d_j$, one for each vertex: where the full
# expression is, minus the face at rest. They are called *blendshapes*. With weights $\beta_j$ the face is
#
# $$ S = S_0 + \sum_j \beta_j\, d_j = S_0 + B\,\beta . $$
#
# Lesson 9 shows where the $d_j$ of this head come from. The sum in numpy is the library's `avatar.vertices`.

# %%
weights = {"jawOpen": 0.4, "mouthSmileLeft": 0.8, "browOuterUpLeft": 1.0}
beta = np.array([weights.get(name, 0.0) for name in rig.names])
by_hand = rig.neutral + np.einsum("j,jvx->vx", beta, rig.deltas)
sum_gap = np.abs(by_hand - avatar.vertices(weights)).max()
assert sum_gap < 1e-4  # mm; displacements are kept in single precision

# %% [markdown]
# What does each knob move? Here is the whole rig on one page: for each expression the length of its displacements, as a
# colour on the skin. The darkest place of each picture moves farthest.


# %%
def heat(delta, side=84):
    """The face at rest, darker where an expression moves it."""
    length = np.linalg.norm(delta, axis=1)
    share = (length / length.max())[:, None]
    colours = (1 - share) * [0.93, 0.9, 0.86] + share * [0.55, 0.05, 0.25]
    camera = ScaledOrthographicCamera.look(0, 0, size=side, centre=(0, -35, 0), extent=165)
    return render_mesh(Surface(rig.neutral, avatar.faces, colours=colours), camera, side)


show(
    [heat(delta) for delta in rig.deltas] + [np.full((84, 84, 3), 255, np.uint8)] * 2,
    [*rig.names, "", ""],
    rows=6,
    side=1.25,
    fontsize=6,
)

# %% [markdown]
# *Figure: The man's face 46 times, each with one expression's name and dark colour where it moves: brows, cheeks, lids,
# jaw, corners of the mouth, lips, sides of the nose. The last, of the tongue, moves nothing that is seen.*
#
# Nearly all come in pairs, left and right (the *subject's* left and right). Most move a small place. The jaw moves
# much.
#
# ## Names: the Facial Action Coding System
#
# In the 1970s Paul Ekman and Wallace Friesen wrote down which muscles move a face, and numbered what each does: *action
# units*, AU. AU 12 pulls the corners of the lips, AU 1 raises the inner brows. Phones and game engines have names of
# their own, and `tg.expression_weights` translates them all into the 46.

# %%
for name in ("AU12", "AU1", "AU45L", "AU25", "viseme_PP"):
    parts = tg.expression_weights({name: 1.0})
    print(f"{name:10s}", ", ".join(f"{own} {weight:g}" for own, weight in parts.items()))

# %% [markdown]
# An emotion is a chord of several units. `tg.preset` knows those that Ekman and Friesen describe.

# %%
emotions = ("smile", "surprise", "anger", "sadness", "fear", "disgust")
show([avatar.render(tg.preset(name), size=200, yaw=-20) for name in emotions], emotions, rows=2, side=2.2)

# %% [markdown]
# *Figure: The man's textured head in six emotions: smile, surprise, anger, sadness, fear and disgust.*
#
# ## Sliders
#
# A weight is a slider: 0 is at rest, 1 is the full expression. Nothing forbids 1.5 or −0.5; the sum goes on, and lesson
# 11 tells what is wrong with that. In a notebook with `pip install ".[notebook]"`, this gives you a head with sliders,
# whose weights you can read and set:
#
# ```python
# widget = tg.AvatarWidget(avatar)
# widget.weights = {"AU12": 0.7}
# widget
# ```

# %%
steps = (-0.5, 0.0, 0.5, 1.0, 1.5)
smiles = [avatar.render(tg.expression_weights({"AU12": w}), size=170) for w in steps]
show(smiles, [f"AU12 = {w:g}" for w in steps], side=1.9)

# %% [markdown]
# *Figure: Five heads with the slider of action unit 12 at −0.5, 0, 0.5, 1 and 1.5: corners of the mouth drawn down, at
# rest, and more and more of a smile.*
#
# ## From a face back to weights
#
# Given vertices $S$, which weights made them? $B$ has 57 171 rows and 46 columns, so this is least squares, with the
# sliders kept between 0 and 1:
#
# $$ \min_{0 \le \beta \le 1} \| B\,\beta - (S - S_0) \|^2 . $$
#
# With all vertices it is easy. But a camera sees few points. Let us try with all vertices, and with the 68 landmarks
# alone, each off by noise of half a millimetre.

# %%
rng = np.random.default_rng(0)
S = avatar.vertices(weights)
flat = rig.deltas.reshape(len(rig.names), -1).T.astype(float)
everything = lsq_linear(flat, (S - rig.neutral).ravel(), bounds=(0, 1)).x

points = avatar.face.landmark_vertices
B68 = rig.deltas[:, points].reshape(len(rig.names), -1).T.astype(float)
seen = (S - rig.neutral)[points] + 0.5 * rng.standard_normal((68, 3))
few = lsq_linear(B68, seen.ravel(), bounds=(0, 1)).x

figure, axis = plt.subplots(figsize=(9, 3), dpi=90, layout="compressed")
place = np.arange(len(rig.names))
for k, (values, label) in enumerate(((beta, "true"), (everything, "from all vertices"), (few, "from 68 noisy points"))):
    axis.bar(place + 0.28 * (k - 1), values, 0.28, label=label)
axis.set_xticks(place, rig.names, rotation=90, fontsize=6)
axis.set_ylabel("weight")
axis.legend(fontsize=8)
plt.show()
recovered, recovered_few = np.abs(everything - beta).max(), np.abs(few - beta).max()
print(f"greatest error: {recovered:.3f} from all vertices, {recovered_few:.2f} from 68 noisy points")

# %% [markdown]
# *Figure: Bars of 46 weights: three are set; from all vertices exactly these come back, from noisy landmarks also false
# ones, where no landmark sees the difference.*
#
# Cheeks have no landmark, and several knobs of the mouth move the same few points alike. What points do not tell has to
# come from elsewhere: from a prior, from time (`tg.LandmarkDriver`), or from the picture (`tg.VideoDriver`, lesson 16).
#
# ## What a sum does not know: contact
#
# Deformation transfer carries over what happens to the surface. It does not know that lips *meet*. A mouth that stays
# shut while the jaw opens (chewing, "m") needs a blendshape that undoes the jaw's work on the lips alone: `mouthClose`,
# a *corrective*. `tg.fit_mouth` makes it close, `tg.fit_lids` finds the eyeballs and makes the lids of a blink meet.
#
# The man's face is near the template, and hardly needs them. A manga girl does: her eyes are nearly five times as
# high as the man's. We compare her rig as transferred with the finished one.

# %%
manga = tg.read_landmarks(data_path("examples/portraits/manga_girl.pts"))
girl = tg.neutral_face(tg.align_face(tg.fit_3dmm(None, manga), manga))
raw = tg.build_rig(girl)  # nothing but deformation transfer
done, girl_eyes = tg.fit_lids(girl, tg.fit_mouth(girl, raw))
L = model.landmarks


def gap(V, upper, lower, between):
    """Least distance of two regions in a strip of 6 mm about the middle of two landmarks, mm."""
    x = done.neutral[L[list(between)], 0].mean()
    strip = np.abs(V[:, 0] - x) < 3
    P, Q = (V[model.region(name) & strip] for name in (upper, lower))
    return float(np.linalg.norm(P[:, None] - Q, axis=2).min())


sealed = {"jawOpen": 0.6, "mouthClose": 0.6}
lips, lids = ("lip_upper", "lip_lower", (62, 66)), ("eyelid_upper_left", "eyelid_lower_left", (42, 45))
open_gap, open_lids = gap(done.vertices({"jawOpen": 0.6}), *lips), gap(done.neutral, *lids)
gaps = [gap(r.vertices(sealed), *lips) for r in (raw, done)]
shut = [gap(r.vertices({"eyeBlinkLeft": 1.0}), *lids) for r in (raw, done)]
print(
    f"jaw open: lips {open_gap:.0f} mm apart; mouthClose: {gaps[0]:.1f} mm (transferred), {gaps[1]:.1f} mm (finished)"
)
print(f"left lids {open_lids:.0f} mm apart; in a blink {shut[0]:.0f} mm (transferred), {shut[1]:.0f} mm (finished)")


def clay(rig, weights, yaw=-20):
    """The girl in clay, her eyeballs dark."""
    camera = ScaledOrthographicCamera.look(yaw, 0, size=220, centre=(0, -30, 0), extent=230)
    colours = np.full((len(rig.neutral), 3), 0.85)
    balls = [
        Surface(girl_eyes.vertices(k), eye.faces, colours=np.full((len(eye.vertices), 3), 0.35))
        for k, eye in enumerate(girl_eyes.templates)
    ]
    return render_mesh([Surface(rig.vertices(weights), girl.faces, colours=colours), *balls], camera, 220)


blink = {"eyeBlinkLeft": 1.0}
pictures = [clay(done, {}), clay(raw, blink), clay(done, blink), clay(raw, sealed), clay(done, sealed)]
show(
    pictures,
    ["at rest", "blink: transferred", "blink: finished", "mouthClose: transferred", "mouthClose: finished"],
    side=2.1,
)

# %% [markdown]
# *Figure: A girl with enormous eyes in clay: at rest; with a transferred blink that leaves the left eye half open, and
# the finished one that shuts it; and with her jaw dropped and her lips held together, as transferred and finished.*
#
# The distances are those of the nearest vertices of two lids or lips, which have a thickness; so they do not get to
# zero.
#
# ## Eyes
#
# An eyeball is a sphere, and it turns; no displacement does that. First we need the sphere. Points $p_k$ on a sphere
# with centre $c$ and radius $r$ satisfy $\|p_k - c\|^2 = r^2$. That is not linear in $c$, but multiply out:
#
# $$ 2\,p_k \cdot c + (r^2 - \|c\|^2) = \|p_k\|^2 , $$
#
# and with $q = r^2 - \|c\|^2$ as a fourth unknown it *is* linear: a least-squares problem with four unknowns.


# %%
def sphere(P):
    """Centre (3,) and radius of the sphere nearest to points (k, 3), in the algebraic sense."""
    A = np.column_stack([2 * P, np.ones(len(P))])
    x = np.linalg.lstsq(A, (P**2).sum(axis=1), rcond=None)[0]
    return x[:3], np.sqrt(x[3] + x[:3] @ x[:3])


eyes = avatar.eyes
direction = rng.standard_normal((50, 3))
known = eyes.centres[0] + eyes.radii[0] * direction / np.linalg.norm(direction, axis=1, keepdims=True)
centre, radius = sphere(known)
sphere_error = max(np.abs(centre - eyes.centres[0]).max(), abs(radius - eyes.radii[0]))
assert sphere_error < 1e-9

edges = rig.neutral[L[42:48]]  # six points on the edges of the left lids
nudged = [sphere(edges + 0.5 * rng.standard_normal(edges.shape))[1] for _ in range(100)]
low, high = np.percentile(nudged, [10, 90])
print(f"radius of the left eye: {sphere(edges)[1]:.0f} mm from six points of the lids;")
print(f"with each of them moved by half a millimetre, {low:.0f} to {high:.0f} mm (eight times of ten)")
print(f"by the library: {eyes.radii[0]:.0f} mm")

# %% [markdown]
# On points of a whole sphere the four unknowns are found exactly. The edges of lids are only a narrow band of it,
# nearly a circle in a plane, and through such a circle go spheres of every size: half a millimetre at six points moves
# the radius by a tenth. So the library's `tg.fit_eyes` adds what is known of eyes (how large they are beside their
# opening) and what must not happen (the eyeball coming out of the cheek).
#
# Then the gaze. A vertex of the eyeball is $c + r\,R\,u$, with $u$ on the unit sphere and a rotation $R$. To look to
# the left is a turn about the vertical axis. How far an eye may turn before its iris would leave the lids stands in
# `eyes.turn`, in degrees: a row for each eye, the left one first; columns sideways, and up or down.

# %%
degrees = eyes.turn[0, 0]
R = Rotation.from_euler("y", degrees, degrees=True).as_matrix()
turned = eyes.centres[0] + eyes.radii[0] * eyes.templates[0].vertices @ R.T
gaze_gap = np.abs(turned - avatar.eye_vertices(0, {"eyeLookOutLeft": 1.0})).max()
assert gaze_gap < 1e-9

looks = {
    "ahead": {},
    "to his left": {"eyeLookOutLeft": 1.0, "eyeLookInRight": 1.0},
    "to his right": {"eyeLookInLeft": 1.0, "eyeLookOutRight": 1.0},
    "up": {"eyeLookUpLeft": 1.0, "eyeLookUpRight": 1.0},
    "down": {"eyeLookDownLeft": 1.0, "eyeLookDownRight": 1.0},
    "at his nose": {"eyeLookInLeft": 0.7, "eyeLookInRight": 0.7},
}
middle = rig.neutral[L[[36, 45]]].mean(axis=0)
close = ScaledOrthographicCamera.look(0, 0, size=(110, 260), centre=middle, extent=55)
views = [render_mesh(avatar.surfaces(w), close, (110, 260)) for w in looks.values()]
show(views, looks, rows=3, side=2.4)

# %% [markdown]
# *Figure: The man's eyes close up, looking ahead, to his left, to his right, up, down and at his nose; the lids follow
# a little.*
#
# ## Exercises
#
# 1. Is `mouthSmileRight` of the model the mirror image of `mouthSmileLeft`? `model.mirror` (n,) says which vertex lies
#    on the other side.
# 2. How many knobs would be enough? Take the singular values of $B$ and find how many directions hold 99 % of the
#    squared motion. Why do rigs have more?
# 3. A lid slides over the eyeball on an arc, but a blendshape moves its points on straight lines. How near to the
#    centre of the eyeball does the lid's edge come halfway through a blink? Compare the finished rig with the
#    transferred one.
#
# ## Solutions

# %%
# 1. Mirrored means: the vertex of the other side, with x turned about.
left, right = (model.expression[model.expression_index(f"mouthSmile{side}")] for side in ("Left", "Right"))
mirror_gap = np.abs(left[model.mirror] * [-1, 1, 1] - right).max()
print(f"greatest difference: {mirror_gap:.3f} mm, of a smile that moves points by {np.abs(left).max():.0f} mm")

# %%
# 2. Singular values of B; the eigenvalues of the small matrix B^T B are their squares.
values = np.linalg.eigvalsh(flat.T @ flat)[::-1]
needed = int(np.searchsorted(np.cumsum(values) / values.sum(), 0.99)) + 1
print(f"{needed} of {len(values)} directions hold 99 % of the motion")

# %% [markdown]
# A small motion can matter most: a lid that stays open by a millimetre is the first thing that one sees. And directions
# of greatest variance are mixtures of everything, while an animator wants "the left brow".


# %%
# 3. The distance of the nearest vertex of the left lids from the centre of the eye, in radii.
def nearest(rig, weight):
    """Distance of the lids' skin from the girl's left eye's centre at a weight of the blink, in radii."""
    skin = model.region("eyelid_upper_left") | model.region("eyelid_lower_left")
    V = rig.vertices({"eyeBlinkLeft": weight})[skin]
    return np.linalg.norm(V - girl_eyes.centres[0], axis=1).min() / girl_eyes.radii[0]


on_the_way = {
    name: [nearest(r, w) for w in (0.25, 0.5, 0.75, 1.0)] for name, r in (("transferred", raw), ("finished", done))
}
for name, distances in on_the_way.items():
    print(f"{name:12s} nearest to the centre:", *(f"{d:.2f}" for d in distances), "radii")

# %% [markdown]
# Below 1 the lid is inside of the eyeball, and one would see the eye through it. The finished rig stays outside on the
# whole way: `tg.keep_lids_outside`, one of the steps of `tg.fit_lids`, moves what would enter, so that the chord lies
# above the arc.

# %%
numbers: dict[str, float] = {
    "sum_gap": sum_gap,
    "recovered": recovered,
    "recovered_few": recovered_few,
    "lips_open_mm": open_gap,
    "lips_sealed_raw_mm": gaps[0],
    "lips_sealed_mm": gaps[1],
    "lids_open_mm": open_lids,
    "lids_shut_raw_mm": shut[0],
    "lids_shut_mm": shut[1],
    "closure_left": done.report.closure_left,
    "sphere_error": sphere_error,
    "gaze_gap": gaze_gap,
    "mirror_gap_mm": mirror_gap,
    "directions": needed,
    "lids_nearest_transferred": min(on_the_way["transferred"]),
    "lids_nearest_finished": min(on_the_way["finished"]),
}
