# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # 16 · Drive, speak, export
#
# **A rigged head can make any face. Who moves it, and where does it go?** A performance is a table of weights over
# time. In this lesson you animate a head by hand, read weights off the landmarks of an actor, let the head speak, and
# write files that other programs open. It needs lesson 10, where the expressions came from.

# %%
import csv
import json
import struct
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import lsq_linear

import toongeo as tg
from toongeo.driving import VisemeTrack, read_live_link, write_live_link
from toongeo.model import data_path

portrait = data_path("examples/portraits/moustache_man.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
avatar = tg.make_avatar(img, landmarks, hair=False, texture_size=512)
folder = Path(tempfile.mkdtemp())  # what this lesson writes

# %% [markdown]
# ## 1. Weights over time
#
# A head with the face at rest $V_0$ and expressions $\Delta_k$ (displacements of all vertices) shows, at weights
# $w_k(t)$,
#
# $$ V(t) = V_0 + \sum_k w_k(t)\,\Delta_k . $$
#
# An animator sets a few *keyframes* and fills in between. Straight lines between them would start and stop with a
# jerk; the polynomial $3\tau^2 - 2\tau^3$ leaves each key with speed 0.
#
# The names of the columns of a `Take` are the 46 expressions and eight directions of gaze, in the order of an
# `Animator`, which computes the sum above thousands of times a second.

# %%
animator = tg.Animator(avatar)
names = list(animator.names)
keys: list[tuple[float, dict[str, float]]] = [
    (0.0, {}),
    (0.4, tg.preset("surprise")),
    (1.0, tg.preset("surprise")),
    (1.6, tg.preset("smile")),
    (2.4, {}),
]


def weights_of(shape: dict[str, float]) -> np.ndarray:
    return np.array([shape.get(name, 0.0) for name in names])


def eased(times: np.ndarray) -> np.ndarray:
    """Weights (f, 54) at times, between keyframes."""
    at = np.array([time for time, _ in keys])
    rows = np.array([weights_of(shape) for _, shape in keys])
    k = np.clip(np.searchsorted(at, times, "right") - 1, 0, len(at) - 2)
    tau = np.clip((times - at[k]) / (at[k + 1] - at[k]), 0, 1)[:, None]
    return rows[k] + (3 * tau**2 - 2 * tau**3) * (rows[k + 1] - rows[k])


fps = 30.0
times = np.arange(int(2.4 * fps) + 1) / fps
take = tg.Take(times, eased(times))
deltas = np.concatenate([avatar.rig.deltas, avatar.rig.gaze])  # gaze moves the lids a little
by_hand = avatar.rig.neutral + np.tensordot(take.weights[30], deltas, axes=1)
sum_difference = float(np.abs(by_hand - animator.frame(take.weights[30])).max())
print("the sum by hand and the animator differ by less than a ten-thousandth of a mm:", sum_difference < 1e-4)

shown = [0, 12, 30, 40, 48, 60]
fig = plt.figure(figsize=(10, 4.2), layout="constrained")
grid = fig.add_gridspec(2, len(shown), height_ratios=(1.1, 1))
for k, frame in enumerate(shown):
    ax = fig.add_subplot(grid[0, k])
    ax.imshow(avatar.render(dict(zip(names, take.weights[frame], strict=True)), size=180))
    ax.set_title(f"{times[frame]:.1f} s", fontsize=9)
    ax.axis("off")
ax = fig.add_subplot(grid[1, :])
for name in ("browInnerUpLeft", "jawOpen", "mouthSmileLeft"):
    ax.plot(times, take.weights[:, names.index(name)], label=name)
ax.set(xlabel="s", ylabel="weight")
ax.legend(fontsize=8)
plt.show()

# %% [markdown]
# *Figure: Six frames of a man who is surprised and then smiles, above the curves of three weights, which rise and fall
# in the shape of an S.*
#
# ## 2. Somebody else's face
#
# Phones measure 52 such weights of an actor (ARKit; the app *Live Link Face* writes them as `.csv`). As weights mean
# the same on every face, the recording drives any head. Our take written and read again:

# %%
write_live_link(folder / "take.csv", take, fps=fps)
again = read_live_link(folder / "take.csv", fps=fps)
csv_difference = float(np.abs(again.weights - take.weights).max())
header = (folder / "take.csv").read_text(encoding="utf-8").splitlines()[0].split(",")
print(f"{len(header)} columns: {', '.join(header[:6])} ...; read again: the same within {csv_difference:.0e}")

# %% [markdown]
# Without such a phone there are landmarks (lesson 2). What weights explain the points $q$ of a frame? In the frame of
# the head, each weight moves the landmarks along known directions, so with $A$ (two rows a landmark, a column an
# expression)
#
# $$ \min_{0 \le w \le 1} \lVert A w - (q - q_0) \rVert^2 + \rho\,\lVert w \rVert^2 . $$
#
# Bounds and the small $\rho$ matter: 68 points see many expressions badly (who puffs a cheek moves no landmark), and
# what is not seen must be quiet. To test it, the avatar itself is the actor: its landmarks are seen by the camera of
# its picture, with a noise of a fifth of a pixel.

# %%
rng = np.random.default_rng(0)
camera, points = avatar.face.camera, avatar.face.landmark_vertices
film = np.array([camera.project(animator.frame(row)[points]) for row in take.weights])
film += rng.normal(0, 0.2, film.shape)

rig = avatar.rig
at_rest = camera.project(rig.neutral[points])
A = np.array([(camera.project((rig.neutral + delta)[points]) - at_rest).ravel() for delta in rig.deltas]).T
rho = 1.0  # px^2: the noise of a point against weights of size one
stacked = np.vstack([A, np.sqrt(rho) * np.eye(A.shape[1])])


def explained(q: np.ndarray) -> np.ndarray:
    return lsq_linear(stacked, np.r_[(q - at_rest).ravel(), np.zeros(A.shape[1])], bounds=(0, 1)).x


ours = np.array([explained(q) for q in film])
theirs = tg.LandmarkDriver(avatar).frames(film, fps)[:, : len(rig.names)]
truth = take.weights[:, : len(rig.names)]
error_ours, error_theirs = (float(np.sqrt(((w - truth) ** 2).mean())) for w in (ours, theirs))
print(f"weights off by (root mean square): ours {error_ours:.3f}, LandmarkDriver {error_theirs:.3f}")

fig, axes = plt.subplots(1, 3, figsize=(10, 2.7), sharey=True, layout="constrained")
for ax, name in zip(axes, ("browInnerUpLeft", "jawOpen", "mouthSmileLeft"), strict=True):
    k = rig.names.index(name)
    ax.plot(times, truth[:, k], "k", linewidth=3, alpha=0.3, label="truth")
    ax.plot(times, ours[:, k], label="ours")
    ax.plot(times, theirs[:, k], label="LandmarkDriver")
    ax.set_title(name, fontsize=10)
    ax.set_xlabel("s")
axes[0].legend(fontsize=8)
plt.show()

# %% [markdown]
# *Figure: Three weights over time, the truth as a broad grey line; our estimates follow it with a jitter, the library's
# without.*
#
# The library also finds the pose of the head in each frame (here it is known), smooths the landmarks *in the frame of
# the head* by a One-Euro filter, both ways, and tells the noise from the residuals.
# `tg.VideoDriver().take(tg.read_video(...))` does all of that on a film.
#
# ## 3. Speech
#
# A *viseme* is what a sound looks like: PP for p, b and m (lips closed), aa for an open mouth, and so on, fifteen in
# all. Shown one after the other they make a puppet; people prepare the next sound while the last still sounds. Cohen
# and Massaro (1993) let each segment $s$ with its weights $T_s$ *dominate* in its time and fade before and after:
#
# $$ F(t) = \frac{\sum_s D_s(t)\,T_s}{\sum_s D_s(t) + D_0}, \qquad
#    D_s(t) = \alpha_s \exp\!\big(-\delta_s(t)/\theta_s\big), $$
#
# where $\delta_s(t)$ is the time from $t$ to the middle half of the segment, $\theta_s$ its reach (one before, one
# after), and $D_0 = 0.02$ a mouth at rest. A lip closure has a large $\alpha$ and a short reach: it wins, but only for
# a moment. One rule is added: where lips must meet, they meet however far the jaw is open (`mouthClose`).

# %%
spoken = ["sil", "PP", "aa", "PP", "aa", "sil"]  # "mama"
starts = np.array([0.0, 0.15, 0.25, 0.48, 0.58, 0.85])
ends = np.array([0.15, 0.25, 0.48, 0.58, 0.85, 1.0])
speech = tg.speak(VisemeTrack(tuple(spoken), starts, ends), fps=100)

with open(data_path("data_templates/visemes.csv"), encoding="utf-8", newline="") as file:
    table = {row["viseme"]: row for row in csv.DictReader(line for line in file if not line.startswith("#"))}
alpha = np.array([float(table[name]["strength"]) for name in spoken])
before, after = (np.array([float(table[name][key]) for name in spoken]) / 1000 for key in ("before", "after"))
T = np.array([weights_of(tg.preset(f"viseme_{name}")) for name in spoken])

t = speech.times[:, None]
quarter = (ends - starts) / 4
away = np.maximum(starts + quarter - t, 0) / before + np.maximum(t - (ends - quarter), 0) / after
D = alpha * np.exp(-away)  # (frames, segments)
total = D.sum(1, keepdims=True) + 0.02
F = D @ T / total
jaw, seal = names.index("jawOpen"), names.index("mouthClose")
meeting = D[:, [name == "PP" for name in spoken]].sum(1) / total[:, 0]
F[:, seal] = np.maximum(F[:, seal], meeting * F[:, jaw])
speech_difference = float(np.abs(np.clip(F, 0, 1) - speech.weights).max())
print(f"by hand and by speak: the same within {speech_difference:.0e}")

fig, axes = plt.subplots(2, 1, figsize=(8, 4.2), sharex=True, layout="constrained")
for k, name in enumerate(spoken):
    axes[0].plot(speech.times, D[:, k], label=name, color=f"C{['sil', 'PP', 'aa'].index(name)}")
    axes[0].text((starts[k] + ends[k]) / 2, 8.4, name, ha="center", fontsize=9)
axes[0].set(ylabel="dominance", ylim=(0, 9.5))
axes[1].plot(speech.times, speech.weights[:, jaw], label="jawOpen")
axes[1].plot(speech.times, speech.weights[:, seal], label="mouthClose")
axes[1].set(xlabel="s", ylabel="weight")
axes[1].legend(fontsize=8)
plt.show()

# %% [markdown]
# *Figure: Above, the dominance of the segments of "mama": twice a high narrow peak for the lips, then a low broad one
# for the vowel. Below, the jaw, which opens twice, and the seal of the lips, which rises wherever the jaw is open
# beside a PP.*
#
# The jaw begins to open before the `aa` does, while the lips are still to be closed: there the seal holds them
# together. `tg.speak("hello.json")` reads the timings of Rhubarb, TalkingHead or Azure; with a sound alone,
# `tg.speak(sound="hello.wav")`, jaw and lips follow loudness and formants.
#
# ## 4. Files
#
# **GLB** is glTF in one file: a header of 12 bytes, then chunks, each with its length and kind. The first is JSON and
# says what lies where in the second. Expressions are *morph targets*, the $\Delta_k$ from above, in metres. A take can
# go along.

# %%
glb = folder / "head.glb"
avatar.save(glb, animation=(take.times, take.weights))
content = glb.read_bytes()
magic, version, length = struct.unpack("<4sII", content[:12])
json_length, kind = struct.unpack("<I4s", content[12:20])
document = json.loads(content[20 : 20 + json_length])
targets = next(mesh["extras"]["targetNames"] for mesh in document["meshes"] if "extras" in mesh)
print(magic, kind, f"version {version}; the length is right: {length == len(content)}")
print(f"{len(targets)} targets: {', '.join(targets[:4])} ...; {len(document['animations'])} animation")

back = tg.load_avatar(glb)
glb_difference = float(np.abs(back.vertices({"jawOpen": 0.7}) - avatar.vertices({"jawOpen": 0.7})).max())
print(f"read again: vertices the same within {glb_difference:.1e} mm")

# %% [markdown]
# **VRM** is a GLB with more words: which node is which bone of a person, and which targets make `happy`, `blink` or
# `aa`. So programs for VTubers need not know our names. **HTML** is a page with sliders that asks nothing of a
# network.

# %%
avatar.save(folder / "head.vrm")
avatar.save(folder / "head.html", title="A head to play with")
vrm = (folder / "head.vrm").read_bytes()
words = json.loads(vrm[20 : 20 + struct.unpack("<I", vrm[12:16])[0]])["extensions"]["VRMC_vrm"]
presets = sorted(words["expressions"]["preset"])
print(f"{len(words['humanoid']['humanBones'])} bones; expressions: {', '.join(presets)}")
page = (folder / "head.html").read_text(encoding="utf-8")
asks = any(word in page for word in ('src="http', 'href="http', "@import", 'src="//'))
print(f"the page: {len(page) / 1e6:.1f} MB, loads anything from elsewhere: {asks}")

# %% [markdown]
# In JupyterLab, `avatar.show()` is that page in a frame, and `tg.AvatarWidget(avatar)` one whose `weights` Python and
# the sliders share. They are not shown here, as a notebook with such a page in it is some megabytes large. On a
# command line: `toongeo drive face.glb --weights take.csv -o take.mp4`, `toongeo speak face.glb --visemes hello.json
# -o hello.mp4`, `toongeo view face.glb`.
#
# ## Exercises
#
# 1. What is the largest acceleration of `jawOpen` with straight lines between the keys, and with the S? Try 30 and 120
#    frames a second.
# 2. Take coarticulation away: let each segment have its own weights between `start` and `end`, and nothing else. How
#    fast must the jaw be, in mm a second at the chin? And with it?
# 3. In section 2, leave out the bounds, then $\rho$. Which weights go astray?
# 4. `avatar.save(..., quantize=True)` stores displacements as integers of 16 bits. How much smaller is the file, and
#    by how much are expressions off?
#
# ## Solutions
#
# **1.** A corner has no acceleration: by differences it grows with the frame rate. That of the S is at most
# $6\,|\Delta w| / T^2$, as the second derivative of $3\tau^2 - 2\tau^3$ is $6 - 12\tau$.

# %%
shapes = {"lines": lambda x: x, "S": lambda x: 3 * x**2 - 2 * x**3}
top, span = keys[1][1]["jawOpen"], 0.4
acceleration = {}
for rate in (30.0, 120.0):
    x = np.clip(np.arange(-0.2, 0.6 + 0.5 / rate, 1 / rate) / span, 0, 1)
    for name, shape in shapes.items():
        acceleration[name, rate] = float(np.abs(np.diff(top * shape(x), 2)).max() * rate**2)
print("largest acceleration, weight/s²:", end=" ")
print(", ".join(f"{name} at {rate:.0f} Hz {value:.1f}" for (name, rate), value in acceleration.items()))
print(f"bound for the S: {6 * top / span**2:.1f} weight/s²")

# %% [markdown]
# **2.** Of a step the speed is again a matter of the frame rate: there is no such jaw.

# %%
chin = int(points[8])
now = (starts <= t) & (t < ends)
stepped = now.astype(float) @ T


def chin_speed(weights: np.ndarray) -> float:
    """Largest speed of the chin, mm a second."""
    way = weights @ deltas[:, chin].astype(float)
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).max() * 100)


