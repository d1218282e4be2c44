# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 2 · Landmarks and Procrustes
#
# **What is left of a shape when place, size and turn are taken away?**
#
# And before that: how do 68 points get onto a picture, and how do you know that they are right? Landmarks are all that
# the fit of lesson 5 sees, so both questions are worth an hour.

# %%
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import toongeo as tg
from toongeo.geometry.rotations.similarity import similarity
from toongeo.metrics import IBUG68_PARTS, landmark_error
from toongeo.model import data_path
from toongeo.model.ibug68 import MIRROR, NAMES

# %% [markdown]
# ## 1 · 68 points with a meaning
#
# A *landmark* is a point that can be found again on every face: the tip of the nose, the corner of an eye. The scheme
# used here is called iBUG-68. Its order is all: point 36 is always the outer corner of the *subject's* right eye, which
# is on the left of the picture. In an array (68, 2) of pixels, x runs right, y runs *down*, and an integer is the
# centre of a pixel. A row of NaN says that a point is missing.

# %%
names = ("moustache_man", "bad_guy", "beethoven", "manga_girl", "blue_girl", "blonde_girl_threequarter", "astronaut")
pictures, landmarks = {}, {}
for name in names:
    portrait = data_path(f"examples/portraits/{name}.png")
    pictures[name], landmarks[name] = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))

man = landmarks["moustache_man"]
fig, axis = plt.subplots(figsize=(6, 6))
axis.imshow(pictures["moustache_man"], alpha=0.35)
for part in ("jaw", "brow", "nose", "eyes", "mouth"):
    rows = list(IBUG68_PARTS[part])
    axis.scatter(*man[rows].T, s=14, label=part)
for k in (0, 8, 16, 17, 21, 26, 27, 30, 33, 36, 39, 42, 45, 48, 51, 54, 57):
    axis.annotate(str(k), man[k], xytext=(3, -8), textcoords="offset points", fontsize=7)
axis.legend(fontsize=8, loc="upper right")
axis.axis("off")
plt.tight_layout()
plt.show()
print({k: NAMES[k] for k in (8, 30, 36, 48)})

# %% [markdown]
# *Figure: The 68 landmarks on a drawing, coloured by part and some of them numbered: 0 to 16 along the jaw, 17 to 26 on
# the brows, 27 to 35 on the nose, 36 to 47 around the eyes, 48 to 67 around the lips.*
#
# **Errors need a unit.** Five pixels are much in a thumbnail and nothing on a poster. So distances are divided by a
# length of the face itself, that of the outer eye corners, and an error of a part is the root of the mean square:
#
# $$ e_{\text{part}} = \frac{\sqrt{\frac{1}{|\text{part}|}\sum_{k \in \text{part}} \lVert p_k - q_k \rVert^2}}
#                          {\lVert q_{36} - q_{45} \rVert} . \tag{1} $$
#
# `toongeo.metrics.landmark_error` is (1) for all parts.

# %%
rng = np.random.default_rng(0)
shaken = man + rng.normal(0, 3, man.shape)
rows = list(IBUG68_PARTS["nose"])
by_hand = np.sqrt(((shaken - man)[rows] ** 2).sum(axis=1).mean()) / np.linalg.norm(man[36] - man[45])
assert np.isclose(by_hand, landmark_error(shaken, man)["nose"])

# %% [markdown]
# ## 2 · Finding them
#
# `tg.detect_landmarks` finds them without a network: a cascade of regressions that starts from a mean shape and moves
# all points, again and again, by what the picture looks like around them. It was trained on renders of the library's
# own head. For each point it also says how likely it is near its place, its *confidence*. Here are four pictures with
# what it finds; rings around the points of which it is least sure.

