# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # Bend a bar, drag an ear
#
# `laplacian_align` moves a few vertices of any triangle mesh and lets the others follow. It keeps the *Laplacian
# coordinate* of each vertex, which is its offset from the mean of its neighbours: the detail of the surface.

# %%
import numpy as np

import toongeo as tg
from toongeo.geometry import vertex_normals
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

# %% [markdown]
# ## A bar
# A tube of square cross-section, with closed ends.


# %%
def tube(rings: np.ndarray, sides: int) -> tuple[np.ndarray, np.ndarray]:
    """Rings (r, sides, 3) of vertices, joined by triangles and closed by a vertex at each end."""
    r = len(rings)
    V = np.vstack([rings.reshape(-1, 3), rings[0].mean(0), rings[-1].mean(0)])
    i, j = np.meshgrid(np.arange(r - 1), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    c, d = b + sides, a + sides
    walls = np.stack([a, b, c, a, c, d], -1).reshape(-1, 3)
    k = np.arange(sides)
    caps = [np.stack([np.full(sides, r * sides), (k + 1) % sides, k], 1)]
    last = (r - 1) * sides
    caps.append(np.stack([np.full(sides, r * sides + 1), last + k, last + (k + 1) % sides], 1))
    return V, np.vstack([walls, *caps])


square = [(s, -1) for s in (-1, -0.5, 0, 0.5)] + [(1, s) for s in (-1, -0.5, 0, 0.5)]
square += [(-s, 1) for s in (-1, -0.5, 0, 0.5)] + [(-1, -s) for s in (-1, -0.5, 0, 0.5)]
x = np.linspace(0, 20, 41)
rings = np.array([[(along, y, z) for y, z in square] for along in x])
V, F = tube(rings, len(square))

# %% [markdown]
# One end is held (`fixed`), the other is turned by a right angle and must be met exactly (an infinite `weight`).
# Laplacian coordinates keep their directions in the world, so the bar shears and gets thin in the bend. With
# `rotations` they turn along with their surroundings.

# %%
held, grip = V[:, 0] < 1.1, np.flatnonzero(V[:, 0] > 18.9)
radius = 20 / (np.pi / 2)
quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
targets = (V[grip] - [20, 0, 0]) @ quarter.T + [radius, radius, 0]
sheared = tg.laplacian_align(V, F, grip, targets, weight=np.inf, fixed=held)
bent = tg.laplacian_align(V, F, grip, targets, weight=np.inf, fixed=held, rotations=5)


def strain(moved: np.ndarray) -> float:
    """The greatest relative change of the length of an edge."""
    i, j = F.ravel(), np.roll(F, -1, axis=1).ravel()
    before, after = (np.linalg.norm(X[i] - X[j], axis=1) for X in (V, moved))
    return float(np.abs(after / before - 1).max())


print(f"greatest strain: plain {strain(sheared):.2f}, with rotations {strain(bent):.2f}")
print(f"a bend of this radius needs {1 / radius:.2f}")

# %% [markdown]
# ## An ear
# A head with two long ears. The tip of one is dragged; everything below the neck of the ear stays.

# %%
angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
height = np.linspace(-1, 1, 25)[1:-1]
width = np.sqrt(1 - height**2)
head = np.array([[(w * np.sin(t), h, w * np.cos(t)) for t in angle] for h, w in zip(height, width, strict=True)])
head_V, head_F = tube(head, len(angle))
ear_height = np.linspace(0, 1, 21)
ears = []
for side in (-1, 1):
    thick = 0.22 * np.sqrt(1.02 - ear_height)
    stem = np.array(
        [
            [(0.4 * side + w * np.sin(t), 0.7 + 1.6 * h, 0.4 * w * np.cos(t)) for t in angle]
            for h, w in zip(ear_height, thick, strict=True)
        ]
    )
    ears.append(tube(stem, len(angle)))
bunny = np.vstack([head_V, ears[0][0], ears[1][0]])
faces = np.vstack([head_F, ears[0][1] + len(head_V), ears[1][1] + len(head_V) + len(ears[0][0])])

# %% [markdown]
# A `LaplacianAligner` is prepared once; then each drag of the tip costs a small product, and a solution of the
# factored system for each estimate of the rotations. Parts without an anchor, here the head and the other ear, stay
# where they are.

# %%
right_ear = np.arange(len(head_V) + len(ears[0][0]), len(bunny))
tip = right_ear[bunny[right_ear, 1] > 2.25]
root = right_ear[bunny[right_ear, 1] < 0.9]
aligner = tg.LaplacianAligner(bunny, faces, tip, fixed=root)
drag = np.array([0.9, -0.5, 0.4])
frames = [aligner.align(bunny[tip] + s * drag, rotations=3) for s in np.linspace(0, 1, 4)]
print("the root has moved by", np.abs(frames[-1][root] - bunny[root]).max())

# %% [markdown]
# ## Pictures
# The library's own renderer draws them, side by side.


# %%
def picture(vertices: np.ndarray, triangles: np.ndarray, centre: np.ndarray, extent: float) -> np.ndarray:
    camera = ScaledOrthographicCamera.look(yaw=-15, pitch=15, size=256, centre=centre, extent=extent)
    shade = 0.35 + 0.6 * np.clip(vertex_normals(vertices, triangles) @ [0.3, 0.5, 0.81], 0, 1)
    clay = Surface(vertices, triangles, colours=np.repeat(shade[:, None], 3, axis=1))
    return render_mesh(clay, camera, 256, shading="unlit")


bars = [picture(X, F, np.array([8.0, 6, 0]), 28) for X in (V, sheared, bent)]
bunnies = [picture(X, faces, np.array([0.3, 0.7, 0]), 4.2) for X in frames[1:]]
sheet = np.vstack([np.hstack(bars), np.hstack(bunnies)])
print("a sheet of", sheet.shape, "with", len(bars) + len(bunnies), "pictures")
