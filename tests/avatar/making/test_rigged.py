import dataclasses

from toongeo.avatar.making.rigged import mouth_warnings, posed


def test_teeth_and_tongue_lie_in_the_picture_as_the_pose_has_them(avatars):
    avatar = avatars("astronaut")
    shown = avatar.rig.vertices(avatar.rig.pose)
    for part in ("teeth_upper", "teeth_lower", "tongue"):
        assert abs(avatar.face.vertices - shown)[avatar.face.region(part)].max() == 0, part


def test_a_face_at_rest_keeps_its_vertices(avatar):
    face, rig = posed(avatar.face, avatar.rig)
    assert face is avatar.face and not rig.pose.any()


def test_it_is_said_when_lips_do_not_close(avatars):
    avatar = avatars("astronaut")
    assert mouth_warnings(avatar.face, avatar.rig) == []
    half = avatar.rig.neutral + 0.6 * (avatar.face.vertices - avatar.rig.neutral)
    (said,) = mouth_warnings(avatar.face, dataclasses.replace(avatar.rig, neutral=half))
    assert said.startswith("the lips are ") and "of the mouth's width apart at rest" in said


def test_of_a_mouth_that_is_drawn_closed_nothing_is_said(avatar):
    assert mouth_warnings(avatar.face, avatar.rig) == []