# %%
found = {name: tg.detect_landmarks(pictures[name]) for name in names}
fig, axes = plt.subplots(1, 4, figsize=(11, 3.2))
for axis, name in zip(axes, ("astronaut", "blue_girl", "beethoven", "bad_guy"), strict=True):
    points, doubt = found[name].points, found[name].confidence < 0.7
    axis.imshow(pictures[name])
    axis.scatter(*points.T, s=7, c="white", edgecolors="black", linewidths=0.4)
    axis.scatter(*points[doubt].T, s=45, facecolors="none", edgecolors="tab:red", linewidths=0.9)
    low, high = landmarks[name].min(axis=0) - 45, landmarks[name].max(axis=0) + 25
    error = landmark_error(points, landmarks[name])["inner51"]
    axis.set(xlim=(low[0], high[0]), ylim=(high[1], low[1]))
    axis.set_title(f"{name}\nerror {error:.1%}, sure: {found[name].is_sure}", fontsize=8)
    axis.axis("off")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Detected landmarks on a photograph and three drawings; on the first two they sit well, on Beethoven and the
# bad guy they miss the drawn mouth and jaw, and red rings mark many of them as doubtful.*
#
# On faces as they are in photographs it is good to some 3 % of the outer-eye distance. On drawings with their own
# anatomy it errs, and mostly knows it. Is the confidence worth anything? Sort all points of all pictures by it:

# %%
inner = np.arange(17, 68)
confidence = np.concatenate([found[name].confidence[inner] for name in names])
miss = np.concatenate(
    [
        np.linalg.norm(found[name].points - landmarks[name], axis=1)[inner]
        / np.linalg.norm(landmarks[name][36] - landmarks[name][45])
        for name in names
    ]
)
order = np.argsort(confidence)
bins = np.array_split(order, 6)
fig, axis = plt.subplots(figsize=(5, 3))
axis.plot([confidence[b].mean() for b in bins], [(miss[b] < 0.08).mean() for b in bins], "o-")
axis.plot([0.3, 1], [0.3, 1], ":", c="0.6")
axis.set(xlabel="confidence (mean of a sixth of all points)", ylabel="share within 8 %")
plt.tight_layout()
plt.show()
doubtful_miss, sure_miss = float(np.median(miss[bins[0]])), float(np.median(miss[bins[-1]]))
print(f"median error of the least sure sixth {doubtful_miss:.1%}, of the surest sixth {sure_miss:.1%}")

# %% [markdown]
# *Figure: The share of detected points that lie within 8 percent of their place rises with their confidence, near the
# dotted diagonal on which a confidence is exactly a chance.*
#
# ## 3 · Correcting them
#
# Where the detector is not sure, a person looks. On the command line `toongeo landmarks face.png` opens a page on your
# machine: drag points, whole parts, softly or on both sides; the fitted face stands beside them, the doubtful ones come
# first. In a notebook the same editor is a widget (`pip install ".[notebook]"`):
#
# ```python
# editor = tg.LandmarkEditor(img, found.points)
# editor               # the last line of a cell: drag
# editor.landmarks     # in the next cell: (68, 2) px
# ```
#
# Files of many tools can be read (`.pts`, dlib's `.xml`, OpenFace's `.csv`, MediaPipe's `.json` ...), and `.pts`,
# `.json` and others written. Note one trap: `.pts` counts the first pixel as 1. The library subtracts it when reading
# and adds it when writing, so that in memory an integer is always the centre of a pixel, counted from 0.

# %%
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "face.pts"
    tg.write_landmarks(path, man)
    first_line = path.read_text().split("{")[1].split("\n")[1]
    assert np.allclose(tg.read_landmarks(path), man, atol=1e-3)
print("in memory", man[0].round(2), "- in the file", first_line)

# %% [markdown]
# How do you find a wrong point where you do not know the truth? Let the others predict it. `tg.held_out_errors` leaves
# every fourth inner point out in turn, fits a face to the rest, and compares. A slip of a single point shows at once:

# %%
slipped = man.copy()
slipped[54] += [0, -0.15 * np.linalg.norm(man[36] - man[45])]  # a corner of the mouth
calm, alarmed = (tg.held_out_errors(None, points) for points in (man, slipped))
print({part: f"{calm[part]:.1%} -> {alarmed[part]:.1%}" for part in ("brow", "nose", "eyes", "mouth")})

