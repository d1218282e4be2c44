"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.driving.arkit_driver import ArkitDriver as ArkitDriver
from toongeo.driving.head_turn import head_quaternions as head_quaternions
from toongeo.driving.head_turn import head_rotation as head_rotation
from toongeo.driving.landmark_driver import LandmarkDriver as LandmarkDriver
from toongeo.driving.landmark_driver import LiveLandmarks as LiveLandmarks
from toongeo.driving.landmark_rig import LandmarkRig as LandmarkRig
from toongeo.driving.live_video import LiveVideo as LiveVideo
from toongeo.driving.puppet.avatar_puppet import AvatarPuppet as AvatarPuppet
from toongeo.driving.puppet.scene_puppet import ScenePuppet as ScenePuppet
from toongeo.driving.puppet.target_columns import target_columns as target_columns
from toongeo.driving.read_live_link import read_live_link as read_live_link
from toongeo.driving.send_weights import send_weights as send_weights
from toongeo.driving.speak import speak as speak
from toongeo.driving.speech.read_visemes import read_visemes as read_visemes
from toongeo.driving.speech.viseme_track import VisemeTrack as VisemeTrack
from toongeo.driving.table.unit_weights import unit_weights as unit_weights
from toongeo.driving.take import Take as Take
from toongeo.driving.video_driver import VideoDriver as VideoDriver
from toongeo.driving.write_live_link import write_live_link as write_live_link
