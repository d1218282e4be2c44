# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 6 · Laplacians
#
# **How do you move a few points of a surface so that the rest follows, and still looks like the same surface?**
#
# A fitted face misses its landmarks by a few pixels. We know where 68 of its points belong; the mesh has 19,057. The
# answer of this lesson is one sparse matrix, the *Laplacian*. It says of each vertex how it lies among its neighbours.
# Keep that, move the few, solve for the rest.
#
# You need numpy and a little linear algebra: what a matrix product is, and that least squares leads to a linear system.
# A *mesh* here is two arrays: vertices `V` (n, 3), and triangles `F` (m, 3), which holds three indices of vertices a
# row, counter-clockwise as seen from outside.

# %%
import matplotlib.pyplot as plt
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import eigsh, splu
from scipy.spatial import ConvexHull, Delaunay

import toongeo as tg
from toongeo.geometry import cotangent_laplacian, uniform_laplacian
from toongeo.model import data_path
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

# %% [markdown]
# ## 1 · A rope first
#
# Take 61 points in the plane, each joined to the next. The simplest question about a point: how far is it from the mean
# of its neighbours?
#
# $$ \delta_i \;=\; v_i - \frac{1}{|N(i)|}\sum_{j \in N(i)} v_j \tag{1} $$
#
# $N(i)$ are the neighbours of point $i$, and $|N(i)|$ is how many they are. $\delta_i$ is called the *Laplacian
# coordinate* of the point. On a straight, evenly spaced stretch it is zero; at a bump it points out of the bump. Moving
# the whole rope changes no $\delta_i$, for the point and the mean of its neighbours move alike. So the Laplacian
# coordinates know the *detail* and not the *place*.
#
# All of (1) at once is a matrix product, $\delta = L v$. With the adjacency matrix $A$ ($A_{ij} = 1$ where an edge
# joins $i$ and $j$, else 0) and the diagonal matrix $D$ of the numbers of neighbours,
#
# $$ L = I - D^{-1} A . \tag{2} $$

# %%


def umbrella(edges: np.ndarray, n: int) -> sp.csr_matrix:
    """Equation (2) for undirected edges (e, 2), each given once."""
    i, j = np.r_[edges, edges[:, ::-1]].T
    A = sp.csr_matrix((np.ones(len(i)), (i, j)), shape=(n, n))
    return sp.csr_matrix(sp.eye_array(n) - sp.diags_array(1 / np.bincount(i)) @ A)


t = np.linspace(0, 1, 61)
rope = np.stack([10 * t, 0.35 * np.sin(2 * np.pi * 9 * t)], axis=1)
L_rope = umbrella(np.stack([np.arange(60), np.arange(1, 61)], axis=1), 61)
delta = L_rope @ rope
assert np.allclose(L_rope @ (rope + [3, -7]), delta)  # the place does not matter

# %% [markdown]
# Now hold the left end, lift the right end, and ask for the rope whose Laplacian coordinates are as before, as nearly
# as possible. With $S$ the matrix that picks the *anchors* (the points that we move or hold) out of all points, and $p$
# the places where they should go:
#
# $$ E(v') = \lVert L v' - \delta \rVert^2 + \lambda\, \lVert S v' - p \rVert^2 \;\to\; \min \tag{3} $$
#
# $\lambda$ says how firmly anchors are held. $E$ is quadratic in the unknown $v'$. Its gradient is
# $2 L^T (L v' - \delta) + 2 \lambda S^T (S v' - p)$. Where that is zero,
#
# $$ (L^T L + \lambda S^T S)\, v' = L^T \delta + \lambda S^T p . \tag{4} $$
#
# That is one sparse linear system, solved for x and y separately with the same matrix. It is all that the function
# `laplacian_align` of the library does at heart (Pan et al. 2024, Eq. 9 and 10).

# %%


def keep_delta(L, delta, anchors, targets, weight=1000.0):
    """The minimiser of (3), by (4): points (n, 2) or (n, 3)."""
    S = sp.csr_matrix((np.ones(len(anchors)), (np.arange(len(anchors)), anchors)), shape=(len(anchors), L.shape[0]))
    K = L.T @ L + weight * S.T @ S
    return splu(K.tocsc()).solve(L.T @ delta + weight * S.T @ targets)


anchors = np.array([0, 1, 59, 60])
targets = np.r_[rope[:2], rope[-2:] + [-1.5, 4]]
lifted = keep_delta(L_rope, delta, anchors, targets)

fig, (left, right) = plt.subplots(1, 2, figsize=(10, 3.2), sharey=True)
left.plot(*rope.T, ".-", c="0.3", ms=4, lw=1)
left.quiver(*rope[1:-1].T, *delta[1:-1].T, color="tab:red", angles="xy", scale_units="xy", scale=0.25, width=0.004)
left.set_title("rest, and δ (4 times as long)", fontsize=9)
right.plot(*rope.T, c="0.8", lw=1)
right.plot(*lifted.T, ".-", c="0.3", ms=4, lw=1)
right.plot(*targets.T, "o", c="tab:blue", ms=6)
right.set_title("anchors (blue) moved: the waves stay", fontsize=9)
for axis in (left, right):
    axis.set(aspect="equal", ylim=(-1.2, 4.8))
plt.tight_layout()
plt.show()
print(f"anchors are missed by at most {np.abs(lifted[anchors] - targets).max():.0e}; the rope is 10 long")
change = np.abs(L_rope @ lifted - delta)[2:-2].max() / np.abs(delta[2:-2]).max()
print(f"Laplacian coordinates inside have changed by at most {change:.0%} of the largest")

# %% [markdown]
# *Figure: On the left a wavy rope with arrows that point out of each wave's crest; on the right the same rope with its
# right end lifted, which rises in one smooth sweep and keeps its waves.*
#
# Look closely at the right picture: the waves still stand *upright*, although the rope now rises to the right. The
# $\delta_i$ kept their direction in the world. Remember that; it is the one flaw of (3), and section 5 mends it.

