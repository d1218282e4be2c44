# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 18 · Bring your own model
#
# **You have another face model: scans of your own, the Basel Face Model, FLAME. How does it get into this pipeline?**
# In this lesson you make a morphable model from a folder of heads by principal components, store it in the layout of
# the Basel Face Model, load it in one line, and give it what it lacks: landmarks, lines along which jaw points slide,
# and a rig. Most models may not be passed on, so the people of this lesson are made here.

# %%
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from scipy.io import savemat

import toongeo as tg
from toongeo.model import data_path, model_format
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

folder = Path(tempfile.mkdtemp())  # what this lesson writes
template = tg.default_model()

# %% [markdown]
# ## Twelve people
#
# Each is a mask of the front of a face, with its vertices in an order that has nothing to do with the template's. What
# matters is that they *correspond*: vertex 137 is the same place on each. Scans do not come like that; lesson 15 is how
# they are brought there.

# %%
rng = np.random.default_rng(5)
mask = template.region("skin") & ~template.region("ears") & (template.mean[:, 2] > -95)  # mm: to behind the jaw
triangles = template.faces[mask[template.faces].all(1)]
order = rng.permutation(np.unique(triangles))  # vertex i of the mask is vertex order[i] of the template
place = np.full(len(template.mean), -1)
place[order] = np.arange(len(order))
F = place[triangles]
picked = place[template.landmarks]  # somebody picked 68 vertices in a viewer
people = np.array([template.vertices(template.sample(rng))[order] for _ in range(12)])

camera = ScaledOrthographicCamera.look(yaw=20, size=150, centre=(0, -25, 0), extent=185)


def clay(V: np.ndarray, faces: np.ndarray) -> np.ndarray:
    return render_mesh(Surface(V, faces), camera, 150, shading="clay")


fig, axes = plt.subplots(2, 6, figsize=(9, 3.1), layout="constrained")
for ax, person in zip(axes.flat, people, strict=True):
    ax.imshow(clay(person, F))
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: Twelve clay masks of faces, broad and narrow, with noses of all kinds.*
#
# ## 1. Principal components
#
# Write each person as a row $x_s$ of $3n$ numbers. With the mean $\bar x$, the singular values of the centred rows say
# in which directions people differ most:
#
# $$ \tfrac{1}{\sqrt{m-1}}\,(X - \bar x) = U S V^\top, \qquad \text{mode } k:\; b_k = S_k\,v_k, \qquad
#    x(\alpha) = \bar x + \sum_k \alpha_k\, b_k . $$
#
# $S_k^2$ is the variance along $v_k$, so with $b_k$ scaled like that, $\alpha_k = 1$ is *one standard deviation*: a
# prior can then say $\lVert\alpha\rVert^2$, whatever the model.

# %%
mean = people.mean(axis=0)
rows = (people - mean).reshape(len(people), -1)
U, S, Vt = np.linalg.svd(rows / np.sqrt(len(people) - 1), full_matrices=False)
k = len(people) - 1  # twelve points span eleven directions
modes = (S[:k, None] * Vt[:k]).reshape(k, -1, 3)

for s, person in enumerate(people):
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in person] + [f"f {a} {b} {c}" for a, b, c in F + 1]
    (folder / "people").mkdir(exist_ok=True)
    (folder / "people" / f"person{s:02d}.obj").write_text("\n".join(lines), encoding="utf-8")
from_folder = tg.load_model(folder / "people")
signs = np.sign((from_folder.identity * modes).sum(axis=(1, 2)))
folder_difference = float(np.abs(signs[:, None, None] * from_folder.identity - modes).max())
print(f"a folder of people: {len(from_folder.identity)} modes, the same as ours within {folder_difference:.1e} mm")

