# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 13 · Hair by inflation
#
# **How does a flat patch of hair become a volume?** A picture shows where hair is, not how deep it is. In this lesson
# you blow up a patch of pixels like a balloon, see why that is not yet hair on a head, and follow what the library
# adds: a skull that gives way, hair of some thickness on the skin, and one closed shell about both.

# %%
import matplotlib.pyplot as plt
import numpy as np
import scipy.sparse as sp
from scipy.ndimage import distance_transform_edt
from scipy.sparse.linalg import spsolve

import toongeo as tg
from toongeo.geometry import cotangent_laplacian
from toongeo.model import data_path
from toongeo.render import interpolate, rasterize

# %% [markdown]
# ## 1. A balloon over an outline
#
# Let $\Omega$ be the patch and $\partial\Omega$ its outline. Solve one Poisson problem and take a root:
#
# $$-\Delta u = 4 \;\text{ in }\Omega,\qquad u = 0 \;\text{ on }\partial\Omega,\qquad z = \sqrt{u}.$$
#
# Why 4, and why the root? Over a disc of radius $r$ the solution is $u = r^2 - x^2 - y^2$ (differentiate twice in $x$
# and in $y$: $-\Delta u = 2 + 2$), so $z$ is **half a ball**. Over another outline it is a dome too, vertical at the
# rim. (How high it is depends on the outline: exercise 1.)
#
# On pixels of side $h$, $-h^2 \Delta$ is the *five-point stencil*: four times a pixel less its four neighbours. So the
# right side becomes $4 h^2$. Pixels outside the patch have $u = 0$, so they simply drop out of the sum.


# %%
def inflated(mask: np.ndarray, h: float = 1.0) -> np.ndarray:
    """u (rows, columns) of -laplacian u = 4 on the set pixels of side h, 0 elsewhere. Solved once, exactly."""
    inside = np.flatnonzero(mask.ravel())
    number = np.full(mask.size, -1)
    number[inside] = np.arange(len(inside))
    A = 4.0 * sp.eye_array(len(inside), format="csr")
    for step in (-1, 1, -mask.shape[1], mask.shape[1]):  # left, right, up, down; the patch does not touch the border
        beside = number[inside + step]
        rows = np.flatnonzero(beside >= 0)
        A = A - sp.csr_array((np.ones(len(rows)), (rows, beside[rows])), A.shape)
    u = np.zeros(mask.size)
    u[inside] = spsolve(A.tocsc(), np.full(len(inside), 4 * h * h))
    return u.reshape(mask.shape)


h, r = 0.05, 2.0
y, x = np.mgrid[-2.5 : 2.5 + h / 2 : h, -2.5 : 2.5 + h / 2 : h]
disc = np.hypot(x, y) < r
u = inflated(disc, h)
exact = np.maximum(r**2 - x**2 - y**2, 0)
disc_error = float(np.abs(u - exact)[disc].max() / r**2)
print(f"largest error of u, of the r^2 at its top: {disc_error:.1%} (pixels make stairs of a circle)")

# %% [markdown]
# Meshes have the same operator. The library's `cotangent_laplacian` of a grid whose squares are cut into two
# triangles *is* the five-point stencil: the diagonals of the squares lie opposite right angles, and the cotangent of
# a right angle is 0. So what you solved is the problem that the library solves on its triangles.

# %%
n = 6
column, row = np.meshgrid(np.arange(n), np.arange(n))
V = np.column_stack([column.ravel(), row.ravel(), np.zeros(n * n)]).astype(float)
corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
F = np.vstack(
    [
        np.column_stack([corner, corner + 1, corner + n + 1]),
        np.column_stack([corner, corner + n + 1, corner + n]),
    ]
)
L = cotangent_laplacian(V, F).toarray()
middle = 2 * n + 2  # a vertex with all its neighbours
stencil = np.zeros(n * n)
stencil[[middle, middle - 1, middle + 1, middle - n, middle + n]] = [4, -1, -1, -1, -1]
stencil_difference = float(np.abs(L[middle] - stencil).max())
assert stencil_difference < 1e-12
print("a row of the cotangent Laplacian:", *(f"{value:+.0f}" for value in L[middle][np.abs(L[middle]) > 1e-9]))

# %% [markdown]
# Is the root worth it? Cut three candidates along a diameter, each with its mirror image behind it: $u$ itself, its
# root, and the distance to the outline.

