# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 15 · Nonrigid registration: your own head gets a rig
#
# **You have modelled or scanned a head. How does it get 46 expressions, when its triangles have nothing to do with
# those of the template?** If each point of the template knew its partner on your head, expressions could be carried
# over (lesson 9). This lesson finds the partners: first by a similarity, then by *nonrigid closest points*, in some
# thirty lines of numpy and scipy, then by the library, which rigs the head with what it found.

# %%
import igl
import matplotlib.pyplot as plt
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

import toongeo as tg
from toongeo.geometry import cotangent_laplacian, rotation_exp, vertex_normals
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

model = tg.default_model()

# %% [markdown]
# ## Your head
#
# To see how well it works we need the truth, so we *make* the user's head: a random person of the model, whose surface
# is then cut down to 9,000 triangles by collapsing edges. No vertex stays where it was, and nobody can tell from the
# result which point was which. It is measured in metres, turned about, and far from the origin. Somebody has picked 51
# points on it by hand (brows, nose, eyes and mouth), half a millimetre off.

# %%
rng = np.random.default_rng(3)
person = model.vertices(model.sample(rng))  # (n, 3) mm: the truth, in the order of the template
outside = model.region("skin") | model.region("scalp") | model.region("ears")
faces = model.faces[outside[model.faces].all(1)]
kept = np.unique(faces)
V, F, _, _ = igl.decimate(person[kept], np.searchsorted(kept, faces), 9000, True)

turn = rotation_exp(np.radians([20.0, 110.0, -35.0]))  # rotation vector: axis times angle
scale, shift = 1e-3, np.array([1.0, 0.2, -3.0])


def posed(x: np.ndarray) -> np.ndarray:
    """From the model frame, mm, to that of the user, m."""
    return scale * x @ turn.T + shift


def unposed(x: np.ndarray) -> np.ndarray:
    return (x - shift) @ turn / scale


V = posed(V)
picked = posed(person[model.landmarks[17:]] + rng.normal(0, 0.5, (51, 3)))
picked = igl.point_mesh_squared_distance(picked, V, F)[2]  # one clicks on the surface, not beside it
print(f"template: {len(model.mean)} vertices; your head: {len(V)} vertices, {len(F)} triangles")