speed_stepped, speed_spoken = chin_speed(stepped), chin_speed(speech.weights)
print(f"stepped: {speed_stepped:.0f} mm/s; with coarticulation: {speed_spoken:.0f} mm/s")

# %% [markdown]
# **3.** What should be zero tells: the sum of the absolute weights of all expressions that the actor does not use,
# mean of the frames, and which of them are largest. Without bounds opposites pay for each other, one of them negative;
# without $\rho$ also what hardly moves a landmark gets a weight.

# %%
differences = (film - at_rest).reshape(len(film), -1).T
free = np.linalg.solve(A.T @ A + rho * np.eye(A.shape[1]), A.T @ differences).T
wild = np.linalg.lstsq(A, differences, rcond=None)[0].T
unused = ~truth.any(axis=0)
astray = [float(np.abs(w[:, unused]).sum(1).mean()) for w in (ours, free, wild)]
for label, sum_unused, w in zip(("bounds and rho", "rho alone", "neither"), astray, (ours, free, wild), strict=True):
    print(f"{label:15s} unused expressions: {sum_unused:.2f}; least weight {w.min():+.2f}", end="; ")
    mean_size = np.where(unused, np.abs(w).mean(axis=0), 0)
    print("largest:", ", ".join(rig.names[k] for k in np.argsort(mean_size)[:-4:-1]))

