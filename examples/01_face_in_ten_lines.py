# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 1 · A face in ten lines
#
# **How does one flat drawing become a head that can turn and smile?**
#
# A drawing has no depth, no back and one expression. All three must come from somewhere else: from what faces have in
# common. This lesson runs the whole way once, looks at what each step gives, and says which lesson explains it. It
# needs numpy and matplotlib, and no geometry yet.

# %%
import matplotlib.pyplot as plt
import numpy as np

import toongeo as tg
from toongeo.model import data_path
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

# %% [markdown]
# ## The ten lines
#
# `data_path` finds the bundled pictures wherever the library is installed; `tg.read_image("face.png")` reads yours.

# %%
portrait = data_path("examples/portraits/moustache_man.png")
img = tg.read_image(portrait)
found = tg.detect_landmarks(img)
landmarks = tg.read_landmarks(portrait.with_suffix(".pts"))
avatar = tg.make_avatar(img, landmarks, hair=False)
rest = avatar.render(size=300)
smile = avatar.render({"mouthSmileLeft": 0.9, "mouthSmileRight": 0.9}, size=300)
side = avatar.render({"jawOpen": 0.6}, size=300, yaw=50)
vertices = avatar.vertices({"jawOpen": 0.6})
print(f"{len(vertices)} points and {len(avatar.faces)} triangles, {len(avatar.names)} expressions")

# %%
fig, axes = plt.subplots(1, 4, figsize=(11, 3))
titles = ("the picture", "at rest", "mouthSmile 0.9", "jawOpen 0.6, turned by 50°")
for axis, shown, title in zip(axes, (img, rest, smile, side), titles, strict=True):
    axis.imshow(shown)
    axis.set_title(title, fontsize=9)
    axis.axis("off")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: A drawing of a man with a moustache, and the head made of it three times: at rest, smiling, and with its
# mouth open, turned to the side.*
#
# `avatar.save("face.glb")` writes a file for Blender, Unity or a page; `avatar.save("face.html")` a page with sliders.
# In a notebook, `avatar.show()` is that page.
#
# ## What happened, step by step
#
# **1. Landmarks.** 68 points with fixed meaning: number 30 is always the tip of the nose. They are all that the
# geometry knows about the picture at first. A person placed the ones used here; a detector finds its own, with a
# confidence for each. How far do the two differ? Distances in pixels depend on the size of the picture, so faces are
# measured in a unit of their own, the distance of the outer eye corners (points 36 and 45). With the detected points
# $p_k$ and the placed ones $q_k$:
#
# $$ e_k = \frac{\lVert p_k - q_k \rVert}{\lVert q_{36} - q_{45} \rVert} $$

# %%
outer_eyes = np.linalg.norm(landmarks[36] - landmarks[45])
error = np.linalg.norm(found.points - landmarks, axis=1) / outer_eyes

fig, axis = plt.subplots(figsize=(4.4, 4.4))
axis.imshow(img)
axis.scatter(*landmarks.T, s=14, c="white", edgecolors="black", linewidths=0.6, label="placed by a person")
axis.scatter(*found.points.T, s=14, marker="x", c="tab:red", linewidths=1, label="detected")
axis.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncol=2)
axis.axis("off")
plt.show()
print(f"detected points are off by {100 * np.median(error):.1f} % of the outer-eye distance (median of 68)")
print(f"sure enough to go on without a person looking: {found.is_sure}")

# %% [markdown]
# *Figure: The 68 landmarks on the drawing, placed by a person as dots and detected as crosses; most crosses lie on or
# next to their dot.*
#
# Lesson 2 is about these points.
#
# **2. Fit.** A *morphable model* is a head with knobs: some change who it is, some its expression. The fit turns the
# knobs, and the head itself, until its landmarks lie on those of the picture. The result can be no stranger than the
# model allows: it is right about *faces*, and misses what is special about *this* one. Lessons 3, 4 and 5.
#
# **3. Align.** The mesh is then bent, smoothly, so that its landmarks lie exactly where they are drawn. Lesson 6.
#
# Both are meshes with the same triangles, so one number says what the bending added: how far points have moved.

# %%
fit, face = avatar.fit, avatar.face
skin = fit.region("face")
moved = np.linalg.norm(face.vertices - fit.vertices, axis=1)


def miss(shape) -> np.ndarray:
    """Distance of the projected landmarks from the drawn ones, in outer-eye distances, as above."""
    projected = shape.project(shape.vertices[shape.landmark_vertices])
    return np.linalg.norm(projected - landmarks, axis=1) / outer_eyes


coarse, exact = np.sqrt(np.mean(miss(fit)[17:] ** 2)), np.sqrt(np.mean(miss(face)[17:] ** 2))
print(f"landmarks missed by the fit: {100 * coarse:.1f} %, after alignment: {100 * exact:.2f} %")
print(f"what alignment moved on the face: {np.median(moved[skin]):.1f} mm in the median")

# %% [markdown]
# Do not read the second number as quality. The aligned face goes through its points because it is *told to*; that
# says nothing about the places between them. This difference, between an error that says something and one that is
# forced, returns in every lesson.


