# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 9 · Deformation transfer
#
# **How does a head make an expression that somebody modelled for another head?**
#
# An artist has modelled one head, and then the same head with its jaw open, winking, smiling: 46 times. Now a second
# head comes along, with a smaller mouth and enormous eyes. How does it open *its* jaw and close *its* eyes, when nobody
# models anything again?
#
# The answer of this lesson is twenty lines of numpy. You need to know arrays, matrix products and least squares; what a
# mesh is, and what a *deformation gradient* is, is said on the way. The method is that of R. W. Sumner and J. Popović,
# *Deformation transfer for triangle meshes*, 2004.

# %%
import matplotlib.pyplot as plt
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

import toongeo as tg
from toongeo.geometry import vertex_components
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


# %% [markdown]
# ## A mesh, and two things to deform
#
# A mesh is two arrays. `V` (n, 3) holds the *vertices*, points in space. `F` (m, 3) holds the *triangles*: each row
# names three vertices. Two meshes with the same `F` and as many vertices *correspond*: vertex 17 of one is vertex 17 of
# the other, whatever they look like.
#
# Before any face, take two bars. Each is a tube of square rings, closed at both ends. The source is thin and straight,
# and a second version of it is bent to a quarter of a circle. The target is longer, and as fat as a bottle. Both have
# the same triangles. (How `bar` numbers its triangles does not matter here; skip it.)


