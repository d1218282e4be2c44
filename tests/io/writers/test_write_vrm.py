"""VRM of any scene with eyes; what three-vrm makes of it is tested with an avatar."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.io import Scene, VrmMeta, read_glb, write_vrm


@pytest.fixture
def eyes(scene):
    """The scene with both eyes on pivots."""
    right = replace(scene.meshes[2], pivot=np.array([-30.0, 0.0, 5.0]))
    return Scene((*scene.meshes[:2], right, scene.meshes[3]), scene.animation)


def test_presets_and_other_names_are_told_apart(tmp_path, eyes):
    expressions = {"aa": {"jawOpen": 0.5}, '"><script>': {"jawOpen": 1.0, "nothing": 2.0}, "neutral": {}}
    write_vrm(tmp_path / "a.vrm", eyes, expressions)
    vrm = read_glb(tmp_path / "a.vrm").json["extensions"]["VRMC_vrm"]
    assert vrm["specVersion"] == "1.0"
    assert set(vrm["expressions"]["preset"]) == {"aa", "neutral"}
    assert vrm["expressions"]["preset"]["aa"]["morphTargetBinds"] == [{"node": 0, "index": 0, "weight": 0.5}]
    assert "morphTargetBinds" not in vrm["expressions"]["preset"]["neutral"]
    (custom,) = vrm["expressions"]["custom"].items()
    assert custom[0] == '"><script>' and [bind["weight"] for bind in custom[1]["morphTargetBinds"]] == [1.0, 1.0]
    assert vrm["lookAt"]["rangeMapVerticalUp"] == {"inputMaxValue": 90.0, "outputScale": 25.0}


def test_emotions_take_the_place_of_what_moves_the_same_parts(tmp_path, eyes):
    """Otherwise players add a blink to a wide eye, which then stays open."""
    head = next(mesh for mesh in eyes.meshes if mesh.target_names)
    names = ("jawOpen", "eyeWideLeft", "mouthSmileLeft")
    targets = np.zeros((3, *head.vertices.shape))
    moving = replace(head, targets=targets, target_names=names)
    scene = Scene(tuple(moving if mesh is head else mesh for mesh in eyes.meshes))
    wide, open_, smile = ({name: 1.0} for name in ("eyeWideLeft", "jawOpen", "mouthSmileLeft"))
    write_vrm(
        tmp_path / "a.vrm", scene, {"surprised": wide | open_, "happy": smile, "blink": wide, "aa": open_, "mine": wide}
    )
    vrm = read_glb(tmp_path / "a.vrm").json["extensions"]["VRMC_vrm"]["expressions"]
    found = {name: entry for group in vrm.values() for name, entry in group.items()}
    kinds = ("overrideBlink", "overrideLookAt", "overrideMouth")
    assert {name: [entry[kind] for kind in kinds] for name, entry in found.items()} == {
        "surprised": ["blend", "none", "blend"],
        **{name: ["none", "none", "none"] for name in ("happy", "blink", "aa", "mine")},
    }


def test_it_is_valid_and_always_the_same(tmp_path, eyes, node):
    write_vrm(tmp_path / "a.vrm", eyes, {"aa": {"jawOpen": 1.0}}, normal_deltas=True, picture="jpeg")
    write_vrm(tmp_path / "b.vrm", eyes, {"aa": {"jawOpen": 1.0}}, normal_deltas=True, picture="jpeg")
    assert (tmp_path / "a.vrm").read_bytes() == (tmp_path / "b.vrm").read_bytes()
    (verdict,) = node("validate.mjs", tmp_path / "a.vrm")
    assert (verdict["errors"], verdict["warnings"]) == (0, 0), verdict["messages"]


def test_what_does_not_fit_is_refused(tmp_path, eyes):
    with pytest.raises(ValueError, match="expressions: expected targets of the scene in 'aa', got 'jawOpne'"):
        write_vrm(tmp_path / "a.vrm", eyes, {"aa": {"jawOpne": 1.0}})
    with pytest.raises(ValueError, match="scene: expected a mesh 'eye_left' with a pivot, got head"):
        write_vrm(tmp_path / "a.vrm", Scene(eyes.meshes[:1]), {})
    unpivoted = Scene((replace(eyes.meshes[1], pivot=None), eyes.meshes[2]))
    with pytest.raises(ValueError, match="scene: expected a mesh 'eye_left' with a pivot"):
        write_vrm(tmp_path / "a.vrm", unpivoted, {})
    with pytest.raises(OSError, match="nowhere"):
        write_vrm(tmp_path / "nowhere" / "a.vrm", eyes, {})
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"name": ""}, "name: expected str, got ''"),
        ({"authors": ()}, r"authors: expected names, got \(\)"),
        ({"authors": ["a"]}, r"authors: expected names, got \['a'\]"),
        ({"authors": ("",)}, "authors: expected names"),
        ({"avatar_permission": "all"}, "avatar_permission: expected onlyAuthor or onlySeparatelyLicensedPerson or"),
        ({"allow_redistribution": 1}, "allow_redistribution: expected bool, got 1"),
        ({"version": 3}, "version: expected str, got 3"),
    ],
)
def test_bad_licences_are_refused(fields, message):
    with pytest.raises(ValueError, match=message):
        VrmMeta(**fields)


def test_empty_texts_are_left_out():
    entry = VrmMeta(version="2", contact_information="a@b").entry()
    assert entry["version"] == "2" and entry["contactInformation"] == "a@b" and "thirdPartyLicenses" not in entry
    assert entry["licenseUrl"] == "https://vrm.dev/licenses/1.0/"