# %%
def clay(vertices: np.ndarray, yaw: float = 0.0) -> np.ndarray:
    """A mesh of the template without colours, as a sculptor would show it."""
    camera = ScaledOrthographicCamera.look(yaw, size=260, centre=(0, 10, 0), extent=300)
    return render_mesh(Surface(vertices, avatar.faces), camera, 260, shading="clay")


shapes = ("what the model starts from", avatar.fit.model.mean), ("fitted", fit.vertices), ("aligned", face.vertices)
fig, axes = plt.subplots(2, 3, figsize=(7.2, 4.9))
for column, (title, shape) in enumerate(shapes):
    for row, yaw in enumerate((0, 50)):
        axes[row, column].imshow(clay(shape, yaw))
        axes[row, column].axis("off")
    axes[0, column].set_title(title, fontsize=9)
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Three clay heads, each from the front and from the side: the face that the model starts from, the fitted one
# with the man's broad face, and the aligned one, whose mouth and nose follow the drawing.*
#
# **4. Rig.** How would *this* face smile? Nobody drew it. The template's smile is known triangle by triangle; each
# triangle's change is carried over (lessons 9 and 10). An expression is then an array of displacements, and expressions
# add up. With neutral face $v_0$ and displacements $d_j$,
#
# $$ v(w) = v_0 + \sum_j w_j\, d_j . $$
#
# That is one line of numpy, and the library gives the same.

# %%
weights = {"jawOpen": 0.6, "mouthSmileLeft": 0.5}
rig = avatar.rig
by_hand = rig.neutral + sum(w * rig.deltas[rig.names.index(name)] for name, w in weights.items())
assert np.allclose(by_hand, avatar.vertices(weights), atol=1e-3)  # mm
jaw_open = np.linalg.norm(rig.deltas[rig.names.index("jawOpen")], axis=1)
print(f"jawOpen 1 moves {np.mean(jaw_open > 0.1):.0%} of the points, the farthest by {jaw_open.max():.0f} mm")

# %% [markdown]
# **5. Texture.** The picture is projected onto the mesh and unrolled into one square image, the *atlas*. What the
# picture does not show is mirrored from the other side, or filled in smoothly. Lesson 8.

# %%
fig, axis = plt.subplots(figsize=(3.6, 3.6))
axis.imshow(avatar.texture[::4, ::4])
axis.axis("off")
plt.show()

# %% [markdown]
# *Figure: The texture atlas, a square image in which the face of the drawing is unrolled and its surroundings are
# filled with skin and hair colours.*
#
# ## What to expect, and what not
#
# - Depth is a guess by the model. From one frontal picture, nobody knows how far the nose reaches out.
# - The back of the head is the model's too.
# - Everything hangs on the landmarks. If a head comes out wrong, look at its points first.
# - It takes seconds on one core, without a network and without training, and each step can be read.

# %%
for line in avatar.report.lines()[:5]:
    print(line)

# %% [markdown]
# ## Exercises
#
# 1. Expressions add up. Take `jawOpen` 0.6 and both `eyeBlink` 1. Is the displacement of both together the sum of the
#    displacements of each?
# 2. A row of NaN means that a landmark is missing. Leave out the jaw (points 0 to 16) and fit with
#    `tg.fit_3dmm(None, ...)`. Then move all points of the mouth (48 to 67) down by 5 % of the outer-eye distance and
#    fit again. By how much does the tip of the chin, which no landmark shows any more, follow?
# 3. Use the detected points in place of those of the person. Which landmark of the fitted face differs most?
#
# ## Solutions

# %%
# 1. The rig is linear, so the displacements are sums, to the last digits of single precision.
both = {"jawOpen": 0.6, "eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
jaw, blink = {"jawOpen": 0.6}, {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
together = avatar.vertices(both) - avatar.vertices()
apart = (avatar.vertices(jaw) - avatar.vertices()) + (avatar.vertices(blink) - avatar.vertices())
sum_gap = float(np.abs(together - apart).max())
print(f"greatest difference: {sum_gap:.4f} mm")

# %%
# 2. The model knows that a low mouth goes with a low chin. The fit has never seen where this one is.
hidden = landmarks.copy()
hidden[:17] = np.nan
lower = hidden.copy()
lower[48:, 1] += 0.05 * outer_eyes
chin = avatar.fit.model.landmarks[8]
before, after = tg.fit_3dmm(None, hidden), tg.fit_3dmm(None, lower)
mouth_down = 0.05 * outer_eyes / before.camera.scale
chin_down = float(before.vertices[chin, 1] - after.vertices[chin, 1])
print(f"the mouth went down by {mouth_down:.1f} mm, the chin by {chin_down:.1f} mm")

# %%
# 3. Points of the model frame can be compared although the pose differs a little.
detected = tg.fit_3dmm(None, found.points)
points = fit.model.landmarks
difference = np.linalg.norm(detected.vertices[points] - fit.vertices[points], axis=1)
print(f"landmark {difference.argmax()} differs most, by {difference.max():.1f} mm")
print(f"half of them differ by less than {np.median(difference):.1f} mm")

# %%
numbers: dict[str, float] = {
    "vertices": len(vertices),
    "expressions": len(avatar.names),
    "detection_error": float(np.median(error)),
    "coarse_error": float(coarse),
    "aligned_error": float(exact),
    "sum_gap": sum_gap,
    "chin_down": chin_down,
    "smile_changes_picture": float(np.abs(smile.astype(float) - rest).mean()),
}