# %% [markdown]
# ## 2 · On a mesh
#
# Nothing changes but the neighbours: the edges of a mesh are the sides of its triangles. Here is a bar: a tube of
# square cross-section with closed ends.


# %%
def tube(rings: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rings (r, s, 3) of vertices, joined by triangles and closed by a vertex at each end."""
    r, s = rings.shape[:2]
    V = np.vstack([rings.reshape(-1, 3), rings[0].mean(0), rings[-1].mean(0)])
    i, j = np.meshgrid(np.arange(r - 1), np.arange(s), indexing="ij")
    a, b = i * s + j, i * s + (j + 1) % s
    walls = np.stack([a, b, b + s, a, b + s, a + s], -1).reshape(-1, 3)
    k, last = np.arange(s), (r - 1) * s
    first_cap = np.stack([np.full(s, r * s), (k + 1) % s, k], 1)
    last_cap = np.stack([np.full(s, r * s + 1), last + k, last + (k + 1) % s], 1)
    return V, np.vstack([walls, first_cap, last_cap])


def edges_of(F: np.ndarray) -> np.ndarray:
    """Each edge (e, 2) of the triangles once."""
    return np.unique(np.sort(np.r_[F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]], axis=1), axis=0)


quarters = (-1, -0.5, 0, 0.5)
square = [(s, -1) for s in quarters] + [(1, s) for s in quarters]
square += [(-s, 1) for s in quarters] + [(-1, -s) for s in quarters]
along = np.linspace(0, 20, 41)
bar, F_bar = tube(np.array([[(x, y, z) for y, z in square] for x in along]))
L_bar = umbrella(edges_of(F_bar), len(bar))
assert abs(L_bar - uniform_laplacian(F_bar, len(bar))).max() < 1e-12
print(f"bar: {len(bar)} vertices, {len(F_bar)} triangles; L has {L_bar.nnz} numbers that are not zero")

# %% [markdown]
# `toongeo.geometry.uniform_laplacian` is (2): *uniform* because each neighbour counts alike. It looks at `F` alone,
# never at `V`. Two consequences, one good and one bad:
#
# - Good: it cannot fail, whatever the triangles look like, and one matrix serves all faces with the same triangles.
# - Bad: it takes uneven spacing for shape. Where the neighbours lie closer on one side, their mean lies there too, and
#   $\delta_i$ points *along* the surface although nothing is bent.
#
# ## 3 · Weights that know the geometry
#
# Which weights see bending alone? Go back to what we want to measure. Let $x$ be a function on the surface, one number
# $x_i$ a vertex, and linear in between. How restless it is says its *Dirichlet energy*, the integral of its squared
# slope:
#
# $$ E(x) = \tfrac12 \int \lVert \nabla x \rVert^2 . \tag{5} $$
#
# (A constant costs nothing, a gentle slope little, ripples much. If $x$ is a coordinate of the surface itself, the
# energy is that of a soap film. The film pulls against the gradient of its energy. So the gradient is zero on a flat
# piece, whatever its triangles look like, and points out of a bump, as $\delta_i$ does in (1). That is what we want of
# a Laplacian coordinate.)
#
# Linear in between means $x = \sum_i x_i \varphi_i$, where the *hat function* $\varphi_i$ of vertex $i$ is 1 there, 0
# at all other vertices, and linear on each triangle. Put into (5):
# $E = \tfrac12 \sum_{ij} x_i x_j \int \nabla\varphi_i \cdot \nabla\varphi_j$. So all we need are these integrals.
#
# Inside one triangle the slope is constant, so the integral is easy. Take the triangle with corners $i, j, o$. The hat
# function $\varphi_i$ rises from the opposite edge, over the triangle's height $h_i$, so that its gradient has length
# $1/h_i$ and is perpendicular to that edge. The angle between the gradients of $i$ and $j$ is $180°$ minus the angle
# $\theta_o$ at the third corner. With the area $T$, this gives
#
# $$ \int \nabla\varphi_i \cdot \nabla\varphi_j =
#    -T\, \frac{\cos\theta_o}{h_i h_j} = -\tfrac12 \cot\theta_o , $$
#
# where the last step uses the lengths of the sides ($\ell_{jo}$: from $j$ to $o$): $h_i = 2T / \ell_{jo}$,
# $h_j = 2T / \ell_{io}$ and $2T = \ell_{io}\,\ell_{jo}\sin\theta_o$. An edge has a triangle on either side, with angles
# $\alpha_{ij}$ and $\beta_{ij}$ that face it. (On a border there is only one; the other counts as 0.) The hats sum to 1
# everywhere, so each row of the matrix $C$ of all these integrals sums to 0. With $C_{ij} = -w_{ij}$ beside the
# diagonal, that settles the diagonal too:
#
# $$ w_{ij} = \tfrac12 (\cot\alpha_{ij} + \cot\beta_{ij}), \qquad
#    (C x)_i = \sum_j w_{ij} (x_i - x_j), \qquad  E(x) = \tfrac12\, x^T C x . \tag{6} $$
#
# $C$ is the *cotangent Laplacian* (Pinkall and Polthier 1993). In this sign it is symmetric and positive semi-definite.
# Many books have the other sign; always look.

# %%
i, j, o = np.array([[0.0, 0.0], [2.4, 0.0], [0.9, 1.5]])  # a triangle, to look at
fig, axis = plt.subplots(figsize=(4.6, 2.9))
axis.plot(*np.array([i, j, o, i]).T, c="0.2")
for place, name, shift in ((i, "i", (-10, -10)), (j, "j", (5, -10)), (o, "o", (-3, 5)), (o, "\\theta_o", (-4, -26))):
    axis.annotate(f"${name}$", place, xytext=shift, textcoords="offset points")
for corner, other, name, colour, shift in ((j, i, "j", "tab:blue", (4, 2)), (i, j, "i", "tab:red", (-26, 2))):
    foot = o + (other - o) * ((corner - o) @ (other - o)) / (
        (other - o) @ (other - o)
    )  # of the height, on the far side
    height = corner - foot
    gradient = height / (height @ height)  # as long as 1 / h
    axis.plot(*np.array([corner, foot]).T, ":", c=colour)
    axis.annotate(f"$h_{name}$", foot, xytext=(-14 if name == "j" else 5, 2), textcoords="offset points", color=colour)
    axis.quiver(*(i + j + o) / 3, *gradient, color=colour, angles="xy", scale_units="xy", scale=1.2, width=0.008)
    tip = (i + j + o) / 3 + gradient / 1.2
    axis.annotate(rf"$\nabla\varphi_{name}$", tip, xytext=shift, textcoords="offset points", color=colour)
axis.set_aspect("equal")
axis.axis("off")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: A triangle with corners i, j and o, the angle at o, two heights as dotted lines, and arrows for the
# gradients of the hat functions of i and j, which point at these corners at right angles to the opposite sides.*


# %%
def cotangent(V: np.ndarray, F: np.ndarray) -> sp.csr_matrix:
    """Equation (6), corner by corner: each angle belongs to the edge that it faces."""
    i_all, j_all, w_all = [], [], []
    for corner in range(3):
        o, i, j = F[:, corner], F[:, (corner + 1) % 3], F[:, (corner + 2) % 3]
        a, b = V[i] - V[o], V[j] - V[o]
        cot = (a * b).sum(axis=1) / np.linalg.norm(np.cross(a, b), axis=1)  # cos / sin
        i_all, j_all, w_all = [*i_all, i, j], [*j_all, j, i], [*w_all, cot / 2, cot / 2]
    i, j, w = map(np.concatenate, (i_all, j_all, w_all))
    W = sp.csr_matrix((w, (i, j)), shape=(len(V), len(V)))
    return sp.csr_matrix(sp.diags_array(np.bincount(i, w)) - W)


C_bar = cotangent(bar, F_bar)
assert abs(C_bar - cotangent_laplacian(bar, F_bar)).max() < 1e-9

# %% [markdown]
# The test of the claim: scatter points in a *flat* square, join them by triangles, and look at the Laplacian
# coordinates inside. Nothing is bent, so they should be zero.

# %%
rng = np.random.default_rng(3)
flat = np.c_[rng.uniform(0, 1, (160, 2)) ** [1.6, 1.0], np.zeros(160)]
side = np.linspace(0, 1, 9)[1:]
for x, y in ((side, 0 * side), (0 * side + 1, side), (1 - side, 0 * side + 1), (0 * side, 1 - side)):
    flat = np.r_[flat, np.c_[x, y, 0 * side]]
F_flat = Delaunay(flat[:, :2]).simplices
inside = np.arange(160)  # the border has no full ring
umbrella_delta = umbrella(edges_of(F_flat), len(flat)) @ flat
C_flat = cotangent(flat, F_flat)
cotangent_delta = (C_flat @ flat) / C_flat.diagonal()[:, None]  # divided as (1) is: a mean with weights

fig, axes = plt.subplots(1, 2, figsize=(8.4, 4.1))
for axis, arrows, title in zip(axes, (umbrella_delta, cotangent_delta), ("uniform", "cotangent"), strict=True):
    axis.triplot(*flat[:, :2].T, F_flat, c="0.8", lw=0.6)
    axis.quiver(
        *flat[inside, :2].T, *arrows[inside, :2].T, color="tab:red", angles="xy", scale_units="xy", scale=1, width=0.006
    )
    axis.set_title(f"{title}: largest |δ| inside {np.linalg.norm(arrows[inside], axis=1).max():.1e}", fontsize=9)
    axis.set_aspect("equal")
    axis.axis("off")
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: Two copies of an uneven flat triangulation; with uniform weights red arrows lie in the plane at most points,
# with cotangent weights there are none.*
#
# The cotangent matrix is blind to spacing. It pays for that: where both angles are large,
# $\alpha_{ij} + \beta_{ij} > 180°$, the weight is negative, and a very thin triangle has a huge one. The library clamps
# the weights where it deforms meshes with them.
#
# ## 4 · What the eigenvectors know
#
# A string has tones, a drum has tones, and so does a surface. Its tones are the eigenvectors of the Laplacian, with
# areas so that big triangles count more. $M$ is the diagonal matrix of a third of the triangles' area around each
# vertex:
#
# $$ C u = \mu\, M u . \tag{7} $$
#
# (Why eigenvectors? Look for the function that is least restless, $x^T C x$ as small as can be, among those of a fixed
# size $x^T M x = 1$: where that is so, the two gradients are parallel, and that is (7), with $\mu = x^T C x$, which is
# twice the energy.)
#
# Low $\mu$: $u$ changes slowly over the surface. High $\mu$: it ripples. On the unit sphere the answer is known
# exactly: $\mu = l(l+1)$ for $l = 0, 1, 2, \dots$, each $2l + 1$ times: 0, 2, 2, 2, 6 (five times), 12 (seven times) …
# So here is a sphere whose points crowd at the north pole, and a fair test for both matrices. (For the uniform one,
# areas are numbers of neighbours, and since it knows no lengths at all we scale it so that it starts right.)

# %%
k = np.arange(2500) + 0.5
z, angle = 1 - 2 * k / 2500, np.pi * (1 + 5**0.5) * k
ring = np.sqrt(1 - z**2)
even = np.stack([ring * np.cos(angle), ring * np.sin(angle), z], axis=1)
plane = even[:, :2] / (1 + even[:, 2:]) * 0.5  # from the south pole onto the plane, squeezed ...
squared = (plane**2).sum(axis=1, keepdims=True)
ball = np.c_[2 * plane, 1 - squared] / (1 + squared)  # ... and back: triangles keep their angles, not their size
F_ball = ConvexHull(ball).simplices.astype(int)
inward = np.linalg.det(ball[F_ball]) < 0
F_ball[inward] = F_ball[inward][:, ::-1]


def vertex_areas(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """The diagonal (n,) of M: a third of each triangle to each of its corners."""
    twice = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1)
    return np.bincount(F.ravel(), np.repeat(twice / 6, 3), len(V))


def tones(C: sp.csr_matrix, areas: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The lowest eigenvalues (count,) of (7) and their vectors (n, count), which are orthonormal: u^T M u = 1."""
    start = np.random.default_rng(0).standard_normal(len(areas))
    shift = -1e-6 * C.diagonal().mean() / areas.mean()  # a little below 0, where C - shift M can be inverted
    mu, U = eigsh(C, k=count, M=sp.diags_array(areas).tocsc(), sigma=shift, v0=start)
    order = np.argsort(mu)
    return mu[order], U[:, order]


mu_cotangent, _ = tones(cotangent(ball, F_ball), vertex_areas(ball, F_ball), 36)
valence = np.bincount(edges_of(F_ball).ravel(), minlength=len(ball)).astype(float)
mu_uniform, _ = tones(sp.csr_matrix(sp.diags_array(valence) @ umbrella(edges_of(F_ball), len(ball))), valence, 36)
mu_uniform *= 2 / mu_uniform[1:4].mean()
exact = np.concatenate([[degree * (degree + 1)] * (2 * degree + 1) for degree in range(6)])

fig, axis = plt.subplots(figsize=(7, 3.2))
axis.step(np.arange(36), exact, where="mid", c="0.6", lw=3, label="the sphere: l(l+1), 2l+1 times")
axis.plot(mu_cotangent, ".", c="tab:blue", label="cotangent")
axis.plot(mu_uniform, "x", c="tab:red", ms=5, label="uniform")
axis.set(xlabel="number of the eigenvalue", ylabel="µ")
axis.legend(fontsize=8)
plt.tight_layout()
plt.show()
cotangent_spectrum_error = float(np.abs(mu_cotangent[1:] / exact[1:] - 1).max())
uniform_spectrum_error = float(np.abs(mu_uniform[1:] / exact[1:] - 1).max())
print(f"largest error of the first 36: cotangent {cotangent_spectrum_error:.1%}, uniform {uniform_spectrum_error:.0%}")

# %% [markdown]
# *Figure: Eigenvalues of an unevenly sampled sphere; those of the cotangent Laplacian lie on the steps 0, 2, 6, 12, 20,
# 30 of the exact answer, those of the uniform one lie on the first steps, to which they were scaled, and spread about
# the later ones, more and more.*
#
# That is the difference: the cotangent Laplacian hears the *sphere*, the uniform one also hears the *mesh*.
#
# On a face the tones are a ladder from coarse to fine. There are as many tones as vertices, and they are orthonormal
# ($u^T M u$ is 1 for a tone, and $u^T M v$ is 0 for two different ones). So any function on the surface is a sum of
# them, and so are the coordinates $x, y, z$ of the surface itself. Leave out the high ones and the face is smoothed:
# $V_k = U_k U_k^T M V$, where $U_k$ holds the lowest $k$ tones.

# %%
model = tg.default_model()


def part(mask: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the vertices of a mask, and the triangles within it, which count in them."""
    kept = np.flatnonzero(mask)
    new = np.full(len(mask), -1)
    new[kept] = np.arange(len(kept))
    return kept, new[F[mask[F].all(axis=1)]]


kept, F_face = part(model.region("face"), model.faces)
face = np.asarray(model.mean[kept], float)
face_areas = vertex_areas(face, F_face)
mu_face, U_face = tones(cotangent(face, F_face), face_areas, 120)
spectrum = U_face.T @ (face_areas[:, None] * face)  # (120, 3): how much of each tone is in x, y, z


def picture(V, F, extent, centre=(0.0, 0.0, 0.0), yaw=0.0, pitch=0.0, size=210, colours=None):
    """A mesh as clay, or with colours (n, 3)."""
    camera = ScaledOrthographicCamera.look(yaw, pitch, size=size, centre=centre, extent=extent)
    return render_mesh(Surface(V, F, colours=colours), camera, size, shading="clay" if colours is None else "lit")


def strip(pictures, titles, width=2.1):
    """Pictures side by side."""
    _, axes = plt.subplots(1, len(pictures), figsize=(width * len(pictures), width * 1.15))
    for axis, shown, title in zip(axes, pictures, titles, strict=True):
        axis.imshow(shown)
        axis.set_title(title, fontsize=9)
        axis.axis("off")
    plt.tight_layout()
    plt.show()


def tinted(values: np.ndarray) -> np.ndarray:
    """Blue where negative, red where positive."""
    return plt.cm.coolwarm(0.5 + 0.5 * values / np.abs(values).max())[:, :3]


view = {"extent": 215, "centre": (0, -15, 0), "yaw": 15}
shown = [picture(face, F_face, colours=tinted(U_face[:, k]), **view) for k in (1, 4, 12, 40)]
strip(shown, [f"tone {k}" for k in (1, 4, 12, 40)])

# %% [markdown]
# *Figure: Four eigenvectors on the face in blue and red: two or three large patches in the first, ever smaller ones in
# the later ones.*

# %%
sums = {k: U_face[:, :k] @ spectrum[:k] for k in (4, 20, 120)}
strip([*(picture(X, F_face, **view) for X in sums.values()), picture(face, F_face, **view)], [*sums, "all 7,131"])
low_pass_error = {k: float(np.sqrt(((X - face) ** 2).sum(axis=1).mean())) for k, X in sums.items()}
print({k: f"{error:.1f} mm" for k, error in low_pass_error.items()})

# %% [markdown]
# *Figure: The face as the sum of its lowest 4, 20 and 120 tones: a flat oval with holes, a mask with a hint of a nose,
# and a face that lacks only creases; beside them the whole face.*
#
# ## 5 · Bending a bar
#
# Back to moving points. Hold one end of the bar; turn the other by a right angle and carry it to where it would be if
# the bar were bent to a quarter of a circle.

# %%
held, grip = np.flatnonzero(bar[:, 0] < 1.1), np.flatnonzero(bar[:, 0] > 18.9)
radius = 20 / (np.pi / 2)
quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
turned = (bar[grip] - [20, 0, 0]) @ quarter.T + [radius, radius, 0]
ends, goals = np.r_[held, grip], np.r_[bar[held], turned]

sheared = keep_delta(L_bar, L_bar @ bar, ends, goals)
assert np.allclose(sheared, tg.laplacian_align(bar, F_bar, ends, goals, weight=1000.0), atol=1e-6)

# %% [markdown]
# Our dozen lines and the library agree to a millionth. Now the flaw: $\delta_i$ keeps its direction in the world, but
# the surface in the bend has turned. The remedy is to turn $\delta_i$ with it:
#
# $$ E(v') = \sum_i \lVert (L v')_i - R_i\, \delta_i \rVert^2 + \lambda \lVert S v' - p \rVert^2 . \tag{8} $$
#
# $R_i$ says how the surroundings of vertex $i$ have turned. It depends on the result, so guess and repeat: solve, look
# how each ring of neighbours has turned, turn the $\delta_i$, solve again. (Each solution minimises (8) for its $R_i$;
# but the next $R_i$ minimise something else, see (9), so nothing guarantees that the rounds settle. In practice five
# do.)
#
# How does one *look* how a ring has turned? Its edges were $e_{ij} = v_i - v_j$ and have become $e'_{ij}$. We want the
# rotation with the least $\sum_j \lVert e'_{ij} - R_i e_{ij} \rVert^2$. Multiply out: the lengths do not depend on
# $R_i$, and what is left to maximise is $\sum_j e_{ij}'^T R_i e_{ij} = \operatorname{tr}(R_i^T S_i)$ with the 3 × 3
# matrix
#
# $$ S_i = \sum_j e'_{ij}\, e_{ij}^T = U \Sigma V^T, \quad R_i = U\, \mathrm{diag}(1, 1, \det(U V^T))\, V^T . \tag{9} $$
#
# The singular value decomposition gives the answer (Kabsch 1976; in lesson 2 it is Procrustes). ($S_i$, $U$ and $V$ are
# letters of this decomposition; they have nothing to do with $S$ in (3), the tones, or the vertices.) For
# $\operatorname{tr}(R^T U \Sigma V^T) = \operatorname{tr}(Z \Sigma)$ with $Z = V^T R^T U$, whose columns have length 1,
# so that no entry of it exceeds 1; the sum is greatest when the diagonal is all ones, $Z = I$, which is $R = U V^T$.
# The determinant keeps it a rotation: without it, a mirror image may fit better.


# %%
def ring_rotations(before: np.ndarray, after: np.ndarray, edges: np.ndarray, weights=1.0) -> np.ndarray:
    """Equation (9) for all vertices: rotations (n, 3, 3)."""
    i, j = np.r_[edges, edges[:, ::-1]].T
    outer = (after[i] - after[j])[:, :, None] * (before[i] - before[j])[:, None, :]
    S = np.zeros((len(before), 3, 3))
    np.add.at(S, i, outer * np.broadcast_to(np.asarray(weights), len(i))[:, None, None])
    U, _, Vt = np.linalg.svd(S)
    U[:, :, 2] *= np.linalg.det(U @ Vt)[:, None]
    return U @ Vt


bent, edges_bar = sheared, edges_of(F_bar)
for _ in range(5):
    R = ring_rotations(bar, bent, edges_bar)
    bent = keep_delta(L_bar, np.einsum("nij,nj->ni", R, L_bar @ bar), ends, goals)
assert np.allclose(bent, tg.laplacian_align(bar, F_bar, ends, goals, weight=1000.0, rotations=5), atol=1e-6)


def strain(moved: np.ndarray) -> float:
    """The greatest relative change of the length of an edge of the bar."""
    i, j = edges_bar.T
    lengths = [np.linalg.norm(X[i] - X[j], axis=1) for X in (bar, moved)]
    return float(np.abs(lengths[1] / lengths[0] - 1).max())


# %% [markdown]
# ### ARAP, side by side
#
# There is a better known way to the same end: *as rigid as possible* (Sorkine and Alexa 2007). It compares edges, not
# Laplacian coordinates:
#
# $$ E(v', R) = \sum_i \sum_{j \in N(i)} w_{ij} \lVert (v'_i - v'_j) - R_i (v_i - v_j) \rVert^2 \tag{10} $$
#
# with the cotangent weights of (6), and anchors exactly met. For given $v'$ the best rotations are again (9), with the
# weights. For given rotations the gradient by $v'_i$ is zero where
#
# $$ \sum_j w_{ij} (v'_i - v'_j) = \sum_j \frac{w_{ij}}{2} (R_i + R_j)(v_i - v_j),
#    \qquad\text{in short}\qquad C v' = b . \tag{11} $$
#
# Both steps lower the same energy, so it can only fall. Anchors are met exactly by taking them out of the system: with
# the free vertices $f$ and the anchors $a$, $C_{ff} v'_f = b_f - C_{fa} p$.


# %%
def arap(V, F, anchors, targets, start, rounds=60):
    """Alternate (9) and (11); returns vertices and the energy (10) after each round."""
    C, edges = cotangent(V, F), edges_of(F)
    i, j = np.r_[edges, edges[:, ::-1]].T
    w = -np.asarray(C[i, j]).ravel()
    free = np.setdiff1d(np.arange(len(V)), anchors)
    solver = splu(C[free][:, free].tocsc())
    X, energies = start.copy(), []
    X[anchors] = targets
    for _ in range(rounds):
        R = ring_rotations(V, X, edges, w)
        rest = np.einsum("eij,ej->ei", R[i] + R[j], V[i] - V[j]) * (w / 2)[:, None]
        b = np.stack([np.bincount(i, rest[:, c], len(V)) for c in range(3)], axis=1)
        X[free] = solver.solve(b[free] - C[free][:, anchors] @ targets)
        gap = (X[i] - X[j]) - np.einsum("eij,ej->ei", R[i], V[i] - V[j])
        energies.append(float(w @ (gap**2).sum(axis=1)))
    return X, np.array(energies)


stiff, energies = arap(bar, F_bar, ends, goals, sheared)
assert (np.diff(energies) <= 1e-9 * energies[0]).all()  # it can only fall

fig, axes = plt.subplots(1, 4, figsize=(10, 2.8))
titles = ("rest", "δ as it was (3)", "δ turned along (8)", "ARAP (10)")
for axis, X, title in zip(axes, (bar, sheared, bent, stiff), titles, strict=True):
    axis.imshow(picture(X, F_bar, 25, centre=(8.5, 5.5, 0), pitch=12, yaw=-10, size=240))
    axis.set_title(f"{title}\nstrain {strain(X):.2f}", fontsize=9)
    axis.axis("off")
plt.tight_layout()
plt.show()
print(f"a bend of this radius needs a strain of {1 / radius:.2f}: the outer side is longer than the middle")

# %% [markdown]
# *Figure: A straight bar and three bends of it by a right angle: with fixed Laplacian coordinates the bar is thin and
# slanted in the bend, with turned ones and with ARAP it keeps its thickness.*
#
# Both remedies bend the bar. They differ in what they do around *single points*. Pull the middle of a square sheet
# whose border is held, and look at the cross-section:

# %%
g = np.linspace(-1, 1, 41)
grid = np.array([(x, y, 0.0) for y in g for x in g])
a = (np.arange(40)[:, None] * 41 + np.arange(40)).ravel()  # the lower left corner of each small square
F_grid = np.r_[np.stack([a, a + 1, a + 42], axis=1), np.stack([a, a + 42, a + 41], axis=1)]
border = np.flatnonzero(np.abs(grid[:, :2]).max(axis=1) > 0.999)
middle = 20 * 41 + 20
pins, places = np.r_[border, middle], np.r_[grid[border], [[0, 0, 0.5]]]
C_grid = cotangent(grid, F_grid)
free = np.setdiff1d(np.arange(len(grid)), pins)
sheet = grid.copy()
sheet[pins] = places
sheet[free] = splu(C_grid[free][:, free].tocsc()).solve(-(C_grid[free][:, pins] @ places))
hill = tg.laplacian_align(grid, F_grid, pins, places, weight=np.inf)  # an infinite weight: anchors are met exactly
tent, _ = arap(grid, F_grid, pins, places, hill)
pulled = {"membrane, C v' = 0": sheet, "Laplacian coordinates (3)": hill, "ARAP (10)": tent}

fig, axis = plt.subplots(figsize=(7, 2.8))
row = slice(20 * 41, 21 * 41)
for (title, X), style in zip(pulled.items(), ("--", "-", ":"), strict=True):
    axis.plot(X[row, 0], X[row, 2], style, label=title, lw=2)
axis.legend(fontsize=8)
axis.set(xlabel="x", ylabel="height")
plt.tight_layout()
plt.show()


def tip_angle(X: np.ndarray) -> float:
    """Between the two flanks at the point that is pulled, degrees; 180 is no kink."""
    before, tip, after = X[row][19:22]
    u, v = before - tip, after - tip
    return float(np.degrees(np.arccos(u @ v / np.linalg.norm(u) / np.linalg.norm(v))))


angles = {title: tip_angle(X) for title, X in pulled.items()}
print({title: f"{value:.0f}°" for title, value in angles.items()})

# %% [markdown]
# *Figure: Cross-sections of a square sheet pulled up at its middle: the membrane rises to a needle, ARAP to a tent with
# straight flanks and a sharp top, the sheet that keeps its Laplacian coordinates to a round hill.*
#
# Why? Write (4) for the displacement $d = v' - V$. Since $\delta = L V$,
#
# $$ (L^T L + \lambda S^T S)\, d = \lambda S^T (p - S V), \tag{12} $$
#
# so away from the anchors $L^T L\, d = 0$: the Laplacian *twice*. That is a thin metal plate, which resists bending.
# The membrane has it once, $C d = 0$: a soap film, which resists stretching only and does not mind being touched by a
# needle. ARAP also has one $C$ in (11). It keeps lengths, and a tent is an easy way to do so. Landmarks are needles: 68
# single points. That is why the library aligns faces with (3), as the paper does.
#
# | | Laplacian coordinates (3) | turned along (8) | ARAP (10) |
# |---|---|---|---|
# | systems to solve | one | a few | tens |
# | large turns | shear, get thin | are followed | are followed |
# | single points | round hill | round hill | tent with a kink |
# | linear in the anchors | yes | no | no |
# | volume kept, no crossing | no | no | no |
#
# The row "linear in the anchors" matters: to a linear method, half the displacement of the landmarks is half the
# displacement of everything, and for fixed anchors all is one matrix, computed once.
#
# ## 6 · Aligning a face
#
# Now the purpose. A drawing, its landmarks, and a face that was fitted as in lesson 5. Its landmarks miss those of the
# drawing. The picture says where they belong in x and y; the depth of the fitted face is kept, because nothing better
# is known. (`fit.camera` projects; `unproject` is the way back for a given depth.) The head has parts that hang
# together with nothing, such as the teeth: `loose="follow"` takes them along. For the comparison the front of the face
# is enough.

# %%
portrait = data_path("examples/portraits/beethoven.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
fit = tg.fit_3dmm(None, landmarks)
points = fit.landmark_vertices
goals68 = fit.camera.unproject(landmarks, fit.camera.depth(fit.vertices[points]))
aligned = tg.laplacian_align(fit.vertices, fit.faces, points, goals68, loose="follow")

in_face = np.isin(points, kept)  # `kept` and `F_face` are those of section 4
rows = np.searchsorted(kept, points[in_face])  # the landmarks as rows of the front
front = fit.vertices[kept]
pull = goals68[in_face] - front[rows]
smooth = tg.laplacian_align(front, F_face, rows, front[rows] + pull) - front

C_front = cotangent(front, F_face)  # and the membrane, with the same displacements at the landmarks
free = np.setdiff1d(np.arange(len(front)), rows)
unique, first = np.unique(rows, return_index=True)  # two landmarks may be the same vertex
needle = np.zeros_like(front)
needle[unique] = pull[first]
needle[free] = splu(C_front[free][:, free].tocsc()).solve(-(C_front[free][:, unique] @ pull[first]))

fig, axes = plt.subplots(1, 4, figsize=(11, 3))
axes[0].imshow(img)
axes[0].scatter(*landmarks.T, s=10, c="white", edgecolors="black", linewidths=0.5, label="drawn")
axes[0].scatter(*fit.project(fit.vertices[points]).T, s=10, marker="x", c="tab:red", linewidths=1, label="fitted")
axes[0].legend(fontsize=7, loc="lower right")
low, high = landmarks.min(axis=0) - 40, landmarks.max(axis=0) + 40
axes[0].set(xlim=(low[0], high[0]), ylim=(high[1], low[1]), title="what the fit misses")
view = {"extent": 250, "centre": (0, -5, 0), "size": 260}
axes[1].imshow(picture(front, F_face, **view))
axes[1].set_title("fitted")
axes[2].imshow(picture(front + needle, F_face, **view))
axes[2].set_title("membrane")
axes[3].imshow(picture(front + smooth, F_face, **view))
axes[3].set_title("Laplacian coordinates")
for axis in axes:
    axis.axis("off")
    axis.title.set_fontsize(9)
plt.tight_layout()
plt.show()

# %% [markdown]
# *Figure: A drawing of Beethoven with its landmarks and those of the fitted face, the fitted face in clay, and two
# aligned ones: the membrane is torn into small spikes at the landmarks, most of all at the lids, the other is smooth.*

# %%
outer_eyes = np.linalg.norm(landmarks[36] - landmarks[45])


def miss(vertices: np.ndarray) -> float:
    """Largest distance of a landmark, as a share of the outer-eye distance."""
    return float(np.linalg.norm(fit.project(vertices[points]) - landmarks, axis=1).max() / outer_eyes)


def kink(displacement: np.ndarray) -> float:
    """How much a landmark's displacement differs from the mean of its neighbours', as a share of it; the median."""
    bend = np.linalg.norm(uniform_laplacian(F_face, len(front)) @ displacement, axis=1)
    return float(np.median(bend[rows] / np.linalg.norm(displacement[rows], axis=1)))


print(f"largest miss: fitted {miss(fit.vertices):.1%}, aligned {miss(aligned):.3%} of the outer-eye distance")
print(f"kink at a landmark: membrane {kink(needle):.1%}, Laplacian coordinates {kink(smooth):.1%} of its displacement")

# %% [markdown]
# `tg.align_face(fit, landmarks)` does more with the same tool: a smooth flow first, where displacements are large, so
# that nothing folds; anchors along the rims of lips and lids; ears and teeth that stay rigid; noisy landmarks told from
# odd faces. The last step is the one that you have just written.
#
# ## 7 · Many drags
#
# Whoever drags a point on a screen asks for (4) thirty times a second with other targets $p$. The matrix stays, so
# factor it once. `tg.LaplacianAligner` goes one step further: by (12) the solution is linear in the targets,
#
# $$ v' = V + Z\,(p - S V), \qquad Z = \lambda\, (L^T L + \lambda S^T S)^{-1} S^T , $$
#
# and for $k$ anchors $Z$ has $k$ columns. After that a drag is a product of a small and a thin matrix.

# %%
S_bar = sp.csr_matrix((np.ones(len(ends)), (np.arange(len(ends)), ends)), shape=(len(ends), len(bar)))
K_bar = L_bar.T @ L_bar + 1000 * S_bar.T @ S_bar
Z = 1000 * splu(K_bar.tocsc()).solve(S_bar.T.toarray())
assert np.allclose(bar + Z @ (goals - bar[ends]), sheared)
assert np.allclose(tg.LaplacianAligner(bar, F_bar, ends, weight=1000.0).align(goals), sheared, atol=1e-6)

# %% [markdown]
# Here is a head with two long ears; the tip of one is dragged. (With `rotations`, each round costs one more solution of
# the factored system.)

# %%
angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
height = np.linspace(-1, 1, 25)[1:-1]
parts = [
    tube(
        np.array(
            [
                [(w * np.sin(t), h, w * np.cos(t)) for t in angle]
                for h, w in zip(height, np.sqrt(1 - height**2), strict=True)
            ]
        )
    )
]
rise = np.linspace(0, 1, 21)
for side in (-1, 1):
    thick = 0.22 * np.sqrt(1.02 - rise)
    stem = [
        [(0.4 * side + w * np.sin(t), 0.7 + 1.6 * h, 0.4 * w * np.cos(t)) for t in angle]
        for h, w in zip(rise, thick, strict=True)
    ]
    parts.append(tube(np.array(stem)))
offsets = np.cumsum([0, *(len(V) for V, _ in parts)])
bunny = np.vstack([V for V, _ in parts])
F_bunny = np.vstack([F + offset for (_, F), offset in zip(parts, offsets, strict=False)])

ear = np.arange(offsets[2], len(bunny))
tip, root = ear[bunny[ear, 1] > 2.25], ear[bunny[ear, 1] < 0.9]
aligner = tg.LaplacianAligner(bunny, F_bunny, tip, fixed=root)
drag = np.array([0.9, -0.5, 0.4])
frames = [aligner.align(bunny[tip] + s * drag, rotations=3) for s in (0.0, 0.5, 1.0)]
root_moved = float(np.abs(frames[-1][root] - bunny[root]).max())
strip(
    [picture(X, F_bunny, 4.4, centre=(0.3, 0.7, 0), pitch=10, yaw=-15) for X in frames], ["rest", "half", "whole drag"]
)

# %% [markdown]
# *Figure: A ball with two long ears, three times; the tip of the right ear is dragged farther and farther to the side,
# and the ear bends in a curve from its root, which stays.*
#
# The other ear and the head have no anchor. Their part of (4) has no solution that is *the* one (they could float
# anywhere), so the library leaves components without an anchor where they are.
#
# ## What to keep in mind
#
# - $\delta = L v$ is the detail without the place; keeping $\delta$ and moving anchors is one sparse system.
# - Uniform weights hear the mesh, cotangent weights the surface. On a template with good triangles the uniform ones are
#   safe and the same for every face; that is why the library (and the paper) takes them for alignment.
# - $L^T L$ for single points; rotations for large turns.
# - Nothing here prevents crossings or keeps volume, and a target that has gone round once more is the same target:
#   whoever wants a bar twisted by a full turn must tell more than where its end lies.
#
# ## Exercises
#
# 1. *Smoothing.* Add noise of 1 mm to the face and solve $(M + \tau C) v' = M v$, one implicit step of diffusion. Which
#    $\tau$ comes nearest to the face without noise? What is lost when $\tau$ is larger?
# 2. *How firm is λ?* Align the front of the face with weights 1, 10, 100, 1000. How does the largest miss fall?
# 3. *Volume.* A closed mesh has the volume $\frac16 \sum \det(v_i, v_j, v_k)$ over its triangles: a signed
#    tetrahedron with the origin each. How much of its volume does the bar lose in the three bends of section 5?
#
# ## Solutions

# %%
# 1. The mean squared error has a minimum: little smoothing leaves noise, much of it shrinks the nose.
noise = np.random.default_rng(0).standard_normal(face.shape)
C_face, M_face = cotangent(face, F_face), sp.diags_array(face_areas)
taus = np.array([0.3, 1.0, 3.0, 10.0, 30.0, 100.0])
smoothed = [splu((M_face + tau * C_face).tocsc()).solve(face_areas[:, None] * (face + noise)) for tau in taus]
errors = [float(np.sqrt(((X - face) ** 2).sum(axis=1).mean())) for X in smoothed]
best = int(np.argmin(errors))
noise_left = errors[best] / float(np.sqrt((noise**2).sum(axis=1).mean()))
print({float(tau): round(error, 2) for tau, error in zip(taus, errors, strict=True)}, "mm")
print(f"best: tau = {taus[best]} mm²; {noise_left:.0%} of the noise is left")

# %%
# 2. Each tenfold weight leaves a tenth of the miss: an anchor stops where the surface's pull equals λ times its miss.
misses = []
for weight in (1, 10, 100, 1000):
    X = tg.laplacian_align(front, F_face, rows, front[rows] + pull, weight=float(weight))
    misses.append(float(np.linalg.norm(X[rows] - front[rows] - pull, axis=1).max()))
print([f"{m:.4f} mm" for m in misses])


# %%
# 3. The cross-sections of the plain bar stay upright nearly up to its end, while its middle line rises and stays as
#    long as it was: where it rises by an angle a, the bar keeps cos a of its thickness. In (8) and (10) the
#    cross-sections turn along, so the volume is kept, although neither speaks of it.
def volume(V: np.ndarray) -> float:
    """Of the bar, by the formula of the exercise."""
    return float(np.linalg.det(V[F_bar]).sum() / 6)


lost = {name: 1 - volume(X) / volume(bar) for name, X in (("plain", sheared), ("turned", bent), ("ARAP", stiff))}
assert np.isclose(volume(bar), 20 * 2 * 2)
print({name: f"{share:.1%}" for name, share in lost.items()})

# %%
numbers: dict[str, float] = {
    "flat_uniform": float(np.linalg.norm(umbrella_delta[inside], axis=1).max()),
    "flat_cotangent": float(np.linalg.norm(cotangent_delta[inside], axis=1).max()),
    "spectrum_cotangent": cotangent_spectrum_error,
    "spectrum_uniform": uniform_spectrum_error,
    "low_pass_4": low_pass_error[4],
    "low_pass_120": low_pass_error[120],
    "strain_plain": strain(sheared),
    "strain_turned": strain(bent),
    "strain_arap": strain(stiff),
    "angle_membrane": angles["membrane, C v' = 0"],
    "angle_laplacian": angles["Laplacian coordinates (3)"],
    "angle_arap": angles["ARAP (10)"],
    "fitted_miss": miss(fit.vertices),
    "aligned_miss": miss(aligned),
    "kink_membrane": kink(needle),
    "kink_laplacian": kink(smooth),
    "root_moved": root_moved,
    "noise_left": noise_left,
    "miss_ratio": misses[-2] / misses[-1],
    "volume_lost_plain": lost["plain"],
    "volume_lost_turned": lost["turned"],
}
