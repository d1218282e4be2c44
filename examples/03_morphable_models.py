# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 3 · Morphable models
#
# **How can eighty numbers hold everybody's face?**
#
# A head of our template has 19,057 vertices, 57,171 numbers. Hardly any choice of them is a head. Faces fill a thin,
# nearly flat piece of that huge space, and a *morphable model* is a map of it: a point in the middle, some directions,
# and how far people lie along each. This lesson takes one apart, makes one from examples, and shows what it knows
# before it has seen you.

# %%
import matplotlib.pyplot as plt
import numpy as np

import toongeo as tg
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

# %% [markdown]
# ## 1 · A mean and some modes
#
# All faces of a model have the same triangles: vertex 8,000 sits on the same spot of everybody. (Bringing scans into
# that form is the hard part of building one; lesson 15.) So faces can be *averaged* and *subtracted* as arrays. A model
# is a mean face $\mu$ and displacements $B_k$, the *modes*, each (n, 3) in millimetres:
#
# $$ v(a, w) = \mu + \sum_k a_k B_k + \sum_j w_j E_j . \tag{1} $$
#
# The $a_k$ say who it is (*identity*), the $w_j$ what the face does (*expression*). One unit of an $a_k$ is one
# standard deviation among people; a $w_j$ runs from 0 to 1.

# %%
model = tg.default_model()
print(f"mean {model.mean.shape}, identity {model.identity.shape}, expression {model.expression.shape}")

rng = np.random.default_rng(0)
a = model.sample(rng)
w = np.zeros(len(model.expression))
w[model.expression_index("jawOpen")] = 0.4
by_hand = model.mean + np.tensordot(a, model.identity, 1) + np.tensordot(w, model.expression, 1)
assert np.allclose(by_hand, model.vertices(a, w), atol=1e-3)  # mm; the modes are single precision


def clay(vertices, yaw=20.0, size=190):
    """A head as clay."""
    view = ScaledOrthographicCamera.look(yaw, size=size, centre=(0, 5, 0), extent=300)
    return render_mesh(Surface(vertices, model.faces), view, size, shading="clay")


def sheet(rows, titles=None, width=1.75):
    """A table of pictures."""
    _, axes = plt.subplots(
        len(rows), len(rows[0]), figsize=(width * len(rows[0]), width * 1.06 * len(rows)), squeeze=False
    )
    for axis, shown in zip(axes.ravel(), [p for row in rows for p in row], strict=True):
        axis.imshow(shown)
        axis.axis("off")
    for axis, title in zip(axes[0] if titles is not None else [], titles or [], strict=True):
        axis.set_title(title, fontsize=9)
    plt.tight_layout()
    plt.show()


likeliest = model.vertices(model.prior.mean)
rows = [[clay(likeliest + sign * 3 * model.identity[k]) for k in (0, 1, 2, 4, 9)] for sign in (-1, 1)]
sheet(rows, ["mode 0", "mode 1", "mode 2", "mode 4", "mode 9"])

# %% [markdown]
# *Figure: Two rows of clay heads, the likeliest face minus and plus three standard deviations of five identity modes;
# the first changes age and breadth together, the others nose, jaw, eyes and mouth, several at a time.*
#
# Two middles: `model.mean` is where all $a_k$ are zero, the face that an artist modelled. People are spread about
# another point, `model.prior.mean`, which was learned from scans: the *likeliest* face. The last identity mode is
# special too: it leads from people towards drawings, and nobody has it at random. `model.principal_modes` are the 80
# others.

# %%
names = ("jawOpen", "mouthSmileLeft", "browInnerUpLeft", "eyeBlinkRight", "mouthPucker", "cheekPuffLeft")
shown = [clay(likeliest + model.expression[model.expression_index(name)], yaw=0) for name in names]
sheet([shown], names)

# %% [markdown]
# *Figure: Six clay heads, one expression each at full strength: open jaw, a smile on the left, a raised inner brow, a
# closed right eye, puckered lips, a puffed cheek.*
#
# Expressions have names, after the muscles that make them, and other systems' names are known too: `tg.preset("smile")`
# and `tg.expression_weights({"AU12": 1})` translate (lesson 10).
#
# ## 2 · Where modes come from
#
# Take $m$ faces with the same triangles, each as one long row of numbers; subtract their mean; the rows are $X$
# ($m \times 3n$). The singular value decomposition $X = U \Sigma V^T$ sorts what they have in common: the rows of $V^T$
# are directions, at right angles to each other, and $\sigma_k^2 / (m-1)$ is the variance of the faces along direction
# $k$. The mode with one standard deviation as its unit is
#
# $$ B_k = \frac{\sigma_k}{\sqrt{m - 1}}\, V_k . \tag{2} $$
#
# This is *principal component analysis*. No scans may travel with this notebook, so let our model play the world: draw
# people from it, and see what PCA finds. How many people does one need? Learn from 10, 40 or 160, and describe 40
# *others* by the first $k$ modes:

