# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 8 · Texture
#
# **The picture shows one side of a head. What colour is the rest?**
#
# A fitted head is a shape without colours. The picture has colours, for what it shows. This lesson unrolls the head
# into a square, the *atlas*, fetches the picture's colours into it, finds out which of them can be believed, and fills
# in the rest, layer by layer. The method is that of Pan et al. 2024, section 3.2.3. You need cameras (lesson 4).

# %%
import base64
import dataclasses
import io
from collections import deque

import matplotlib.pyplot as plt
import numpy as np
import scipy.sparse as sp
from PIL import Image
from scipy.ndimage import binary_dilation, label
from scipy.sparse.linalg import spsolve

import toongeo as tg
from toongeo.geometry import vertex_normals
from toongeo.model import atlas_coordinates, data_path
from toongeo.render import interpolate, rasterize, sample_image, uv_to_px


def show(pictures, titles, *, rows=1, side=2.2, **options):
    """Pictures in rows, a title above each."""
    figure, axes = plt.subplots(rows, len(pictures) // rows, dpi=90, squeeze=False, layout="compressed")
    figure.set_size_inches(side * len(pictures) / rows, rows * (side + 0.3))
    for axis, picture, title in zip(axes.flat, pictures, titles, strict=True):
        axis.imshow(picture, **options)
        axis.set_title(title, fontsize=9)
        axis.axis("off")
    plt.show()


path = data_path("examples/portraits/blonde_girl_threequarter.png")
img, landmarks = tg.read_image(path), tg.read_landmarks(path.with_suffix(".pts"))
avatar = tg.make_avatar(img, landmarks, hair=False, texture_size=512)
face, model = avatar.face, avatar.face.model
V, F = face.vertices, face.faces
print(f"the head is turned by {face.camera.yaw:.0f} degrees")

# %% [markdown]
# ## The atlas
#
# Every vertex has a second place, in a square of side 1: its texture coordinates $(u, v)$, as if the skin had been cut
# open and flattened. On a cut, one vertex of the head lies at two places of the atlas. So there are more places than
# vertices, and each triangle has its corners twice: as vertices in `faces` (m, 3), as places in `uv_faces` (m, 3). The
# atlas is made once for the model, and is the same for all heads.

# %%
SIZE, FACE = 256, np.s_[:165, 30:226]  # texels; and where the face lies in the atlas
atlas = atlas_coordinates(model)
on_atlas = uv_to_px(atlas.uv, SIZE, SIZE)  # (t, 2), v up becomes rows down
figure, axes = plt.subplots(1, 2, figsize=(7, 3.5), dpi=90, layout="compressed")
axes[0].imshow(img)
axes[0].triplot(*face.project(V).T, F[model.region("face")[F].all(axis=1)], linewidth=0.15, color="black")
axes[1].triplot(*on_atlas.T, atlas.uv_faces[model.region("face")[F].all(axis=1)], linewidth=0.15, color="black")
axes[1].set(xlim=(30, 226), ylim=(170, 0), aspect="equal")
for axis, title in zip(axes, ("triangles in the picture", "the same triangles in the atlas"), strict=True):
    axis.set_title(title, fontsize=9)
    axis.axis("off")
plt.show()

# %% [markdown]
# *Figure: The triangles of the face drawn over the picture of a girl who looks a little to one side, and in the atlas,
# where the face is seen from the front and spread out.*
#
# A cell of the atlas is a *texel*. Which triangle does it lie in, and where? Drawing triangles into a grid and noting
# that is *rasterising*. The place in the triangle is given by *barycentric coordinates*: three weights
# $\lambda_1, \lambda_2, \lambda_3$ with sum 1, so that the texel is $\lambda_1 a + \lambda_2 b + \lambda_3 c$ of the
# triangle's corners in the atlas. And now the trick: the same weights of the same corners *in space* are the point of
# the skin that the texel stands for; the camera $\Pi$ says where the picture shows it (Eq. 12):
#
# $$ p = \lambda_1 v_1 + \lambda_2 v_2 + \lambda_3 v_3, \qquad \text{pixel} = \Pi(p) . $$

# %%
fragments = rasterize(on_atlas, atlas.uv_faces, SIZE, SIZE)
texels = np.flatnonzero(fragments.mask)
triangle = fragments.face_ids.ravel()[texels]
weight = fragments.barycentrics.reshape(-1, 3)[texels].astype(float)


def at_texels(values):
    """Values of vertices (n, c) at the texels (k, c), by the weights of their corners."""
    return np.einsum("kc,kcx->kx", weight, values[F[triangle]])


pixel = face.camera.project(at_texels(V))
on_skin = model.region("face")[F[triangle]].all(axis=1)  # the front of the head; the picture does not tell the rest
# Where all texels lie in the picture follows from where the vertices do: the camera is affine.
u, v = tg.texture_coordinates(face, img.shape).T
own = np.column_stack([u * img.shape[1] - 0.5, (1 - v) * img.shape[0] - 0.5])
place_gap = np.abs(at_texels(own) - pixel).max()
assert place_gap < 1e-3  # px; barycentric weights are kept in single precision

inside = on_skin & (pixel > 0).all(axis=1) & (pixel < np.array(img.shape[1::-1]) - 1).all(axis=1)
colour = sample_image(img, pixel)


def picture_of(colours, known):
    """The atlas (SIZE, SIZE, 3): colours (k, 3) of the texels where `known` (k,), grey elsewhere."""
    out = np.full((SIZE * SIZE, 3), 128, np.uint8)
    out[texels[known]] = np.clip(np.rint(colours[known]), 0, 255)
    return out.reshape(SIZE, SIZE, 3)


naive = picture_of(colour, inside)

# %% [markdown]
# ## What can be believed
#
# Eight lines, and we have a texture. It is wrong: a line of sight passes through *two* sides of the head, and both got
# the colour of the near one. Two tests sort that out.
#
# 1. *Is it turned to us?* The cosine between the normal of the skin and the direction to the camera, which is the third
#    row of its rotation: 1 is face to face, 0 is edge-on, where one pixel covers a long strip of skin, below 0 is the
#    far side.
# 2. *Is nothing before it?* The mesh rasterised in the picture gives the depth of the nearest skin at every pixel, in
#    mm, larger towards the viewer. What lies more than a few millimetres behind that is hidden, as a cheek behind a
#    nose.

# %%
cosine = vertex_normals(V, F) @ face.camera.rotation[2]
depth = face.camera.depth(V)
front = rasterize(np.column_stack([face.project(V), depth]), F, *img.shape[:2])
nearest = interpolate(front, F, depth)  # (H, W) depth of the nearest skin
column, row = np.clip(np.rint(pixel), 0, np.array(img.shape[1::-1]) - 1).astype(int).T
cosines = at_texels(cosine[:, None])[:, 0]
behind = nearest[row, column] - at_texels(depth[:, None])[:, 0]  # mm
turned = np.clip((cosines - 0.15) / 0.3, 0, 1)  # from 0 at a cosine of 0.15 to 1 at 0.45
confidence = turned * (behind < 3.0) * inside


def map_of(values):
    """The atlas (SIZE, SIZE): values (k,) of the texels, NaN between the islands."""
    out = np.full(SIZE * SIZE, np.nan)
    out[texels] = np.where(on_skin, values, np.nan)
    return out.reshape(SIZE, SIZE)


grey = plt.get_cmap("viridis")
maps = [grey(np.clip(map_of(values), 0, 1)) for values in (cosines, (behind < 3.0).astype(float), confidence)]
show(
    [naive[FACE], *(values[FACE] for values in maps)],
    ["every texel its pixel", "cosine", "nothing before it", "confidence"],
    side=2.5,
)
hidden = float((inside & (behind >= 3.0)).sum() / inside.sum())
print(f"{hidden:.0%} of the texels in the picture are hidden, {np.mean(confidence[on_skin] > 0.5):.0%} can be believed")

# %% [markdown]
# *Figure: Four atlases, the last three from blue for 0 to yellow for 1: the picture's colours everywhere, with the far
# side of the face smeared; the cosine, high in front and at the near cheek; what is not hidden; and the confidence,
# which is left in front and on the near side.*
#
# Also hair and background must not get onto the skin, nor the black lines between them. That is the work of
# `tg.parse_face`, which says of each pixel what it shows. We keep eight pixels away from all that is hair or
# background.

# %%
labels = avatar.parse.labels
not_skin = np.isin(labels, [tg.FaceLabel.HAIR, tg.FaceLabel.BACKGROUND])
near = binary_dilation(not_skin, iterations=8)
mask = np.zeros(SIZE * SIZE, bool)
mask[texels] = (confidence > 0.5) & ~near[row, column]
parts, _ = label(mask.reshape(SIZE, SIZE))
mask = parts == np.bincount(parts.ravel())[1:].argmax() + 1  # one piece, without crumbs
known = mask.ravel()[texels]
believed = picture_of(colour, known)
print(f"{known.sum()} texels are known, {(~known & on_skin).sum()} of the face are not")

# %% [markdown]
# ## Diffusion, breadth first
#
# Unknown texels take the colours of their neighbours. In which order? *Breadth first*: first all that touch a known
# one, then all that touch those, and so on. The layer of a texel is its distance $d$ from the known ones in steps, and
# its colour is the mean of its neighbours that came before it:
#
# $$ c_i = \frac{1}{|\{j \sim i : d_j < d_i\}|} \sum_{j \sim i,\; d_j < d_i} c_j . $$
#
# In code: a padded array, four shifts, and a loop over layers.


# %%
def diffuse(img, mask):
    """Picture (H, W, c) and what is known of it (H, W), after each layer of filling its unknown pixels."""
    colour = np.pad(np.where(mask[..., None], img, 0).astype(float), ((1, 1), (1, 1), (0, 0)))
    known = np.pad(mask, 1)
    border = np.pad(np.ones_like(mask), 1)
    while not known[1:-1, 1:-1].all():
        total, count = np.zeros_like(colour), np.zeros(known.shape)
        for axis in (0, 1):
            for step in (1, -1):
                total += np.roll(colour * known[..., None], step, axis)
                count += np.roll(known, step, axis)
        layer = ~known & (count > 0) & border
        colour[layer] = total[layer] / count[layer][:, None]
        known = known | layer
        yield colour[1:-1, 1:-1].copy(), known[1:-1, 1:-1].copy()


rng = np.random.default_rng(0)
small, small_mask = rng.random((20, 24, 3)), rng.random((20, 24)) < 0.05
*_, (filled, _) = diffuse(small, small_mask)
layers_gap = np.abs(filled - tg.diffuse_texture(small, small_mask)).max()
assert layers_gap < 1e-12

# %% [markdown]
# That is `tg.diffuse_texture`. Now the atlas of the girl, watched at six moments. Between the islands of the atlas the
# colours run on too, which does no harm: nothing is drawn there, and a filter that reads across an edge finds a fitting
# colour.

# %%
layers = list(diffuse(believed, mask))
print(f"{len(layers)} layers")


def frame(k):
    """The atlas after k layers, grey where it is unknown."""
    colour, there = layers[k - 1] if k else (believed.astype(float), mask)
    return np.where(there[..., None], np.clip(np.rint(colour), 0, 255), 128).astype(np.uint8)


moments = [0, 3, 10, 25, 50, len(layers)]
show([frame(k)[FACE] for k in moments], [f"layer {k}" for k in moments], rows=2, side=2.4)
diffused = frame(len(layers))
library_gap = int(np.abs(diffused.astype(int) - tg.diffuse_texture(believed, mask)).max())
assert library_gap <= 1  # of 255: rounding

# %% [markdown]
# *Figure: Six moments of the diffusion: the known part of the face in a grey atlas, then a growing fringe of its
# colours, until the face is covered with skin; beside one brow a black patch has grown.*
#
# The black patch is worth a look. The end of that brow reached the border of what was known, and diffusion does not
# know that a line is a line: what touches the border is spread. The library lets only plain skin do that.
#
# The same as a film, which plays once, where the notebook is shown by something that plays it.


# %%
def animate(frames, description):
    """Show frames once, as a film of less than five seconds, in a notebook; nothing where there is none."""
    try:
        from IPython import get_ipython
        from IPython.display import display
    except ImportError:
        return
    if get_ipython() is None:
        return
    pictures = [Image.fromarray(frame).resize((196, 165)).quantize(48) for frame in frames]
    file = io.BytesIO()
    pictures[0].save(file, "gif", save_all=True, append_images=pictures[1:], duration=160)
    data = {"image/gif": base64.b64encode(file.getvalue()).decode(), "text/plain": description}
    display(data, raw=True, metadata={"image/gif": {"alt": description}})


animate(
    [frame(k)[FACE] for k in [0, 0, 0, *range(1, 12), *range(12, 60, 4), len(layers), len(layers), len(layers)]],
    "Film: the colours of the known part of the face grow layer by layer over the atlas",
)

# %% [markdown]
# ## A queue, or layers
#
# The paper describes a queue: a pixel after the other, each taking the mean of *all* neighbours that are known by then,
# also of its own layer. That depends on the order in which a layer is walked through. With layers at once, the result
# of a mirrored picture is the mirrored result, to the last bit. A face is nearly symmetric, so that matters.


# %%
def queued(img, mask):
    """The same with one queue, in raster order."""
    colour, known = img.astype(float).copy(), mask.copy()
    h, w = mask.shape

    def around(r, c):
        return [(a, b) for a, b in ((r - 1, c), (r, c - 1), (r, c + 1), (r + 1, c)) if 0 <= a < h and 0 <= b < w]

    queue = deque(p for p in np.argwhere(~mask).tolist() if any(known[q] for q in around(*p)))
    waiting = {tuple(p) for p in np.argwhere(~mask).tolist()} - {tuple(p) for p in queue}
    while queue:
        r, c = queue.popleft()
        colour[r, c] = np.mean([colour[q] for q in around(r, c) if known[q]], axis=0)
        known[r, c] = True
        for q in around(r, c):
            if q in waiting:
                waiting.remove(q)
                queue.append(q)
    return colour


stripes, edge = np.zeros((40, 60, 3)), np.zeros((40, 60), bool)
edge[:, :3] = True
stripes[edge] = np.repeat(plt.get_cmap("tab10")(np.arange(40) // 8)[:, :3], 3, axis=0)
by_queue = queued(stripes, edge)
queue_gap = np.abs(by_queue - tg.diffuse_texture(stripes, edge, order="sequential")).max()
assert queue_gap < 1e-12
*_, (by_layers, _) = diffuse(stripes, edge)
flip = np.s_[::-1]
asymmetry = {
    "layers": np.abs(tg.diffuse_texture(stripes[flip], edge[flip])[flip] - by_layers).max(),
    "queue": np.abs(queued(stripes[flip], edge[flip])[flip] - by_queue).max(),
}
print("mirrored picture, mirrored result, off by:", {name: round(float(gap), 2) for name, gap in asymmetry.items()})
show([stripes, by_layers, by_queue], ["known at the left edge", "layers", "queue"])

# %% [markdown]
# *Figure: Coloured stripes along the left edge of a black picture; filled by layers, they run straight to the right;
# filled by a queue, they are dragged down on the way.*
#
# ## On the head
#
# Now three textures on the head, seen from the side that the picture shows and from the other: every texel its pixel;
# the known ones and diffusion in the atlas, as above; and `tg.bake_texture`.

# %%
texture = avatar.texture


def worn(ours):
    """The avatar in a texture of ours; eyeballs, mouth and the back of the head are left to the library."""
    mine = np.zeros(SIZE * SIZE, bool)
    mine[texels[on_skin]] = True
    large = np.repeat(np.repeat(mine.reshape(SIZE, SIZE), 2, axis=0), 2, axis=1)
    smooth = np.array(Image.fromarray(ours).resize((512, 512), Image.Resampling.BILINEAR))
    return dataclasses.replace(avatar, texture=np.where(large[..., None], smooth, texture))


heads = {"every texel its pixel": worn(naive), "diffused": worn(diffused), "bake_texture": avatar}
sides = [head.render(avatar.pose, size=230, yaw=yaw) for yaw in (face.camera.yaw, 40) for head in heads.values()]
show(sides, [*heads, *("other side",) * 3], rows=2, side=2.5)

# %% [markdown]
# *Figure: The girl's head in three textures, as in the picture and from the other side. With every texel its pixel,
# hair and black lines are smeared over temple and cheek; diffused, they are skin, but for the patch beside the brow;
# the library's has skin, and hair where the picture has it.*
#
# What `tg.bake_texture` does beyond these lines: it takes the mean over what a texel covers and not one pixel; it
# believes by degrees; what is not seen is first looked for on the *mirrored* side, raised or lowered in colour to meet
# the seen side without a seam; the diffusion runs over the surface, where the seams of the atlas do not stop it; and
# the scalp takes the colour of the hair.
#
# One check: from the camera of the picture, the textured head must look like the picture, where it was believed.

# %%
flat = tg.render_mesh(avatar.surfaces(avatar.pose), face.camera, img.shape[:2], shading="unlit")
seen = np.unique(np.column_stack([row, column])[confidence >= 1], axis=0)
seen = seen[~near[tuple(seen.T)]]
difference = np.abs(flat[tuple(seen.T)].astype(int) - img[tuple(seen.T)].astype(int)).max(axis=1)
back = float(np.median(difference))
print(f"median difference over {len(seen)} pixels: {back:.0f} of 255")

# %% [markdown]
# ## Exercises
#
# 1. Two pixels of a picture are known. How many layers are there, and what are the smallest and the largest value that
#    can come out?
# 2. Diffusion leaves streaks. The smoothest filling solves $\Delta c = 0$ instead: every unknown pixel is the mean of
#    *all* its neighbours. Set up that linear system for the small picture of random colours, and compare the sum of
#    squared differences between neighbours.
# 3. Use 8 neighbours in place of 4 (`connectivity=8`). How many layers does the atlas need then?
#
# ## Solutions

# %%
# 1. Means never leave the range of what they are made of. The layer of a pixel is its distance in steps along rows and
#    columns from the nearest known one.
dots, spots = np.zeros((41, 41), bool), np.zeros((41, 41, 1))
dots[20, 20] = dots[8, 30] = True
spots[20, 20], spots[8, 30] = 0.2, 0.9
*_, (two, _) = diffuse(spots, dots)
rows_, columns_ = np.indices(dots.shape)
steps = np.min([abs(rows_ - r) + abs(columns_ - c) for r, c in np.argwhere(dots)], axis=0)
count = sum(1 for _ in diffuse(spots, dots))
print(f"greatest distance {steps.max()}, layers {count}; values from {two.min():.1f} to {two.max():.1f}")

# %%
# 2. A row for each unknown pixel: its number of neighbours on the diagonal, −1 for each neighbour.
h, w = small_mask.shape
index = np.arange(h * w).reshape(h, w)
pairs = np.vstack(
    [
        np.column_stack([index[:, 1:].ravel(), index[:, :-1].ravel()]),
        np.column_stack([index[1:].ravel(), index[:-1].ravel()]),
    ]
)
adjacent = sp.coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(h * w, h * w))
adjacent = (adjacent + adjacent.T).tocsr()
laplacian = (sp.diags_array(adjacent.sum(axis=1)) - adjacent).tocsr()
free, fixed = np.flatnonzero(~small_mask.ravel()), np.flatnonzero(small_mask.ravel())
smoothest = small.reshape(-1, 3).copy()
smoothest[free] = spsolve(laplacian[free][:, free].tocsc(), -(laplacian[free][:, fixed] @ smoothest[fixed]))


def roughness(colours):
    """Sum of squared differences between neighbours."""
    return float((np.diff(colours.reshape(-1, 3)[pairs], axis=1) ** 2).sum())


rough, smooth = roughness(filled), roughness(smoothest)
print(f"squared differences: {rough:.1f} breadth first, {smooth:.1f} at least")

# %%
# 3. A step may go along a diagonal: the distance is that of a king on a chess board, and there are fewer layers.
eight = 0
there = mask.copy()
while not there.all():
    grown = np.pad(there, 1)
    there = np.any([np.roll(grown, (a, b), (0, 1))[1:-1, 1:-1] for a in (-1, 0, 1) for b in (-1, 0, 1)], axis=0)
    eight += 1
print(f"{len(layers)} layers with 4 neighbours, {eight} with 8")

# %%
numbers: dict[str, float] = {
    "place_gap": place_gap,
    "hidden": hidden,
    "known_share": float(known.sum() / on_skin.sum()),
    "layers_gap": layers_gap,
    "library_gap": library_gap,
    "queue_gap": queue_gap,
    "asymmetry_layers": asymmetry["layers"],
    "asymmetry_queue": asymmetry["queue"],
    "picture_again": back,
    "greatest_distance": int(steps.max()),
    "layers": count,
    "rough": rough,
    "smoothest": smooth,
    "layers_4": len(layers),
    "layers_8": eight,
}
