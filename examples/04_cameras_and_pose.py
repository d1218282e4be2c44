# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 4 · Cameras, pose, and why the jaw is different
#
# **From where does a picture see the head, and why do the points of the jaw not stick to the skin?**
#
# A camera is a function from space to the plane. This lesson builds the two that matter for faces, rotations in two
# descriptions, and a closed formula for the pose of a head. Then it meets the one part of the face for which
# "landmark = vertex" is false.

# %%
import matplotlib.pyplot as plt
import numpy as np

import toongeo as tg
from toongeo.geometry import rotation_exp, vertex_normals
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.model import data_path
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera, Surface, render_mesh

# %% [markdown]
# ## 1 · Three frames
#
# - The **model frame**: millimetres, the origin between the eyeballs, +X to the subject's left, +Y up, +Z out of the
#   face.
# - The **camera frame**: +X to the right of the picture, +Y up, +Z towards the viewer. A rotation $R$ leads into it.
# - The **picture**: pixels, x right, y *down*, an integer is the centre of a pixel.
#
# The *scaled orthographic* camera turns the head, drops the depth, and scales what is left:
#
# $$ \text{px} = s\, P\, R\, v + t, \qquad P = \begin{bmatrix} 1 & 0 & 0 \\ 0 & -1 & 0 \end{bmatrix} . \tag{1} $$
#
# The $-1$ in $P$ is all that is ever done about "y down"; do it in one place, and no sign haunts you later.

# %%
model = tg.default_model()
head = np.asarray(model.vertices(model.prior.mean), float)  # the likeliest face
camera = ScaledOrthographicCamera.look(yaw=30, pitch=10, size=300, centre=(0, 0, 0), extent=300)
P = np.array([[1.0, 0, 0], [0, -1, 0]])
px = camera.scale * head @ (P @ camera.rotation).T + camera.translation
assert np.allclose(px, camera.project(head))

# %% [markdown]
# ## 2 · Rotations
#
# **Angles.** A head is shaken (yaw), nods (pitch), tilts (roll):
# $R = R_z(\text{roll})\,R_x(\text{pitch})\,R_y(\text{yaw})$, each counter-clockwise when its axis points at you. Good
# for telling people; bad for optimizing, for at a pitch of 90° yaw and roll turn about the same axis.
#
# **Vectors.** Any rotation is a turn by an angle $\theta$ about an axis $a$ of length 1. Write it as one vector
# $\omega = \theta a$, and with the cross product as a matrix, $[\omega]_\times u = \omega \times u$, the rotation is
# the exponential
#
# $$ R = e^{[\omega]_\times} =
#    I + \frac{\sin\theta}{\theta} [\omega]_\times + \frac{1 - \cos\theta}{\theta^2} [\omega]_\times^2
#    \qquad\text{(Rodrigues)}. \tag{2} $$
#
# Near $\omega = 0$ this is $I + [\omega]_\times$: a small turn moves a point $u$ by $\omega \times u$. That derivative
# is as simple as derivatives get, which is why the library's fit describes a pose as (2) times the pose where it began.


# %%
def cross_matrix(w: np.ndarray) -> np.ndarray:
    """[w]x, so that ``cross_matrix(w) @ u == np.cross(w, u)``."""
    x, y, z = w
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def rodrigues(w: np.ndarray) -> np.ndarray:
    """Equation (2)."""
    angle, W = np.linalg.norm(w), cross_matrix(w)
    return np.eye(3) + np.sin(angle) / angle * W + (1 - np.cos(angle)) / angle**2 * W @ W


w = np.array([0.3, -0.8, 0.2])
assert np.allclose(rodrigues(w), rotation_exp(w[:, None])[:, :, 0])  # the library takes many vectors, as columns
assert np.allclose(rodrigues(np.radians([0, 30, 0])), ScaledOrthographicCamera.look(yaw=30).rotation)


def clay(vertices, view, size=220):
    """The head as clay."""
    return render_mesh(Surface(vertices, model.faces), view, size, shading="clay")


def strip(pictures, titles, width=2.0):
    """Pictures side by side."""
    _, axes = plt.subplots(1, len(pictures), figsize=(width * len(pictures), width * 1.12))
    for axis, shown, title in zip(axes, pictures, titles, strict=True):
        axis.imshow(shown)
        axis.set_title(title, fontsize=9)
        axis.axis("off")
    plt.tight_layout()
    plt.show()


