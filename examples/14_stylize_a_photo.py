# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 14 · Stylize a photo
#
# **What must change before a photograph becomes a drawing?** Three things: the *shape* (larger eyes, a smaller chin,
# more of what is special about this face), the *tones* (a few in place of thousands) and the *lines*. In this lesson
# you write each in a few lines of numpy, and meet the library's version of it.

# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates
from skimage.color import lab2rgb, rgb2lab

import toongeo as tg
from toongeo.model import data_path

portrait = data_path("examples/portraits/astronaut.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
window = np.s_[20:290, 95:365]  # rows and columns that the figures show

# %% [markdown]
# ## 1. Shape: a warp that cannot fold
#
# To enlarge an eye by $s$ about its centre, one moves each point $x$ (counted from the centre) to
#
# $$ f(x) = x + b(|x|)\,(s - 1)\,x, $$
#
# where the *bump* $b$ falls smoothly from 1 at the centre to 0 at the rim. Near the centre that is $s\,x$, beyond the
# rim nothing moves. But what is pushed out by a large $s$ overtakes what lies before it: the picture folds.
#
# The remedy is to prescribe a *velocity* and to let the points flow for one unit of time:
#
# $$ v(x) = b(|x|)\,\ln(s)\,x, \qquad \dot\varphi_t = v(\varphi_t), \quad \varphi_0(x) = x,
#    \qquad \exp(v) := \varphi_1 . $$
#
# Near the centre $\dot\varphi = \ln(s)\,\varphi$ has the solution $e^{t\ln s}x$, which at $t = 1$ is $s\,x$ again. But
# two points can never meet, for they would have the same velocity from there on, and, run backwards, the same past.


# %%
def bump(r: np.ndarray) -> np.ndarray:
    """1 at r = 0 and 0 from r = 1 on, with two continuous derivatives."""
    inside = np.clip(1 - r, 0, 1)
    return inside**3 * (10 - 15 * inside + 6 * inside**2)


def flow(velocity, x: np.ndarray, time: float = 1.0, steps: int = 20) -> np.ndarray:
    """Where points x are after some time, by the classical Runge-Kutta method. Negative times go back."""
    h = time / steps
    for _ in range(steps):
        k1 = velocity(x)
        k2 = velocity(x + h / 2 * k1)
        k3 = velocity(x + h / 2 * k2)
        k4 = velocity(x + h * k3)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return x


s = 3.5
line = np.linspace(-1.2, 1.2, 481)
displaced = line + bump(np.abs(line)) * (s - 1) * line
flowed = flow(lambda x: bump(np.abs(x)) * np.log(s) * x, line)
slope_displaced, slope_flowed = np.diff(displaced).min() / np.diff(line)[0], np.diff(flowed).min() / np.diff(line)[0]
print(f"least slope: displaced {slope_displaced:+.2f}, flowed {slope_flowed:+.2f}")

fig, axes = plt.subplots(1, 2, figsize=(7.5, 3.2), sharey=True, layout="constrained")
for ax, y, name in zip(axes, (displaced, flowed), ("displaced by $f$", r"flowed along $v$: $\exp(v)$"), strict=True):
    ax.plot(line, line, ":", color="gray")
    ax.plot(line, y, color="tab:blue")
    falls = np.diff(y, append=y[-1] + 1) < 0
    ax.plot(np.where(falls, line, np.nan), y, color="tab:red", linewidth=3)
    ax.set_title(name, fontsize=10)
    ax.set_xlabel("place in the photograph")
axes[0].set_ylabel("place in the drawing")
plt.show()

# %% [markdown]
# *Figure: Two curves from place to place. The displacement rises, falls on two red pieces, and rises again, so that
# three places of the photograph come to one; the flow always rises.*
#
# In the plane the slope becomes the *Jacobian determinant*, the factor by which a small area grows; where it is
# negative, the picture is folded. Along a flow it obeys Liouville's formula
#
# $$ \frac{d}{dt}\det D\varphi_t = (\operatorname{div} v)(\varphi_t)\,\det D\varphi_t
#    \quad\Rightarrow\quad \det D\varphi_1 = \exp\!\int_0^1 (\operatorname{div} v)(\varphi_t)\,dt \;>\; 0 . $$
#
# An exponential is positive, whatever stands in it.
#
# ## 2. The library's warp
#
# `stylize` adds such fields, one for each rule of a style ("scale what is around landmarks 36 to 41 by 1.6 and 2.3"),
# samples the sum on a grid, and follows it. The grid is in `warp.field` (px), so our `flow` can follow it, too.

# %%
drawn = tg.stylize(img, landmarks, "chibi")
warp = drawn.warp


def sampled_velocity(points: np.ndarray) -> np.ndarray:
    """The library's field at points (k, 2) px: linear between the nodes of its grid, 0 beyond."""
    column, row = ((points - warp.corner) / warp.cell).T
    return np.column_stack([map_coordinates(warp.field[..., k], [row, column], order=1) for k in range(2)])


ours = flow(sampled_velocity, landmarks.astype(float))
flow_difference = float(np.abs(ours - warp.points(landmarks)).max())
there_and_back = float(np.abs(warp.inverse(warp.points(landmarks)) - landmarks).max())
areas = warp.determinants()
print(f"our flow and the library's differ by at most {flow_difference:.3f} px at the landmarks")
print(f"there and back: within {there_and_back:.3f} px")
print(f"area factors from the drawing back to the photograph: {areas.min():.2f} to {areas.max():.2f}, none negative")

grid = np.stack(np.meshgrid(np.arange(95, 366, 10.0), np.arange(20, 291, 10.0)), axis=-1)
moved = warp.points(grid)
extent = (window[1].start, window[1].stop, window[0].stop, window[0].start)
fig, axes = plt.subplots(1, 3, figsize=(8.4, 2.9), layout="constrained")
axes[0].imshow(img[window], extent=extent)
axes[1].imshow(warp.picture(img)[window], extent=extent)
axes[2].imshow(np.full((2, 2, 3), 255, np.uint8), extent=extent)  # white paper
for ax, lines in ((axes[0], grid), (axes[2], moved)):
    ax.plot(*lines.transpose(2, 0, 1), color="tab:blue", linewidth=0.5)
    ax.plot(*lines.transpose(2, 1, 0), color="tab:blue", linewidth=0.5)
axes[2].plot(*drawn.landmarks.T, "k.", markersize=2)
for ax, name in zip(axes, ("photograph and grid", "warped", "grid and landmarks, warped"), strict=True):
    ax.set(xlim=extent[:2], ylim=extent[2:])
    ax.set_title(name, fontsize=10)
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The photograph of an astronaut under a square grid; the same face with large eyes, a small nose and a short
# chin; and the grid after the warp, dense at the nose, wide at the eyes, nowhere folded.*
#
# ## 3. Shape: what is special about this face
#
# Caricaturists exaggerate *differences from the average*. Susan Brennan's caricature generator (1985) is one line:
#
# $$ p'_k = p_k + e\,(p_k - m_k), $$
#
# with landmarks $p$, those of the average face $m$, and an exaggeration $e$; $e = -1$ gives the average face. The
# average must be *laid on* the face first, or place, size and tilt would be exaggerated. With points as complex
# numbers, a similarity is $z \mapsto a z + b$ (the modulus of $a$ is the scale, its angle the rotation), and the best
# one in the least squares sense is, for centred points,
#
# $$ a = \frac{\sum_k \bar m_k\, p_k}{\sum_k |m_k|^2} . $$
#
# As the average has the pose and the expression that the fit found, neither is exaggerated.

# %%
fit = tg.fit_3dmm(img, landmarks)
average = fit.camera.project(fit.model.vertices(None, fit.expression)[fit.landmark_vertices])
m, p = average @ [1, 1j], landmarks @ [1, 1j]
m, centre = m - m.mean(), p.mean()
a = np.vdot(m, p - centre) / np.vdot(m, m).real  # vdot conjugates its first argument
laid = a * m + centre


def exaggerated(e: float) -> np.ndarray:
    z = p + e * (p - laid)
    return np.column_stack([z.real, z.imag])


rest = p - laid
similarity_left = abs(np.vdot(m, rest)) / np.linalg.norm(m) / np.linalg.norm(rest)  # 0: nothing a similarity could add
print(
    f"scale {abs(a):.3f}, turn {np.degrees(np.angle(a)):+.1f} degrees, differs by {abs(rest).mean():.1f} px on average"
)

parts = [range(17), range(17, 22), range(22, 27), range(27, 31), range(31, 36), [*range(36, 42), 36]]
parts += [[*range(42, 48), 42], [*range(48, 60), 48], [*range(60, 68), 60]]
fig, axes = plt.subplots(1, 4, figsize=(9, 2.9), sharex=True, sharey=True, layout="constrained")
for ax, e in zip(axes, (-1.0, 0.0, 1.3, 2.6), strict=True):
    for part in parts:
        ax.plot(*exaggerated(e)[list(part)].T, "k", linewidth=1.2)
    ax.set_title({-1.0: "$e=-1$: average", 0.0: "$e=0$: the face"}.get(e, f"$e={e}$"), fontsize=10)
    ax.set_aspect("equal")
    ax.axis("off")
axes[0].invert_yaxis()
plt.show()

# %% [markdown]
# *Figure: Four line drawings through the landmarks, from the average face over this one to two exaggerations, in which
# the jaw gets narrower and the smile more one-sided.*
#
# Moved like that, lines may cross: look at the brow on the right at the largest $e$. The library's style `"caricature"`
# takes the differences, times 1.3, as *velocities* at the landmarks, spreads them by Gaussians, and follows the flow,
# which folds nothing.
#
# ## 4. Tones
#
# A drawing has few tones. *Soft quantization* (Winnemoeller, Olsen and Gooch 2006) moves the lightness $L$ of a pixel
# towards the middle of its level, of width $\Delta$, by a $\tanh$ that is steep where levels meet:
#
# $$ Q(L) = L_0 + \frac{\Delta}{2}\,\frac{\tanh\!\big(2\varsigma\,(L - L_0)/\Delta\big)}{\tanh \varsigma}, $$
#
# where $L_0$ is the nearest border of two levels, and lightness runs from 0 (black) to 100 (white). Small $\varsigma$
# leaves a photograph, large $\varsigma$ gives steps.
# Pixels must be smoothed first, or the noise of the skin jumps between levels.


# %%
def quantized(L: np.ndarray, width: float, slope: float) -> np.ndarray:
    border = width * np.round(L / width)
    return border + width / 2 * np.tanh(2 * slope * (L - border) / width) / np.tanh(slope)


lab = rgb2lab(img)
smooth = np.dstack([gaussian_filter(lab[..., k], 1.5) for k in range(3)])
width = 100 / 6
levels = quantized(smooth[..., 0], width, 4.0)
largest_change = float(np.abs(levels - smooth[..., 0]).max())
posterized = lab2rgb(np.dstack([levels, smooth[..., 1:]]))

ramp = np.linspace(0, 100, 501)
fig, axes = plt.subplots(1, 3, figsize=(8.8, 2.9), layout="constrained")
for slope in (0.5, 2.0, 8.0):
    axes[0].plot(ramp, quantized(ramp, width, slope), label=rf"$\varsigma = {slope:g}$")
axes[0].set(xlabel="$L$", ylabel="$Q(L)$")
axes[0].legend(fontsize=8)
axes[1].imshow(img[window])
axes[2].imshow(posterized[window])
for ax, name in zip(axes[1:], ("photograph", "six levels of lightness"), strict=True):
    ax.set_title(name, fontsize=10)
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The curve from lightness to quantized lightness, a line for a small slope and stairs for a large one; the
# photograph; and the photograph in six levels, with borders across the skin where shadows happen to fall.*
#
# Look at the cheeks: the borders follow every reflection, not the form. An artist shades the *form*. So the library
# fits the face and its light to the photograph first (lesson 7), and quantizes the *fitted* shading of the skin: two
# or three tones whose borders run as the surface turns. What is not skin takes a small palette.
#
# ## 5. Lines
#
# Lines are where a picture is darker than its surroundings. The difference of two Gaussians (one a little wider) is a
# cheap measure of that; the *extended* one (XDoG, Winnemoeller et al. 2012) keeps the picture's own darkness with it.
# $G_\sigma * L$ is the picture smoothed by a Gaussian of $\sigma$ pixels, with $L$ from 0 to 1:
#
# $$ D = (1 + \tau)\,G_\sigma * L \;-\; \tau\,G_{k\sigma} * L, \qquad
#    T = \begin{cases} 1 & D \ge \varepsilon \\ 1 + \tanh(\phi\,(D - \varepsilon)) & \text{else.} \end{cases} $$


# %%
def xdog(L: np.ndarray, sigma: float, tau: float, epsilon: float, phi: float, k: float = 1.6) -> np.ndarray:
    """1 is paper, 0 is ink. L in [0, 1]."""
    D = (1 + tau) * gaussian_filter(L, sigma) - tau * gaussian_filter(L, k * sigma)
    return 1 + np.tanh(phi * np.minimum(D - epsilon, 0))


L = lab[..., 0] / 100
ink = {tau: xdog(L, 0.9, tau, 0.5, 12.0) for tau in (0.0, 4.0, 16.0)}
grey_pixels = [float(((T > 0.1) & (T < 0.9)).mean()) for T in ink.values()]
fig, axes = plt.subplots(1, 3, figsize=(9, 3.3), layout="constrained")
for ax, (tau, T) in zip(axes, ink.items(), strict=True):
    ax.imshow(T[window], cmap="gray", vmin=0, vmax=1)
    ax.set_title(rf"$\tau = {tau:g}$", fontsize=10)
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The photograph in ink three times; without the difference it is a soft threshold of the lightness, and the
# larger the difference counts, the more it consists of lines.*
#
# That knows nothing of faces: it draws wrinkles as eagerly as lids, and what the light washes out gets no line at all.
# The library has landmarks, so it *draws* lids, brows, lips, nose and jaw along them with pens that swell and taper,
# and takes such filtered lines only outside the face.
#
# ## 6. All together

# %%
caricature = tg.stylize(img, landmarks, "caricature")
colours = [len(np.unique(picture[window].reshape(-1, 3) // 32, axis=0)) for picture in (img, drawn.img, caricature.img)]
print("different colours (in steps of 32):", dict(zip(("photograph", "chibi", "caricature"), colours, strict=True)))

fig, axes = plt.subplots(1, 4, figsize=(9.6, 2.7), layout="constrained")
pictures = {"photograph": img, "chibi": drawn.img, "caricature": caricature.img, "chibi, for textures": drawn.texture}
for ax, (name, picture) in zip(axes, pictures.items(), strict=True):
    ax.imshow(picture[window])
    ax.set_title(name, fontsize=10)
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The photograph; a chibi drawing with huge eyes and flat tones; a caricature with a broad smile; and the chibi
# variant for textures, without shadows on the skin.*
#
# The last one is what a head is textured with: a head in 3D gets its light when it is rendered, so the drawing must
# not bring its own. `tg.make_avatar(img, style="chibi")` does all of it, and `tg.make_avatar(drawn.texture,
# drawn.landmarks)` is the same in two steps. Other styles: `"toon"`, `"ink"`, `"painted"`.
#
# ## Exercises
#
# 1. *Scaling and squaring.* $\exp(v) = \exp(v/2)\circ\exp(v/2)$. So start with the map $x + v(x)/2^n$ for a small
#    step, and apply it to itself $n$ times (Arsigny et al. 2006). How many squarings are as good as our 20 Runge-Kutta
#    steps?
# 2. Check Liouville's formula for the eye of section 1 in the plane: compare the determinant by differences with the
#    exponential of the integral.
# 3. `strength` multiplies the field. Why is a warp of strength 0.5, done twice, that of strength 1, while averaging
#    start and end points would not do?
#
# ## Solutions
#
# **1.** In the plane, for one eye. A map that is known on a grid must be interpolated to be applied to itself. Here the
# formula of $v$ is at hand, so the first map is simply applied $2^n$ times: what $n$ squarings make of it. A step of
# length $2^{-n}$ has an error of the size $4^{-n}$, all $2^n$ steps together one of $2^{-n}$.


# %%
def eye(x: np.ndarray) -> np.ndarray:
    """Velocity (k, 2) that enlarges by 1.6 across and 2.3 down about the origin, within a radius of 1."""
    return bump(np.linalg.norm(x, axis=1))[:, None] * np.log([1.6, 2.3]) * x


rng = np.random.default_rng(0)
x = rng.uniform(-1, 1, (500, 2))
truth = flow(eye, x, steps=400)
squaring_errors = []
for n in (2, 4, 6, 8):
    y = x
    for _ in range(2**n):
        y = y + eye(y) / 2**n
    squaring_errors.append(float(np.abs(y - truth).max()))
runge_kutta_error = float(np.abs(flow(eye, x) - truth).max())
print("squarings:", *(f"{error:.1e}" for error in squaring_errors), f"   20 Runge-Kutta steps: {runge_kutta_error:.1e}")

# %% [markdown]
# Each pair of squarings divides the error by four. About 24 squarings would match Runge-Kutta: the order of a method
# counts more than its number of steps. On a grid squaring is still attractive, as it needs only $n$ passes.
#
# **2.** The divergence by differences, its integral along the paths by the trapezoid rule.

# %%
eps = 1e-5
across, down = np.array([eps, 0]), np.array([0, eps])
J1 = (flow(eye, x + across) - flow(eye, x - across)) / (2 * eps)
J2 = (flow(eye, x + down) - flow(eye, x - down)) / (2 * eps)
determinant = J1[:, 0] * J2[:, 1] - J1[:, 1] * J2[:, 0]


def divergence(x: np.ndarray) -> np.ndarray:
    return (eye(x + across) - eye(x - across))[:, 0] / (2 * eps) + (eye(x + down) - eye(x - down))[:, 1] / (2 * eps)


path = [x]
for _ in range(100):
    path.append(flow(eye, path[-1], 0.01, 1))
liouville = np.exp(np.trapezoid([divergence(at) for at in path], dx=0.01, axis=0))
liouville_error = float(np.abs(determinant / liouville - 1).max())
print(f"determinants {determinant.min():.2f} to {determinant.max():.2f}; Liouville's differ by {liouville_error:.1e}")

# %% [markdown]
# **3.** The field does not depend on time, so to flow for half the time and then for the other half is to flow for the
# whole; and half the field for the whole time is the whole field for half of it. The mean of start and end is a
# straight line that knows nothing of the places between.

# %%
half = flow(lambda q: 0.5 * eye(q), x)
twice = flow(lambda q: 0.5 * eye(q), half)
halves_error = float(np.abs(twice - flow(eye, x)).max())
mean_is_no_half = float(np.abs((x + truth) / 2 - half).max())
print(f"half strength twice: {halves_error:.1e}; the mean of start and end is off by up to {mean_is_no_half:.3f}")

# %%
numbers: dict[str, float] = {
    "slope_displaced": float(slope_displaced),
    "slope_flowed": float(slope_flowed),
    "flow_difference_px": flow_difference,
    "there_and_back_px": there_and_back,
    "least_area_factor": float(areas.min()),
    "similarity_left": float(similarity_left),
    "largest_change_of_lightness": largest_change,
    "grey_without_difference": grey_pixels[0],
    "grey_with_lines": grey_pixels[-1],
    "colours_of_photograph": float(colours[0]),
    "colours_of_drawing": float(colours[1]),
    "squaring_ratio": squaring_errors[-2] / squaring_errors[-1],
    "runge_kutta_error": runge_kutta_error,
    "liouville_error": liouville_error,
    "halves_error": halves_error,
    "mean_is_no_half": mean_is_no_half,
}