# %% [markdown]
# **4.** Two thirds of the file are displacements. They take two bytes in place of four, small ones become zero, and
# what does not move is not stored. Places of vertices shrink as well.

# %%
avatar.save(folder / "small.glb", quantize=True)
avatar.save(folder / "plain.glb")
sizes = [(folder / name).stat().st_size for name in ("small.glb", "plain.glb")]
small = tg.load_avatar(folder / "small.glb")
quantized_off = max(
    float(np.abs(small.vertices({name: 1.0}) - avatar.vertices({name: 1.0})).max())
    for name in ("jawOpen", "cheekPuffLeft")
)
print(f"{sizes[0] / 1e6:.1f} MB against {sizes[1] / 1e6:.1f} MB; off by {quantized_off:.3f} mm at most")

# %%
numbers: dict[str, float] = {
    "sum_difference_mm": sum_difference,
    "csv_difference": csv_difference,
    "weights_error_ours": error_ours,
    "weights_error_library": error_theirs,
    "speech_difference": speech_difference,
    "lips_seal": float(speech.weights[:, seal].max()),
    "targets": float(len(targets)),
    "glb_is_whole": float(length == len(content) and magic == b"glTF"),
    "glb_difference_mm": glb_difference,
    "vrm_expressions": float(len(presets)),
    "page_from_elsewhere": float(asks),
    "corner_grows": acceleration["lines", 120.0] / acceleration["lines", 30.0],
    "s_over_bound": acceleration["S", 120.0] / (6 * top / span**2),
    "speed_stepped": speed_stepped,
    "speed_spoken": speed_spoken,
    "astray_bounded": astray[0],
    "astray_free": astray[1],
    "astray_wild": astray[2],
    "quantized_off_mm": quantized_off,
    "quantized_size": sizes[0] / sizes[1],
}
