# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 17 · Swap in a regressor
#
# **The fit of lesson 5 solves an optimization problem for each face. Can the answer not simply be *learned*?** It can:
# a regressor is a function from what is seen to the coefficients of the model. In this lesson you make training data
# without a single photograph, learn a linear regressor in three lines, see how much to hold it back, put it into the
# place of the fit's start, or of the fit itself, and, if you have torch, do the same with a small network.

# %%
import matplotlib.pyplot as plt
import numpy as np

import toongeo as tg
from toongeo.metrics import check_gradient
from toongeo.model import data_path
from toongeo.render import ScaledOrthographicCamera
from toongeo.testing import check_regressor

try:
    import torch
except ImportError:
    torch = None

model = tg.default_model()
portrait = data_path("examples/portraits/moustache_man.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))

# %% [markdown]
# ## 1. Data from the model itself
#
# A morphable model can make as many faces as we like, each with its coefficients: draw a person, a few expressions and
# a view, and note where the 68 landmarks fall. Of the 19,000 vertices only those 68 are needed, so all faces are one
# product of matrices: with the mean $\mu$ of the landmarks and the modes $B$,
#
# $$ \text{points} = \mu + c\,B, \qquad \text{pixels} = s\,P R\,\text{points} + t + \text{noise}. $$
#
# As *features* $x$ the regressor sees the pixels in a frame of the face: origin between the outer corners of the eyes,
# which are at distance 1 on a horizontal line. So place, size and tilt in the picture cannot matter; it need not learn
# that they do not.

# %%
RIGHT, LEFT = 36, 45  # outer corners of the eyes
named = model.n_named
basis = np.concatenate([model.identity, model.expression[:named]])[:, model.landmarks].astype(float)  # (c, 68, 3) mm
centre = model.mean[model.landmarks]
likely = np.concatenate([np.zeros(len(model.identity)) if model.prior is None else model.prior.mean, np.zeros(named)])


def features(pixels: np.ndarray) -> np.ndarray:
    """(n, 136) from landmarks (n, 68, 2); x and y of each point in the frame of the eyes, NaN where missing."""
    z = pixels @ [1, 1j]
    middle, axis = (z[:, RIGHT] + z[:, LEFT]) / 2, z[:, LEFT] - z[:, RIGHT]
    w = (z - middle[:, None]) / axis[:, None]
    return np.hstack([w.real, w.imag])


def synthetic(n: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Features (n, 136) and coefficients (n, c) of random faces."""
    faces = np.zeros((n, len(basis)))
    faces[:, : len(model.identity)] = [model.sample(rng, sigma=0.7) for _ in range(n)]
    for row in faces:
        row[len(model.identity) + rng.choice(named, 4, replace=False)] = rng.uniform(0, 0.8, 4)
    points = centre + np.tensordot(faces, basis, axes=1)
    pixels = np.empty((n, 68, 2))
    for k in range(n):
        camera = ScaledOrthographicCamera.look(rng.uniform(-35, 35), rng.uniform(-15, 15))
        pixels[k] = camera.project(points[k]) + rng.normal(0, 0.015 * 90 * camera.scale, (68, 2))  # 1.5 % of 90 mm
    return features(pixels), faces


X, Y = synthetic(2000, np.random.default_rng(0))
X_choice, Y_choice = synthetic(300, np.random.default_rng(1))
X_test, Y_test = synthetic(300, np.random.default_rng(5))
print(f"{len(X)} faces to learn from: {X.shape[1]} features, {Y.shape[1]} coefficients")
print(f"{len(X_choice)} to choose by, {len(X_test)} to judge by")

fig, ax = plt.subplots(figsize=(4.2, 4), layout="constrained")
for k in range(40):
    ax.plot(X[k, :68], X[k, 68:], ".", markersize=2, color="tab:blue", alpha=0.5)
ax.plot(X[:, :68].mean(0), X[:, 68:].mean(0), "k.", markersize=5)
ax.invert_yaxis()
ax.set_aspect("equal")
ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The landmarks of forty random faces as small blue points and their mean in black; the outer corners of the
# eyes coincide, the points of the jaw are spread most.*
#
# ## 2. Ridge regression
#
# The simplest function is linear. With centred features $X$ (n, f) and coefficients $Y$ (n, c), ridge regression
# (Hoerl and Kennard 1970) looks for the weights that minimize
#
# $$ E(W) = \tfrac1n\lVert X W - Y \rVert^2 + \lambda \lVert W \rVert^2, \qquad
#    \nabla E = \tfrac2n X^\top (XW - Y) + 2\lambda W = 0
#    \;\Rightarrow\; W = \big(\tfrac1n X^\top X + \lambda I\big)^{-1} \tfrac1n X^\top Y . $$
#
# These are the *normal equations*. $\lambda$ holds the weights back: 136 features that are nearly combinations of each
# other would else be played off against each other with huge weights, and noise with them.


# %%
def ridge(X: np.ndarray, Y: np.ndarray, lam: float) -> tuple[np.ndarray, np.ndarray]:
    """Weights (f, c) and offset (c,)."""
    x, y = X.mean(0), Y.mean(0)
    gram = (X - x).T @ (X - x) / len(X)
    W = np.linalg.solve(gram + lam * np.eye(X.shape[1]), (X - x).T @ (Y - y) / len(X))
    return W, y - x @ W


lam = 1e-4
W, offset = ridge(X, Y, lam)

# %% [markdown]
# Three checks that the formula is right. The gradient is zero there; the gradient that was set to zero *is* that of
# $E$ (a Taylor slope, as in lesson 5); and a solver that knows nothing of normal equations finds the same, when the
# penalty is written as more rows: $\sqrt{\lambda}\,I$ that want to be 0.

# %%
Xc, Yc = X - X.mean(0), Y - Y.mean(0)


def energy(w: np.ndarray) -> tuple[float, np.ndarray]:
    rest, W = Xc @ w.reshape(W_shape) - Yc, w.reshape(W_shape)
    value = (rest**2).sum() / len(X) + lam * (W**2).sum()
    return float(value), (2 / len(X) * Xc.T @ rest + 2 * lam * W).ravel()


W_shape = W.shape
at_optimum = float(np.abs(energy(W.ravel())[1]).max())
slopes = check_gradient(energy, np.random.default_rng(2).standard_normal(W.size))
stacked = np.vstack([Xc / np.sqrt(len(X)), np.sqrt(lam) * np.eye(X.shape[1])])
by_lstsq = np.linalg.lstsq(stacked, np.vstack([Yc / np.sqrt(len(X)), np.zeros(W.shape)]), rcond=None)[0]
ways_differ = float(np.abs(by_lstsq - W).max() / np.abs(W).max())
print(f"gradient at its minimum {at_optimum:.0e}; slope {slopes.slopes.min():.2f}; lstsq off by {ways_differ:.0e}")

# %% [markdown]
# ## 3. How much to hold back
#
# Coefficients are no measure: some move millimetres, others nothing. So we judge the *faces*, by the mean distance of
# points of the face from where they should be, in mm. With few faces to learn from, small $\lambda$ learns their noise
# by heart: no error on them, a large one on others. Large $\lambda$ learns nothing and answers the average.
#
# A $\lambda$ that is best on some faces flatters itself there. So it is chosen on one set, and judged once on another.

# %%
spots = np.flatnonzero(model.region("face"))[::25]
surface = np.concatenate([model.identity, model.expression[:named]])[:, spots].astype(float)


def error_mm(guess: np.ndarray, truth: np.ndarray) -> float:
    """Mean distance over faces and points, mm, but for a shift of the whole face, which landmarks cannot tell."""
    off = np.tensordot(guess - truth, surface, axes=1)
    off -= off.mean(axis=1, keepdims=True)
    return float(np.linalg.norm(off, axis=2).mean())


lams = 10.0 ** np.arange(-9, 1.1, 0.5)
curves = {}
for n in (100, 2000):
    fits = [ridge(X[:n], Y[:n], value) for value in lams]
    curves[n] = [(error_mm(X[:n] @ V + b, Y[:n]), error_mm(X_choice @ V + b, Y_choice)) for V, b in fits]
average_error = error_mm(np.tile(Y.mean(0), (len(Y_test), 1)), Y_test)
best = float(lams[np.argmin([others for _, others in curves[2000]])])
W, offset = ridge(X, Y, best)
learned_error = error_mm(X_test @ W + offset, Y_test)
print(f"best lambda {best:.0e}: {learned_error:.2f} mm on unseen faces; the average face: {average_error:.2f} mm")

fig, ax = plt.subplots(figsize=(7, 3.4), layout="constrained")
for n, colour in ((100, "tab:red"), (2000, "tab:blue")):
    learned, unseen = np.array(curves[n]).T
    ax.semilogx(lams, learned, ":", color=colour, label=f"{n} faces: on themselves")
    ax.semilogx(lams, unseen, color=colour, label=f"{n} faces: on others")
ax.axhline(average_error, color="gray", linestyle="--", label="the average face")
ax.set(xlabel=r"$\lambda$", ylabel="mm", ylim=(0, 4))
ax.legend(fontsize=8)
plt.show()

# %% [markdown]
# *Figure: The error over the weight of the penalty. Learned from 100 faces it is near zero on these and larger than
# that of the average face on others, unless the penalty is large; learned from 2,000 faces both errors are near each
# other.*
#
# ## 4. Plug it in
#
# `fit_3dmm` takes any callable `(img, landmarks) -> Coefficients`. Its answer is where the fit starts or, with
# `refine=False`, the answer itself; any part may be left out (here the pose, which is then found for the guess). It
# must live with missing points, which are NaN rows: here they take the mean of the faces it learned from.


# %%
class Linear:
    """Our ridge regression as a `Regressor`."""

    def __init__(self, W: np.ndarray, offset: np.ndarray, usual: np.ndarray) -> None:
        self.W, self.offset, self.usual = W, offset, usual

    def __call__(self, img: np.ndarray | None, landmarks: np.ndarray) -> tg.Coefficients:
        points = np.asarray(landmarks, float)
        x = features(points[None])[0]
        guess = np.where(np.isfinite(x), x, self.usual) @ self.W + self.offset
        identity, weights = np.split(guess, [len(model.identity)])
        expression = np.zeros(len(model.expression))
        expression[:named] = np.clip(weights, 0, 1)
        return tg.Coefficients(identity=identity, expression=expression)


linear = Linear(W, offset, X.mean(0))
check_regressor(linear, picture=False)  # raises if it is none: wrong sizes, other answers the second time ...
theirs = tg.train_ridge_regressor(model, np.random.default_rng(0), n=500)


def smiling(img: np.ndarray | None, landmarks: np.ndarray) -> tg.Coefficients:
    """Not learned at all: this one only knows that the mouth of this picture is a smile."""
    expression = np.zeros(len(model.expression))
    for side in ("Left", "Right"):
        expression[model.expression_index(f"mouthSmile{side}")] = 0.5
    return tg.Coefficients(expression=expression)


regressors = {"ours": linear, "train_ridge_regressor": theirs, "smiling": smiling}
plain = tg.fit_3dmm(img, landmarks)
print(f"{'no regressor':22s} refine=True : inner landmarks off by {plain.report.rms_percent:.2f} %")
off: dict[tuple[str, bool], float] = {}
ends: dict[str, float] = {}
for name, regressor in regressors.items():
    for refine in (False, True):
        fit = tg.fit_3dmm(img, landmarks, regressor=regressor, refine=refine)
        off[name, refine] = fit.report.rms_percent
        print(f"{name:22s} refine={refine!s:5}: inner landmarks off by {fit.report.rms_percent:.2f} %")
    ends[name] = float(np.linalg.norm(fit.vertices - plain.vertices, axis=1)[model.region("face")].mean())
print("refined fits end so many mm from the plain one:", {name: round(mm, 2) for name, mm in ends.items()})

# %% [markdown]
# A percent is one of the distance of the outer corners of the eyes. The library's regressor is a ridge regression too,
# but its features know more: it turns the mean face until it lies best, and looks at what is left, also times the turn.
# Read the table twice:
#
# - *Without refinement* a regressor is a guess in a fraction of a millisecond. It is worse than the fit, which looks at
#   *this* face until its landmarks lie right.
# - *With refinement* all end at the same place, wherever they start: the problem has one good minimum (lesson 5), and a
#   regressor saves time, not errors. What it can bring that landmarks cannot is what it sees in the *picture*.
#
# ## 5. A small network
#
# A network adds something bent to $xW + b$, for example $\tanh(xW_1 + b_1)\,W_2 + b_2$. Its minimum has no formula: one
# goes downhill. toongeo need not know its library: the network hides behind the same call. Without torch this cell only
# says so.


# %%
class Network:
    """Any torch module from features (1, 136) to coefficients (1, c), as a `Regressor`."""

    def __init__(self, module, usual: np.ndarray) -> None:
        self.module, self.usual = module.eval(), usual

    def __call__(self, img: np.ndarray | None, landmarks: np.ndarray) -> tg.Coefficients:
        x = features(np.asarray(landmarks, float)[None])
        x = np.where(np.isfinite(x), x, self.usual)
        with torch.inference_mode():
            guess = self.module(torch.tensor(x)).numpy()[0]
        identity, weights = np.split(guess, [len(model.identity)])
        expression = np.zeros(len(model.expression))
        expression[:named] = np.clip(weights, 0, 1)
        return tg.Coefficients(identity=identity, expression=expression)


def trained_network(width: int = 64, steps: int = 250):
    """Ridge regression, and two layers that learn what is left of it; Adam on all faces at once."""
    torch.manual_seed(0)
    torch.set_num_threads(1)

    class Residual(torch.nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.linear = torch.nn.Linear(X.shape[1], Y.shape[1])
            self.bent = torch.nn.Sequential(
                torch.nn.Linear(X.shape[1], width), torch.nn.Tanh(), torch.nn.Linear(width, Y.shape[1])
            )
            with torch.no_grad():
                self.linear.weight.copy_(torch.tensor(W.T))
                self.linear.bias.copy_(torch.tensor(offset))
                self.bent[2].weight.zero_()  # so that it begins as the ridge regression
                self.bent[2].bias.zero_()

        def forward(self, x):
            return self.linear(x) + self.bent(x)

    module = Residual().double()
    x, y = torch.tensor(X), torch.tensor(Y)
    optimizer = torch.optim.AdamW(module.parameters(), lr=1e-3, weight_decay=1e-2)
    for _ in range(steps):
        optimizer.zero_grad()
        ((module(x) - y) ** 2).mean().backward()
        optimizer.step()
    return module


if torch is None:
    print("torch is not installed: no network is trained")
else:
    module = trained_network()
    with torch.inference_mode():
        network_error = error_mm(module(torch.tensor(X_test)).numpy(), Y_test)
    network = Network(module, X.mean(0))
    check_regressor(network, picture=False)
    fit = tg.fit_3dmm(img, landmarks, regressor=network, refine=False)
    print(f"network: {network_error:.2f} mm on unseen faces; inner landmarks off by {fit.report.rms_percent:.2f} %")

# %% [markdown]
# With torch it comes out a little better than ridge regression, by hundredths of a millimetre: within these views the
# way from landmarks to coefficients is all but linear, and a network has little to bend. Where it pays is the picture.
#
# A network that sees the picture would begin with `torch.from_numpy(img).permute(2, 0, 1)[None] / 255`. One in ONNX
# needs no torch: `tg.fit_3dmm(..., regressor=OnnxRegressor("face.onnx", {"identity": "id"}))` of `toongeo.adapters`.
#
# ## Exercises
#
# 1. With the singular values $s_i$ of $X/\sqrt n$, ridge regression keeps the share $s_i^2/(s_i^2+\lambda)$ of each
#    direction. How many of the 136 directions are kept by more than half at the best $\lambda$? Check that this gives
#    $W$.
# 2. How much of the remaining error is noise of the landmarks? Learn from, and judge on, points without noise.
# 3. Expressions and views look alike: a raised chin and a nod. By how much is the error smaller if no head is turned?
#
# ## Solutions
#
# **1.** With $X/\sqrt n = U S V^\top$: $W = V\,\frac{S}{S^2 + \lambda}\,U^\top Y/\sqrt n$.

# %%
U, S, Vt = np.linalg.svd(Xc / np.sqrt(len(X)), full_matrices=False)
by_svd = Vt.T @ ((S / (S**2 + best))[:, None] * (U.T @ Yc / np.sqrt(len(X))))
svd_differs = float(np.abs(by_svd - W).max() / np.abs(W).max())
kept_directions = int((S**2 / (S**2 + best) > 0.5).sum())
print(f"the same weights within {svd_differs:.0e}; {kept_directions} of {len(S)} directions are kept by more than half")

# %% [markdown]
# **2. and 3.** One function with switches for noise and view.


# %%
def experiment(noise: float, turn: float) -> float:
    """Error in mm on unseen faces, with the lambda that is best on them: the least that this way could reach."""
    sets = []
    for n, seed in ((2000, 3), (300, 4)):
        rng = np.random.default_rng(seed)
        faces = np.zeros((n, len(basis)))
        faces[:, : len(model.identity)] = [model.sample(rng, sigma=0.7) for _ in range(n)]
        for row in faces:
            row[len(model.identity) + rng.choice(named, 4, replace=False)] = rng.uniform(0, 0.8, 4)
        points = centre + np.tensordot(faces, basis, axes=1)
        views = [
            ScaledOrthographicCamera.look(turn * rng.uniform(-35, 35), turn * rng.uniform(-15, 15)) for _ in range(n)
        ]
        pixels = np.array([view.project(p) for view, p in zip(views, points, strict=True)])
        pixels += rng.normal(0, 0.015 * 90 * views[0].scale, pixels.shape) * noise
        sets.append((features(pixels), faces))
    (A, B), (A_test, B_test) = sets
    return min(error_mm(A_test @ V + b, B_test) for V, b in (ridge(A, B, value) for value in lams[::2]))


both, quiet, frontal, neither = (experiment(noise, turn) for noise, turn in ((1, 1), (0, 1), (1, 0), (0, 0)))
print(f"noise and turns {both:.2f} mm; no noise {quiet:.2f}; no turns {frontal:.2f}; neither {neither:.2f}")

# %% [markdown]
# Even with neither, an error remains: 68 points seen from the front do not tell depth, nor what lies between them. No
# learning brings back what the features do not hold; a prior can only make it likely.

# %%
numbers: dict[str, float] = {
    "gradient_at_solution": at_optimum,
    "gradient_is_right": float(slopes.passed),
    "lstsq_difference": ways_differ,
    "average_error_mm": average_error,
    "learned_error_mm": learned_error,
    "few_faces_by_heart_mm": curves[100][0][0],
    "few_faces_on_others_mm": curves[100][0][1],
    "plain_percent": plain.report.rms_percent,
    "ours_percent": off["ours", False],
    "ours_refined_percent": off["ours", True],
    "library_percent": off["train_ridge_regressor", False],
    "smiling_percent": off["smiling", False],
    "refined_ends_apart_mm": max(ends.values()),
    "svd_difference": svd_differs,
    "kept_directions": float(kept_directions),
    "noise_and_turns_mm": both,
    "no_noise_mm": quiet,
    "no_turns_mm": frontal,
    "neither_mm": neither,
}
