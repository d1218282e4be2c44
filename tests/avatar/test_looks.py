"""How avatars look in other people's viewers: lit or as drawn, closed below."""

import dataclasses

import numpy as np
import pytest

from toongeo.avatar.looks.drawn_look import drawn_look, flatness
from toongeo.avatar.looks.neck_cap import neck_cap
from toongeo.avatar.scene import avatar_scene
from toongeo.io import glb_scene, read_glb
from toongeo.render import rasterize


@pytest.fixture(scope="module")
def cap(avatar):
    return neck_cap(avatar.face.model, avatar.rig, avatar.texture)


def open_edges(vertices, faces):
    """Directed edges, by the places of their ends, that no other face runs along the other way."""
    places = np.unique(vertices.round(6), axis=0, return_inverse=True)[1].reshape(-1)
    corners = places[faces]
    edges = {(int(a), int(b)) for i in range(3) for a, b in zip(corners[:, i], corners[:, (i + 1) % 3], strict=True)}
    return {(a, b) for a, b in edges if (b, a) not in edges}, places


def test_skin_and_cap_are_closed_below(avatar, cap):
    """Of the edges that only one triangle of the skin has, none is left at the neck; those of the eyes are."""
    skin, model = avatar.rig.neutral, avatar.face.model
    before, _ = open_edges(skin, avatar.faces)
    points = np.vstack([skin, cap.vertices])
    after, places = open_edges(points, np.vstack([avatar.faces, cap.faces + len(skin)]))
    neck = set(places[: len(skin)][model.region("neck")].tolist())
    assert len(before) - len(after) == len(cap.faces) == 84
    assert not any(a in neck and b in neck for a, b in after)


def test_the_cap_looks_down_and_stays_behind_the_skin(avatar, cap):
    a, b, c = (cap.vertices[cap.faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a).sum(axis=0)
    assert normal[1] < 0 and abs(normal[0]) < 0.05 * abs(normal[1])
    below = np.column_stack([cap.vertices[:, [0, 2]] * [1, -1], -cap.vertices[:, 1]])
    assert rasterize(below + [100, 0, 0], cap.faces, 200, 200, cull_back=True).mask.sum() > 1000


def test_no_expression_parts_skin_and_cap(avatar, cap):
    moved = np.abs(avatar.rig.deltas).max(axis=(0, 2))
    rim = (avatar.rig.neutral[:, None] == cap.vertices[None, :-1]).all(axis=2).any(axis=1)
    assert rim.sum() == 84 and moved[rim].max() < 1e-6


def test_a_model_without_neck_gets_no_cap(avatar):
    model = avatar.face.model
    bare = dataclasses.replace(model, regions={k: v for k, v in model.regions.items() if k != "neck"})
    assert neck_cap(bare, avatar.rig, avatar.texture) is None
    assert "neck_cap" not in {mesh.name for mesh in avatar_scene(avatar, crop="face").meshes}


def test_drawings_are_told_from_photographs(avatars):
    assert drawn_look(avatars("moustache_man")) and not drawn_look(avatars("astronaut"))


def test_noise_is_not_flat_and_an_empty_texture_is(avatar, rng):
    grain = rng.integers(0, 256, avatar.texture.shape, dtype=np.uint8)
    assert flatness(dataclasses.replace(avatar, texture=grain)) < 0.4
    assert flatness(dataclasses.replace(avatar, texture=np.full_like(avatar.texture, 90))) == 1.0


@pytest.mark.parametrize("suffix", [".glb", ".vrm"])
@pytest.mark.parametrize("unlit", [True, False, "auto"])
def test_files_say_whether_they_are_lit(avatar, tmp_path, node, suffix, unlit):
    path = tmp_path / f"a{suffix}"
    avatar.save(path, unlit=unlit, texture=None)
    document = read_glb(path).json
    kinds = {tuple(material.get("extensions", {})) for material in document["materials"]}
    as_drawn = drawn_look(avatar) if unlit == "auto" else unlit
    toon = "KHR_materials_unlit" if suffix == ".glb" else "VRMC_materials_mtoon"
    assert kinds == {(toon if as_drawn else "KHR_materials_specular",)}
    (verdict,) = node("validate.mjs", path)
    assert (verdict["errors"], verdict["warnings"]) == (0, 0)
    if suffix == ".glb":
        meshes = glb_scene(read_glb(path)).meshes
        assert {mesh.unlit for mesh in meshes} == {as_drawn}
        assert {mesh.specular for mesh in meshes} == ({1.0} if as_drawn else {0.2})


def test_another_look_is_refused(avatar, tmp_path):
    with pytest.raises(ValueError, match="unlit: expected True, False or 'auto', got 'dark'"):
        avatar.save(tmp_path / "a.glb", unlit="dark")
    assert not list(tmp_path.iterdir())
