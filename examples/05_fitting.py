# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 5 · Fitting
#
# **Which face, seen from where, puts its landmarks onto these dots?**
#
# A morphable model makes faces from numbers; a camera makes pixels from faces. Fitting runs both backwards. There is no
# formula for that. So we write down *how wrong* a guess is, as one number, and let an optimizer make it small. On the
# way all the questions come up that make fitting an art: is my gradient right? Why is it so slow? Why does the face
# look like a monster although all landmarks fit? And what if one landmark is simply wrong?
#
# You need numpy, and what a derivative is. Lessons 3 and 4 explain the model and the camera at length; what is used of
# them is repeated here.

# %%
import matplotlib.pyplot as plt
import nlopt
import numpy as np

import toongeo as tg
from toongeo.model import data_path
from toongeo.pipeline.fit.frame.unknowns import Unknowns
from toongeo.pipeline.fit.losses.landmark_loss import LandmarkLoss
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

# %% [markdown]
# ## 1 · From numbers to dots
#
# **The model.** Vertex $n$ of a face is a mean plus a sum of displacements ("modes"), each with a coefficient:
#
# $$ p_n = \mu_n + \sum_k B_{nk}\, c_k \qquad (\mu_n, B_{nk} \in \mathbb{R}^3, \text{ mm}) \tag{1} $$
#
# (Here $\mu$ is the likeliest face, so that $c = 0$ is it. It is not `model.mean`: see lesson 3.)
#
# Some coefficients say who it is (*identity*, here 81 of them, counted in standard deviations from the likeliest face),
# some say the *expression* (46 named ones such as `jawOpen`, from 0 to 1). A landmark is just a certain vertex: number
# 30 is the vertex on the tip of the nose. So of all 19,057 vertices the fit looks at 51: landmarks 17 to 67. The 17
# points of the jaw line are left to lesson 4, because they are not fixed vertices.
#
# **The camera.** Turn the face by a rotation $R$, drop the depth, scale it by $e^\ell$, shift it by $t$:
#
# $$ \hat q_n = e^{\ell}\, \begin{bmatrix} 1 & 0 & 0 \\ 0 & 1 & 0 \end{bmatrix} R\, p_n + t . \tag{2} $$
#
# The scale is written as $e^\ell$ so that no guess can make it negative. $R$ is made of three angles: first yaw (a head
# shaken), then pitch (nodding), then roll (tilting): $R = R_z(\text{roll})\, R_x(\text{pitch})\, R_y(\text{yaw})$.
#
# **The unit.** Pixels depend on the size of the picture. We count in outer-eye distances (between landmarks 36 and 45)
# instead, from the middle of the landmarks, and with y up. A residual of 0.01 then always means the same: a hundredth
# of the width of both eyes.

# %%
model = tg.default_model()
inner = np.arange(17, 68)
likeliest = model.prior.mean  # identity coefficients of the likeliest face; ours count from there
named = model.n_named

mean = model.vertices(likeliest)[model.landmarks[inner]]  # (51, 3) mm: mu
modes = np.concatenate([model.identity, model.expression[:named]])[:, model.landmarks[inner]]
modes = np.asarray(modes.transpose(1, 2, 0), float)  # (51, 3, 127) mm: B
N, _, K = modes.shape
n_id = len(likeliest)