turns = {
    "yaw 35°": {"yaw": 35},
    "pitch 25°": {"pitch": 25},
    "roll 20°": {"roll": 20},
    "all": {"yaw": 35, "pitch": 25, "roll": 20},
}
strip([clay(head, ScaledOrthographicCamera.look(**turn, size=220, extent=320)) for turn in turns.values()], list(turns))

# %% [markdown]
# *Figure: Four clay heads: turned to the subject's left, nodding down, tilted counter-clockwise, and all three at
# once.*
#
# ## 3 · Perspective
#
# A real lens makes near things large. With the viewer at the origin of the camera frame, a point $y = R v + t$ (so
# $y_z < 0$ for what is seen) lands at
#
# $$ \text{px} = c + f\, \frac{P\, y}{-y_z} . \tag{3} $$
#
# $f$ is the focal length in pixels, $c$ the pixel of the optical axis. Compare (1): the scale $s$ has become
# $f / (-y_z)$, one for each point. If the head is far away, $-y_z$ is nearly the same for all its points, and (1) is
# (3) with one mean depth. How far is far? Move away and zoom in, so that the eyes stay as far apart:

# %%
distances = np.array([300, 450, 700, 1200, 2500, 6000.0])  # mm
skin = model.region("skin")
views, gap = [], []
for distance in distances:
    focal = camera.scale * distance  # then s = f / distance is always the same
    lens = PerspectiveCamera(focal, np.eye(3), (0, 0, -distance), (149.5, 149.5))
    y = head @ lens.rotation.T + lens.translation
    assert np.allclose(lens.project(head), lens.principal_point + focal * y @ P.T / -y[:, 2:])
    parallel = ScaledOrthographicCamera(camera.scale, np.eye(3), (149.5, 149.5))
    gap.append(np.abs(lens.project(head) - parallel.project(head))[skin].max() / camera.scale)  # mm on the head
    views.append(clay(head, lens, 300))
strip(
    [*(views[k] for k in (0, 2, 4)), clay(head, parallel, 300)], ["0.3 m", "0.7 m", "2.5 m", "orthographic"], width=2.3
)
print({f"{d / 1000} m": f"{g:.0f} mm" for d, g in zip(distances, gap, strict=True)}, "largest difference on the skin")

# %% [markdown]
# *Figure: The same head at 0.3, 0.7 and 2.5 metres with the eyes equally far apart, and without perspective: near, the
# face is narrow, the nose large and the ears small or hidden; from 2.5 metres on the pictures look alike.*
#
# The difference falls like one over the distance. Portraits are painted and taken from one or two metres, drawings have
# no lens at all: so the fit uses (1) unless you ask for `camera="perspective"`. A selfie at arm's length is where you
# should.
#
# ## 4 · The pose, in closed form
#
# Known: points $v_n$ of a face in space, and where they are seen, $q_n$. Wanted: $s, R, t$. If $A$ may be *any* 2 × 3
# matrix, $q_n \approx A v_n + t$ is a linear least-squares problem. Subtract both means and $t$ is gone; `lstsq` does
# the rest. Then find the scaled rotation nearest to $A$. With the singular value decomposition
# $A = U\,\mathrm{diag}(\sigma_1, \sigma_2)\,V^T$,
#
# $$ R_{2\times3} = U V^T, \qquad s = \tfrac12 (\sigma_1 + \sigma_2), \tag{4} $$
#
# and the third row of $R$ is the cross product of the two. (Proof: see lesson 2, where the same decomposition turns one
# shape onto another.)


