"""To trimesh, and through its files back."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from toongeo.colour.srgb import srgb_to_linear
from toongeo.geometry import vertex_normals
from toongeo.io import Scene, read_mesh, trimesh_scene


def test_bare_meshes_keep_their_numbers(scene):
    got = trimesh_scene(scene, textured=False)
    assert isinstance(got, trimesh.Scene) and list(got.geometry) == [mesh.name for mesh in scene.meshes]
    for mesh in scene.meshes:
        found = got.geometry[mesh.name]
        np.testing.assert_array_equal(found.vertices, mesh.vertices)
        np.testing.assert_array_equal(found.faces, mesh.faces)
        np.testing.assert_array_equal(got.graph[mesh.name][0], np.eye(4))
        found.vertices += 1.0  # writable, and not the scene's own
        assert not np.array_equal(found.vertices, mesh.vertices)
    assert got.units == "millimeters"


def test_textured_meshes_have_the_same_corners_uv_and_normals(scene):
    got = trimesh_scene(scene)
    for mesh in scene.meshes:
        found = got.geometry[mesh.name]
        np.testing.assert_array_equal(found.vertices[found.faces], mesh.vertices[mesh.faces])
        normals = vertex_normals(mesh.vertices, mesh.faces)
        np.testing.assert_allclose(found.vertex_normals[found.faces], normals[mesh.faces], atol=1e-12)
        material = found.visual.material
        np.testing.assert_allclose(
            np.array(material.baseColorFactor) / 255, [*srgb_to_linear(mesh.color), 1], atol=0.5 / 255
        )
        assert material.roughnessFactor == pytest.approx(mesh.roughness) and material.metallicFactor == 0
        if mesh.texture is None:
            assert material.baseColorTexture is None
        else:
            np.testing.assert_array_equal(found.visual.uv[found.faces], mesh.uv[mesh.uv_faces])
            np.testing.assert_array_equal(np.array(material.baseColorTexture), mesh.texture)


def test_a_shared_texture_stays_one(scene):
    head, *_, teeth = scene.meshes  # their textures are the same pixels in two arrays

    def pictures(scene):
        made = trimesh_scene(scene).geometry
        return [made[name].visual.material.baseColorTexture for name in (head.name, teeth.name)]

    apart = pictures(scene)
    assert apart[0] is not apart[1]
    shared = pictures(Scene((head, replace(teeth, texture=head.texture))))
    assert shared[0] is shared[1]


def test_through_a_file_of_trimesh(tmp_path, scene):
    trimesh_scene(scene).export(tmp_path / "a.glb")
    got = {mesh.name: mesh for mesh in read_mesh(tmp_path / "a.glb").meshes}
    assert set(got) == {mesh.name for mesh in scene.meshes}
    for mesh in scene.meshes:
        found = got[mesh.name]
        np.testing.assert_allclose(found.vertices[found.faces], mesh.vertices[mesh.faces], rtol=1e-6, atol=1e-5)
        if mesh.texture is not None:
            np.testing.assert_array_equal(found.texture, mesh.texture)
            np.testing.assert_allclose(found.uv[found.uv_faces], mesh.uv[mesh.uv_faces], atol=1e-6)