share = np.cumsum(S[:k] ** 2) / (S**2).sum()
fig, axes = plt.subplots(1, 5, figsize=(10, 2.2), width_ratios=(1.5, 1, 1, 1, 1), layout="constrained")
axes[0].bar(np.arange(1, k + 1), 100 * share)
axes[0].set(xlabel="modes", ylabel="variance, %", xticks=(1, 4, 8, 11))
for ax, (mode, step) in zip(axes[1:], ((0, -2), (0, 2), (1, -2), (1, 2)), strict=True):
    ax.imshow(clay(mean + step * modes[mode], F))
    ax.set_title(f"mode {mode + 1}: {step:+d}", fontsize=9)
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The share of the variance that the first modes explain, rising from a quarter to all of it; and the faces two
# standard deviations along the first and the second mode, which differ in breadth and length.*
#
# The sign of a mode is nobody's: $-v_k$ is as good as $v_k$. Two programs agree up to signs, as above.
#
# ## 2. A published layout
#
# The Basel Face Model of 2009 is a MATLAB file. Its layout is simple, and each line of it has a trap: coordinates in
# *micrometres*, interleaved `x1 y1 z1 x2 ...`; a basis of *unit length* `shapePC` and standard deviations `shapeEV`
# (whose name sounds like eigenvalues, which are variances); triangles counted from *one* and facing *inwards*; colours
# from 0 to 255.

# %%
file = folder / "model.mat"
savemat(
    file,
    {
        "shapeMU": 1000 * mean.reshape(-1, 1),
        "shapePC": Vt[:k].T.astype(np.float32),
        "shapeEV": 1000 * S[:k, None],
        "texMU": np.tile([[205.0], [160.0], [135.0]], (len(mean), 1)),
        "texPC": np.zeros((mean.size, 1), np.float32),
        "texEV": np.ones((1, 1)),
        "tl": F[:, ::-1] + 1,
    },
)
(folder / "picked.json").write_text(json.dumps(picked.tolist()), encoding="utf-8")
bare = tg.load_model(file)
print(f"{model_format(file)}: {len(bare.mean)} vertices, {len(bare.identity)} modes")
print("it has", [part for part in ("landmarks", "contours", "uv", "eyes", "expression", "albedo") if bare.has(part)])

layout_difference = float(np.abs(np.ptp(bare.mean, axis=0) - np.ptp(mean, axis=0)).max())
modes_difference = float(np.abs(bare.identity - modes).max())
outwards = bool(np.array_equal(bare.faces, F))
print(f"as before within {max(layout_difference, modes_difference):.1e} mm; triangles face outwards: {outwards}")

# %% [markdown]
# Arrays that are in no file go the same way: `from_arrays` checks shapes and indices, turns triangles about that face
# inwards, finds the unit if it is a power of ten (`"auto"`: a head has human size), and puts the origin between the
# eyes.

# %%
from_arrays = tg.MorphableModel.from_arrays(
    mean / 1000, F[:, ::-1], identity=modes / 1000, unit="auto", landmarks=picked
)
arrays_difference = float(np.abs(from_arrays.identity - modes).max())
eyes = from_arrays.mean[from_arrays.landmarks[[36, 39, 42, 45]]].mean(axis=0)
print(f"from metres, facing inwards: modes as before within {arrays_difference:.1e} mm")
print(f"the corners of the eyes lie about the origin: x {eyes[0]:+.1f}, y {eyes[1]:+.1f} mm")

# %% [markdown]
# ## 3. Landmarks, and lines along which they slide
#
# A fit needs to know which vertices the 68 landmarks are. `with_landmarks` takes them, or `load_model(file,
# landmarks=...)` reads them. Jaw points are special (lesson 4): on a turned head the outline is another line of the
# surface, so a jaw point may slide along a path from the front to the back. `with_contours` finds such paths from the
# shape.

# %%
model = bare.with_landmarks(picked).with_contours()
direct = tg.load_model(file, landmarks=folder / "picked.json")
same_landmarks = bool(np.array_equal(direct.landmarks, model.landmarks) and direct.has("contours"))

