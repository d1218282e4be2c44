# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 11 · Deformation gradients
#
# **What is twice a difference? And why do caricatures need to know?**
#
# A caricature takes what is special about a face and doubles it. A morphable model adds displacements, so twice the
# difference would be twice the displacements. This lesson shows on a bar why that goes wrong, what to double instead
# (rotations, and stretches, each for itself), how a mesh is made of them again, and what it does for faces. The method
# is that of Wu, Zhang, Lai, Zheng and Cai, *Alive caricature from 2D to 3D*, 2018; numbers of equations are theirs.
# Lesson 9 introduces the deformation gradient of a triangle, which is needed here.

# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.sparse.linalg import splu

import toongeo as tg
from toongeo.caricature import linear_fit
from toongeo.geometry import cotangent_laplacian, deformation_gradients, polar_decomposition, rotation_exp, rotation_log
from toongeo.model import data_path
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh


def show(pictures, titles, *, rows=1, side=2.2):
    """Pictures in rows, a title above each."""
    figure, axes = plt.subplots(rows, len(pictures) // rows, dpi=90, squeeze=False, layout="compressed")
    figure.set_size_inches(side * len(pictures) / rows, rows * (side + 0.3))
    for axis, picture, title in zip(axes.flat, pictures, titles, strict=True):
        axis.imshow(picture)
        axis.set_title(title, fontsize=9)
        axis.axis("off")
    plt.show()


def clay(V, F, centre, extent, yaw=0.0, pitch=0.0, side=220):
    """Picture of a mesh as a sculptor's clay."""
    camera = ScaledOrthographicCamera.look(yaw, pitch, size=side, centre=centre, extent=extent)
    return render_mesh(Surface(V, F), camera, side, shading="clay")


# %% [markdown]
# ## A bar that bends by 60 degrees
#
# The bar is a tube along x, 20 long. A second version of it is bent to an arc of 60 degrees, and no part of its middle
# line is longer or shorter than before. Twice this deformation should be an arc of 120 degrees, of the same length.


# %%
def tube(length=20.0, rings=41, sides=12):
    """Vertices (n, 3) and triangles (m, 3) of a tube of radius 1 along x, with pointed ends."""
    turn = 2 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.zeros(sides), np.cos(turn), np.sin(turn)])
    body = np.concatenate([circle + [x, 0, 0] for x in np.linspace(0, length, rings)])
    i, j = np.meshgrid(np.arange(rings - 1), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    walls = np.stack([a, b, b + sides, a, b + sides, a + sides], -1).reshape(-1, 3)
    k, end = np.arange(sides), (rings - 1) * sides
    first = np.stack([np.full(sides, rings * sides), (k + 1) % sides, k], 1)
    last = np.stack([np.full(sides, rings * sides + 1), end + k, end + (k + 1) % sides], 1)
    return np.vstack([body, [-1, 0, 0], [length + 1, 0, 0]]), np.vstack([walls, first, last])


def bent(V, degrees, length=20.0):
    """The tube bent upwards to an arc as long as it was."""
    radius = length / np.radians(degrees)
    angle = V[:, 0] / radius
    return np.column_stack([(radius - V[:, 1]) * np.sin(angle), radius - (radius - V[:, 1]) * np.cos(angle), V[:, 2]])


V, F = tube()
arc = bent(V, 60)


def middle_line(X):
    """Length of the line through the centres of the 41 rings."""
    centres = X[:-2].reshape(41, 12, 3).mean(axis=1)
    return np.linalg.norm(np.diff(centres, axis=0), axis=1).sum()


twice = V + 2 * (arc - V)
print("middle line at rest, bent, and with displacements doubled:", *(f"{middle_line(X):.1f}" for X in (V, arc, twice)))
show(
    [clay(X, F, (8, 8, 0), 28) for X in (V, arc, twice, bent(V, 120))],
    ["at rest", "bent by 60°", "displacements × 2", "bent by 120°: wanted"],
)

# %% [markdown]
# *Figure: A bar at rest; bent by 60 degrees; with doubled displacements, where it has become much longer and thicker at
# its end; and bent by 120 degrees, as it should be.*
#
# A point of a turning bar travels on a circle. A displacement is a straight line. Go twice as far on the line, and you
# have left the circle: the bar grows.
#
# ## The gradient at a vertex
#
# What happens around vertex $i$? Its edges $e_{ij} = v_j - v_i$ to its neighbours become $e'_{ij}$. The *deformation
# gradient* is the 3 x 3 matrix that comes nearest to doing this to all of them (Eq. 1):
#
# $$ T_i = \arg\min_T \sum_j c_{ij}\, \| e'_{ij} - T e_{ij} \|^2 . $$
#
# This is least squares for nine numbers. Set the derivative to zero:
#
# $$ T_i \underbrace{\sum_j c_{ij}\, e_{ij} e_{ij}^T}_{C_i} = \underbrace{\sum_j c_{ij}\, e'_{ij} e_{ij}^T}_{M_i}
# \quad\Longrightarrow\quad T_i = M_i C_i^{-1} . $$
#
# The weights $c_{ij}$ are those of the cotangent Laplacian (lesson 6): its entries beside the diagonal are $-c_{ij}$.
# The few negative ones are left out here.


# %%
def gradients(V, F, P):
    """T (n, 3, 3) of the rings of a mesh V (n, 3) that was deformed to P (n, 3)."""
    L = cotangent_laplacian(V, F).tocoo()
    beside = (L.row != L.col) & (L.data < 0)
    i, j, c = L.row[beside], L.col[beside], -L.data[beside]
    old, new = V[j] - V[i], P[j] - P[i]
    C, M = np.zeros((len(V), 3, 3)), np.zeros((len(V), 3, 3))
    np.add.at(C, i, c[:, None, None] * old[:, :, None] * old[:, None, :])
    np.add.at(M, i, c[:, None, None] * new[:, :, None] * old[:, None, :])
    return M @ np.linalg.inv(C)


# %% [markdown]
# First check: a matrix $A$ applied to all vertices is found at each of them, by our lines and by the library's
# `deformation_gradients`.

# %%
A = np.array([[1.2, 0.3, 0.0], [-0.4, 0.9, 0.1], [0.0, 0.2, 1.1]])
affine_error = max(np.abs(gradients(V, F, V @ A.T) - A).max(), np.abs(deformation_gradients(V, F, V @ A.T) - A).max())
assert affine_error < 1e-9

T = gradients(V, F, arc)
library = deformation_gradients(V, F, arc)
gradient_gap = np.abs(T - library).max()
print(f"on the bent bar, lines and library agree to {gradient_gap:.3f}")
assert gradient_gap < 0.05

# %% [markdown]
# They agree to some thousandths and no better, on purpose. A ring on a smooth surface is nearly flat. Its edges say
# next to nothing about the direction across it, so $C_i$ is nearly singular there, and on a face its inverse would be
# noise. The library lets the neighbouring rings have a small say.
#
# ## A rotation and a stretch
#
# Every matrix with a positive determinant is a rotation after a stretch, $T = R\,S$, where $R$ is a rotation and $S$ is
# symmetric: the *polar decomposition*. It follows from the singular values: if $T = U \Sigma V^T$, then $R = U V^T$ and
# $S = V \Sigma V^T$. And a rotation is an axis and an angle. Written as one vector along the axis, as long as the angle
# is in radians, it is the *logarithm* of $R$ (Eq. 2); the exponential leads back.


# %%
def polar(T):
    """R and S (n, 3, 3) of matrices T (n, 3, 3)."""
    U, sigma, Vt = np.linalg.svd(T)
    return U @ Vt, Vt.transpose(0, 2, 1) @ (sigma[:, :, None] * Vt)


def log(R):
    """Rotation vectors (n, 3) of rotations (n, 3, 3) by less than half a turn."""
    angle = np.arccos(np.clip((np.trace(R, axis1=1, axis2=2) - 1) / 2, -1, 1))
    axis = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    return axis * (0.5 / np.maximum(np.sinc(angle / np.pi), 1e-12))[:, None]  # angle / (2 sin angle)


def exp(w):
    """Rotations (n, 3, 3) of rotation vectors (n, 3): Rodrigues' formula."""
    angle = np.linalg.norm(w, axis=1)[:, None, None]
    K = np.cross(w[:, None, :], np.eye(3)).transpose(0, 2, 1)  # K @ x is w × x
    half = np.sinc(angle / (2 * np.pi))
    return np.eye(3) + np.sinc(angle / np.pi) * K + 0.5 * half**2 * (K @ K)


R, S = polar(T)
w = log(R)
last = T.transpose(1, 2, 0)  # the library keeps matrices along the last axis: (3, 3, n)
R_lib, S_lib = polar_decomposition(last)
own = {
    "polar": np.abs(R_lib.transpose(2, 0, 1) - R).max(),
    "log": np.abs(rotation_log(R_lib).T - w).max(),
    "exp": np.abs(rotation_exp(w.T).transpose(2, 0, 1) - exp(w)).max(),
    "round_trip": np.abs(exp(w) - R).max(),
}
assert max(own.values()) < 1e-6

# %% [markdown]
# For the bar the answer is known: at the place $x$ it is turned by $60° \cdot x / 20$ about the z axis, and by nothing
# else. So the z component of the logarithm is a straight line. The plot shows this line, and the numbers found at all
# vertices.

# %%
figure, axis = plt.subplots(figsize=(5, 2.8), dpi=90)
axis.plot(V[:, 0], np.degrees(w[:, 2]), ".", markersize=3, label="log R, z component, all vertices")
axis.plot([0, 20], [0, 60], "k--", linewidth=1, label="60° · x / 20")
axis.set(xlabel="place x along the bar", ylabel="degrees")
axis.legend(fontsize=8)
plt.show()
angle_error = np.abs(np.degrees(w[:, 2]) - 3 * V[:, 0]).max()
print(f"farthest off the line: {angle_error:.2f} degrees")

# %% [markdown]
# *Figure: The angle of every vertex plotted over its place along the bar: a straight line from 0 to 60 degrees. Only
# the two tips, whose rings are all on one side, stand off it.*
#
# ## Doubling, and a mesh again
#
# Now doubling is clear: twice the angle, about the same axis; and twice the stretch beyond none, $I + 2(S - I)$. For
# several deformed shapes $l$ with weights $w_{R,l}$ and $w_{S,l}$ (Eq. 5):
#
# $$ T_i(w) = \exp\Big(\sum_l w_{R,l} \log R_{l,i}\Big) \Big(I + \sum_l w_{S,l}\,(S_{l,i} - I)\Big) . $$
#
# A mesh with these gradients does not exist in general, as in lesson 9, so that one is taken which comes nearest:
#
# $$ \min_{P} \sum_i \sum_j c_{ij}\, \| (p_j - p_i) - T_i (v_j - v_i) \|^2
# \quad\Longrightarrow\quad
# 2 \sum_j c_{ij}\,(p_i - p_j) = \sum_j c_{ij}\,(T_i + T_j)(v_i - v_j) , $$
#
# which is a linear system with the Laplacian, $2 L P = b$ (Eq. 8). (The code divides both sides by 2.) One vertex is
# held.


# %%
def integrate(V, F, T):
    """Vertices (n, 3) whose rings are deformed most nearly by T (n, 3, 3); the first stays."""
    L = cotangent_laplacian(V, F).tocsc()
    entries = L.tocoo()
    i, j, c = entries.row, entries.col, -entries.data
    b = np.zeros_like(V)
    beside = i != j
    i, j, c = i[beside], j[beside], c[beside]
    np.add.at(b, i, 0.5 * c[:, None] * ((T[i] + T[j]) @ (V[i] - V[j])[:, :, None])[:, :, 0])
    P = np.zeros_like(V)
    P[0] = V[0]
    P[1:] = splu(L[1:][:, 1:]).solve(b[1:] - L[1:][:, [0]] @ V[:1])
    return P


def doubled(amount, T=library):
    """Gradients (n, 3, 3) of `amount` times the deformation T."""
    R, S = polar(T)
    return exp(amount * log(R)) @ (np.eye(3) + amount * (S - np.eye(3)))


own_twice = integrate(V, F, doubled(2.0))
space = tg.DeformationSpace.from_meshes(V, F, [arc, V * [1, 2, 2]], align=False)
space_twice = space.vertices([2.0, 0.0])
lengths = {
    "displacements": middle_line(twice),
    "own lines": middle_line(own_twice),
    "library": middle_line(space_twice),
}
print("middle line of twice the deformation:", {name: round(float(length), 1) for name, length in lengths.items()})
both = space.vertices([1.5, 0.5])  # one and a half times the bend, and half of "twice as thick"
pictures = [clay(X, F, (8, 8, 0), 28) for X in (own_twice, space_twice, both)]
show(pictures, ["own lines, × 2", "library, × 2", "1.5 bend, 0.5 thick"], side=2.4)

# %% [markdown]
# *Figure: The bar bent by 120 degrees by our own lines and by the library's space, as long as at rest; and bent by one
# and a half times the arc while half of a thickening is added.*
#
# `tg.DeformationSpace` holds any number of shapes as logarithms and stretches. Weight 1 of one shape gives back that
# shape, exactly: what the rings do not tell of it is kept beside and added. Our lines do not have this part.
#
# ## From −1 to 3
#
# How does the length of the middle line change as we go on? The plot shows it for amounts from −1 (bent the other way)
# to 3: the space keeps the length, displacements do so only where they were measured, at 0 and 1.

# %%
amounts = np.linspace(-1, 3, 17)
straight = [middle_line(V + a * (arc - V)) for a in amounts]
turning = [middle_line(space.vertices([a, 0.0])) for a in amounts]
figure, axis = plt.subplots(figsize=(5, 2.8), dpi=90)
axis.plot(amounts, straight, label="displacements")
axis.plot(amounts, turning, label="deformation space")
axis.plot([0, 1], [20, 20], "ko", markersize=4, label="the two given shapes")
axis.set(xlabel="amount", ylabel="length of the middle line", ylim=(0, 40))
axis.legend(fontsize=8)
plt.show()

# %% [markdown]
# *Figure: Length of the bar's middle line over the amount of deformation: flat at 20 for the deformation space, a bowl
# that rises to 33 for displacements.*
#
# ## Faces
#
# `tg.face_space()` is such a space for the skin of the library's head: 75 faces and 23 expressions, 98 shapes. Take an
# expression with a rotation in it, the open jaw, and go on to one and a half times and twice of it. What a jaw must
# not do is swell: we measure the area of its skin.

# %%
faces = tg.face_space()
model, skin, deform = faces.model, faces.vertices, faces.space
mean = deform.reference
jaw_triangles = deform.faces[model.region("jaw")[skin][deform.faces].all(axis=1)]


def head(P, yaw=-35.0, side=230):
    """Picture of the skin of a head."""
    return clay(P, deform.faces, (0, -25, -15), 275, yaw, side=side)


def jaw_area(P):
    """Area of the skin of the lower jaw, mm²."""
    a, b, c = (P[jaw_triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


jaw = mean + model.expression[model.expression_index("jawOpen")][skin]
w_jaw = deform.fit(jaw, ridge=1e-4).w  # Eq. 9: the weights whose gradients come nearest; large ones cost a little
amounts = (1.0, 1.5, 2.0)
along = [mean + a * (jaw - mean) for a in amounts]
turned = [deform.vertices(a * w_jaw) for a in amounts]
growth = {how: [jaw_area(P) / jaw_area(mean) - 1 for P in row] for how, row in (("moved", along), ("turned", turned))}
print("skin of the jaw grows, by displacements:", *(f"{g:+.0%}" for g in growth["moved"]))
print("in the deformation space:               ", *(f"{g:+.0%}" for g in growth["turned"]))
titles = [f"{how} × {a:g}" for how in ("displacements", "space") for a in amounts]
show([head(P) for P in along + turned], titles, rows=2, side=2.4)

# %% [markdown]
# *Figure: The jaw opened once, one and a half times and twice. By displacements the chin becomes longer and longer; in
# the deformation space the jaw turns on and hardly grows, while the lips crumple at twice the expression.*
#
# The space is not magic. Lips are the hardest place of a face: at twice the expression they crumple, because what two
# lips may not do (go through each other) is nothing that gradients know.
#
# ## A caricature from landmarks
#
# Now a drawing. Its 68 landmarks ask for eyes and chins that no face of the model has. Three ways to get there:
#
# 1. *Linear, with a prior.* Modes are added up, and coefficients that are large cost something: the face stays a face,
#    and misses the drawing.
# 2. *Linear, without.* The same, at no cost: the landmarks are met, by whatever sum of modes.
# 3. *Deformation space.* The mesh may go where the landmarks are; what it costs is how far its gradients are from those
#    that some weights $w$ give, $E_{def}(P, w) = \sum_i \sum_j c_{ij} \| e'_{ij} - T_i(w)\, e_{ij} \|^2$ (Eq. 6). Mesh
#    and weights are found in turns: that is `tg.fit_caricature` (Eq. 14).
#
# Two numbers say how it went: by how much the landmarks are missed, in percent of the distance of the outer eye
# corners, and how many *folds* there are, pairs of neighbouring triangles whose normals are more than 120 degrees
# apart.


# %%
def folds(P, F):
    """How many pairs of neighbouring triangles have normals more than 120 degrees apart."""
    corners = P[F]
    n = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-12)
    edges = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
    order = np.lexsort(edges.T)
    edges, owner = edges[order], np.tile(np.arange(len(F)), 3)[order]
    same = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))  # the two triangles of an edge are neighbours here
    return int(((n[owner[same]] * n[owner[same + 1]]).sum(axis=1) < -0.5).sum())


