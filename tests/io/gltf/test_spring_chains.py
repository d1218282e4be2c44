from dataclasses import replace

import numpy as np
import pytest

from toongeo.io import Scene, SpringChains, read_glb, write_vrm


def chains(n):
    joints = np.array([[[50.0, -100, -60], [50, -130, -60], [50, -160, -60]]])
    weights = np.zeros((n, 1, 2))
    weights[0] = [[0.25, 0.5]]
    return SpringChains(joints, weights)


def test_a_file_says_what_follows_what(tmp_path, scene):
    """Head and two bones share the first vertex as told; all others are the head's."""
    right = replace(scene.meshes[2], pivot=np.array([-30.0, 0.0, 5.0]))
    head = replace(scene.meshes[0], springs=chains(len(scene.meshes[0].vertices)))
    write_vrm(tmp_path / "a.vrm", Scene((head, scene.meshes[1], right)), {})
    document = read_glb(tmp_path / "a.vrm")
    nodes = document.json["nodes"]
    (spring,) = document.json["extensions"]["VRMC_springBone"]["springs"]
    names = [nodes[joint["node"]]["name"] for joint in spring["joints"]]
    assert names == ["head_0_0", "head_0_1", "head_0_2"]
    np.testing.assert_allclose(nodes[spring["joints"][1]["node"]]["translation"], [0, -0.03, 0], atol=1e-7)
    attributes = document.json["meshes"][0]["primitives"][0]["attributes"]
    bones, shares = (document.accessors[attributes[name]] for name in ("JOINTS_0", "WEIGHTS_0"))
    assert (shares.sum(1, dtype=int) == 255).all()
    skin = [nodes[k]["name"] for k in document.json["skins"][0]["joints"]]
    told = {skin[bone]: share for bone, share in zip(bones[0], shares[0], strict=True) if share}
    assert told == {"Head": 63, "head_0_0": 63, "head_0_1": 129}  # what rounding leaves is the largest share's
    assert {skin[bone] for bone in bones[-1, shares[-1] > 0]} == {"Head"}


def test_a_file_says_what_chains_stay_out_of(tmp_path, scene):
    """A capsule of the head's bone, in its frame; all chains of the mesh know of it, and no group without one."""
    right = replace(scene.meshes[2], pivot=np.array([-30.0, 0.0, 5.0]))
    springs = replace(chains(len(scene.meshes[0].vertices)), capsules=np.array([[0.0, -90, -20, 0, -160, -30, 45]]))
    write_vrm(tmp_path / "a.vrm", Scene((replace(scene.meshes[0], springs=springs), scene.meshes[1], right)), {})
    document = read_glb(tmp_path / "a.vrm").json
    entry = document["extensions"]["VRMC_springBone"]
    (collider,), (group,) = entry["colliders"], entry["colliderGroups"]
    assert group["colliders"] == [0] and entry["springs"][0]["colliderGroups"] == [0]
    assert document["nodes"][collider["node"]]["name"] == "Head"
    capsule = collider["shape"]["capsule"]
    assert capsule["radius"] == pytest.approx(0.045)
    np.testing.assert_allclose(np.subtract(capsule["tail"], capsule["offset"]), [0, -0.07, -0.01], atol=1e-9)
    parents = {child: k for k, node in enumerate(document["nodes"]) for child in node.get("children", ())}
    place, node = np.array(capsule["offset"]), collider["node"]
    while node is not None:
        place, node = place + document["nodes"][node]["translation"], parents.get(node)
    np.testing.assert_allclose(place, [0, -0.09 + 1.58, -0.02], atol=1e-9)  # the ground is 1.58 m below the eyes


@pytest.mark.parametrize("capsules", [np.zeros((1, 6)), np.zeros((1, 7)), np.full((1, 7), np.nan)])
def test_capsules_that_cannot_be_are_refused(capsules):
    with pytest.raises(ValueError, match="capsules: expected"):
        SpringChains(np.zeros((1, 2, 3)), np.zeros((4, 1, 1)), capsules)


@pytest.mark.parametrize(
    ("joints", "weights", "message"),
    [
        (np.zeros((1, 1, 3)), np.zeros((4, 1, 0)), r"joints: expected \(c, k >= 2, 3\), got \(1, 1, 3\)"),
        (np.zeros((1, 3, 3)), np.zeros((4, 1, 1)), r"weights: expected \(n, 1, 2\), got \(4, 1, 1\)"),
        (np.full((1, 2, 3), np.nan), np.zeros((4, 1, 1)), "joints: expected finite numbers"),
        (np.zeros((1, 2, 3)), np.full((4, 1, 1), 1.1), "weights: expected shares"),
        (np.zeros((1, 2, 3)), np.full((4, 1, 1), -0.1), "weights: expected shares"),
    ],
)
def test_what_cannot_be_is_refused(joints, weights, message):
    with pytest.raises(ValueError, match=message):
        SpringChains(joints, weights)


def test_chains_of_another_mesh_are_refused(scene):
    with pytest.raises(ValueError, match="springs of mesh 'head': expected weights of"):
        replace(scene.meshes[0], springs=chains(3))