# %%
def bar(along, thick):
    """Vertices (n, 3) of a bar whose rings stand at `along` (r,) and are `thick` (r,), and its triangles (m, 3)."""
    square = np.array([(-1, -1), (0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0)])
    rings = np.array([[(x, t * y, t * z) for y, z in square] for x, t in zip(along, thick, strict=True)])
    r, sides = len(along), len(square)
    i, j = np.meshgrid(np.arange(r - 1), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    walls = np.stack([a, b, b + sides, a, b + sides, a + sides], -1).reshape(-1, 3)
    k, end = np.arange(sides), (r - 1) * sides
    first = np.stack([np.full(sides, r * sides), (k + 1) % sides, k], 1)
    last = np.stack([np.full(sides, r * sides + 1), end + k, end + (k + 1) % sides], 1)
    return np.vstack([rings.reshape(-1, 3), rings[0].mean(0), rings[-1].mean(0)]), np.vstack([walls, first, last])


def bent(V, length):
    """A bar (n, 3) that lay along x, bent upwards to a quarter of a circle as long as it was."""
    radius = length / (np.pi / 2)
    angle = V[:, 0] / radius
    return np.column_stack([(radius - V[:, 1]) * np.sin(angle), radius - (radius - V[:, 1]) * np.cos(angle), V[:, 2]])


s = np.linspace(0, 1, 33)
S, F = bar(20 * s, np.ones(33))
S_bent = bent(S, 20)
T, _ = bar(30 * s, 1.8 + 0.8 * np.sin(7 * s))


def clay(V, F, centre, extent, yaw=0.0, pitch=0.0, side=220):
    """Picture of a mesh as a sculptor's clay."""
    camera = ScaledOrthographicCamera.look(yaw, pitch, size=side, centre=centre, extent=extent)
    return render_mesh(Surface(V, F), camera, side, shading="clay")


# %% [markdown]
# ## The obvious idea, and why it fails
#
# The obvious idea is to copy *displacements*: move every vertex of the target by as much as its partner on the source
# moves.

# %%
copied = T + (S_bent - S)
views = [clay(X, F, (13, 8, 0), 38) for X in (S, S_bent, T, copied)]
show(views, ["source S", "source, deformed", "target T", "displacements copied"])

# %% [markdown]
# *Figure: A thin bar, straight and then bent to a quarter of a circle; a bottle, straight and then with the
# displacements of the bar, which shear and pinch it and leave its end aslant.*
#
# The reason: a displacement tells where a vertex of *that* mesh goes. It does not say what happens to the surface
# around it: this piece turned by 40 degrees, that one grew by a tenth. What happens to the surface is what we want to
# carry over.
#
# ## The deformation gradient of a triangle
#
# Look at one triangle with corners $v_1, v_2, v_3$. Two of its edges leave the first corner, $v_2 - v_1$ and
# $v_3 - v_1$. After the deformation they are $\tilde v_2 - \tilde v_1$ and $\tilde v_3 - \tilde v_1$. We look for the
# 3 x 3 matrix $Q$ that takes the old edges to the new ones. Turning, growing and shearing are all matrices, and where
# the triangle stands plays no part, because edges are differences.
#
# A matrix of three rows and columns is known when we know what it does to three directions, and two edges are only two:
# nothing says yet what $Q$ does *across* the triangle. So a third edge is added, perpendicular to the other two. The
# *cross product* of two vectors, `np.cross`, is such a direction: it is called the *normal* $n$ of the triangle. The
# third edge leads to a made-up *fourth vertex* $v_4$:
#
# $$ v_4 = v_1 + \frac{n}{\sqrt{|n|}}, \qquad n = (v_2 - v_1) \times (v_3 - v_1). $$
#
# (The cross product is as long as twice the area of the triangle: a length *squared*. Divided by the root of its length
# it is a length again, so that a triangle with sides twice as long has a third edge twice as long. Exercise 3 shows
# what goes wrong otherwise. Of the deformed source, $\tilde v_4$ is made of $\tilde v_1, \tilde v_2, \tilde v_3$ in the
# same way.) With the three edges as the columns of a matrix $E$,
#
# $$ E = [\,v_2 - v_1,\; v_3 - v_1,\; v_4 - v_1\,], \qquad Q\,E = \tilde E \quad\Longrightarrow\quad
# Q = \tilde E\,E^{-1}. $$


# %%
def frames(V, F):
    """E (m, 3, 3) of every triangle: its columns are two edges, and the third along the normal."""
    v1, v2, v3 = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    n = np.cross(v2 - v1, v3 - v1)
    return np.stack([v2 - v1, v3 - v1, n / np.sqrt(np.linalg.norm(n, axis=1))[:, None]], axis=2)


# %% [markdown]
# Try it with a triangle that is turned by 30 degrees about z and made twice as large, and shifted. We know the matrix,
# and $Q$ finds it, wherever the triangle went.

# %%
triangle, one = np.array([[0.0, 0, 0], [2, 0, 0], [0.5, 1, 0]]), np.array([[0, 1, 2]])
c, d = np.cos(np.pi / 6), np.sin(np.pi / 6)
M = 2 * np.array([[c, -d, 0], [d, c, 0], [0, 0, 1]])
moved = triangle @ M.T + [5, 1, 0]  # vertices are rows, so the matrix stands on the right, transposed
Q = frames(moved, one) @ np.linalg.inv(frames(triangle, one))
print(Q[0].round(3))
q_error = np.abs(Q[0] - M).max()
figure = plt.figure(figsize=(6, 3), dpi=90)
for k, (corners, title) in enumerate(((triangle, "E: before"), (moved - [5, 1, 0], "Q E: after"))):
    axis = figure.add_subplot(1, 2, k + 1, projection="3d")
    axis.plot_trisurf(*corners.T, triangles=one, alpha=0.3)
    for edge, colour in zip(frames(corners, one)[0].T, ("C0", "C1", "C2"), strict=True):
        axis.quiver(*corners[0], *edge, color=colour, arrow_length_ratio=0.15)
    axis.set(xlim=(-1, 4), ylim=(-1, 4), zlim=(0, 4), title=title)
    axis.view_init(25, -70)
    axis.tick_params(labelsize=6)
plt.show()

# %% [markdown]
# *Figure: A triangle before and after it is turned and enlarged, with three arrows: two along its sides, and a third
# that stands on it.*
#
# ## What is asked of the target
#
# Compute $Q_j$ for every triangle $j$ of the source. They are the whole deformation. Now the target gets unknown new
# vertices $x$, with gradients $Q'_j$ of its own, and these should be those of the source ($\|\cdot\|^2$ of a matrix is
# the sum of its squared entries):
#
# $$ \min_x \sum_j \left\| Q_j - Q'_j(x) \right\|^2 . $$
#
# Why not just *set* $Q'_j = Q_j$? Because neighbouring triangles share vertices. If each did as it liked the surface
# would fall apart; on the target the $Q_j$ do not fit together exactly, so they are met as well as possible, in the
# sense of least squares.
#
# And this is least squares of the simple, linear sort. With $W_j = E_j^{-1}$ of the target *at rest*, which is a
# constant,
#
# $$ Q'_j(x) = [\,x_2 - x_1,\; x_3 - x_1,\; x_4 - x_1\,]\; W_j , $$
#
# and every number in it is a sum of unknowns times constants. Here $x_4$ is *not* computed from the other three: it is
# one more unknown of the triangle. Nothing forces it to stay perpendicular above the triangle, and that is what keeps
# the problem linear. In this equation a vertex is a *column* of three numbers. The differences are the four columns
# $x_1 \dots x_4$ times a matrix of $-1$, $0$ and $1$:
#
# $$ [\,x_2 - x_1,\; x_3 - x_1,\; x_4 - x_1\,] = [\,x_1, x_2, x_3, x_4\,]\; D, \qquad
# D = \begin{bmatrix} -1 & -1 & -1 \\ 1 & 0 & 0 \\ 0 & 1 & 0 \\ 0 & 0 & 1 \end{bmatrix} $$
#
# so $Q'_j = [\,x_1, x_2, x_3, x_4\,]\, (D\,W_j)$. In numpy a vertex is a *row*. Transposed, with $K_j = D\,W_j$ (4 x
# 3),
#
# $$ Q_j'^{\,T} = K_j^T \begin{bmatrix} x_1^T \\ x_2^T \\ x_3^T \\ x_4^T \end{bmatrix} . $$
#
# These are three equations for triangle $j$, each with four numbers, and they are the same for the x, the y and the z
# of the vertices. Now write the equations of all triangles below each other. The unknowns are all vertices, and after
# them all fourth vertices, one a triangle. Each equation has a number in four of their columns, and 0 in the others.
# That is a tall matrix $A$ that is nearly empty, and the transposed $Q_j$ of the source are its right side $B$:
#
# $$ \min_X \| A X - B \|^2, \qquad A \in \mathbb{R}^{3m \times (n + m)}, \quad X \in \mathbb{R}^{(n + m) \times 3},
# \quad B \in \mathbb{R}^{3m \times 3} . $$
#
# Let us see $A$ for the smallest closed mesh, a tetrahedron: four vertices, four triangles. The loops say it slowly:
# corner $k$ of triangle $j$ has the numbers of row $k$ of $K_j$; they go to the three rows of this triangle, and to the
# column of that corner.

# %%
D = np.array([[-1.0, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]])


def equations_slowly(T, F):
    """A (3 m, n + m), number by number."""
    n, m = len(T), len(F)
    A = np.zeros((3 * m, n + m))
    for j in range(m):
        K = D @ np.linalg.inv(frames(T, F)[j])
        columns = [*F[j], n + j]  # the three corners, and the fourth vertex of this triangle
        for k in range(4):
            for row in range(3):
                A[3 * j + row, columns[k]] = K[k, row]
    return A


tetrahedron = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
sides = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
A_small = equations_slowly(tetrahedron, sides)
figure, axis = plt.subplots(figsize=(3.4, 3.8), dpi=90)
axis.imshow(A_small, cmap="coolwarm", vmin=-2, vmax=2)
axis.set_xticks(range(8), [*(f"$x_{k}$" for k in range(4)), *(f"4th {j}" for j in range(4))], fontsize=7, rotation=90)
axis.set_yticks(range(1, 12, 3), [f"triangle {j}" for j in range(4)], fontsize=7)
plt.show()

# %% [markdown]
# *Figure: The matrix A of a tetrahedron: three rows for each of four triangles, with numbers in the columns of its
# three corners and of its own fourth vertex, and zero elsewhere.*
#
# One thing is missing. Edges do not know where the mesh stands: shift all of it, and nothing changes. So some vertices
# are *held*, at places that we name; one is enough. How does one solve least squares of which some unknowns are given?
# The minimum of $\|A X - B\|^2$ satisfies the *normal equations* $N X = A^T B$ with $N = A^T A$. Sort the unknowns into
# free and held ones. Of the equations those of the free unknowns are kept, and what the held ones contribute is known
# and goes to the right side:
#
# $$ N_{free,free}\, X_{free} = (A^T B)_{free} - N_{free,held}\, X_{held} . $$
#
# ## Twenty lines


# %%
def equations(T, F):
    """A (3 m, n + m): the transposed gradients of all triangles are A times vertices and fourth vertices."""
    n, m = len(T), len(F)
    K = D @ np.linalg.inv(frames(T, F))  # (m, 4, 3)
    rows = np.broadcast_to(3 * np.arange(m)[:, None, None] + np.arange(3), (m, 4, 3))
    columns = np.broadcast_to(np.column_stack([F, n + np.arange(m)])[:, :, None], (m, 4, 3))
    return sp.csr_array((K.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * m, n + m))


def meet(Q, F, T, held, places):
    """Vertices (n, 3) whose gradients come nearest to Q (m, 3, 3); `held` (p,) go to `places` (p, 3)."""
    A, n, m = equations(T, F), len(T), len(F)
    N, right = sp.csc_array(A.T @ A), A.T @ Q.transpose(0, 2, 1).reshape(3 * m, 3)
    free = np.setdiff1d(np.arange(n + m), held)
    X = np.zeros((n + m, 3))
    X[held] = places
    X[free] = splu(N[free][:, free]).solve(right[free] - N[free][:, held] @ X[held])
    return X[:n]


def transfer(S, S_new, F, T, held, places):
    """Deform T (n, 3) as S (n, 3) is deformed to S_new."""
    return meet(frames(S_new, F) @ np.linalg.inv(frames(S, F)), F, T, held, places)


assert np.abs(equations(tetrahedron, sides).toarray() - A_small).max() == 0


# %% [markdown]
# With `frames`, these are the twenty lines. `equations` does what the loops did, for all triangles at once: it lists
# the number, the row and the column of every entry, and `csr_array` makes a *sparse* matrix of them, which stores
# nothing else. `transfer` computes the gradients of the source and hands them to `meet`, which finds the vertices by
# the formula above. `splu` factors the matrix of the free unknowns, and solves for x, y and z.
#
# ## The bottle bends
#
# We hold the first ring of the bottle, and look how far the last piece of each bar has turned.

# %%
ring = np.arange(8)
T_bent = transfer(S, S_bent, F, T, ring, T[ring])
show(
    [clay(S_bent, F, (13, 8, 0), 38), clay(T, F, (13, 8, 0), 38)]
    + [clay(T_bent, F, (13, 8, 0), 38, yaw, pitch) for yaw, pitch in ((0, 0), (-35, 20))],
    ["source, deformed", "target T", "transferred", "transferred, turned"],
)

# %% [markdown]
# *Figure: The bent bar, the bottle at rest, and the bottle after the transfer from the front and in a three-quarter
# view: it turns upwards as the bar does and stays as fat as it was.*


# %%
def end_angle(V):
    """Degrees by which the last piece of a bar is turned: the way from the last ring but three to the last.

    (The way is a chord, so for a quarter of a circle it is 90 − 4.2 degrees.)
    """
    along = V[-10:-2].mean(0) - V[-34:-26].mean(0)
    return np.degrees(np.arctan2(along[1], along[0]))


Q = frames(S_bent, F) @ np.linalg.inv(frames(S, F))
Q_met = frames(T_bent, F) @ np.linalg.inv(frames(T, F))
misfit = np.linalg.norm(Q_met - Q) / np.linalg.norm(Q - np.eye(3))
angles = {name: end_angle(V) for name, V in (("source", S_bent), ("copied", copied), ("transferred", T_bent))}
print({name: f"{angle:.1f} degrees" for name, angle in angles.items()})
print(f"what the gradients of the bottle miss of those of the bar: {misfit:.0%} of the deformation")

# %% [markdown]
# The bottle turns as the bar does. Its gradients cannot be those of the bar everywhere, because it is fatter: where the
# bar's outer side grows by a little, a fat bottle's has to grow by more. Least squares spreads that over all triangles.
#
# ## Three checks
#
# A method that cannot fail a test is not understood. Three things can be said about it before any picture:
#
# 1. No deformation of the source gives none of the target.
# 2. If the source is turned and resized as a whole, by $M = s R$ with a rotation $R$, all gradients are $M$. They fit
#    together, and the target is turned and resized by $M$, exactly, provided that the held vertices are put where $M$
#    takes them. (This is not so for a matrix $M$ that shears: it takes the triangles along, but the normal of the
#    sheared triangle is not $M$ times the old one.)
# 3. The library does the same. `tg.DeformationTransfer` eliminates the fourth vertices beforehand: each occurs in one
#    term only, and drops out. That leaves a third of the unknowns and the same minimum.

# %%
rest = transfer(S, S, F, T, ring, T[ring])
turned = transfer(S, S @ M.T, F, T, ring, T[ring] @ M.T)
library = tg.deformation_transfer(S, S_bent, F, T, pinned=ring)
checks = {
    "rest": np.abs(rest - T).max(),
    "turned": np.abs(turned - T @ M.T).max(),
    "library": np.abs(library - T_bent).max(),
}
assert max(checks.values()) < 1e-9
print(", ".join(checks), "hold to the ninth digit")

# %% [markdown]
# ## Faces
#
# Now the heads. The source is the mean face of the library's model, in millimetres. It comes with 46 expressions as
# displacements of its 19057 vertices: `model.expression[i]` (n, 3). The targets are two drawings of this repository,
# fitted and aligned by the functions that other lessons take apart; here they are just two meshes with the same
# triangles and other proportions.


# %%
def head_of(name):
    """Vertices (n, 3), mm, of a portrait's face."""
    path = data_path(f"examples/portraits/{name}.png")
    img, landmarks = tg.read_image(path), tg.read_landmarks(path.with_suffix(".pts"))
    return np.array(tg.align_face(tg.fit_3dmm(img, landmarks), landmarks).vertices)


model = tg.default_model()
heads = {name: head_of(name) for name in ("moustache_man", "blue_girl")}


def portrait(V, yaw=-30.0, extent=260.0, centre=(0, -20, -25), side=260):
    return clay(V, model.faces, centre, extent, yaw, side=side)


show([portrait(model.mean), *(portrait(V) for V in heads.values())], ["source: the mean face", *heads], side=2.6)

# %% [markdown]
# *Figure: Three heads in clay from three quarters: the mean face, a man with a broad face and small eyes, and a girl
# with large eyes and a small mouth.*
#
# ### Which vertices are held
#
# The neck, the ears and the back of the skull are not moved by any expression of the source. They are held where the
# target has them: each expression then ends where the face ends. A mesh can also consist of several *components* that
# share no edge; here skin, tongue, upper and lower teeth. What one component does tells nothing about another, so each
# needs a vertex that is held. The first vertex of a component that has none goes as far as it goes on the source.

# %%
moves = np.abs(model.expression[: model.n_named]).max(axis=(0, 2))
still = np.flatnonzero(moves < 0.05)  # mm
component = vertex_components(model.faces, len(model.mean))
first = np.unique(component, return_index=True)[1]
loose = np.array([v for c, v in enumerate(first) if not np.isin(component[still], c).any()])
held = np.concatenate([still, loose])
print(f"{len(first)} components; {len(still)} of {len(model.mean)} vertices are still, {len(loose)} others are held")


def expressed(name, T):
    """T (n, 3) with an expression of the model, by the twenty lines."""
    delta = model.expression[model.expression_index(name)].astype(float)
    places = np.concatenate([T[still], T[loose] + delta[loose]])
    return transfer(model.mean, model.mean + delta, model.faces, T, held, places)


# %% [markdown]
# ### Jaw and lids
#
# Two expressions suffice to see it. The girl's mouth is narrow and her eyes are large.

# %%
results = {}
pictures = []
for head, face in heads.items():
    pictures.append(portrait(face, side=200))
    for name in ("jawOpen", "eyeBlinkLeft"):
        copy = face + model.expression[model.expression_index(name)]
        results[head, name] = copy, expressed(name, face)
        pictures += [portrait(V, side=200) for V in results[head, name]]
show(
    pictures,
    ["at rest", "jaw: copied", "jaw: transferred", "blink: copied", "blink: transferred"] * 2,
    rows=2,
    side=1.9,
)

# %% [markdown]
# *Figure: Two rows, the man and the girl: at rest, the jaw open and the left eye closed, each by copied displacements
# and by transfer; copied displacements open the girl's mouth too far and leave her eye open.*
#
# In numbers: how far the lips are apart (points 62 and 66 of the 68 landmarks), in widths of the head's own mouth
# (points 48 and 54); and what remains of the left eye's opening (43 and 47, 44 and 46) where 100 % is at rest.

# %%
L = model.landmarks


def opening(V):
    """Height of the left eye, mm."""
    return np.linalg.norm(V[L[[43, 44]]] - V[L[[47, 46]]], axis=1).mean()


def table(head, T, shapes):
    """Prints and returns opening of the mouth and of the eye, for pairs of shapes."""
    width = np.linalg.norm(T[L[48]] - T[L[54]])
    mouths = [np.linalg.norm(V[L[62]] - V[L[66]]) / width for V in shapes["jawOpen"]]
    lids = [opening(V) / opening(T) for V in shapes["eyeBlinkLeft"]]
    print(f"{head:14s}", "mouth", *(f"{m:.2f}" for m in mouths), "  eye", *(f"{lid:.0%}" for lid in lids))
    return mouths, lids


names = ("jawOpen", "eyeBlinkLeft")
source = table(
    "source", model.mean, {name: [model.mean + model.expression[model.expression_index(name)]] for name in names}
)
print("                copied, then transferred:")
measured = {head: table(head, face, {name: results[head, name] for name in names}) for head, face in heads.items()}

# %% [markdown]
# The source opens its mouth by 0.8 of its width. Copied, that becomes more for the girl, whose mouth is small, and less
# for the man, whose mouth is large; transferred, it is within a twentieth of the source's for both. The lids, copied,
# close the man's small eyes more than the girl's large ones; transferred, both are left equally open, at 37 and 38 % of
# their height. That is more than the source's 27 %: no gradient says that two lids should *meet*. (The source is not at
# 0 either, for the points lie on the outer side of the lids.) After the transfer the library makes contact by other
# means (`tg.fit_lids`, `tg.fit_mouth`, of which lesson 10 tells).
#
# ## With the library: factor once, transfer often
#
# The matrix $A^T A$ depends only on the target at rest and the triangles, not on the deformation. So it is factored
# once, and each of 46 expressions costs no more than a right side and a solution. `tg.DeformationTransfer` is that
# object; `tg.build_rig(face)` calls it for all expressions of the model.

# %%
girl = tg.DeformationTransfer(model.mean, model.faces, heads["blue_girl"], pinned=still)
shown = ("jawOpen", "mouthSmileLeft", "mouthPucker", "browOuterUpLeft", "cheekPuffLeft", "eyeBlinkLeft")
shapes = [girl(model.mean + model.expression[model.expression_index(name)]) for name in shown]
face_agreement = np.abs(shapes[0] - results["blue_girl", "jawOpen"][1]).max()
assert face_agreement < 1e-6  # mm
show([portrait(V, side=220) for V in shapes], shown, rows=2, side=2.4)

# %% [markdown]
# *Figure: The girl with six transferred expressions: jaw open, smiling on one side, lips pursed, brow raised, cheek
# puffed, eye closed.*
#
# ## What to remember
#
# - A deformation is what happens to edges, not where points go.
# - A triangle and its normal give a 3 x 3 matrix, the deformation gradient.
# - Neighbours share vertices, so gradients are met in the sense of least squares: one sparse linear system.
# - The gradients are those of the axes of the world: source and target have to face the same way (exercise 1).
# - Source and target need the same triangles. Lesson 15 gives a head of your own the triangles of the model first.
#
# ## Exercises
#
# 1. Turn the bottle by 90 degrees about the y axis before the transfer, so that it lies along z. What comes out? What
#    does `align=True` of the library do about it?
# 2. An expression should be twice as strong. Take gradients $I + 2\,(Q - I)$ in place of $Q$. Show that this doubles
#    the displacements of the target exactly, if the held vertices stay. What follows for blendshapes?
# 3. Use the plain normal $n$ in place of $n / \sqrt{|n|}$ for the third edge, and turn and *enlarge* the source as
#    a whole, as in check 2. What goes wrong?
# 4. Leave out all held vertices. What does `splu` say, and why?
#
# ## Solutions
#
# **1.** The gradients say "bend up, turning about the world's z axis", and the bottle that lies along z is *twisted*
# about its own length in place of being bent: its end does not rise. With `align=True` the source and its deformations
# are first turned by the rotation that brings the source nearest to the target (found from the vertices, as lesson 2
# does), and the bottle bends again.

# %%
quarter = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
T_turned = T @ quarter.T
wrong = tg.deformation_transfer(S, S_bent, F, T_turned, pinned=ring)
right = tg.deformation_transfer(S, S_bent, F, T_turned, pinned=ring, align=True)
show([clay(V, F, (0, 8, -13), 44, yaw=-60, pitch=20) for V in (wrong, right)], ["as it is", "align=True"])
raised = [V[-10:-2, 1].mean() for V in (wrong, right)]
print(f"the end rises by {raised[0]:.1f} and by {raised[1]:.1f}")

# %% [markdown]
# *Figure: The bottle along the other axis, twisted about its own length without `align`, and bent upwards with it.*
#
# **2.** $B$ is linear in the $Q$, the solution is linear in $B$, and no deformation gives no displacement; so twice the
# deviation of $Q$ from $I$ gives twice the displacement. A source whose gradients are $I + 2(Q - I)$ need not exist,
# but the system does not ask for one. It follows that the transferred expression may be kept as a displacement and
# multiplied by a weight: a *blendshape*.

# %%
once, twice = (meet(np.eye(3) + k * (Q - np.eye(3)), F, T, ring, T[ring]) for k in (1, 2))
linearity = np.abs((twice - T) - 2 * (once - T)).max()
assert linearity < 1e-9

# %% [markdown]
# **3.** The normal $n$ grows with the *square* of the size. Of a source enlarged to twice its size, $Q$ would say:
# twice as wide, but four times as thick. The gradient of a mere enlargement depends on the direction of each triangle
# then, and those of the bottle, which has other directions, do not fit together any more: check 2 fails.


# %%
def plain_frames(V, F):
    """As `frames`, with a third edge as long as twice the area."""
    v1, v2, v3 = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    return np.stack([v2 - v1, v3 - v1, np.cross(v2 - v1, v3 - v1)], axis=2)


with_root = frames(2 * S, F) @ np.linalg.inv(frames(S, F))
without = plain_frames(2 * S, F) @ np.linalg.inv(plain_frames(S, F))
print("singular values of Q for twice the size, with the root:", np.linalg.svd(with_root[0])[1].round(3))
print("without it:", np.linalg.svd(without[0])[1].round(3))
thickening = np.linalg.svd(without[0])[1].max()
Q_plain = plain_frames(S @ M.T, F) @ np.linalg.inv(plain_frames(S, F))
plain_gap = np.abs(meet(Q_plain, F, T, ring, T[ring] @ M.T) - T @ M.T).max()
print(f"check 2 without the root: off by {plain_gap:.2f}")

# %% [markdown]
# **4.** A shift of the whole target changes no gradient, so $A$ times a column of ones (for vertices and fourth
# vertices alike) is zero: the normal matrix is singular, and each component adds one such direction. Rounding hides
# that from `splu`: it finds a tiny pivot in place of 0 and does not complain. The bottle comes out bent, but somewhere:
# rounding has chosen the place.

# %%
null = np.abs(equations(T, F).sum(axis=1)).max()  # A times the column of ones
assert null < 1e-12

# %%
numbers: dict[str, float] = {
    "gradient_of_one_triangle": q_error,
    "bar_at_rest": checks["rest"],
    "bar_turned": checks["turned"],
    "bar_library": checks["library"],
    "face_library_mm": face_agreement,
    "angle_source": angles["source"],
    "angle_copied": angles["copied"],
    "angle_transferred": angles["transferred"],
    "mouth_source": source[0][0],
    "mouth_girl_copied": measured["blue_girl"][0][0],
    "mouth_girl_transferred": measured["blue_girl"][0][1],
    "mouth_man_transferred": measured["moustache_man"][0][1],
    "lids_spread_copied": abs(measured["blue_girl"][1][0] - measured["moustache_man"][1][0]),
    "lids_spread_transferred": abs(measured["blue_girl"][1][1] - measured["moustache_man"][1][1]),
    "rise_twisted": raised[0],
    "rise_aligned": raised[1],
    "linearity": linearity,
    "thickening_without_root": thickening,
    "turned_without_root": plain_gap,
    "null_space": null,
    "misfit": misfit,
}