def missed(fit, landmarks):
    """RMS distance of the landmarks, percent of the distance of the outer eye corners."""
    error = fit.project(fit.vertices[fit.landmark_vertices]) - landmarks
    return 100 * np.sqrt((error**2).sum(axis=1).mean()) / np.linalg.norm(landmarks[36] - landmarks[45])


modes = np.concatenate([model.identity, model.expression])
pictures, table = [], {}
for name in ("moustache_man", "blue_girl"):
    path = data_path(f"examples/portraits/{name}.png")
    img, landmarks = tg.read_image(path), tg.read_landmarks(path.with_suffix(".pts"))
    fits = [linear_fit(landmarks, model, model.mean, modes, prior) for prior in (3000.0, 0.0)]  # px² a coefficient
    fits.append(tg.fit_caricature(img, landmarks, space=faces))
    table[name] = [(missed(fit, landmarks), folds(fit.vertices[skin], deform.faces)) for fit in fits]
    print(f"{name:14s}", "   ".join(f"missed by {m:4.1f} %, {k:4d} folds" for m, k in table[name]))
    centre = landmarks.mean(axis=0).astype(int)
    half = int(1.1 * np.ptp(landmarks, axis=0).max() / 2)
    rows, columns = (np.clip(np.arange(centre[k] - half, centre[k] + half), 0, img.shape[1 - k] - 1) for k in (1, 0))
    pictures += [img[np.ix_(rows, columns)], *(head(fit.vertices[skin]) for fit in fits)]