portrait = data_path("examples/portraits/astronaut.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
fits = {name: tg.fit_3dmm(img, landmarks, model=m) for name, m in (("yours", model), ("the template", template))}
for name, fit in fits.items():
    print(f"{name}: {len(fit.model.identity)} people modes, inner landmarks off by {fit.report.rms_percent:.2f} %")

fig, axes = plt.subplots(1, 2, figsize=(7, 3.4), layout="constrained")
for ax, view, title in ((axes[0], 0, "frontal"), (axes[1], -35, "turned by 35°")):
    look = ScaledOrthographicCamera.look(yaw=view, size=300, centre=(0, -25, 0), extent=185)
    ax.imshow(render_mesh(Surface(model.mean, model.faces), look, 300, shading="clay"))
    for line in model.contour_lines:
        ax.plot(*look.project(model.mean[line]).T, "-", color="tab:blue", linewidth=0.8)
    ax.plot(*look.project(model.mean[model.landmarks]).T, "r.", markersize=4)
    ax.set(xlim=(0, 299), ylim=(299, 0))
    ax.set_title(title, fontsize=10)
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The mean of your model from the front and turned, with its landmarks as red dots and blue lines across the
# cheeks on which the points of the jaw may slide. Those of the far side are drawn through the head.*
#
# Your model misses the landmarks by more: it knows twelve people and no smile, and the astronaut smiles.
#
# ## 4. A rig
#
# A scanned mask has no expressions, eyeballs or inside of a mouth. `with_rig_of` brings *its people* to the surface of
# the template, which has all that: the template's mean is laid on the model's (lesson 15), each template vertex takes
# the modes of the point on which it lies,
#
# $$ b'_k(v) = \sum_{c} \beta_c(v)\, b_k\big(f_c(v)\big), $$
#
# with the three corners $f_c$ and the barycentric coordinates $\beta_c$ of that point, and expressions come over by
# deformation transfer (lesson 9). The coefficients stay those of your model: the same $\alpha$ is the same person.

# %%
rigged = model.with_rig_of()
alpha = np.random.default_rng(8).standard_normal(k)
person, moved = model.vertices(alpha), rigged.vertices(alpha)


def apart(points: np.ndarray) -> np.ndarray:
    """mm to the inner landmarks of the person, but for a shift: one origin is between eyeballs, one between lids."""
    difference = points - person[model.landmarks[17:]]
    return np.linalg.norm(difference - difference.mean(axis=0), axis=1)


off = apart(moved[rigged.landmarks[17:]])
off_mean = apart(template.mean[template.landmarks[17:]])
same_person = float(np.median(off))
print(
    f"{len(rigged.identity)} modes, {rigged.n_named} expressions, eyes and teeth: {rigged.has('eyes', 'teeth_upper')}"
)
print(f"one person on both: landmarks {same_person:.2f} mm apart (the template's mean: {np.median(off_mean):.2f})")

fit = tg.fit_3dmm(img, landmarks, model=rigged)
print(f"with the rig, inner landmarks off by {fit.report.rms_percent:.2f} %")


def posed(**weights: float) -> np.ndarray:
    expression = np.zeros(len(rigged.expression))
    for name, weight in weights.items():
        expression[rigged.expression_index(name)] = weight
    return rigged.vertices(alpha, expression)


shown = {
    "your model": (person, model.faces),
    "with a rig": (moved, rigged.faces),
    "jawOpen": (posed(jawOpen=0.8), rigged.faces),
    "smile": (posed(mouthSmileLeft=1.0, mouthSmileRight=1.0), rigged.faces),
    "fitted to the astronaut": (fit.vertices, rigged.faces),
}
fig, axes = plt.subplots(1, 5, figsize=(10, 2.4), layout="constrained")
for ax, (name, (V, faces)) in zip(axes, shown.items(), strict=True):
    ax.imshow(clay(V, faces))
    ax.set_title(name, fontsize=9)
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: One person of your model as a mask, as a whole head with a rig, with its mouth open and smiling, and the
# rigged model fitted to the smiling astronaut.*
#
# Everything that takes `model=` takes it: `tg.make_avatar(img, landmarks, model=rigged)`. As the rig takes some
# seconds, keep it: `save_model` writes our own format, the same bytes for the same model.

# %%
tg.save_model(rigged, folder / "rigged.npz")
kept = tg.load_model(folder / "rigged.npz")
round_trip = bool(np.array_equal(kept.identity, rigged.identity) and kept.expression_names == rigged.expression_names)
print(f"{(folder / 'rigged.npz').stat().st_size / 1e6:.0f} MB; read again it is the same: {round_trip}")

# %% [markdown]
# ## 5. When something is wrong
#
# The commonest fault is a table of landmarks with left and right exchanged, or in another order. Fits then fail in odd
# ways. `toongeo model check` looks for that, for a wrong unit, modes that explode and broken triangles; its exit code
# says whether it found something. Here the sides are exchanged on purpose.

# %%
mirror = np.r_[
    16:-1:-1, 26:16:-1, 27:31, 35:30:-1, 45:41:-1, 47, 46, 39:35:-1, 41, 40, 54:47:-1, 59:54:-1, 64:59:-1, 67:64:-1
]
assert np.array_equal(mirror[mirror], np.arange(68))
(folder / "swapped.json").write_text(json.dumps(picked[mirror].tolist()), encoding="utf-8")
codes = []
for table in ("picked.json", "swapped.json"):
    command = [sys.executable, "-m", "toongeo", "model", "check", "model.mat", "--landmarks", table]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    codes.append(done.returncode)
    print(f"{table}: exit code {done.returncode}", (done.stdout + done.stderr).strip(), sep="\n  ")

# %% [markdown]
# ## Exercises
#
# 1. How well do $j$ modes describe a person who was *not* among the twelve? Project one: $\alpha$ that minimizes
#    $\lVert \bar x + B\alpha - x\rVert$. Compare with one of the twelve.
# 2. Take `shapeEV` for variances, that is, multiply by its root. How far do the modes reach then? Would `toongeo model
#    check` notice?
# 3. If $\alpha$ is drawn from the standard normal distribution, what is the mean of $\lVert\alpha\rVert^2$? Which
#    coefficients do the twelve people have?
#
# ## Solutions
#
# **1.** The modes are orthogonal, so the best coefficients are plain products.

# %%
stranger = template.vertices(template.sample(np.random.default_rng(99)))[order]


def left_mm(x: np.ndarray, j: int) -> float:
    """Root mean square distance of a person from the nearest face of the first j modes, mm."""
    rest = (x - mean).ravel()
    rest = rest - Vt[:j].T @ (Vt[:j] @ rest)
    return float(np.sqrt((rest.reshape(-1, 3) ** 2).sum(axis=1).mean()))


for j in (0, 3, 6, k):
    print(f"{j:2d} modes: stranger {left_mm(stranger, j):.2f} mm, one of the twelve {left_mm(people[4], j):.2f} mm")

# %% [markdown]
# Each of the twelve is described exactly, as they span the space; a stranger little better than by the mean. Twelve
# people are no model of mankind: published ones have hundreds to thousands.
#
# **2.** In micrometres a standard deviation of some $10^5$ (summed over all vertices) becomes some $10^{2.5}$: modes
# that hardly move anything. The check looks for modes that explode or do nothing at all, and does not notice; compare
# `model.sample` with people instead.

# %%
reach = [float(np.sqrt((b**2).sum(axis=1).mean())) for b in (modes[0], np.sqrt(1000 * S[0]) / (1000 * S[0]) * modes[0])]
print(f"first mode moves vertices by {reach[0]:.2f} mm, read as a variance by {reach[1]:.4f} mm")

# %% [markdown]
# **3.** Each of the $k$ coefficients has variance 1, so the mean is $k = 11$. The coefficients of the twelve are
# $\sqrt{m-1}\,U$; the sum of the squares of all is $(m-1)\,k$, so their mean is $\frac{m-1}{m}k$.

# %%
coefficients = np.sqrt(len(people) - 1) * U[:, :k]
rebuilt = float(np.abs(mean + np.tensordot(coefficients[4], modes, axes=1) - people[4]).max())
mean_square = float((coefficients**2).sum(axis=1).mean())
drawn_square = float((rng.standard_normal((20_000, k)) ** 2).sum(axis=1).mean())
print(
    f"drawn: {drawn_square:.2f}; the twelve: {mean_square:.2f} = 11/12 of 11; a person rebuilt within {rebuilt:.0e} mm"
)

# %%
numbers: dict[str, float] = {
    "folder_difference_mm": folder_difference,
    "layout_difference_mm": max(layout_difference, modes_difference),
    "outwards": float(outwards),
    "arrays_difference_mm": arrays_difference,
    "origin_off_mm": float(np.abs(eyes[:2]).max()),
    "same_landmarks": float(same_landmarks),
    "yours_percent": fits["yours"].report.rms_percent,
    "template_percent": fits["the template"].report.rms_percent,
    "rigged_percent": fit.report.rms_percent,
    "expressions": float(rigged.n_named),
    "same_person_mm": same_person,
    "mean_instead_mm": float(np.median(off_mean)),
    "round_trip": float(round_trip),
    "exit_code_right": float(codes[0]),
    "exit_code_swapped": float(codes[1]),
    "stranger_mm": left_mm(stranger, k),
    "stranger_mean_mm": left_mm(stranger, 0),
    "known_mm": left_mm(people[4], k),
    "mean_square": mean_square,
    "drawn_square": drawn_square,
}