# %% [markdown]
# ## 4 · Procrustes
#
# Two pictures of faces: one is larger, one is tilted, they lie elsewhere. None of this is *shape*. The Procrustes
# problem is to take it away: find the scale $s$, rotation $R$ and shift $t$ that bring the points $x_k$ nearest to
# their partners $y_k$,
#
# $$ \min_{s, R, t} \sum_k \lVert s R x_k + t - y_k \rVert^2 . \tag{2} $$
#
# It falls apart into three easy pieces.
#
# **Shift.** Whatever $s$ and $R$ are, the best $t$ puts mean on mean. So subtract the means: $a_k = x_k - \bar x$,
# $b_k = y_k - \bar y$.
#
# **Rotation.** Multiply out:
# $\sum \lVert s R a_k - b_k \rVert^2 = s^2 \sum \lVert a_k \rVert^2 - 2 s \sum b_k^T R a_k + \sum \lVert b_k \rVert^2$.
# Only the middle term knows $R$. With $M = \sum_k b_k a_k^T$ it is $\operatorname{tr}(R^T M)$. Write $M = U \Sigma V^T$
# (singular value decomposition): $\operatorname{tr}(R^T M) = \operatorname{tr}(V^T R^T U \Sigma)$, and $Z = V^T R^T U$
# is a rotation too. Its diagonal entries are at most 1, so $\operatorname{tr}(Z \Sigma) \le \sum \sigma_i$, with
# equality for $Z = I$:
#
# $$ R = U\, \mathrm{diag}(1, \dots, 1, d)\, V^T, \qquad d = \det(U V^T) = \pm 1 . \tag{3} $$
#
# The sign $d$ keeps a mirror image from posing as a rotation.
#
# **Scale.** What is left is a parabola in $s$ with its minimum at
# $s = \operatorname{tr}(R^T M) / \sum \lVert a_k \rVert^2$.