show(pictures, ["drawing", "linear, with prior", "linear, without", "deformation space"] * 2, rows=2, side=2.2)

# %% [markdown]
# *Figure: Two drawings with three heads each in clay: with a prior both heads look like the mean face; without it the
# man's is torn to pieces, and the girl's is blown up until one scrap of it fills the picture; in the deformation space
# they have the man's broad face and the girl's large eyes.*
#
# Why does the second way fail, although it meets its landmarks? 136 numbers (68 points, two each) do not determine 145
# coefficients (81 of identity, 64 of expression), and among those that meet them most are no faces. The prior of the
# first way chooses a face, but pulls towards the mean. The third way asks for something local: pieces of surface that
# deform *like* pieces of faces do, and more of it where the drawing wants more.
#
# ## Exaggeration
#
# `tg.exaggerate(fit, amount)` pushes a fitted face away from the mean: amount 1 doubles what differs. In a row: the
# moustache man's fitted face less himself, as fitted, and twice as much himself.

# %%
path = data_path("examples/portraits/moustache_man.png")
fit = tg.fit_3dmm(tg.read_image(path), tg.read_landmarks(path.with_suffix(".pts")))
exaggerated = [tg.exaggerate(fit, amount, space=faces).vertices[skin] for amount in (-1.0, 1.0)]
show(
    [head(P) for P in (exaggerated[0], fit.vertices[skin], exaggerated[1])],
    ["amount −1", "amount 0", "amount 1"],
    side=2.4,
)


