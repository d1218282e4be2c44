# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 7 · Analysis by synthesis
#
# **A picture is shape times paint times light. Can we tell which is which?**
#
# Landmarks are 68 points. A picture has a hundred thousand pixels, and each of them says something about the surface:
# skin that is turned to the light is bright. To use that we go the other way round: *synthesise* a picture from a
# shape, a paint and a light, compare it with the one we have, and change the three until both look alike. That is the
# third term of the loss of Pan et al. 2024 (Eq. 3), after landmarks and prior (lesson 5). You need lesson 4 for
# cameras.

# %%
import matplotlib.pyplot as plt
import numpy as np

import toongeo as tg
from toongeo.geometry import vertex_normals
from toongeo.model import data_path
from toongeo.render import (
    ScaledOrthographicCamera,
    Surface,
    interpolate,
    irradiance,
    rasterize,
    render_mesh,
    sample_image,
    sh_basis,
    srgb_to_linear,
)


def show(pictures, titles, *, rows=1, side=2.2, **options):
    """Pictures in rows, a title above each."""
    figure, axes = plt.subplots(rows, len(pictures) // rows, dpi=90, squeeze=False, layout="compressed")
    figure.set_size_inches(side * len(pictures) / rows, rows * (side + 0.3))
    for axis, picture, title in zip(axes.flat, pictures, titles, strict=True):
        axis.imshow(picture, **options)
        axis.set_title(title, fontsize=9)
        axis.axis("off")
    plt.show()


# %% [markdown]
# ## Light in nine numbers
#
# Skin is taken for *matt*: it sends the light that falls on it equally in all directions. How much falls on a place
# depends on its normal $n$ alone, if the light comes from far away. With radiance $L(\omega)$ from each direction,
#
# $$ E(n) = \int L(\omega)\, \max(n \cdot \omega, 0)\, d\omega . $$
#
# The cosine blurs: details of the light do not show on a matt surface. So $L$ is written in functions on the sphere
# that are ordered by detail, the *spherical harmonics* $Y_{lm}$, as a sound is written in frequencies. Of degree 0
# there is one (constant), of degree 1 three (the components of $n$), of degree 2 five (products of two of them). The
# integral multiplies each by a number $A_l$ that depends on the degree only, and from degree 3 on next to nothing is
# left (Ramamoorthi and Hanrahan 2001):
#
# $$ E(n) = \sum_{l=0}^{2} \sum_m A_l\, L_{lm}\, Y_{lm}(n), \qquad
# A_0 = \pi,\; A_1 = \tfrac{2\pi}{3},\; A_2 = \tfrac{\pi}{4} . $$
#
# Nine numbers for each colour channel are all the light there is. Do not believe the $A_l$: compute the integral. We
# spread 20 000 directions evenly over the sphere and sum up.

# %%
count = 20_000
k = np.arange(count) + 0.5
height, around = 1 - 2 * k / count, np.pi * (1 + 5**0.5) * k  # a Fibonacci spiral
directions = np.column_stack([np.sqrt(1 - height**2) * np.cos(around), height, np.sqrt(1 - height**2) * np.sin(around)])
normals = directions[::500]
falling = np.maximum(normals @ directions.T, 0) @ sh_basis(directions) * (4 * np.pi / count)  # E of each Y as a light
A = np.repeat([np.pi, 2 * np.pi / 3, np.pi / 4], [1, 3, 5])
lobe_error = np.abs(falling - sh_basis(normals) * A).max()
print(f"integral and A_l Y_lm differ by less than 0.001: {bool(lobe_error < 1e-3)}")

# %% [markdown]
# The nine functions, as the paint of a ball: what a light of this kind does to a matt surface, warm where it adds
# light, blue where it takes some away. No light is negative; it is the sum that must not be.

# %%
grid = np.linspace(-1, 1, 90)
x, y = np.meshgrid(grid, -grid)
inside = x**2 + y**2 < 1
ball = np.column_stack([x[inside], y[inside], np.sqrt(1 - x[inside] ** 2 - y[inside] ** 2)])
views = []
for value in sh_basis(ball).transpose():
    view = np.full((*x.shape, 3), 1.0)
    shade = plt.get_cmap("coolwarm")(0.5 + 0.5 * value)[:, :3]
    view[inside] = shade
    views.append(view)
names = ["1", "y", "z", "x", "xy", "yz", "3z² − 1", "xz", "x² − y²"]
show(views, names, side=1.05)

# %% [markdown]
# *Figure: Nine balls coloured by the nine harmonics: one even, three that are light on one side (from above, from the
# front, from the right), five with more patches.*
#
# ## Synthesis
#
# What is seen is light times paint: with *albedo* $\rho$ (the share of light that is sent back, for each channel),
#
# $$ I = \frac{\rho}{\pi}\, E(n) . \qquad (\text{Eq. 2}) $$
#
# It holds for *linear* light. Numbers in a picture file are not linear: they are encoded by the sRGB curve, which gives
# dark tones more of the 256 steps. So pictures are decoded first.
#
# Our test subject is a random person of the model, under a light that we choose. Everything about it is known.

# %%
model = tg.default_model()
rng = np.random.default_rng(3)
V_true = model.vertices(model.sample(rng, sigma=1.0))
camera = ScaledOrthographicCamera.look(15, 0, size=400, centre=(0, -20, 0), extent=260)


def lamp(ambient, right, above, front):
    """A white light (9, 3): the same from everywhere, and more from some sides, as the viewer sees them."""
    light = np.zeros((9, 3))
    light[[0, 3, 1, 2]] = np.array([ambient, right, above, front])[:, None]
    return light


lights = {
    "even": lamp(2.7, 0, 0, 0),
    "from the right": lamp(2.3, 1.2, 0.2, 0.4),
    "from above": lamp(2.3, 0, 1.3, 0.4),
    "from below": lamp(2.3, 0, -1.3, 0.4),
}
person = Surface(V_true, model.faces, colours=model.albedo_mean)
pictures = {name: render_mesh(person, camera, 400, light=light) for name, light in lights.items()}
show([picture[::2, ::2] for picture in pictures.values()], pictures)

# %% [markdown]
# *Figure: The same head four times: in even light it is flat, in light from the right, from above and from below it has
# shape, and a different mood each time.*
#
# ## Analysis, first part: the light
#
# Suppose that shape and paint are known. Then the picture is *linear* in the light. At each vertex that the camera
# sees, read the picture at the pixel where the vertex falls; that gives an equation a channel for nine unknowns:
#
# $$ \frac{\rho_i}{\pi} \sum_{lm} A_l\, Y_{lm}(n_i)\; L_{lm} = I_i . $$
#
# Which vertices are seen? Those of the face that are turned to the camera, and that nothing hides. The third row of the
# camera's rotation is the direction towards the viewer: its product with a normal says how far the skin is turned away.
# For what hides, the mesh is *rasterised*: for each pixel, which triangle is nearest, and at which depth. The `depth`
# of this camera, in mm, grows *towards* the viewer. A vertex more than a millimetre behind what its pixel shows is
# hidden.


# %%
def seen_vertices(V, camera, size=400):
    """Vertices of the face (k,) that the camera sees, not too obliquely."""
    px, depth = camera.project(V), camera.depth(V)
    fragments = rasterize(np.column_stack([px, depth]), model.faces, size, size)
    nearest = interpolate(fragments, model.faces, depth)
    column, row = np.clip(np.rint(px), 0, size - 1).astype(int).T
    facing = vertex_normals(V, model.faces) @ camera.rotation[2] > 0.3
    return np.flatnonzero(model.region("face") & facing & (nearest[row, column] - depth < 1.0))


def observed(picture, V, camera, rows):
    """Linear light (k, 3) of a picture where vertices fall."""
    return srgb_to_linear(sample_image(picture, camera.project(V[rows])) / 255)


def shading_basis(V, camera, rows):
    """Shade (k, 9) of a white surface in each harmonic; normals in the frame of the camera, where the light is."""
    normals = vertex_normals(V, model.faces)[rows] @ camera.rotation.T
    return sh_basis(normals) * A / np.pi


def best_light(B, albedo, seen):
    """Light (9, 3) of least squares for a shade B (k, 9), albedo (k, 3) and what is seen (k, 3), all linear."""
    return np.column_stack([np.linalg.lstsq(B * albedo[:, [c]], seen[:, c], rcond=None)[0] for c in range(3)])


rows = seen_vertices(V_true, camera)
albedo = srgb_to_linear(model.albedo_mean)
B = shading_basis(V_true, camera, rows)
assert (
    np.abs(
        B @ lights["from above"]
        - irradiance(vertex_normals(V_true, model.faces)[rows] @ camera.rotation.T, lights["from above"]) / np.pi
    ).max()
    < 1e-12
)
found = {name: best_light(B, albedo[rows], observed(pic, V_true, camera, rows)) for name, pic in pictures.items()}
light_error = max(np.abs(found[name] - lights[name]).max() for name in lights)
for name, light in found.items():
    print(f"{name:15s} ambient, above, front, right:", *(f"{c:5.2f}" for c in light[:4].mean(axis=1)))
print(f"the worst of 108 numbers is off by {light_error:.2f}")

# %% [markdown]
# The light comes back, but not to the last digit: the renderer works out light at vertices and mixes it between them, a
# picture has 256 steps, and the half of a face that is seen hardly tells some of the nine apart (exercise 1).
#
# ## Analysis, second part: shape
#
# Now the light is *not* known, and one number of the shape is not known either. For every value of it we can do the
# step above: find the light that is best for this shape, and see what is left,
#
# $$ L_{photo}(\alpha) = \min_{L} \frac{1}{N} \sum_i
# \left\| \frac{\rho_i}{\pi} E_L(n_i(\alpha)) - I\big(\Pi\, v_i(\alpha)\big) \right\|^2 . \qquad (\text{Eq. 5}) $$
#
# Two things depend on the shape: the normals, and the place $\Pi v_i$ where the picture is read. The light is never
# searched for; it is solved for inside of the loss. (This is called *variable projection*. It takes 27 unknowns, nine
# for each channel, out of the search.)
#
# We take the true person, change one mode of the shape by −2 to 2 standard deviations, and look at the loss.


# %%
def photo_loss(V, picture, camera, rows):
    """What is left of the picture with the best light for this shape: RMS, linear."""
    B, seen = shading_basis(V, camera, rows), observed(picture, V, camera, rows)
    return np.sqrt(((B @ best_light(B, albedo[rows], seen) * albedo[rows] - seen) ** 2).mean())


steps = np.linspace(-2, 2, 21)
picture = pictures["from the right"]
figure, axis = plt.subplots(figsize=(5.5, 3), dpi=90)
lowest = {}
for mode in (0, 1, 3):
    curve = [photo_loss(V_true + s * model.identity[mode], picture, camera, rows) for s in steps]
    lowest[mode] = steps[np.argmin(curve)]
    axis.plot(steps, curve, label=f"mode {mode}")
axis.axvline(0, color="black", linestyle="--", linewidth=1)
axis.set(xlabel="off the true shape, standard deviations", ylabel="RMS of what is left")
axis.legend(fontsize=8)
plt.show()
print("least at", {mode: round(float(at), 1) for mode, at in lowest.items()})

# %% [markdown]
# *Figure: The loss over the error of three modes of shape: three valleys with their lowest point at the true shape.*
#
# The valleys are there, and their floors are where they should be: two standard deviations off, one still finds the way
# down. A wrong *pose* has no such valley. The picture is then read at places that show something else, a nostril in
# place of a cheek, and a small change tells nothing. So photometric fitting starts from a fit to landmarks, never from
# nothing.
#
# ## A gradient, and its test
#
# To go downhill in many dimensions one needs the gradient. For light $\ell$ (9) and one coefficient $b$ of the paint,
# $\rho = \rho_0 + b\,\rho_1$, the loss of one channel is $L = \frac1N \|r\|^2$ with $r = (B\,\ell) \odot \rho - I$
# (with $\odot$ the product of elements), and
#
# $$ \frac{\partial L}{\partial \ell} = \frac2N\, B^T (\rho \odot r), \qquad
# \frac{\partial L}{\partial b} = \frac2N\, \big((B\,\ell) \odot \rho_1\big) \cdot r . $$
#
# A wrong gradient still goes downhill somehow, and the result is a bit worse, and nobody notices. So test it. If $g$ is
# the gradient, what remains of $L(x + h d) - L(x) - h\, g \cdot d$ falls with the *square* of $h$; with a wrong $g$
# only with $h$. `tg.check_gradient` measures the exponent.

# %%
rho0, rho1 = albedo[rows, 1], model.albedo[0, rows, 1].astype(float)
green = observed(picture, V_true, camera, rows)[:, 1]


def channel_loss(x):
    """Loss and gradient (10,) for light (9,) and one coefficient of the paint."""
    shade, rho = B @ x[:9], rho0 + x[9] * rho1
    r = shade * rho - green
    return float(r @ r / len(r)), np.r_[2 / len(r) * (B.T @ (rho * r)), 2 / len(r) * ((shade * rho1) @ r)]


check = tg.check_gradient(channel_loss, np.r_[found["even"][:, 1], 0.5])
wrong = tg.check_gradient(lambda x: (channel_loss(x)[0], 0.98 * channel_loss(x)[1]), np.r_[found["even"][:, 1], 0.5])
print(f"slopes: ours {check.slopes.min():.2f} or more; with a gradient 2 % too short {wrong.slopes.max():.2f} or less")

# %% [markdown]
# ## All at once: `tg.photometric_fit`
#
# The library does this for identity, expression, pose and paint together, with landmarks and prior in the loss, normals
# and reading places moving along, and gradients tested as above. It starts from `tg.fit_3dmm`. Two options say how far
# it may go: a picture counts as so many independent observations (pixels beside each other err alike), and the samples
# are chosen and weighed anew in each pass. How much better is the shape? Here the truth is known. The distance to it is
# measured in millimetres over the face, after place, size and turn are taken out (lesson 2).

# %%
points = camera.project(V_true[model.landmarks])
coarse = tg.fit_3dmm(picture, points)
options = tg.PhotometricOptions(independent_samples=100, passes=8)  # for clean pictures; 20 and 4 without asking
refined = tg.photometric_fit(picture, coarse, points, options=options)
face = model.region("face")


def off(V):
    """Distances (k,) of the face from the truth, mm, after a similarity."""
    P, Q = V[face] - V[face].mean(axis=0), V_true[face] - V_true[face].mean(axis=0)
    U, _, Vt = np.linalg.svd(P.T @ Q)
    turned = P @ U @ Vt
    return np.linalg.norm(turned * ((turned * Q).sum() / (turned**2).sum()) - Q, axis=1)


shapes = {"mean face": model.mean, "landmarks": coarse.vertices, "and picture": refined.vertices}
errors = {name: float(np.sqrt((off(V) ** 2).mean())) for name, V in shapes.items()}
print({name: f"{error:.1f} mm" for name, error in errors.items()})


def heat(V, yaw=-35):
    """The shape with its distance from the truth as colour: white 0, red 6 mm."""
    colours = np.full((len(V), 3), 0.92)
    colours[face] = plt.get_cmap("Reds")(np.clip(off(V) / 6, 0, 1) * 0.85)[:, :3]
    view = ScaledOrthographicCamera.look(yaw, 0, size=240, centre=(0, -20, 0), extent=250)
    return render_mesh(Surface(V, model.faces, colours=colours), view, 240)


show([heat(V_true), *(heat(V) for V in shapes.values())], ["truth", *(f"{n}: {e:.1f} mm" for n, e in errors.items())])

# %% [markdown]
# *Figure: Four heads from three quarters, white where they are true and red where they are 6 mm off or more: the truth;
# the mean face, red nearly all over; the fit to landmarks, with a red forehead and reddish cheeks; and the photometric
# fit, nearly white.*
#
# The landmarks do not see cheeks, forehead and depth; the shading does. But look at the conditions of this success: the
# paint was the model's, the surface matt, no shadow fell, no hair. Real pictures keep none of these promises.
#
# ## A photograph
#
# The astronaut: photograph, rendering, paint, and what is left. `residual_map` is rendering minus picture; the
# brightest colour stands for a third of the whole range or more.

# %%
path = data_path("examples/portraits/astronaut.png")
img, landmarks = tg.read_image(path), tg.read_landmarks(path.with_suffix(".pts"))
start = tg.fit_3dmm(img, landmarks)
astronaut = tg.photometric_fit(img, start, landmarks)
low = landmarks.min(axis=0).astype(int) - [30, 60]
box = np.s_[low[1] : low[1] + 200, low[0] : low[0] + 170]
left = np.abs(tg.residual_map(img, astronaut)).mean(axis=2)
views = [
    img[box],
    tg.rendered_picture(astronaut, img.shape, background=img)[box],
    tg.rendered_picture(astronaut, img.shape, background=img, lit=False)[box],
    (255 * plt.get_cmap("magma")(np.nan_to_num(left[box]) * 3)[..., :3]).astype(np.uint8),
]
show(views, ["photograph", "rendering", "its paint alone", "what is left"])
report = astronaut.photometric
print(f"RMS of what is left, sRGB: {report.residual_ambient:.3f} with even light,", end=" ")
print(f"{report.residual_before:.3f} with the best light, {report.residual_after:.3f} with shape and paint fitted too")

# %% [markdown]
# *Figure: The astronaut's face; the model's face in her place, lit alike; its paint without light; and what is left,
# which is largest where hair covers the forehead, and at eyes, mouth and brows.*
#
# Most of the gain comes from the light. Hair, teeth and shadows are nothing that this model can paint. Two things keep
# them from bending the shape: pixels count less the less their colour is like the skin of this face, and less the worse
# they are explained (lesson 5). How much the picture counts against the landmarks follows from how well it is explained
# as a whole. In a clean rendering the pixels rule; in a drawing, whose shading is what the artist liked, the landmarks
# do. For a drawing there is little to gain, so `tg.make_avatar` does this in photographs of people alone, unless you
# ask (`photometric=True`).
#
# ## Exercises
#
# 1. Make the light twice as strong and the paint half as dark. What does the picture do? What must hold for
#    `best_light` to be unique?
# 2. Fit the light with 1, 4 and 9 harmonics to a picture by a hard lamp, $E = \max(n \cdot d, 0)$ with one direction
#    $d$. How much is left each time?
# 3. Forget to decode sRGB. By how much is the light from the right off?
#
# ## Solutions

# %%
# 1. The picture stays: only the product counts. The scale of one of the two must be fixed; here the paint is given,
#    and the nine columns have to be independent on the normals that are seen.
half = np.abs((B @ (2 * lights["from above"])) * (albedo[rows] / 2) - (B @ lights["from above"]) * albedo[rows]).max()
rank = np.linalg.matrix_rank(B)
condition = np.linalg.cond(B)
print(f"the picture changes by {half:.1f}; rank {rank} of 9, condition number {condition:.0f}")

# %%
# 2. A hard lamp has no end of harmonics, but a matt surface shows few. Over the whole sphere:
d = np.array([0.6, 0.48, 0.64])
hard = np.maximum(directions @ d, 0)
basis = sh_basis(directions)
left_over = []
for terms in (1, 4, 9):
    fitted = basis[:, :terms] @ np.linalg.lstsq(basis[:, :terms], hard, rcond=None)[0]
    left_over.append(float(np.sqrt(((fitted - hard) ** 2).mean() / (hard**2).mean())))
print("left of a hard lamp with 1, 4 and 9 terms:", *(f"{100 * e:.0f} %" for e in left_over))

# %%
# 3. Encoded numbers are too bright in the dark: the light seems more even than it is.
encoded = sample_image(picture, camera.project(V_true[rows])) / 255
naive = best_light(B, model.albedo_mean[rows].astype(float), encoded)
ratios = [light[3].mean() / light[0].mean() for light in (lights["from the right"], found["from the right"], naive)]
print("light from the right, over ambient: true {:.2f}, decoded {:.2f}, not decoded {:.2f}".format(*ratios))

# %%
numbers: dict[str, float] = {
    "lobe_error": lobe_error,
    "light_error": light_error,
    **{f"valley_{mode}": float(at) for mode, at in lowest.items()},
    "taylor_slope": check.slopes.min(),
    "wrong_slope": wrong.slopes.max(),
    "mean_mm": errors["mean face"],
    "landmarks_mm": errors["landmarks"],
    "photometric_mm": errors["and picture"],
    "astronaut_ambient": report.residual_ambient,
    "astronaut_light": report.residual_before,
    "astronaut_all": report.residual_after,
    "scale_ambiguity": half,
    "rank": rank,
    "left_1": left_over[0],
    "left_4": left_over[1],
    "left_9": left_over[2],
    "contrast_true": ratios[0],
    "contrast_decoded": ratios[1],
    "contrast_naive": ratios[2],
}