# %%
cut = disc.shape[0] // 2
profiles = {
    "$u$, scaled to the same height": u / r,
    r"$\sqrt{u}$: half a ball": np.sqrt(u),
    "distance to the outline": distance_transform_edt(disc) * h,
}
fig, axes = plt.subplots(1, 3, figsize=(9, 3.2), sharey=True, layout="constrained")
for ax, (name, height) in zip(axes, profiles.items(), strict=True):
    along = np.where(disc[cut], height[cut], 0.0)
    ax.fill_between(x[cut], -along, along, color="#d8a06a")
    ax.plot(x[cut], along, "k", x[cut], -along, "k", linewidth=1)
    ax.set_title(name, fontsize=10)
    ax.set_aspect("equal")
plt.show()

# %% [markdown]
# *Figure: Three cuts through a disc that was blown up. The first has a sharp edge where front and back meet, the third,
# a square on its corner, has a crease on top as well; the one in the middle is a circle.*
#
# Only the root arrives at the rim *vertically*, so that front and back go over into each other.

# %% [markdown]
# ## 2. Hair of a picture
#
# `find_hair` says which pixels are hair; `make_avatar` has called it. Our balloon takes any mask: thin strands become
# thin tubes and broad parts high domes, without a rule for either.

# %%
portrait = data_path("examples/portraits/blue_girl.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
avatar = tg.make_avatar(img, landmarks, texture_size=512)
assert avatar.parse.hair is not None and avatar.hair is not None
mask = avatar.parse.hair.mask
step = 3  # px: every third pixel is enough for a look
small = np.pad(mask[::step, ::step], 1)
balloon = np.sqrt(inflated(small, step))

fig, axes = plt.subplots(1, 3, figsize=(9.5, 3.4), layout="constrained")
axes[0].imshow(img[::2, ::2])
axes[1].imshow(mask[::2, ::2], cmap="gray", interpolation="nearest")
shown = axes[2].imshow(np.where(small, balloon, np.nan), cmap="magma")
for ax, name in zip(axes, ("picture", "mask of hair", "height of the balloon, px"), strict=True):
    ax.set_title(name, fontsize=10)
    ax.axis("off")
fig.colorbar(shown, ax=axes[2], shrink=0.8)
plt.show()

# %% [markdown]
# *Figure: A drawn girl with blue hair, the white mask of her hair on black, and the height of the balloon over it,
# which is greatest where the patch is broadest, above the forehead.*
#
# ## 3. Why a balloon is not enough
#
# There is a head inside. The next cell draws depth maps: for each pixel, how near the head is, in mm. `rasterize` finds
# the triangle that is nearest at each pixel, `interpolate` the depth there. Then it puts the balloon where the crown
# turns from front to back, and asks how much of the head that the mask covers sticks out.

# %%
face, camera = avatar.face, avatar.face.camera
view = camera.cropped(np.array([-step, -step]), 1 / step)  # the same camera for the small mask with its border


def depth_map(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Depth (rows, columns) of a mesh in mm, larger is nearer; NaN where there is none."""
    z = camera.depth(V)
    found = rasterize(np.column_stack([view.project(V), z]), F, *small.shape)
    return np.where(found.mask, interpolate(found, F, z), np.nan)


on_head = face.region("skin") | face.region("scalp")
skin = depth_map(face.vertices, face.faces[on_head[face.faces].all(1)])
turn = float(np.median(camera.depth(face.vertices[face.region("scalp")])))
covered = small & (skin > turn)
sticks_out = float((skin > turn + balloon / camera.scale)[covered].mean())
print(f"{sticks_out:.0%} of the covered skin sticks out of a balloon over the hair alone")

whole = small | ~np.isnan(skin)
dome = turn + np.sqrt(inflated(whole, step)) / camera.scale
dome_sticks_out = float((skin > dome)[covered].mean())
print(f"{dome_sticks_out:.0%} sticks out of a balloon over hair and head together")

# %% [markdown]
# A balloon belongs over the whole silhouette, hair *and* head. Even so the forehead comes through. So the library
# takes, at each point of the plane, the larger of two surfaces: the balloon, and the skin with some thickness of hair
# on it. A plain maximum would leave a crease where they cross. Its smooth sister does not:
#
# $$\operatorname{smax}_w(a, b) = \tfrac12\Big(a + b + \sqrt{(a-b)^2 + w^2}\Big) \;\ge\; \max(a, b),$$
#
# a hyperbola whose asymptotes are $a$ and $b$. It is highest above the plain maximum where both are equal: by $w/2$.


# %%
def smax(a: np.ndarray, b: np.ndarray, w: float) -> np.ndarray:
    return (a + b + np.sqrt((a - b) ** 2 + w**2)) / 2


thickness, w = 6.0, 5.0  # mm
ours = np.where(covered, smax(dome, skin + thickness, w), dome)
over_max = (smax(dome, skin + thickness, w) - np.maximum(dome, skin + thickness))[covered]
assert over_max.min() >= 0 and over_max.max() <= w / 2
still_out = float((skin > ours)[covered].mean())
print(f"{still_out:.0%} sticks out of the smooth maximum")

theirs = depth_map(avatar.hair.vertices, avatar.hair.faces)
brows = view.project(face.vertices[face.landmark_vertices[17:27]])
row = round(float(brows[:, 1].min() - 0.6 * np.ptp(brows[:, 0]) / 2))  # above the brows, where hair is all across
columns = np.flatnonzero(small[row])
across = (columns - columns.mean()) * step / camera.scale
fig, ax = plt.subplots(figsize=(7.5, 3.4), layout="constrained")
ax.fill_between(across, -60, skin[row, columns], color="#f1d3bd", label="head")
ax.plot(across, dome[row, columns], "--", color="tab:blue", label="balloon over hair and head")
ax.plot(across, (skin + thickness)[row, columns], ":", color="tab:red", label="skin and 6 mm")
ax.plot(across, ours[row, columns], color="k", linewidth=2.5, label="smooth maximum of both")
ax.plot(across, theirs[row, columns], color="tab:green", label="the library's hair")
ax.set(xlabel="across, mm", ylabel="towards the viewer, mm")
ax.legend(fontsize=8, loc="lower center")
plt.show()

# %% [markdown]
# *Figure: A horizontal cut through head and hair above the brows. The skin comes through the balloon, the smooth
# maximum covers both without a crease, and the library's hair lies a little outside it.*
#
# It lies outside because the library takes the thickness from the picture: half of what is drawn above the crown.
#
# ## 4. The library's shell
#
# `build_hair` does this on triangles that follow the outline, for a sheet in front and one behind the head. Both are
# heights over the *same* triangles and share the rim, so the result is closed by construction. Before, `make_room` has
# drawn the skull inside the outline of the hair: drawn heads are often narrower than people's. `make_avatar` has called
# both; called again on its face, `build_hair` gives the same to the bit.

# %%
hair = tg.build_hair(img, face, avatar.rig, mask)
same = np.array_equal(hair.vertices, avatar.hair.vertices) and np.array_equal(hair.texture, avatar.hair.texture)
edges = np.sort(hair.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
_, times = np.unique(edges, axis=0, return_counts=True)
shared_edges = float((times == 2).mean())
euler = len(hair.vertices) - len(times) + len(hair.faces)
print(f"the same as in the avatar: {same}")
print(f"{len(hair.faces)} triangles; edges that two of them share: {shared_edges:.0%}; V - E + F = {euler}")

# %% [markdown]
# Each edge has a triangle on both sides: there is no hole to look into. $V - E + F$ is 2 for what can be deformed into
# a ball, and two less for each tunnel through it: hair to the chin on both sides and behind is like a ball with dents.
#
# Does it fill the outline that was drawn? Draw hair and head together with the camera of the fit, take the pixels whose
# nearest triangle is of the hair, and compare with the mask. *Intersection over union*, $|A\cap B| / |A\cup B|$, is 1
# for equal sets.

# %%
V = np.vstack([hair.vertices, face.vertices])
F = np.vstack([hair.faces, face.faces + len(hair.vertices)])
nearest = rasterize(np.column_stack([camera.project(V), camera.depth(V)]), F, *mask.shape).face_ids
visible = (nearest >= 0) & (nearest < len(hair.faces))
outline_iou = float((visible & mask).sum() / (visible | mask).sum())
print(f"hair that is seen, against the mask of the picture: IoU {outline_iou:.3f}")

yaws = (-60, -20, 20, 60, 180)
fig, axes = plt.subplots(2, len(yaws), figsize=(10, 4.1), layout="constrained")
for k, yaw in enumerate(yaws):
    axes[0, k].imshow(avatar.render(size=220, yaw=yaw))
    axes[1, k].imshow(avatar.render(size=220, yaw=yaw, textured=False))
    axes[0, k].set_title(f"yaw {yaw}°", fontsize=10)
for ax in axes.flat:
    ax.axis("off")
plt.show()

# %% [markdown]
# *Figure: The head with its hair from five sides, in colours and in clay. The hair has sides and a back, whose strands
# continue those of the picture, and its edge lies on the forehead.*

# %% [markdown]
# ## Exercises
#
# 1. Over a long strip of half width $a$ nothing changes along it, so $-u'' = 4$. How high is the balloon? Which right
#    side would make the strip a half cylinder?
# 2. A ring of hair between the radii $r_1 < r_2$ (a headband) keeps its hole. Compare `inflated` with the closed form
#    $u = -\rho^2 + A\ln\rho + B$.
# 3. What is the volume of the hair? Use the divergence theorem: a closed mesh encloses
#    $\tfrac16\sum_{(i,j,k)} \det(v_i, v_j, v_k)$.
#
# ## Solutions
#
# **1.** $u = 2(a^2 - x^2)$, so $z = \sqrt2\,\sqrt{a^2 - x^2}$: an ellipse that is $\sqrt2\,a$ high. With 2 in place of
# 4 it would be a circle. That is why strands of the library, which are strips, get a fullness of their own.

# %%
strip = np.zeros((41, 601), bool)
strip[1:-1, 1:-1] = True
a = 20.0  # pixels from the middle to the first one outside
strip_height = float(np.sqrt(inflated(strip)[20, 300]) / a)
print(f"height over half width: {strip_height:.4f}; root of 2: {np.sqrt(2):.4f}")

# %% [markdown]
# **2.** $\ln\rho$ is harmonic away from the origin, $-\rho^2$ gives the 4, and two constants meet the two rims. A finer
# grid makes smaller stairs; their error is of the size of a pixel.

# %%
inner, outer = 0.8, 2.2


def ring_error(h: float) -> float:
    """Mean error of u over the ring, of the greatest u."""
    y, x = np.mgrid[-2.5 : 2.5 + h / 2 : h, -2.5 : 2.5 + h / 2 : h]
    rho = np.hypot(x, y)
    ring = (rho > inner) & (rho < outer)
    A = (outer**2 - inner**2) / np.log(outer / inner)
    exact = -(rho[ring] ** 2) + A * np.log(rho[ring] / inner) + inner**2
    return float(np.abs(inflated(ring, h)[ring] - exact).mean() / exact.max())


ring_errors = [ring_error(h) for h in (0.1, 0.05, 0.025)]
print("mean error with pixels of 0.1, 0.05, 0.025:", *(f"{error:.1%}" for error in ring_errors))

# %% [markdown]
# **3.** First a cube, whose volume is known, then the hair. What it encloses is hair and the part of the head inside:
# the shell is solid, as nobody sees its inside.


# %%
def volume(V: np.ndarray, F: np.ndarray) -> float:
    """Volume that a closed mesh encloses; > 0 if its triangles are counter-clockwise from outside."""
    return float(np.linalg.det(V[F]).sum() / 6)


cube = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)
squares = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
cube_volume = volume(cube, np.array([half for a, b, c, d in squares for half in ([a, b, c], [a, c, d])]))
hair_litres = volume(hair.vertices, hair.faces) / 1e6
print(f"a cube of side 1: {cube_volume:.3f}; the hair and what is inside: {hair_litres:.1f} litres")

# %%
numbers: dict[str, float] = {
    "disc_error": disc_error,
    "stencil_difference": stencil_difference,
    "sticks_out": sticks_out,
    "dome_sticks_out": dome_sticks_out,
    "still_out": still_out,
    "same_as_make_avatar": float(same),
    "shared_edges": shared_edges,
    "euler": float(euler),
    "outline_iou": outline_iou,
    "strip_height": strip_height,
    "ring_error_coarse": ring_errors[0],
    "ring_error_fine": ring_errors[-1],
    "cube_volume": cube_volume,
    "hair_litres": hair_litres,
}