# %%
def pose(points: np.ndarray, pixels: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Equation (4): scale, rotation and translation of (1)."""
    up = pixels * [1, -1]
    centre3, centre2 = points.mean(axis=0), up.mean(axis=0)
    A = np.linalg.lstsq(points - centre3, up - centre2, rcond=None)[0].T
    U, sigma, Vt = np.linalg.svd(A, full_matrices=False)
    rows, s = U @ Vt, sigma.mean()
    R = np.vstack([rows, np.cross(*rows)])
    return s, R, (centre2 - s * rows @ centre3) * [1, -1]


inner = np.arange(17, 68)
points = head[model.landmarks[inner]]
exact = ScaledOrthographicCamera.look(yaw=-40, pitch=8, roll=12, size=400, extent=300)
s, R, t = pose(points, exact.project(points))
assert np.allclose(s, exact.scale) and np.allclose(R, exact.rotation) and np.allclose(t, exact.translation)
for mine, theirs in zip((s, R, t), scaled_orthographic_pose(points, exact.project(points)), strict=True):
    assert np.allclose(mine, theirs)

names = ("moustache_man", "bad_guy", "blonde_girl_threequarter", "astronaut")
fig, axes = plt.subplots(1, 4, figsize=(10, 3))
yaws = {}
for axis, name in zip(axes, names, strict=True):
    portrait = data_path(f"examples/portraits/{name}.png")
    img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
    s, R, t = pose(points, landmarks[inner])
    fit = tg.fit_3dmm(None, landmarks)
    yaws[name] = (ScaledOrthographicCamera(s, R, t).yaw, fit.camera.yaw)
    axis.imshow(img)
    nose = np.array([0, -30, 25.0])  # mm, near the tip
    for direction, colour in zip(70 * np.eye(3), ("tab:red", "tab:green", "tab:blue"), strict=True):
        ends = (np.stack([nose, nose + direction]) @ R.T)[:, :2] * [s, -s] + t
        axis.plot(*ends.T, c=colour, lw=3)
    low, high = landmarks.min(axis=0), landmarks.max(axis=0)
    pad = 0.3 * (high - low)
    axis.set(xlim=(low[0] - pad[0], high[0] + pad[0]), ylim=(high[1] + pad[1], low[1] - 2 * pad[1]))
    axis.set_title(f"{name}\nyaw {round(yaws[name][0])}° (fit: {round(yaws[name][1])}°)", fontsize=8)
    axis.axis("off")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Three drawings and a photograph with the axes of the head drawn at the nose: red to the subject's left, green
# up, blue out of the face; on the girl's three-quarter view the blue axis points far to the side.*
#
# All four used the *same* average face. The formula is a good start and no more: what is special about a face shifts
# it, and the fit of lesson 5 goes on from there with shape and pose together.
#
# ## 5 · A nod or a long chin?
#
# How well can pose and shape be told apart at all? Ask how the 51 dots move when the head nods by one degree, and
# whether another *shape* could move them just so. That is a small least-squares problem with a prior (lesson 3): the
# least coefficients $c$ (in standard deviations) whose motion of the dots equals that of the nod, up to the 1.4 % of
# the outer-eye distance by which landmarks are noisy anyway.

# %%
eyes = np.linalg.norm(points[36 - 17] - points[45 - 17])
modes = np.asarray(model.principal_modes[:, model.landmarks[inner]], float)  # (80, 51, 3) mm
shape_moves = modes[:, :, :2].reshape(80, -1).T / eyes  # (102, 80) seen from the front


def imitation(axis: np.ndarray, degrees: float) -> tuple[float, float]:
    """Of a turn about an axis: the share of its motion that shapes imitate, and how unusual they are, in deviations."""
    turn = np.radians(degrees) * np.cross(axis, points)[:, :2].ravel() / eyes
    # Translation and scale can follow too: they cost nothing.
    free = np.stack([np.tile([1.0, 0], 51), np.tile([0, 1.0], 51), points[:, :2].ravel() / eyes], axis=1)
    A = np.hstack([shape_moves, free])
    ridge = np.diag(np.r_[np.ones(80), np.zeros(3)]) * 0.014**2
    c = np.linalg.solve(A.T @ A + ridge, A.T @ turn)
    moved = turn - free @ np.linalg.lstsq(free, turn, rcond=None)[0]
    return 1 - np.linalg.norm(turn - A @ c) / np.linalg.norm(moved), float(np.linalg.norm(c[:80]))


nod, shake, tilt = (imitation(axis, 5.0) for axis in np.eye(3))
for name, (share, size) in {"nod": nod, "shake": shake, "tilt": tilt}.items():
    print(f"{name:5s} by 5°: {share:.0%} of it can be imitated, by a face {size:.1f} deviations from the likeliest")
print(f"(a random person is {np.sqrt(80):.1f} away: the length of 80 numbers with deviation 1)")

# %% [markdown]
# Nodding by 5° looks nearly the same as being another, quite ordinary person; shaking and tilting do not, since faces
# are symmetric. So from one frontal picture nobody can tell a nod from the way a face is built. The library takes the
# side of the ordinary: a weak prior that heads nod by no more than some 6°.
#
# ## 6 · Why the jaw is different
#
# An eye corner is a place on the skin. But look at what an annotator does at the cheek: there is nothing to see on the
# skin, so they put points 0 to 16 on the *outline* of the face. The outline is where the surface turns away from the
# viewer, and when the head turns, other skin is there.
#
# $$ \text{outline:}\quad n \cdot z = 0, \qquad n \text{ the normal},\ z \text{ the direction to the viewer.} \tag{5} $$

# %%
normals = vertex_normals(head, model.faces)
jaw = model.landmarks[:17]
fig, axes = plt.subplots(1, 3, figsize=(9.3, 3.2))
for axis, yaw in zip(axes, (0, 20, 40), strict=True):
    view = ScaledOrthographicCamera.look(yaw, size=300, centre=(0, -30, 0), extent=250)
    axis.imshow(clay(head, view, 300))
    for line in model.contour_lines:
        axis.plot(*view.project(head[line]).T, c="tab:blue", lw=0.6)
    turned_away = normals @ view.rotation[2] <= 0
    sliding = [
        line[turned_away[line].argmax()] if turned_away[line].any() else line[-1] for line in model.contour_lines
    ]
    axis.scatter(*view.project(head[jaw]).T, s=16, marker="x", c="tab:red", label="fixed vertices")
    axis.scatter(
        *view.project(head[sliding]).T, s=14, c="white", edgecolors="black", linewidths=0.6, label="on the outline"
    )
    axis.set_title(f"yaw {yaw}°", fontsize=9)
    axis.axis("off")
axes[0].legend(fontsize=7, loc="lower left")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: A head turned by 0, 20 and 40 degrees with lines across its jaw: red crosses stay on the skin and wander into
# the face or out of sight, white dots lie on the visible outline at each turn.*
#
# The remedy: each jaw point has a *contour line* of vertices across the jaw (blue). For a given pose it takes the first
# vertex of its line, from the front, that turns away from the viewer. The library does it between two minimisations:
# place the points, fit, place them anew, until they stay. `fit.landmark_vertices` are those of the last time. How much
# does it matter? Turn the head, take the true outline, and measure the pose once with points on the outline and once
# with fixed vertices:


# %%
def slide(view: ScaledOrthographicCamera, vertices: np.ndarray) -> np.ndarray:
    """The vertices (17,) of the jaw points at a pose."""
    away = vertex_normals(vertices, model.faces) @ view.rotation[2] <= 0
    return np.array([line[away[line].argmax()] if away[line].any() else line[-1] for line in model.contour_lines])


turns = np.arange(0, 61, 10)
wrong_yaw, right_yaw, drift = [], [], []
for yaw in turns:
    view = ScaledOrthographicCamera.look(yaw, size=400, extent=300)
    seen = np.r_[slide(view, head), model.landmarks[17:]]
    dots = view.project(head[seen])
    drift.append(np.linalg.norm(dots[:17] - view.project(head[jaw]), axis=1).mean() / view.scale / eyes)
    wrong_yaw.append(ScaledOrthographicCamera(*pose(head[model.landmarks], dots)).yaw)
    guess = ScaledOrthographicCamera(*pose(head[model.landmarks], dots))
    for _ in range(5):  # place, fit, place anew
        guess = ScaledOrthographicCamera(*pose(head[np.r_[slide(guess, head), model.landmarks[17:]]], dots))
    right_yaw.append(guess.yaw)

fig, axes = plt.subplots(1, 2, figsize=(8.6, 3))
axes[0].plot(turns, np.array(wrong_yaw) - turns, "x-", c="tab:red", label="fixed vertices")
axes[0].plot(turns, np.array(right_yaw) - turns, "o-", c="tab:blue", label="sliding points")
axes[0].set(xlabel="true yaw, degrees", ylabel="error of the yaw, degrees")
axes[0].legend(fontsize=8)
axes[1].plot(turns, 100 * np.array(drift), "x-", c="tab:red")
axes[1].set(
    xlabel="true yaw, degrees", ylabel="% of the outer-eye distance", title="fixed jaw vertices against the outline"
)
axes[1].title.set_fontsize(9)
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: With fixed jaw vertices the measured yaw is off by several degrees as the head turns, with sliding points it
# is right; the distance of the fixed vertices from the outline grows with the turn.*
#
# And even on the outline, *where along it* a point lies is a matter of the annotator's taste. So the library lets an
# error along the outline count less than one across it (`JawOptions.tangent`), and all jaw points little
# (`JawOptions.weight`).
#
# ## Exercises
#
# 1. *Mirror.* Reflect the pixels of a pose ($x \to -x$) and compute the pose again with (4). Is the result a rotation?
#    How large are the residuals? Where does the head look?
# 2. *Depth.* Flatten the face to a plate (z = 0). What does (4) say about a yaw of +25° and of −25°?
# 3. *Focal length.* Project the landmarks from 0.5 m, move each by a pixel of noise, and fit with
#    `camera="perspective"`, with the true `focal_px` and without. How well does the fit find the distance?
#
# ## Solutions

# %%
# 1. It is a rotation, and it fits exactly: the head seen from *behind*, as if it were of glass. For if r1, r2, r3 are
#    the rows of R, then -r1, r2, -r3 are those of a rotation too, and the third is not seen. That a face hides what is
#    behind it is not in (1). So look at R[2, 2], the cosine between the view and where the face looks, before you
#    believe a pose.
mirrored = exact.project(points) * [-1, 1]
s, R, t = pose(points, mirrored)
left_over = ScaledOrthographicCamera(s, R, t).project(points) - mirrored
mirror_miss = float(np.sqrt((left_over**2).sum(axis=1).mean()) / (s * eyes))
print(f"determinant {np.linalg.det(R):.0f}, residuals {mirror_miss:.0e}, the face looks along z = {R[2, 2]:.2f}")

# %%
# 2. The picture of a plate turned either way is the same: narrower by cos(25°). Only depth tells the sign of a yaw.
plate = points * [1, 1, 0]
left, right = (ScaledOrthographicCamera.look(yaw, size=400, extent=300).project(plate) for yaw in (-25, 25))
plate_gap = float(np.abs(left - right).max())
print(f"the two pictures differ by {plate_gap:.1e} px")

# %%
# 3. Given the focal length, the distance comes out to within some percent. Without it, the fit has only the faint
#    perspective of the face itself, and shapes that imitate it: one pixel of noise moves the distance by centimetres.
lens = PerspectiveCamera(900.0, ScaledOrthographicCamera.look(10).rotation, (0, 0, -500.0), (300.0, 300.0))
near = lens.project(head[np.r_[slide(ScaledOrthographicCamera.look(10), head), model.landmarks[17:]]])
fitted = {"with": [], "without": []}
for k in range(5):
    noisy = near + np.random.default_rng(k).normal(0, 1, near.shape)
    for lens_is, known in (("with", {"focal_px": 900.0}), ("without", {})):
        fit = tg.fit_3dmm(None, noisy, camera="perspective", principal_point=(300.0, 300.0), **known)
        fitted[lens_is].append(-float(fit.camera.translation[2]))
for lens_is, found in fitted.items():
    print(f"true 500 mm; {lens_is} the focal length {min(found):.0f} to {max(found):.0f} mm")
distance_given, distance_found = (max(found, key=lambda d: abs(d - 500)) for found in fitted.values())

# %%
numbers: dict[str, float] = {
    "gap_near_mm": float(gap[0]),
    "gap_far_mm": float(gap[-1]),
    "gap_ratio": float(gap[3] / gap[4]),
    "yaw_girl": yaws["blonde_girl_threequarter"][0],
    "yaw_girl_fit": yaws["blonde_girl_threequarter"][1],
    "nod_imitated": nod[0],
    "nod_deviations": nod[1],
    "shake_imitated": shake[0],
    "tilt_imitated": tilt[0],
    "yaw_error_fixed": float(np.abs(np.array(wrong_yaw) - turns).max()),
    "yaw_error_sliding": float(np.abs(np.array(right_yaw) - turns).max()),
    "mirror_miss": mirror_miss,
    "mirror_looks": float(R[2, 2]),
    "plate_gap": plate_gap,
    "distance_given": distance_given,
    "distance_found": distance_found,
}
