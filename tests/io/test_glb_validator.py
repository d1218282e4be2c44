"""The Khronos validator finds nothing to say, and three.js moves the vertices as far as they should go."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.io import Scene, SceneMesh, write_glb


def large_scene():
    """More vertices than 16 bits count, one target of them all."""
    n = 70_000
    v = np.random.default_rng(1).standard_normal((n, 3))
    f = np.arange(n - n % 3).reshape(-1, 3)
    targets = np.zeros((2, n, 3), np.float32)
    targets[0, -5:] = 1
    targets[1] = 1
    return Scene((SceneMesh("large", v, f, targets=targets, target_names=("few", "all")),))


@pytest.mark.parametrize("normal_deltas", [False, True])
@pytest.mark.parametrize("still", [False, True])
def test_valid(tmp_path, node, scene, normal_deltas, still):
    write_glb(tmp_path / "a.glb", replace(scene, animation=None) if still else scene, normal_deltas=normal_deltas)
    (verdict,) = node("validate.mjs", tmp_path / "a.glb")
    assert verdict["messages"] == []
    assert verdict["info"]["hasMorphTargets"] and verdict["info"]["hasTextures"]
    assert verdict["info"]["animationCount"] == (0 if still else 1)


def test_large_and_degenerate_meshes_are_valid(tmp_path, node):
    write_glb(tmp_path / "large.glb", large_scene())
    flat = SceneMesh("flat", np.zeros((4, 3)), np.array([[0, 1, 2], [3, 3, 3]]))
    write_glb(tmp_path / "flat.glb", Scene((flat,)))
    for verdict in node("validate.mjs", tmp_path / "large.glb", tmp_path / "flat.glb"):
        assert verdict["errors"] == verdict["warnings"] == 0, verdict["messages"]


def test_validator_sees_a_fault(tmp_path, node, scene):
    """So that its silence means something."""
    write_glb(tmp_path / "a.glb", scene)
    content = (tmp_path / "a.glb").read_bytes()
    (tmp_path / "a.glb").write_bytes(content.replace(b'"count":', b'"c0unt":'))
    (verdict,) = node("validate.mjs", tmp_path / "a.glb")
    assert verdict["errors"] > 0


def test_three_js_moves_it(tmp_path, node, scene):
    write_glb(tmp_path / "a.glb", scene)
    (report,) = node("load.mjs", tmp_path / "a.glb")
    assert [mesh["name"] for mesh in report["meshes"]] == [mesh.name for mesh in scene.meshes]
    for got, mesh in zip(report["meshes"], scene.meshes, strict=True):
        assert got["triangles"] == len(mesh.faces) and not got["doubleSided"]
        assert got["textured"] == (mesh.texture is not None)
        assert tuple(got["targets"]) == mesh.target_names
        assert not any(got["influences"])
        pivot = np.zeros(3) if mesh.pivot is None else mesh.pivot
        np.testing.assert_allclose(got["position"], pivot * 1e-3, atol=1e-7)
        bounds = np.array([mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)])
        np.testing.assert_allclose(got["bounds"], (bounds - pivot) * 1e-3, atol=1e-7)
        for name, delta in zip(mesh.target_names, () if mesh.targets is None else mesh.targets, strict=True):
            farthest = np.linalg.norm(delta, axis=1).max() * 1e-3
            np.testing.assert_allclose(got["reach"][name], farthest, rtol=1e-4, atol=1e-9)
    (clip,) = report["animations"]
    assert clip["duration"] == 2 and clip["tracks"] == 4
    np.testing.assert_allclose(clip["halfway"][0], scene.animation.weights["head"][2], rtol=1e-6)
    np.testing.assert_allclose(clip["turns"][2], scene.animation.rotations["eye_right"][2], rtol=1e-6)