portrait = data_path("examples/portraits/moustache_man.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
unit_px = np.linalg.norm(landmarks[36] - landmarks[45])
middle_px = landmarks[inner].mean(axis=0)


def from_px(pixels: np.ndarray) -> np.ndarray:
    """Pixels (k, 2), y down -> outer-eye distances, y up."""
    return (pixels - middle_px) * [1, -1] / unit_px


def to_px(points: np.ndarray) -> np.ndarray:
    """The inverse of `from_px`."""
    return points * [1, -1] * unit_px + middle_px


q = from_px(landmarks[inner])  # (51, 2): the dots

# %% [markdown]
# All unknowns stand in one vector:
# $x = [\,c_1 \dots c_{127},\ \text{yaw}, \text{pitch}, \text{roll},\ \ell,\ t_x, t_y\,]$. Here is (1) and (2) in code,
# and with it what the optimizer will ask for: how each dot moves when each unknown moves. Such a table of derivatives
# is called the *Jacobian* $J$. It comes from (2) term by term:
#
# | unknown | how $\hat q_n$ moves |
# |---|---|
# | $c_k$ | $e^\ell R_{2\times3} B_{nk}$: the mode, seen by the camera ($R_{2\times 3}$: the first two rows of $R$) |
# | yaw | $e^\ell R_z R_x R_y'\, p_n$, its first two rows; likewise pitch and roll |
# | $\ell$ | $e^\ell R_{2\times3}\, p_n$: away from the origin of the model |
# | $t$ | by itself |


# %%
def rotation(angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """R (3, 3) for yaw, pitch, roll in radians, and its derivative by each of the three (3, 3, 3)."""
    # A turn about y mixes z and x, one about x mixes y and z, one about z mixes x and y: always by [[c, -s], [s, c]].
    factors, slopes = [], []
    for angle, (i, j) in zip(angles, ((2, 0), (1, 2), (0, 1)), strict=True):
        c, s = np.cos(angle), np.sin(angle)
        turn, slope = np.eye(3), np.zeros((3, 3))
        turn[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
        slope[[i, i, j, j], [i, j, i, j]] = -s, -c, c, -s
        factors.append(turn)
        slopes.append(slope)
    (Ry, Rx, Rz), (dRy, dRx, dRz) = factors, slopes
    # Product rule: each angle stands in one factor only.
    return Rz @ Rx @ Ry, np.stack([Rz @ Rx @ dRy, Rz @ dRx @ Ry, dRz @ Rx @ Ry])


def dots(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the landmarks are seen (51, 2), and the Jacobian (51, 2, 133)."""
    R, dR = rotation(x[K : K + 3])
    scale, p = np.exp(x[K + 3]), mean + modes @ x[:K]
    J = np.zeros((N, 2, K + 6))
    J[:, :, :K] = scale * R[:2] @ modes
    J[:, :, K : K + 3] = scale * np.einsum("aij,nj->nia", dR[:, :2], p)
    J[:, :, K + 3] = scale * p @ R[:2].T
    J[:, :, K + 4 :] = np.eye(2)
    return J[:, :, K + 3] + x[K + 4 :], J  # the column of l is the dot itself, before the shift


start = np.zeros(K + 6)  # the likeliest face, at rest, from the front, ...
start[K + 3] = -np.log(np.linalg.norm(mean[36 - 17] - mean[45 - 17]))  # ... as large as the one in the picture
start[K + 4 :] = -np.exp(start[K + 3]) * mean[:, :2].mean(axis=0)

check = ScaledOrthographicCamera.look(yaw=25, pitch=-10, roll=5)  # degrees; our rotation is the library's
assert np.allclose(rotation(np.radians([25, -10, 5]))[0], check.rotation)


def draw_dots(axis, x, title):
    """The picture, its landmarks as dots, and where x puts them as crosses."""
    axis.imshow(img)
    found = to_px(dots(x)[0])
    for a, b in zip(landmarks[inner], found, strict=True):
        axis.plot(*np.stack([a, b]).T, c="tab:red", lw=0.8)
    axis.scatter(*landmarks[inner].T, s=12, c="white", edgecolors="black", linewidths=0.5)
    axis.scatter(*found.T, s=12, marker="x", c="tab:red", linewidths=0.9)
    (left, top), (right, bottom) = landmarks[inner].min(axis=0) - 25, landmarks[inner].max(axis=0) + 25
    axis.set(xlim=(left, right), ylim=(bottom, top))
    axis.set_title(title, fontsize=9)
    axis.axis("off")


fig, axis = plt.subplots(figsize=(3.8, 3.8))
draw_dots(axis, start, "the likeliest face, not fitted")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: The drawing with its landmarks as dots, and the landmarks of the likeliest face as crosses, joined to their
# dots by red lines; brows, mouth and nose are all off.*
#
# ## 2 · How wrong is a guess?
#
# The red lines are the *residuals* $r_n = \hat q_n - q_n$. The mean of their squares is the landmark loss (Eq. 4 of Pan
# et al. 2024), with a weight $\omega_n$ for each point, which is 1 for now:
#
# $$ L_{\text{lan}}(x) = \frac1N \sum_n \omega_n \lVert r_n(x) \rVert^2 . \tag{3} $$
#
# Why squares? They are smooth, they make large errors count, and if the dots are off by independent Gaussian noise, the
# least squares are the likeliest answer. (Where that is false, squares do harm: section 6.)
#
# The gradient says in which direction the loss grows fastest. By the chain rule, with $J_n$ (2 × 133) as the part of
# $J$ that belongs to dot $n$,
#
# $$ \frac{\partial L_{\text{lan}}}{\partial x} = \frac2N \sum_n \omega_n\, J_n^T\, r_n . \tag{4} $$


# %%
def landmark_loss(x, points=None, weights=None):
    """(3) and its gradient (4)."""
    points = q if points is None else points
    weights = np.ones(N) if weights is None else weights
    found, J = dots(x)
    r = found - points
    value = (weights * (r**2).sum(axis=1)).sum() / N
    return value, 2 / N * np.einsum("nik,ni->k", J, weights[:, None] * r)


value, _ = landmark_loss(start)
print(f"loss of the start: {value:.5f}, which is an error of {np.sqrt(value):.1%} of the outer-eye distance")

# %% [markdown]
# The library has the same term in `toongeo/pipeline/fit/losses/landmark_loss.py`. It turns the head by a rotation
# vector in place of three angles, since angles fail when a head looks straight up or down. That vector counts from
# `rotation0`, so it is zero here; and a weight is a 2 × 2 matrix, here the identity. The value must be the same, and so
# must the slopes, but for those of the rotation, which is counted in another way:

# %%
# A place with nothing special about it: at a minimum, or at zero, many mistakes do not show.
somewhere = start + 0.1 * np.random.default_rng(0).standard_normal(len(start))
of_library = LandmarkLoss(
    unknowns=Unknowns(n_id, named),
    points=q,
    weights=np.tile(np.eye(2), (N, 1, 1)),
    count=N,
    mean=mean,
    modes=modes.reshape(3 * N, K),
    rotation0=rotation(somewhere[K : K + 3])[0],
)
same_value, same_slope = of_library(np.r_[somewhere[:K], 0, 0, 0, somewhere[K + 3 :]])
value, slope = landmark_loss(somewhere)
assert np.isclose(value, same_value)
assert np.allclose(slope[:K], same_slope[:K]) and np.allclose(slope[K + 3 :], same_slope[K + 3 :])

# %% [markdown]
# ## 3 · Is the gradient right?
#
# A wrong gradient does not crash. The optimizer stops early, or crawls, and the result is a bit bad. So never trust a
# gradient; test it. Taylor's theorem is the test: along any direction $d$,
#
# $$ f(x + h d) = f(x) + h\, g^T d + O(h^2) , $$
#
# where $O(h^2)$ stands for something that shrinks like $h^2$. If $g$ is the gradient, what is left over,
# $|f(x + hd) - f(x) - h\,g^T d|$, shrinks *a hundredfold* when $h$ shrinks tenfold. If $g$ is wrong, a term with $h$
# stays, and it shrinks only tenfold. In a plot with two logarithmic axes these are slopes of 2 and 1. Below, the right
# gradient, and one with a typical mistake: the scale was forgotten in the column of yaw.


# %%
def with_a_mistake(x):
    """A loss whose gradient is wrong in one of 133 entries."""
    value, slope = landmark_loss(x)
    slope[K] /= np.exp(x[K + 3])
    return value, slope


def remainders(loss, x, d, steps):
    """What Taylor's first order leaves over."""
    value, slope = loss(x)
    return np.array([abs(loss(x + h * d)[0] - value - h * slope @ d) for h in steps])


rng = np.random.default_rng(1)
d = rng.standard_normal(len(start))
d /= np.linalg.norm(d)
steps = 10.0 ** -np.arange(0, 8)
right, wrong = remainders(landmark_loss, somewhere, d, steps), remainders(with_a_mistake, somewhere, d, steps)

fig, axis = plt.subplots(figsize=(5, 3.4))
axis.loglog(steps, wrong, "x-", c="tab:red", label="one entry wrong: slope 1")
axis.loglog(steps, right, "o-", c="tab:blue", label="right gradient: slope 2")
axis.axhline(value * np.finfo(float).eps, c="0.6", ls=":", label="rounding error of the loss")
axis.set(xlabel="step h", ylabel="remainder")
axis.legend(fontsize=8)
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Two straight lines in a doubly logarithmic plot: with each decade of the step the remainder of the right
# gradient shrinks by two decades, almost down to rounding error, that of the wrong one by one.*
#
# `tg.check_gradient` does this along several directions and tells the slopes. Use it on each loss that you write.

# %%
good, bad = tg.check_gradient(landmark_loss, somewhere), tg.check_gradient(with_a_mistake, somewhere)
print(f"right: passed {good.passed}, slopes {good.slopes.round(2)}")
print(f"wrong: passed {bad.passed}, slopes {bad.slopes.round(2)}")

# %% [markdown]
# ## 4 · Downhill
#
# The simplest optimizer walks against the gradient: $x \leftarrow x - \eta\, g$, with the step $\eta$ halved until the
# loss falls enough. It works, and it is hopeless. The reason is that unknowns differ in strength. Turning the head by
# one radian moves the dots by 0.3 of the outer-eye distance or more; one standard deviation of a typical identity mode
# by less than a hundredth of that. The loss is a narrow valley, and the gradient points at its walls, not along it.
#
# Two remedies.
#
# **Scale the unknowns** so that each has the same curvature. The second derivative of a sum of squares is
# $H \approx \frac2N \sum_n \omega_n J_n^T J_n$. (Differentiate (4) once more; what is left out is multiplied by the
# residuals, which are small. This is called the *Gauss-Newton* matrix.) So measure unknown $k$ in units of
# $1 / \sqrt{H_{kk}}$. (The prior adds its own second derivative; the weights $\omega_n$ are left out, for a scale need
# not be exact.)
#
# **Remember.** Near its minimum a smooth loss is a bowl, and the step to the bottom is $-H^{-1} g$ (Newton). It needs
# the whole matrix $H$ and a solution with it, in each step. L-BFGS never forms $H$: it keeps the last few steps
# $\Delta x$ and the changes $\Delta g$ of the gradient that came with them. Each such pair says how the bowl curves in
# one direction, $H \Delta x \approx \Delta g$, and from a handful of them a good guess of $-H^{-1} g$ is put together
# with a few dot products. nlopt has it, and bounds too: a `jawOpen` below 0 means nothing, so named expressions stay in
# $[0, 1]$.
#
# So that the three walks below have a definite goal, the loss already has the small prior that section 5 explains.


# %%
def total_loss(x, prior_weight=4e-6, points=None, weights=None):
    """(3) plus the prior (5), and the gradient."""
    value, slope = landmark_loss(x, points, weights)
    stiffness = np.r_[np.ones(n_id), np.full(named, 4.0), np.zeros(6)]
    return value + prior_weight * (stiffness * x**2).sum(), slope + 2 * prior_weight * stiffness * x


assert tg.check_gradient(total_loss, somewhere).passed

lower = np.r_[np.full(n_id, -4.0), np.zeros(named), np.full(6, -np.inf)]
upper = np.r_[np.full(n_id, 4.0), np.ones(named), np.full(6, np.inf)]
upper[n_id + model.expression_index("mouthClose")] = 0  # it mends an open jaw; dots cannot tell it from a long chin
lower[K + 3], upper[K + 3] = start[K + 3] - 2, start[K + 3] + 2


def typical_steps(x, prior_weight=4e-6):
    """1 / sqrt(H_kk): in these units each unknown has the curvature 1."""
    J = dots(x)[1]
    stiffness = np.r_[np.ones(n_id), np.full(named, 4.0), np.zeros(6)]
    return 1 / np.sqrt(2 / N * (J**2).sum(axis=(0, 1)) + 2 * prior_weight * stiffness)


def lbfgs(loss, x, scale=None, evaluations=1500):
    """nlopt's L-BFGS within the bounds; the best x, and the loss at each evaluation."""
    scale = np.ones(len(x)) if scale is None else scale
    trace = []

    def objective(z, gradient):
        value, slope = loss(z * scale)
        gradient[:] = slope * scale  # chain rule: x = scale z
        trace.append(value)
        return value

    optimizer = nlopt.opt(nlopt.LD_LBFGS, len(x))
    optimizer.set_min_objective(objective)
    optimizer.set_lower_bounds(lower / scale)
    optimizer.set_upper_bounds(upper / scale)
    optimizer.set_ftol_rel(1e-9)
    optimizer.set_maxeval(evaluations)
    return optimizer.optimize(x / scale) * scale, np.array(trace)


def steepest_descent(loss, x, evaluations=1500):
    """Against the gradient, within the bounds; the step is halved until the loss falls enough, and doubled after."""
    value, slope = loss(x)
    trace, eta = [value], 1.0
    while len(trace) < evaluations:
        new = np.clip(x - eta * slope, lower, upper)
        new_value, new_slope = loss(new)
        trace.append(new_value)
        if new_value <= value - 0.1 * slope @ (x - new):
            x, value, slope, eta = new, new_value, new_slope, 2 * eta
        else:
            eta /= 2
    return x, np.array(trace)


scale = typical_steps(start)
_, walk = steepest_descent(total_loss, start)
_, plain = lbfgs(total_loss, start)
fitted, scaled = lbfgs(total_loss, start, scale)

best = min(trace.min() for trace in (walk, plain, scaled))
fig, axis = plt.subplots(figsize=(6.2, 3.4))
for trace, label in ((walk, "steepest descent"), (plain, "L-BFGS"), (scaled, "L-BFGS, scaled unknowns")):
    axis.semilogy(np.minimum.accumulate(trace) - best + 1e-12, label=label)
axis.set(xlabel="evaluations of the loss", ylabel="loss above the best", xlim=(0, 600))
axis.legend(fontsize=8)
plt.tight_layout()
plt.show()


def evaluations_until(trace, excess):
    """How many evaluations until the loss is within a share of the best."""
    there = np.flatnonzero(trace <= best * (1 + excess))
    return int(there[0]) + 1 if len(there) else len(trace)


counts = [evaluations_until(trace, 0.01) for trace in (walk, plain, scaled)]
print(f"within 1 % of the best after {counts[1]} evaluations, with scaled unknowns after {counts[2]};")
print(f"steepest descent is {walk.min() / best:.2f} times the best after {len(walk)}")

# %% [markdown]
# *Figure: Loss above the best against evaluations, logarithmic: steepest descent hardly falls any more after its first
# steps, L-BFGS falls steadily, and with scaled unknowns much faster.*

# %%
fig, axes = plt.subplots(1, 2, figsize=(7.6, 3.9))
draw_dots(axes[0], start, "start")
draw_dots(axes[1], fitted, "fitted")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: The drawing twice, with residuals as red lines: long ones at the start, and after the fit crosses that lie on
# their dots or beside them.*
#
# ## 5 · A prior, or a monster
#
# There are 133 unknowns and 102 numbers. Of course everything fits! What comes out without a prior is a monster, as we
# shall see below.
#
# A *prior* says what we believe before we see the picture: identities are spread around the likeliest face with
# standard deviation 1 in each coefficient, expressions are mostly small. If the dots have Gaussian noise of standard
# deviation $\sigma$ in each coordinate, the likeliest face given both maximises
#
# $$ \prod_n e^{-\lVert r_n \rVert^2 / 2\sigma^2} \cdot \prod_k e^{-c_k^2/2} . $$
#
# Take the logarithm, turn the sign, multiply by $2\sigma^2/N$:
#
# $$ L(x) = \frac1N \sum_n \lVert r_n \rVert^2 +
#    w_r \Bigl( \sum_{k\,\in\,\text{id}} c_k^2 + 4\!\!\sum_{k\,\in\,\text{exp}} c_k^2 \Bigr),
#    \qquad w_r = \frac{\sigma^2}{N} . \tag{5} $$
#
# (That is Eq. 3 and 6 of the paper; the 4 says that expressions are spread by 0.5 and not by 1.) So the weight of a
# prior is no taste: it is the noise that you expect. With $\sigma$ = 1.4 % of the outer-eye distance and 51 points,
# $w_r = 0.014^2 / 51 \approx 4 \cdot 10^{-6}$, which is the library's default.
#
# How do you *know* that a weight is good? Not from the residuals: they only grow with $w_r$. Two honest measures:
#
# - **Held-out points.** Leave out every fourth dot, fit the others, and see how well the face predicts those left out.
# - **Truth.** Make faces whose shape is known, project them, add noise, fit, and compare in 3D.

# %%
skin = model.region("face")


def shape_of(x):
    """All vertices (n, 3) of x, mm, in the model's own frame."""
    return model.vertices(likeliest + x[:n_id], np.r_[x[n_id:K], np.zeros(len(model.expression) - named)])


def fit(points, prior_weight=4e-6, weights=None, x=start):
    """The minimiser of (5)."""

    def loss(z):
        return total_loss(z, prior_weight, points, weights)

    return lbfgs(loss, x, typical_steps(x, prior_weight), evaluations=400)[0]


def rms(r):
    """Root mean square length of residuals (k, 2)."""
    return float(np.sqrt((r**2).sum(axis=1).mean()))


def held_out(points, prior_weight):
    """Error of the dots, each on a face that was fitted to the other three quarters of them."""
    r = np.zeros((N, 2))
    for k in range(4):
        left = np.arange(N) % 4 == k
        x = fit(points, prior_weight, weights=1.0 - left)
        r[left] = (dots(x)[0] - points)[left]
    return rms(r)


rng = np.random.default_rng(5)
people = []
for _ in range(5):
    person = start.copy()
    person[:80] = rng.standard_normal(80)  # the 81st mode tells drawings from people: see lesson 3
    chosen = rng.choice(named - 1, 4, replace=False)  # any four but the last, tongueOut, which no dot shows
    person[n_id + chosen] = rng.uniform(0.1, 0.5, 4)
    person[n_id + model.expression_index("mouthClose")] = 0
    person[K : K + 3] = rng.normal(0, np.radians([20, 5, 5]))
    people.append((person, dots(person)[0] + 0.014 * rng.standard_normal((N, 2))))


def error_3d(x, person):
    """Root mean square distance of the vertices of the face, mm; pose is no matter."""
    return float(np.sqrt(((shape_of(x) - shape_of(person))[skin] ** 2).sum(axis=1).mean()))


prior_weights = 10.0 ** np.arange(-9, -1.0)
used = [rms(dots(fit(q, w))[0] - q) for w in prior_weights]
left_out = [held_out(q, w) for w in prior_weights]
in_3d = [np.mean([error_3d(fit(points, w), person) for person, points in people]) for w in prior_weights]
mean_face_3d = np.mean([error_3d(start, person) for person, _ in people])

fig, axes = plt.subplots(1, 2, figsize=(9.6, 3.3))
axes[0].loglog(prior_weights, used, "o-", c="0.6", label="points that were used")
axes[0].loglog(prior_weights, left_out, "s-", c="tab:blue", label="points that were left out")
axes[0].set(xlabel="$w_r$", ylabel="error / outer-eye distance", title="this drawing")
axes[1].semilogx(prior_weights, in_3d, "s-", c="tab:green", label="fitted face")
axes[1].axhline(mean_face_3d, c="0.6", ls=":", label="the likeliest face for all")
axes[1].set(xlabel="$w_r$", ylabel="error in 3D, mm", title="five people whose faces are known", ylim=(0, None))
for axis in axes:
    axis.axvline(4e-6, c="tab:orange", lw=1, label="$\\sigma^2/N$")
    axis.legend(fontsize=8)
    axis.title.set_fontsize(9)
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Left, errors against the prior's weight: at used points they only grow, at left-out points there is a valley
# around a weight of 1e-6; right, the error in 3D of known faces has a valley around 1e-5.*

# %%
weak, strong = fit(q, 1e-9), fit(q, 1e-2)
faces = ("w_r = 1e-9", weak), ("w_r = 4e-6", fitted), ("w_r = 1e-2", strong)
fig, axes = plt.subplots(1, 3, figsize=(7.6, 3.0))
camera = ScaledOrthographicCamera.look(20, size=260, centre=(0, 0, 0), extent=290)
for axis, (title, x) in zip(axes, faces, strict=True):
    axis.imshow(render_mesh(Surface(shape_of(x), model.faces), camera, 260, shading="clay"))
    largest = np.abs(x[:n_id]).max()
    axis.set_title(f"{title}\nerror {rms(dots(x)[0] - q):.2%}, largest |c| {largest:.1f}", fontsize=9)
    axis.axis("off")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Three clay heads fitted with a weak, a fitting and a strong prior: the first is bent and lumpy, the second a
# plausible man with a broad jaw, the third almost the average face.*
#
# The two valleys do not lie at the very same place: one drawing is no person, and four quarters of 51 points are few.
# But both lie near $\sigma^2/N$, and both warn of a prior that is far too weak: with 1e-9 the five people come out
# worse than if nothing had been fitted. The face on the left is of that kind. Half of its coefficients are at their
# bound, and it has the smallest error of the three. **The loss of the points that you fitted tells you nothing about
# the face.**
#
# ## 6 · One landmark is simply wrong
#
# A detector mistakes a hat for a brow; a hand slips. Squares take such a point at its word: an error five times as
# large counts twenty-five times. The remedy is a *kernel* $\rho$ that stops growing, here that of Geman and McClure:
#
# $$ L_{\text{lan}} = \frac1N \sum_n \rho(\lVert r_n \rVert^2), \qquad \rho(u) = \frac{u}{1 + u/\kappa^2} . \tag{6} $$
#
# The prior of (5) is added as before. The gradient of (6) is that of (3) with weights
# $\omega_n = \rho'(\lVert r_n \rVert^2) = (1 + \lVert r_n \rVert^2/\kappa^2)^{-2}$. Where the weights are, for the
# moment, held fixed, it is the old problem. So: fit, look which points lie far off, give them less weight, fit again.
# This is called *iteratively reweighted least squares*. The width $\kappa$ must follow the errors themselves, and the
# median is a yardstick that outliers cannot bend.

# %%
e = np.linspace(0, 5, 200)  # residual / kappa
fig, axes = plt.subplots(1, 2, figsize=(8, 2.8))
kernels = {
    "squares": (e**2, np.ones_like(e)),
    "Huber": (np.where(e < 1, e**2, 2 * e - 1), np.minimum(1, 1 / np.maximum(e, 1e-9))),
    "Geman-McClure": (e**2 / (1 + e**2), (1 + e**2) ** -2),
}
for name, (cost, weight) in kernels.items():
    axes[0].plot(e, cost, label=name)
    axes[1].plot(e, weight, label=name)
axes[0].set(xlabel="residual / κ", ylabel="cost", ylim=(0, 5))
axes[1].set(xlabel="residual / κ", ylabel="weight")
axes[0].legend(fontsize=8)
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Left, the cost of a residual: a parabola for squares, a straight line beyond 1 for Huber, a curve that levels
# off for Geman-McClure; right, the weights: constant, falling slowly, falling to nothing.*


# %%
def robust_fit(points, rounds=6, kernel=lambda u: (1 + u) ** -2):
    """Iteratively reweighted least squares; x and the weights (51,)."""
    x = fit(points)
    for _ in range(rounds):
        squares = ((dots(x)[0] - points) ** 2).sum(axis=1)
        # For 2D noise of variance s² in each coordinate the median of the squared length is 2 ln 2 · s²: that gives s.
        # Kappa is three s, so points within that are believed; but never less than the 1.4 % that section 5 expects.
        kappa_squared = max(9 * np.median(squares) / (2 * np.log(2)), 0.014**2)
        weights = kernel(squares / kappa_squared)
        x = fit(points, weights=weights, x=x)
    return x, weights


person, points = people[0]
wrong_brow = points.copy()
wrong_brow[0:5] += [0.05, 0.3]  # landmarks 17 to 21: the right brow is where the hat begins
wrong_brow[44] += [0.3, -0.1]  # and one point of the mouth slipped
results = {
    "clean dots, squares": fit(points),
    "six wrong dots, squares": fit(wrong_brow),
    "six wrong dots, robust": robust_fit(wrong_brow)[0],
}
errors_3d = {name: error_3d(x, person) for name, x in results.items()}
found_weights = robust_fit(wrong_brow)[1]
print({name: f"{value:.1f} mm" for name, value in errors_3d.items()})
print("landmarks that lost their weight:", inner[found_weights < 0.1])

fig, axes = plt.subplots(1, 4, figsize=(10, 2.9))
for axis, (title, x) in zip(axes, {"truth": person, **results}.items(), strict=True):
    axis.imshow(render_mesh(Surface(shape_of(x), model.faces), camera, 240, shading="clay"))
    axis.set_title(title, fontsize=9)
    axis.axis("off")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Four clay heads: the true face, a fit of clean dots that resembles it, a fit by squares of dots with six
# wrong ones, with a twisted forehead, and the robust fit, which resembles the truth again.*
#
# A kernel is no magic. Six points of 51 are outvoted by the rest; had half of all points been wrong, they would not be.
# (The sixth, landmark 18, just misses the list: the face reaches for it a little, and it keeps a tenth of its weight.)
# And a whole brow that lies higher may be a slip, or a raised brow: on a drawing the library believes it.
#
# ## 7 · The library
#
# `tg.fit_3dmm` is what you have built, with some care around it: all 68 points, those of the jaw sliding on the outline
# (lesson 4); weights by how well annotators agree on each point; a robust kernel, also for points that are shifted
# along with their neighbours; a prior on the pitch; a prior that counts more where a caricature misses all its points;
# a perspective camera, if asked; and, in the place of L-BFGS, Newton's steps within the bounds: with so few unknowns a
# solution with the whole matrix is cheap, and a tenth of the steps will do.

# %%
of_library = tg.fit_3dmm(None, landmarks)  # None: no picture is needed, the dots are enough
report = of_library.report
difference = float(np.sqrt(((of_library.vertices - shape_of(fitted))[skin] ** 2).sum(axis=1).mean()))
print(
    f"library: inner landmarks off by {report.rms_percent:.2f} %, in {report.evaluations} evaluations ({report.status})"
)
print(f"ours:    {100 * rms(dots(fitted)[0] - q):.2f} %; the two faces differ by {difference:.1f} mm in 3D")
strongest = sorted(of_library.expression_weights().items(), key=lambda item: -item[1])[:5]
print("strongest expressions:", {name: round(w, 2) for name, w in strongest})

# %% [markdown]
# Read the expressions with care: no dot tells a wrinkled nose from a short one, so a bit of what is drawn as *shape*
# comes out as *expression*, and the other way round.
#
# And what its kernel is good for: four points of another drawing, misplaced by three tenths of the outer-eye distance.

# %%
girl = tg.read_landmarks(data_path("examples/portraits/manga_girl.pts"))
unharmed = tg.fit_3dmm(None, girl)
angles = np.array([0.3, 2.0, 3.5, 5.0])  # rad: into four directions
wrong = girl.copy()
wrong[[24, 33, 54, 61]] += (
    0.3 * np.linalg.norm(girl[36] - girl[45]) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
)
plain_fit, robust = tg.fit_3dmm(None, wrong, robust=None), tg.fit_3dmm(None, wrong)


def moved_by(other):
    """How far a fit is from that of the right landmarks, mm."""
    return float(np.sqrt(((other.vertices - unharmed.vertices)[skin] ** 2).sum(axis=1).mean()))


print("robust: outliers", robust.report.outliers)
print(f"the face moved by {moved_by(plain_fit):.1f} mm with squares, by {moved_by(robust):.1f} mm with the kernel")

# %% [markdown]
# In a drawing whose points miss the model by much everywhere, the median is large, and so is the width of the kernel:
# an outlier then has to lie farther off to be called one.
#
# ## What to keep in mind
#
# - Forward model, residuals, loss, gradient, optimizer, prior, kernel: each fit of anything has these parts.
# - Check gradients by the slope of the remainder: 2 is right, 1 is wrong.
# - Scale unknowns; let L-BFGS do the walking; bound what has bounds.
# - The prior's weight is the noise that you expect. Judge it by points left out, never by points used.
# - 51 dots in a plane say little about depth. What comes out in z is mostly the prior's, and lesson 4 shows how pose
#   and shape can stand in for each other.
# - An optimizer goes downhill from where it starts, and in general finds *a* valley. Exercise 3 asks how many there are
#   here. A loss that compares pixels (lesson 7) has many.
#
# ## Exercises
#
# 1. *Finite differences.* Approximate the derivative of the loss by yaw as $(f(x + h) - f(x - h)) / 2h$ for $h$ from 1
#    to $10^{-12}$ and plot its error. Why does it have a smallest value, and where?
# 2. *Huber.* Use $\omega = \min(1, \kappa/\lVert r \rVert)$ in `robust_fit`. Is it as good against the six wrong dots?
#    Why not?
# 3. *Where to start.* Fit from starts with other poses: yaw 0°, 90°, 180°, each with pitch −60°, 0°, 60° and roll 0°,
#    180°. From which do you arrive at the same loss? And at the same angles?
# 4. *No lower bounds.* Fit without the lower bounds on expressions. Which are the most negative? What would they mean?
#
# ## Solutions

# %%
# 1. Truncation falls like h², rounding grows like 1/h: the two meet where h is about the cube root of 1e-16. At best
#    some ten digits are right; and one never knows beforehand at which h. The slope test needs no such luck.
e = np.zeros(len(start))
e[K] = 1
sizes = 10.0 ** -np.arange(0, 13)
true_slope = landmark_loss(somewhere)[1][K]
gaps = np.array(
    [
        abs((landmark_loss(somewhere + h * e)[0] - landmark_loss(somewhere - h * e)[0]) / (2 * h) - true_slope)
        for h in sizes
    ]
)
fig, axis = plt.subplots(figsize=(4.6, 2.8))
axis.loglog(sizes, gaps / abs(true_slope), "o-")
axis.set(xlabel="h", ylabel="relative error")
plt.tight_layout()
plt.show()
best_step = float(sizes[gaps.argmin()])
print(f"best h: {best_step:.0e}")

# %% [markdown]
# *Figure: The error of a finite difference against its step has the shape of a V, with the tip between 1e-4 and 1e-6.*

# %%
# 2. Huber's weight falls like 1/r, so the pull of a point, weight times residual, stays as large as that of a point at
#    the edge of belief, however far off it is. Geman-McClure's pull falls back to nothing.
huber, _ = robust_fit(wrong_brow, kernel=lambda u: np.minimum(1, 1 / np.sqrt(np.maximum(u, 1e-12))))
huber_3d = error_3d(huber, person)
print(f"Huber {huber_3d:.1f} mm, Geman-McClure {errors_3d['six wrong dots, robust']:.1f} mm")

# %%
# 3. From everywhere! A face is far from symmetric between up and down or front and back, and 51 dots leave one valley.
#    But the angles are not always the same: (180°, 180°, 180°) is the same rotation as (0°, 0°, 0°). Compare rotations,
#    never angles; and that is one more reason for the library to take rotation vectors.
ends = []
for degrees in [(y, p, r) for y in (0, 90, 180) for p in (-60, 0, 60) for r in (0, 180)]:
    x = start.copy()
    x[K : K + 3] = np.radians(degrees)
    ends.append(fit(q, x=x))
losses = np.array([total_loss(x)[0] for x in ends])
gaps_R = np.array([np.abs(rotation(x[K : K + 3])[0] - rotation(fitted[K : K + 3])[0]).max() for x in ends])
aliases = sum(np.abs(np.degrees(x[K : K + 3] - fitted[K : K + 3])).max() > 90 for x in ends)
print(f"{np.sum(losses < 1.02 * best)} of {len(ends)} starts arrive; rotations differ by at most {gaps_R.max():.2f},")
print(f"but {aliases} of them have other angles")

# %%
# 4. Negative expressions explain dots, and mean nothing: there is no muscle that shrugs a lip by minus a half. Here it
#    makes the upper lip longer, which is a matter of shape.
kept = lower.copy()
lower[n_id:K] = -np.inf
free = fit(q)
lower = kept
negative = sorted((float(w), name) for w, name in zip(free[n_id:K], model.expression_names, strict=False))[:4]
print("most negative:", {name: round(w, 2) for w, name in negative})

# %%
numbers: dict[str, float] = {
    "start_error": float(np.sqrt(landmark_loss(start)[0])),
    "slope_right": float(good.slopes.min()),
    "slope_wrong": float(bad.slopes.min()),
    "evaluations_plain": counts[1],
    "evaluations_scaled": counts[2],
    "steepest_descent_over_best": float(walk.min() / best),
    "error_used": rms(dots(fitted)[0] - q),
    "held_out_weak": left_out[0],
    "held_out_best": min(left_out),
    "held_out_strong": left_out[-1],
    "best_prior_weight": float(prior_weights[np.argmin(left_out)]),
    "best_prior_weight_3d": float(prior_weights[np.argmin(in_3d)]),
    "error_3d_weak": float(in_3d[0]),
    "error_3d_best": float(min(in_3d)),
    "error_3d_mean_face": float(mean_face_3d),
    "outliers_clean": errors_3d["clean dots, squares"],
    "outliers_squares": errors_3d["six wrong dots, squares"],
    "outliers_robust": errors_3d["six wrong dots, robust"],
    "library_difference": difference,
    "library_percent": report.rms_percent,
    "library_moved_squares": moved_by(plain_fit),
    "library_moved_robust": moved_by(robust),
    "best_step": best_step,
    "huber": huber_3d,
    "starts_that_arrive": float(np.mean(losses < 1.02 * best)),
    "starts_with_other_angles": aliases,
    "most_negative": negative[0][0],
}