def from_mean(P):
    """RMS distance from the mean face, mm, but for place and turn."""
    P, Q = P - P.mean(axis=0), mean - mean.mean(axis=0)
    U, _, Vt = np.linalg.svd(P.T @ Q)
    return np.sqrt(((P @ U @ Vt - Q) ** 2).sum(axis=1).mean())


unlike = [from_mean(P) for P in (exaggerated[0], fit.vertices[skin], exaggerated[1])]
print("RMS distance from the mean face:", *(f"{d:.1f} mm" for d in unlike))

# %% [markdown]
# *Figure: Three clay heads of the moustache man: nearly the mean face, as fitted with a broad chin, and with chin, nose
# and brow exaggerated.*
#
# To be fair: how *people* differ is more stretch than rotation. For this man, doubled displacements would look much the
# same. It is where parts turn (jaws, lids, the bar) that the two ways part.
#
# ## Exercises
#
# 1. The other way: a bar that is bent by 300 degrees. What is *half* of it, by displacements and by angles?
# 2. Logarithms are added in Eq. 5. When is $\exp(a + b) = \exp(a)\exp(b)$ for rotations? Try two turns of 30 degrees
#    about the same axis, and about two that are perpendicular.
# 3. Let one number $a$ scale the angles alone, with the gradients $\exp(a \log R_i)$ in Eq. 6 and no stretch. Write the
#    derivative of this energy, and show with `tg.check_gradient` that it is right.
#
# ## Solutions
#
# **1.** Half the way on straight lines leads through the inside of the ring: the bar gets short and thin. Half the
# angle is an arc of 150 degrees. The logarithm of a rotation only tells angles of less than 180 degrees, so the ring
# itself cannot be given to a space. The arc of 150 degrees can; the ring is that shape at weight 2, and half of it at
# 1.