def front_triangles(x: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Triangles that face the viewer, about the mouth; vertices in the model frame."""
    middle, normals = x[triangles].mean(1), vertex_normals(x, triangles)[triangles].mean(1)
    near = (np.abs(middle[:, 0]) < 32) & (np.abs(middle[:, 1] + 65) < 32) & (middle[:, 2] > 20)
    return triangles[near & (normals[:, 2] > 0.1)]


fig, axes = plt.subplots(1, 2, figsize=(8, 3.9), layout="constrained")
for ax, (name, x, triangles) in zip(
    axes, (("template", model.mean, model.faces), ("your head", unposed(V), F)), strict=True
):
    ax.triplot(x[:, 0], x[:, 1], front_triangles(x, triangles), linewidth=0.4, color="k")
    ax.set_title(name, fontsize=10)
    ax.set_aspect("equal")
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The triangles about the mouth of the template, in even loops around the lips, and those of your head, larger
# and in no order.*
#
# ## 1. A similarity from landmarks
#
# First bring the template into your head's place, size and pose: the $s, R, t$ that minimize
# $\sum_k \lVert s R\,p_k + t - q_k \rVert^2$ over the picked points. With centred points $\hat p_k, \hat q_k$, the
# covariance and its singular value decomposition give them in closed form (Umeyama 1991):
#
# $$ C = \sum_k \hat q_k \hat p_k^\top = U S W^\top, \quad D = \operatorname{diag}(1, 1, \det(UW^\top)), \quad
#    R = U D W^\top, \quad s = \frac{\operatorname{tr}(S D)}{\sum_k \lVert \hat p_k\rVert^2}, \quad
#    t = \bar q - sR\,\bar p . $$
#
# $D$ keeps a reflection out.


# %%
def similarity(p: np.ndarray, q: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    a, b = p - p.mean(0), q - q.mean(0)
    U, S, Wt = np.linalg.svd(b.T @ a)
    D = np.array([1, 1, np.linalg.det(U @ Wt)])
    R = U * D @ Wt
    s = (S * D).sum() / (a**2).sum()
    return s, R, q.mean(0) - s * R @ p.mean(0)


marks = model.landmarks[17:]
s, R, t = similarity(model.mean[marks], picked)
target = (V - t) @ R / s  # your head comes to the template, in mm, and not the other way: units stay readable
goals = (picked - t) @ R / s
truth = (posed(person) - t) @ R / s
off = np.linalg.norm(model.mean[marks] - goals, axis=1).mean()
print(f"your head is {1000 * s:.2f} times as large as the template; its landmarks are off by {off:.1f} mm")

# %% [markdown]
# ## 2. Closest points that resist bending
#
# *Iterated closest points*: let each vertex $x_i$ look for the closest point $p_i$ of your surface, move towards it,
# and look again. If each simply jumps to its partner, neighbours jump to different places and the surface crumples. So
# the displacements $d = x - x^0$ have an energy of their own:
#
# $$ E(d) = \underbrace{\sum_i a_i \lVert x_i - p_i\rVert^2}_{\text{partners}}
#    + \underbrace{\sum_k w\lVert x_{i_k} - q_k \rVert^2}_{\text{landmarks}}
#    + \lambda\Big(\underbrace{\beta\, d^\top L A^{-1} L\, d}_{\text{bending}}
#    + \underbrace{\gamma\, d^\top L\, d}_{\text{stretching}}\Big) . $$
#
# $L$ is the cotangent Laplacian (lesson 6), $a_i$ the area about a vertex, $A$ their diagonal matrix; $x^0$ is the
# template at rest, and $p$ holds all partners. For given partners $E$ is quadratic, so its minimum solves a linear
# system with the same matrix for x, y and z:
#
# $$ \big(A + W + \lambda(\beta L A^{-1} L + \gamma L)\big)\, d = A(p - x^0) + W(q - x^0) . $$
#
# ($W$ is diagonal, with $w$ at the picked points and 0 elsewhere. It is not the $W$ of section 1.) The *stiffness*
# $\lambda$ begins high and falls: a stiff surface finds the large forms and cannot be led astray by a few wrong
# partners; later it follows the details (Amberg, Romdhani and Vetter 2007: "optimal step nonrigid ICP").

# %%
front = model.region("face")
triangles = model.faces[front[model.faces].all(1)]
used = np.unique(triangles)
X0, T = model.mean[used], np.searchsorted(used, triangles)
of = np.full(len(model.mean), -1)
of[used] = np.arange(len(used))
rows = of[marks]  # the front has them all


def closest(x: np.ndarray) -> np.ndarray:
    """Closest points (n, 3) of your head."""
    return igl.point_mesh_squared_distance(x, target, F)[2]


def register(levels: tuple[float, ...], iterations: int = 4, pull: float = 1.0) -> np.ndarray:
    """Vertices (n, 3), mm, of the front laid on your head; landmarks pull ``pull`` times as strongly as partners."""
    L = cotangent_laplacian(X0, T, clamp=0.05)
    double = np.linalg.norm(np.cross(X0[T[:, 1]] - X0[T[:, 0]], X0[T[:, 2]] - X0[T[:, 0]]), axis=1)
    area = np.bincount(T.ravel(), np.repeat(double / 6, 3), len(X0))
    A = sp.diags_array(area)
    weight = np.zeros(len(X0))
    weight[rows] = pull * area.sum() / len(rows)
    W = sp.diags_array(weight)
    q = np.zeros_like(X0)
    q[rows] = goals
    bending, stretching = L @ sp.diags_array(1 / area) @ L, L
    x = X0
    for level in levels:
        matrix = A + W + level * (1000.0 * bending + 1.0 * stretching)  # mm^4 and mm^2: see exercise 1
        solver = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A")
        for _ in range(iterations):
            x = X0 + solver.solve(A @ (closest(x) - X0) + W @ (q - X0))
    return x


jumped = closest(X0)
ours = register((1000.0, 100.0, 10.0, 1.0, 0.1, 0.01), 3)

# %% [markdown]
# How good is it? Two questions, which must not be confused. *Does it lie on the surface?* That is what was minimized,
# and jumping is best at it. *Does each point lie where it belongs?* Here we can tell, as we know the truth; of your own
# head nobody does. And a third: has any triangle turned over?


# %%
def judged(x: np.ndarray) -> tuple[float, float, float, float]:
    """Median distances to the surface and the truth, mm; share of turned triangles; nine of ten are as near as, mm."""
    before, after = (np.cross(y[T[:, 1]] - y[T[:, 0]], y[T[:, 2]] - y[T[:, 0]]) for y in (truth[used], x))
    to_surface = np.median(np.linalg.norm(x - closest(x), axis=1))
    to_truth, nine_of_ten = np.percentile(np.linalg.norm(x - truth[used], axis=1), [50, 90])
    return float(to_surface), float(to_truth), float(((before * after).sum(1) < 0).mean()), float(nine_of_ten)


found = tg.nonrigid_register(X0, T, V, F, rows, picked)
theirs = (found.vertices - t) @ R / s
results = {"similarity alone": X0, "jump to the closest point": jumped, "our registration": ours}
results["nonrigid_register"] = theirs
table = {name: judged(x) for name, x in results.items()}
print("medians, and within how far of the truth nine of ten vertices lie:")
for name, (surface, middle, turned, most) in table.items():
    print(
        f"{name:25s} surface {surface:4.2f}  truth {middle:4.2f}, nine of ten {most:5.2f} mm  turned over {turned:5.2%}"
    )

camera = ScaledOrthographicCamera.look(yaw=25, size=250, centre=(0, -25, 0), extent=190)
fig, axes = plt.subplots(2, 4, figsize=(10, 5), layout="constrained")
limit = 8.0  # mm
for k, (name, x) in enumerate(results.items()):
    errors = np.linalg.norm(x - truth[used], axis=1)
    colours = plt.get_cmap("viridis")(np.clip(errors / limit, 0, 1))[:, :3]
    axes[0, k].imshow(render_mesh(Surface(x, T), camera, 250, shading="clay"))
    axes[1, k].imshow(render_mesh(Surface(x, T, colours=colours), camera, 250, shading="unlit"))
    axes[0, k].set_title(name, fontsize=9)
for ax in axes.flat:
    ax.axis("off")
scalar = plt.cm.ScalarMappable(plt.Normalize(0, limit), "viridis")
fig.colorbar(scalar, ax=axes[1], shrink=0.7, label="mm from the truth")
plt.show()

# %% [markdown]
# *Figure: The front of the template four times in clay, and below in colours of the distance from the truth: as it is,
# far off at nose and forehead; crumpled about eyes, nose and lips where points jumped; smooth and mostly dark after our
# registration, but for the rim of the forehead and the chin; and after the library's, whose forehead is better and
# whose chin is worse, with a dent.*
#
# What remains is mostly *along* the surface: a cheek has no marks by which one could tell a point from its neighbour.
# For most expressions that matters little, since neighbours move alike. The chin is the worst place. Nobody picked a
# point on it, it was far off at first, and what seeks its partner slips underneath. A small distance to the surface
# alone says nothing: the jump has none at all.
#
# ## 3. What the library adds
#
# The same energy, and
#
# - partners must *face the same way* (cosine at least 0.5), or an upper lip would find the lower one;
# - partners at borders, or far off against the others, pull less or not at all;
# - a vertex slides along the surface ten times more easily than it leaves it: good for the forehead, bad for the chin;
# - bending is measured from where the level before ended, so that a large motion is paid for once.

# %%
s_same = abs(found.scale / s - 1)
R_same = float(np.abs(found.rotation - R).max())
matched = float(found.matched.mean())
print(f"the library starts from the same similarity: scale within {s_same:.0e}, rotation within {R_same:.0e}")
print(f"{matched:.0%} of the face found a partner; {found.iterations} iterations, {found.status}")

# %% [markdown]
# ## 4. A rig for your head
#
# `rig_mesh` registers, carries the expressions over by deformation transfer, closes what blinks leave open, and lets
# each vertex of *your* mesh move as the point of the template that lies on it. Your mesh stays as it is.

# %%
landmarks = np.full((68, 3), np.nan)  # jaw points are not needed: a missing point is NaN
landmarks[17:] = picked
rig = tg.rig_mesh(V, F, landmarks)
print(f"{len(rig.names)} expressions for {rig.neutral.shape[0]} vertices, in units of your head")

faces_shown = {
    "at rest": {},
    "jawOpen": {"jawOpen": 1.0},
    "smile": {"mouthSmileLeft": 1.0, "mouthSmileRight": 1.0},
    "eyeBlink": {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0},
    "browInnerUp": {"browInnerUpLeft": 1.0, "browInnerUpRight": 1.0},
}
camera = ScaledOrthographicCamera.look(yaw=15, size=220, centre=(0, -15, 0), extent=230)
fig, axes = plt.subplots(1, 5, figsize=(11, 2.5), layout="constrained")
for ax, (name, weights) in zip(axes, faces_shown.items(), strict=True):
    ax.imshow(render_mesh(Surface(unposed(rig.vertices(weights)), F), camera, 220, shading="clay"))
    ax.set_title(name, fontsize=9)
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: Your head in clay, at rest, with its mouth open, smiling, with its eyes closed and its brows raised. Eyeballs
# are missing because the mesh has none.*
#
# Are these the right motions? The truth would be those of the person whose surface this is. Carry them to your vertices
# by the triangle that each lies in, and compare. Written as one number: the length of the difference against the length
# of the motion, for five expressions.

# %%
transferred = tg.DeformationTransfer(model.mean, model.faces, person)
names = ["jawOpen", "mouthSmileLeft", "browInnerUpLeft", "eyeBlinkRight", "cheekPuffLeft"]
home = unposed(V)
_, at, foot = igl.point_mesh_squared_distance(home, person, faces)
corners = faces[at]
share = igl.barycentric_coordinates(foot, *(np.ascontiguousarray(person[corners[:, k]]) for k in range(3)))
errors = {}
for name in names:
    shape = model.mean + model.expression[model.expression_index(name)]
    motion = transferred.transfer(shape[None])[0] - person
    motion -= motion[model.region("scalp")].mean(0)
    wanted = np.einsum("vc,vcd->vd", share, motion[corners])
    got = rig.deltas[rig.names.index(name)] @ turn / scale
    errors[name] = float(np.linalg.norm(got - wanted) / np.linalg.norm(wanted))
print("error against the motion:", ", ".join(f"{name} {error:.0%}" for name, error in errors.items()))

# %% [markdown]
# Broad motions come over well, a blink less so: within a few millimetres of lid its motion falls from 12 mm to
# nothing, so there it counts where along the surface the partner was found, and of your coarse mesh some fifty
# vertices take part.
#
# On a command line: `toongeo rig head.obj --landmarks head.json -o head.glb`. `toongeo landmarks head.obj` lets you
# click the points in a browser; MeshLab's `.pp` is read as well.
#
# ## Exercises
#
# 1. Bending has the weight $\lambda\beta$ against an area. What is the unit of $\beta$? Read off the size of a bump
#    that is smoothed away at each level, with $\beta = 1000$: for a wave $d = \sin(2\pi x/\ell)$ of length $\ell$ each
#    application of $A^{-1}L$ multiplies by $(2\pi/\ell)^2$.
# 2. Skip the stiff levels: `register((0.01,), 18)` has as many iterations. What becomes of it?
# 3. Does the result depend on the frame and unit in which your head comes? It must not.
# 4. How many picked points does it take? Leave out all but the corners of eyes and mouth and the tip of the nose.
#
# ## Solutions
#
# **1.** $d^\top L A^{-1} L d$ has the unit of $(d/\text{mm}^2)^2\,\text{mm}^2$, partners that of $d^2\,\text{mm}^2$, so
# $\beta$ is in mm$^4$. The wave is damped by $1/(1 + \lambda\beta(2\pi/\ell)^4)$, to one half where
# $\ell = 2\pi(\lambda\beta)^{1/4}$. (That is bending alone. Stretching adds $\lambda\gamma(2\pi/\ell)^2$ to the
# denominator, with $\gamma$ = 1 mm$^2$. This matters most at the first level: there the wave that is halved is 253 mm
# long.)

# %%
half = {level: 2 * np.pi * (level * 1000.0) ** 0.25 for level in (1000.0, 10.0, 0.1, 0.01)}
print("waves that are halved, mm:", ", ".join(f"level {level:g}: {length:.0f}" for level, length in half.items()))

# %% [markdown]
# **2.** A soft surface lies down on whatever is near, and is content with it: as close to your head, but with its
# points at the wrong places.

# %%
hasty = judged(register((0.01,), 18))
ordered = table["our registration"]
print(f"at once: surface {hasty[0]:.2f} mm, truth {hasty[1]:.2f} mm")
print(f"by stiffness: surface {ordered[0]:.2f} mm, truth {ordered[1]:.2f} mm")

# %% [markdown]
# **3.** The library brings the target to the source by the similarity of the landmarks, so all that follows sees the
# same numbers, up to rounding.

# %%
again = rotation_exp(np.array([0.4, -1.0, 2.0]))
options = {"stiffness": (0.3, 0.003), "iterations": 2}
one = tg.nonrigid_register(X0, T, V, F, rows, picked, **options)
two = tg.nonrigid_register(X0, T, 39.37 * V @ again.T + 7, F, rows, 39.37 * picked @ again.T + 7, **options)
frame_difference = float(np.abs((two.vertices - 7) @ again / 39.37 - one.vertices).max() / scale)
print(f"in inches, turned and shifted: the same within {frame_difference:.1e} mm")

# %% [markdown]
# **4.** Seven points are enough for the pose and the size; the brows and the lips are then found by closest points
# alone.

# %%
few = np.array([36, 39, 42, 45, 48, 54, 30]) - 17
seven = tg.nonrigid_register(X0, T, V, F, rows[few], picked[few])
seven_error = judged((seven.vertices - t) @ R / s)[1]
print(f"seven points: truth {seven_error:.2f} mm; 51 points: {table['nonrigid_register'][1]:.2f} mm")

# %%
numbers: dict[str, float] = {
    "similarity_scale_difference": float(s_same),
    "similarity_rotation_difference": R_same,
    "truth_similarity_mm": table["similarity alone"][1],
    "truth_ours_mm": table["our registration"][1],
    "truth_library_mm": table["nonrigid_register"][1],
    "surface_ours_mm": table["our registration"][0],
    "surface_library_mm": table["nonrigid_register"][0],
    "surface_hasty_mm": hasty[0],
    "turned_jumped": table["jump to the closest point"][2],
    "turned_ours": table["our registration"][2],
    "turned_library": table["nonrigid_register"][2],
    "ours_to_library_mm": float(np.median(np.linalg.norm(ours - theirs, axis=1))),
    "matched": matched,
    "expressions": float(len(rig.names)),
    "worst_motion_error": max(errors.values()),
    "jaw_motion_error": errors["jawOpen"],
    "truth_hasty_mm": hasty[1],
    "frame_difference_mm": frame_difference,
    "truth_seven_points_mm": seven_error,
}