# %%
skin = np.flatnonzero(model.region("face"))[::4]  # every fourth vertex of the face is enough here
B = np.asarray(model.principal_modes[:, skin], float).reshape(80, -1)  # (80, 3n)


def people(count: int, rng: np.random.Generator) -> np.ndarray:
    """Faces (count, 3n) of random people, mm, about the likeliest."""
    return rng.standard_normal((count, 80)) @ B


def pca(X: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The mean, modes (2), and variances of faces (m, 3n)."""
    centre = X.mean(axis=0)
    _, sigma, Vt = np.linalg.svd(X - centre, full_matrices=False)
    kept = sigma > 1e-6 * sigma[0]  # the mean took one direction away
    sigma, Vt = sigma[kept], Vt[kept]
    return centre, sigma[:, None] / np.sqrt(len(X) - 1) * Vt, sigma**2 / (len(X) - 1)


def rms_mm(X: np.ndarray) -> float:
    """Root mean square length of displacements (m, 3n)."""
    return float(np.sqrt((X.reshape(len(X), -1, 3) ** 2).sum(axis=2).mean()))


others = people(40, np.random.default_rng(99))
fig, axes = plt.subplots(1, 2, figsize=(9, 3.2))
left_over = {}
for count, colour in ((10, "tab:red"), (40, "tab:orange"), (160, "tab:blue")):
    X = people(count, np.random.default_rng(count))
    centre, found, variances = pca(X)
    errors_seen, errors_new = [], []
    ks = range(0, len(found) + 1, 3 if count > 10 else 1)
    for k in ks:
        V = found[:k] / np.linalg.norm(found[:k], axis=1, keepdims=True)
        for faces, errors in ((X, errors_seen), (others, errors_new)):
            around = faces - centre
            errors.append(rms_mm(around - around @ V.T @ V))
    left_over[count] = errors_new[-1]
    axes[0].plot(ks, errors_seen, ":", c=colour)
    axes[0].plot(ks, errors_new, "-", c=colour, label=f"learned from {count}")
    axes[1].plot(np.cumsum(variances) / variances.sum(), c=colour)
true_share = np.cumsum(np.sort((np.linalg.svd(B, compute_uv=False)) ** 2)[::-1])
axes[1].plot(true_share / true_share[-1], c="black", lw=1, ls="--", label="the truth")
axes[0].set(xlabel="number of modes", ylabel="error, mm", ylim=(0, None))
axes[0].set_title("new people (solid), those learned from (dotted)", fontsize=9)
axes[1].set(xlabel="number of modes", ylabel="share of the variance", ylim=(0, 1.02))
for axis in axes:
    axis.legend(fontsize=8)
plt.tight_layout()
plt.show()
print({count: f"{error:.1f} mm" for count, error in left_over.items()}, "left over on new people")

# %% [markdown]
# *Figure: Left, errors against the number of modes: on the people learned from they fall to zero, on new people they
# level off high after 10 examples and lower after 40, and only 160 reach zero; right, the variance is overestimated
# from few examples.*
#
# Both pictures are a warning. With 10 examples, 9 modes explain *those ten* perfectly and new people badly. And few
# examples make the world look simpler than it is: all their variance seems to lie in few modes.
#
# ## 3 · Sampling
#
# If people's coefficients are independent and normally distributed with variance 1, drawing a random person is drawing
# 80 random numbers. `model.sample` does it, about the likeliest face:

# %%
sigmas = (0.5, 1.0, 2.0)
rows = [[clay(model.vertices(model.sample(rng, sigma=sigma))) for _ in range(5)] for sigma in sigmas]
sheet(rows)

# %% [markdown]
# *Figure: Three rows of five random heads: at half a standard deviation they look like siblings, at one like people, at
# two like caricatures.*
#
# Now a surprise. The likeliest face is the one at the middle. How likely is it to *meet* somebody near the middle? The
# squared distance $\sum_k a_k^2$ of a random person has the mean 80 and hardly varies: *everybody is about
# $\sqrt{80} \approx 9$ deviations from the average*. In one dimension the middle is where people are; in eighty it is
# empty.

# %%
distances = np.linalg.norm(np.random.default_rng(1).standard_normal((20000, 80)), axis=1)
fig, axis = plt.subplots(figsize=(5, 2.6))
axis.hist(distances, bins=60, color="tab:blue")
axis.axvline(np.sqrt(80), c="black", lw=1)
axis.set(xlabel="distance from the likeliest face, deviations", xlim=(0, 14), yticks=[])
plt.tight_layout()
plt.show()
print(f"nearest of 20,000: {distances.min():.1f}, farthest: {distances.max():.1f}")

# %% [markdown]
# *Figure: A histogram of the distances of random people from the likeliest face: a narrow hump around 9, and nobody
# below 5.*
#
# So a fit that comes out *at* the average has not found the likeliest person; it has found nothing out.
#
# ## 4 · What a prior does
#
# Suppose we measure a few points of a face in space, with noise. What do they tell about *all the others*? The prior
# says $a \sim N(0, I)$. Each measured coordinate says $y = b^T a + \varepsilon$ with noise of variance $\sigma^2$. Put
# all measured rows $b^T$ into a matrix $H$. Multiply the two Gaussians, and what comes out is a Gaussian again, with
#
# $$ \text{covariance}\quad S = \Bigl(\frac{H^T H}{\sigma^2} + I\Bigr)^{-1}, \qquad
#    \text{mean}\quad \hat a = S\, \frac{H^T y}{\sigma^2} . \tag{3} $$
#
# This is a least-squares fit with a penalty $\sum a_k^2$, the very thing that lesson 5 minimises. But it also knows
# *how sure* it is: the variance of any coordinate with row $b$ is $b^T S b$. Below, a person of whom we measure
# landmarks, to 1 mm: first those of the nose, then nose and eyes, then all but the jaw.

# %%
front = np.flatnonzero(model.region("face"))
B_face = np.asarray(model.principal_modes[:, front], float)  # (80, n, 3)
truth = np.random.default_rng(4).standard_normal(80)
noise_mm = 1.0


def told(landmarks: np.ndarray, sigma: float = noise_mm, use_prior: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """Mean (80,) and covariance (80, 80) of (3) after some landmarks of the person were measured."""
    H = np.asarray(model.principal_modes[:, model.landmarks[landmarks]], float).reshape(80, -1).T
    y = H @ truth + np.random.default_rng(7).normal(0, noise_mm, len(H))
    if not use_prior:
        return np.linalg.lstsq(H, y, rcond=None)[0], np.eye(80)
    S = np.linalg.inv(H.T @ H / sigma**2 + np.eye(80))
    return S @ H.T @ y / sigma**2, S


def error_mm(a: np.ndarray) -> float:
    """Root mean square error of the face, mm."""
    return rms_mm(np.tensordot(a - truth, B_face, 1)[None])


def sheet_of_doubt(S: np.ndarray) -> np.ndarray:
    """The face coloured by its standard deviation, mm: violet 0, yellow 4."""
    spread = np.sqrt(np.einsum("knc,kl,lnc->n", B_face, S, B_face))
    colours = np.full((len(model.mean), 3), 0.85)
    colours[front] = plt.cm.viridis(np.clip(spread / 4, 0, 1))[:, :3]
    view = ScaledOrthographicCamera.look(15, size=230, centre=(0, -10, 0), extent=240)
    return render_mesh(Surface(likeliest, model.faces, colours=colours), view, 230)


sets = {
    "nothing": np.arange(0),
    "the nose": np.arange(27, 36),
    "nose and eyes": np.r_[27:48],
    "all but the jaw": np.arange(17, 68),
}
posteriors = {name: told(landmarks) for name, landmarks in sets.items()}
errors = {name: error_mm(mean) for name, (mean, _) in posteriors.items()}
titles = [f"{name}\nerror {errors[name]:.1f} mm" for name in sets]
sheet([[sheet_of_doubt(S) for _, S in posteriors.values()]], titles, width=2.2)
without = error_mm(told(sets["all but the jaw"], use_prior=False)[0])
print(f"without the prior, from all but the jaw: {without:.0f} mm")

# %% [markdown]
# *Figure: A face coloured by how uncertain it still is, from violet (0 mm) to yellow (4 mm), four times: yellow and
# green when nothing is known, violet around what was measured, and violet nearly everywhere when all inner landmarks
# were.*
#
# Nine points on the nose also tell something about the cheeks: faces hang together. And without the prior the same 51
# points give a face that is off by a hand's length, although no other sum of modes comes nearer to them. (They are
# still missed by about 1 mm, which is the noise.)
#
# What does a prior *cost*? It pulls towards the middle. The posterior mean is as a rule nearer to the average than the
# truth is, most where little was measured: a fit without evidence gives everybody the same cheeks.

# %%
lengths = {name: float(np.linalg.norm(mean)) for name, (mean, _) in posteriors.items()}
print(
    {name: round(length, 1) for name, length in lengths.items()}, "- the truth:", round(float(np.linalg.norm(truth)), 1)
)
shown = [clay(likeliest + np.tensordot(mean, model.principal_modes, 1)) for mean, _ in posteriors.values()]
shown.append(clay(likeliest + np.tensordot(truth, model.principal_modes, 1)))
sheet([shown], [*sets, "the truth"], width=2.0)

# %% [markdown]
# *Figure: The mean of what is believed after each measurement: from the average face step by step towards the person,
# who is shown on the right and remains a little more marked than the best guess.*
#
# ## 5 · Beyond people
#
# A caricaturist does with $a$ what you would guess: whatever is special about a face, more of it. Scale the distance
# from the likeliest face.

# %%
exaggerated = [clay(likeliest + f * np.tensordot(truth, model.principal_modes, 1)) for f in (0.0, 1.0, 2.0, 3.5)]
sheet([exaggerated], ["0 ×", "1 ×", "2 ×", "3.5 ×"])

# %% [markdown]
# *Figure: The same person at 0, 1, 2 and 3.5 times the distance from the average: a bland face, the person, a
# caricature, and a face that is bent and begins to break.*
#
# Twice is funny, three and a half times is broken: a straight line in the space of coordinates leaves the space of
# faces. A line of *rotations and stretches* goes much farther; that is lesson 11.
#
# ## What to keep in mind
#
# - Same triangles, so faces are vectors: mean, modes, coefficients. All of it is linear.
# - PCA learns modes from examples; too few examples look simpler than the world is.
# - Everybody is far from the average, in all directions at once.
# - A prior turns a few measurements into a whole face, tells how sure it is, and pulls towards the average.
#
# ## Exercises
#
# 1. *Half-way.* Is the face with the mean coefficients of two people the mean of their faces? And does it look like
#    both?
# 2. *Which noise?* Use (3) with all inner landmarks and a wrong $\sigma$: 0.1, 0.3, 1, 3, 10, 30 mm, while the noise is
#    1 mm. Which gives the least error?
# 3. *One more point.* After the nose, which single further landmark lowers the uncertainty (the trace of the covariance
#    of the whole face) most?
#
# ## Solutions

# %%
# 1. (1) is linear, so yes. It looks like neither: what is special in one is diluted by the other, which is why averages
#    of many faces look so smooth.
one, two = model.sample(rng), model.sample(rng)
middle_gap = float(np.abs(model.vertices((one + two) / 2) - (model.vertices(one) + model.vertices(two)) / 2).max())
sheet([[clay(model.vertices(x)) for x in (one, (one + two) / 2, two)]], ["one", "half-way", "two"])
print(f"largest difference {middle_gap:.1e} mm")

# %% [markdown]
# *Figure: Two people and the face half-way between them, which is plainer than either.*

# %%
# 2. The true one, or near it. Too small: noise is taken for shape. Too large: everybody is the average.
tried = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
by_sigma = {sigma: error_mm(told(sets["all but the jaw"], sigma)[0]) for sigma in tried}
best_sigma = min(by_sigma, key=by_sigma.get)
print({sigma: f"{error:.1f} mm" for sigma, error in by_sigma.items()})

# %%
# 3. Not the farthest one, but one whose motion goes with that of much else, and that the nose has not told yet. (The
#    covariance does not depend on what is measured, so nothing has to be measured to answer this: that is how
#    experiments are planned.)
G = np.einsum("knc,lnc->kl", B_face, B_face) / B_face.shape[1]
doubt = {k: float(np.sqrt(np.trace(told(np.r_[27:36, k])[1] @ G))) for k in range(68) if not 27 <= k < 36}
best_point = min(doubt, key=doubt.get)
before = float(np.sqrt(np.trace(posteriors["the nose"][1] @ G)))
print(f"landmark {best_point}: from {before:.2f} mm to {doubt[best_point]:.2f} mm")

# %%
numbers: dict[str, float] = {
    "left_over_10": left_over[10],
    "left_over_40": left_over[40],
    "left_over_160": left_over[160],
    "nearest_person": float(distances.min()),
    "error_nothing": errors["nothing"],
    "error_nose": errors["the nose"],
    "error_inner": errors["all but the jaw"],
    "error_without_prior": without,
    "length_nose": lengths["the nose"],
    "length_inner": lengths["all but the jaw"],
    "length_truth": float(np.linalg.norm(truth)),
    "middle_gap": middle_gap,
    "best_sigma": best_sigma,
    "doubt_before": before,
    "doubt_after": doubt[best_point],
}