# %%
def procrustes(x: np.ndarray, y: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """(2) by (3), in the plane or in space: s, R, t."""
    a, b = x - x.mean(axis=0), y - y.mean(axis=0)
    M = b.T @ a
    U, _, Vt = np.linalg.svd(M)
    D = np.eye(len(M))
    D[-1, -1] = np.linalg.det(U @ Vt)
    R = U @ D @ Vt
    s = np.sum(R * M) / np.sum(a**2)
    return s, R, y.mean(axis=0) - s * R @ x.mean(axis=0)


def onto(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The points x, brought nearest to y by a similarity."""
    s, R, t = procrustes(x, y)
    return s * x @ R.T + t


model = tg.default_model()
points3d = model.mean[model.landmarks]
noisy = 0.7 * points3d @ np.linalg.qr(rng.standard_normal((3, 3)))[0].T + [10, 20, 30] + rng.normal(0, 1, (68, 3))
for mine, theirs in zip(procrustes(points3d, noisy), similarity(points3d, noisy), strict=True):
    assert np.allclose(mine, theirs)

c, s = np.cos(0.4), np.sin(0.4)
assert np.allclose(onto(1.7 * man @ [[c, s], [-s, c]] + [99, -5], man), man)  # a similarity leaves nothing

# %% [markdown]
# ### Many at once
#
# To compare *seven* faces, bring each onto their mean; but the mean is only known when they lie on each other. So
# repeat: align all to a first guess, average, align to the average. Keep the size fixed, or the mean shrinks away (the
# points nearest to everything are all in one spot). This is *generalised Procrustes analysis*.

# %%


def unit_size(x: np.ndarray) -> np.ndarray:
    """Centred, and scaled to a root mean square distance of 1 from the centre."""
    x = x - x.mean(axis=0)
    return x / np.sqrt((x**2).sum(axis=1).mean())


frontal = [name for name in names if name != "blonde_girl_threequarter"]
shapes = np.array([unit_size(landmarks[name]) for name in frontal])
mean_shape, spread = shapes[0], []
for _ in range(10):
    shapes = np.array([onto(x, mean_shape) for x in shapes])
    mean_shape = unit_size(shapes.mean(axis=0))
    spread.append(float(np.sqrt(((shapes - mean_shape) ** 2).sum(axis=2).mean())))

strokes = (range(17), range(17, 22), range(22, 27), range(27, 31), range(31, 36), (*range(36, 42), 36))
strokes += ((*range(42, 48), 42), (*range(48, 60), 48), (*range(60, 68), 60))


def draw(axis, points, **style):
    """A face as a line drawing of its landmarks."""
    for k, stroke in enumerate(strokes):
        axis.plot(*points[list(stroke)].T, **{**style, "label": style.get("label") if k == 0 else None})


fig, axes = plt.subplots(1, 2, figsize=(9, 4.6))
for name, shape, colour in zip(frontal, shapes, plt.cm.tab10.colors, strict=False):
    draw(axes[0], landmarks[name], c=colour, lw=1)
    draw(axes[1], shape, c=colour, lw=1, label=name)
draw(axes[1], mean_shape, c="black", lw=2.2, label="mean")
axes[1].legend(fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))
for axis, title in zip(axes, ("in pixels", "place, size and turn taken away"), strict=True):
    axis.set_title(title, fontsize=9)
    axis.set_aspect("equal")
    axis.invert_yaxis()
plt.tight_layout()
plt.show()
print(f"spread about the mean: {spread[0]:.4f} in the first round, {spread[-1]:.4f} in the last")

# %% [markdown]
# *Figure: Left, line drawings of the landmarks of six pictures in pixels, a jumble; right, the same after alignment:
# six faces on top of each other that differ in the length of the jaw and the size of the eyes, and their mean in
# black.*
#
# What is left on the right *is* shape: Beethoven's long face, the bad guy's broad one. The distance that remains
# between two aligned shapes tells how much they resemble each other.

# %%
distance = np.array([[np.sqrt(((onto(b, a) - a) ** 2).sum(axis=1).mean()) for b in shapes] for a in shapes])
fig, axis = plt.subplots(figsize=(4.6, 3.8))
shown = axis.imshow(distance, cmap="viridis_r")
axis.set_xticks(range(6), frontal, rotation=40, ha="right", fontsize=7)
axis.set_yticks(range(6), frontal, fontsize=7)
fig.colorbar(shown, label="Procrustes distance")
plt.tight_layout()
plt.show()
i, j = divmod(int((distance + 9 * np.eye(6)).argmin()), 6)
print(f"most alike: {frontal[i]} and {frontal[j]}; farthest from the mean:", end=" ")
print(frontal[int(np.argmax(((shapes - mean_shape) ** 2).sum(axis=(1, 2))))])

# %% [markdown]
# *Figure: A square table of distances between six faces in colour; the row and column of Beethoven are the darkest.*
#
# ## 5 · Mirrors
#
# Reflect a face, $x \to -x$, and its right eye is a left one. The points must be *renamed* too: point 36 of the
# mirrored face is where 45 was. With a table of partners (`MIRROR`) a mirrored face is a face again, and the distance
# of a face from its own mirror image measures how asymmetric it is, or how far it is turned.


# %%
def mirrored(points: np.ndarray) -> np.ndarray:
    """Reflected and renamed."""
    return (points * [-1, 1])[MIRROR]


def asymmetry(points: np.ndarray) -> float:
    """Distance from the own mirror image, with the size of the face as 1."""
    x = unit_size(points)
    return float(np.sqrt(((onto(mirrored(x), x) - x) ** 2).sum(axis=1).mean()))


asymmetries = {name: asymmetry(landmarks[name]) for name in names}
for name, value in sorted(asymmetries.items(), key=lambda item: item[1]):
    print(f"{name:26s} {value:.3f} {'#' * round(200 * value)}")

# %% [markdown]
# ## What to keep in mind
#
# - Order is meaning; the unit is the outer-eye distance; NaN is "missing"; y runs down.
# - A detector that says how sure it is can be corrected where it matters. Points that are predicted by the others are
#   probably right.
# - Procrustes: means, one singular value decomposition, one ratio. You meet (3) again for head poses (lesson 4), for
#   turning rings of a mesh (lesson 6) and wherever rigid motion must be taken away.
# - In the plane, a turned head is *not* a similarity of a frontal one. For that, shapes need depth: lesson 3.
#
# ## Exercises
#
# 1. *Without renaming.* Compute the distance of the drawing `moustache_man` from its reflection without `MIRROR`. Why
#    is it so large although the drawing is symmetric? And with `d = 1` always in (3)?
# 2. *Missing points.* Extend `procrustes` so that rows with NaN in either shape are left out. Test it: drop ten points;
#    how far off do they come out?
# 3. *A robust unit.* The outer-eye distance shrinks when a head turns. Scale the yaw of the model from 0° to 50° and
#    compare the outer-eye distance with the root mean square distance from the centre as units. Which shrinks less?
#
# ## Solutions

# %%
# 1. Without new names the left eye is compared with the right one. If mirror images are allowed as "rotations", the
#    distance is zero: the reflection is undone by another.
x = unit_size(man)
plain = x * [-1, 1]
without_names = float(np.sqrt(((onto(plain, x) - x) ** 2).sum(axis=1).mean()))
U, _, Vt = np.linalg.svd(x.T @ plain)
undone = float(np.abs(plain @ (U @ Vt).T - x).max())
print(f"renamed {asymmetries['moustache_man']:.3f}, not renamed {without_names:.3f}, reflections allowed {undone:.0e}")


# %%
# 2. All sums in (2) simply run over the points that are there.
def procrustes_with_gaps(x, y):
    """`procrustes` of the rows that are complete in both."""
    there = np.isfinite(x).all(axis=1) & np.isfinite(y).all(axis=1)
    return procrustes(x[there], y[there])


gaps = man.copy()
gaps[rng.choice(68, 10, replace=False)] = np.nan
target = 2.0 * man + [5, 7]
s, R, t = procrustes_with_gaps(gaps, target)
gap_error = float(np.abs(s * man @ R.T + t - target).max())
print(f"s = {s:.3f}, largest error {gap_error:.0e} px")

# %%
# 3. The root mean square distance knows height too, which a turn does not change, and what it loses in width it gains
#    in depth: it hardly shrinks. (Errors are given in outer-eye distances all the same, because everybody does.)
units = []
for degrees in (0, 25, 50):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    seen = (points3d @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T)[:, :2]
    units.append((np.linalg.norm(seen[36] - seen[45]), np.sqrt(((seen - seen.mean(axis=0)) ** 2).sum(axis=1).mean())))
shrunk_eyes, shrunk_size = np.array(units)[-1] / np.array(units)[0]
print(f"at 50° the outer-eye distance is {shrunk_eyes:.0%} of that at 0°, the size {shrunk_size:.0%}")

# %%
numbers: dict[str, float] = {
    "error_astronaut": landmark_error(found["astronaut"].points, landmarks["astronaut"])["inner51"],
    "error_bad_guy": landmark_error(found["bad_guy"].points, landmarks["bad_guy"])["inner51"],
    "sure_astronaut": found["astronaut"].is_sure,
    "sure_bad_guy": found["bad_guy"].is_sure,
    "doubtful_miss": doubtful_miss,
    "sure_miss": sure_miss,
    "mouth_calm": calm["mouth"],
    "mouth_alarmed": alarmed["mouth"],
    "spread_first": spread[0],
    "spread_last": spread[-1],
    "asymmetry_man": asymmetries["moustache_man"],
    "asymmetry_threequarter": asymmetries["blonde_girl_threequarter"],
    "without_names": without_names,
    "undone": undone,
    "gap_error": gap_error,
    "shrunk_eyes": float(shrunk_eyes),
    "shrunk_size": float(shrunk_size),
}