# %%
ring = bent(V, 300)
half_moved = V + 0.5 * (ring - V)
half_turned = tg.DeformationSpace.from_meshes(V, F, [bent(V, 150), V * 1.1], align=False).vertices([1.0, 0.0])
halves = [middle_line(P) for P in (half_moved, half_turned)]
print(f"middle line: {halves[0]:.1f} by displacements, {halves[1]:.1f} by angles")
show([clay(P, F, (6, 4, 0), 26) for P in (ring, half_moved, half_turned)], ["300°", "half: moved", "half: turned"])

# %% [markdown]
# *Figure: A bar bent nearly to a closed ring; half of it by displacements, which is short and thin; half of it by
# angles, an arc of full length.*
#
# **2.** When the axes are the same. About perpendicular axes the order matters, and the sum of the logarithms is
# neither order: it is off by about half the product of the angles. A space of deformations that adds them is still
# fine: it only has to be smooth, and right at its examples.

# %%
thirty = np.radians(30)
x, z = np.array([[thirty, 0, 0]]), np.array([[0, 0, thirty]])
same_axis = np.abs(exp(z + z) - exp(z) @ exp(z)).max()
other_axis = np.degrees(np.linalg.norm(log(exp(x + z).transpose(0, 2, 1) @ (exp(x) @ exp(z)))))
print(f"same axis: equal, {bool(same_axis < 1e-12)}; perpendicular axes: {other_axis:.1f} degrees apart")

# %% [markdown]
# **3.** With $K_i$ the matrix of the cross product by $\log R_i$, $\frac{d}{da} \exp(a K_i) = K_i \exp(a K_i)$. So
#
# $$ E'(a) = -2 \sum_i \sum_j c_{ij}\, \big( e'_{ij} - \exp(a K_i)\, e_{ij} \big) \cdot K_i \exp(a K_i)\, e_{ij} . $$
#
# `tg.check_gradient` takes steps of several lengths: what the linear approximation leaves must fall with the square of
# the step, a slope of 2.

# %%
entries = cotangent_laplacian(V, F).tocoo()
beside = (entries.row != entries.col) & (entries.data < 0)
i, j, c = entries.row[beside], entries.col[beside], -entries.data[beside]
old, new = V[j] - V[i], arc[j] - arc[i]


def energy(x):
    """E and its derivative (1,) at one number a, given as x (1,)."""
    turned = np.einsum("kab,kb->ka", exp(x[0] * w)[i], old)
    left = new - turned
    slope = np.cross(w[i], turned)
    return float((c * (left**2).sum(axis=1)).sum()), np.array([-2 * (c * (left * slope).sum(axis=1)).sum()])


check = tg.check_gradient(energy, np.array([0.4]))
grid = np.linspace(0, 2, 201)
best = grid[np.argmin([energy(np.array([a]))[0] for a in grid])]
print(f"slopes {check.slopes.min():.2f} to {check.slopes.max():.2f}; the least energy is at a = {best:.2f}")

# %%
numbers: dict[str, float] = {
    "affine_error": affine_error,
    "gradient_gap": gradient_gap,
    **{f"own_{name}": value for name, value in own.items()},
    "angle_error_degrees": angle_error,
    **{f"length_{name.replace(' ', '_')}": value for name, value in lengths.items()},
    "jaw_growth_moved": growth["moved"][-1],
    "jaw_growth_turned": growth["turned"][-1],
    **{
        f"{name}_{how}_{what}": value
        for name, row in table.items()
        for how, pair in zip(("prior", "free", "space"), row, strict=True)
        for what, value in zip(("missed", "folds"), pair, strict=True)
    },
    **{f"unlike_{k}": value for k, value in enumerate(unlike)},
    "half_moved": halves[0],
    "half_turned": halves[1],
    "same_axis": same_axis,
    "other_axis_degrees": other_axis,
    "taylor_slope": check.slopes.min(),
    "best_weight": best,
}
