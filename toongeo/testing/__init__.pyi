"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.testing.check_camera import check_camera as check_camera
from toongeo.testing.check_expression_driver import check_expression_driver as check_expression_driver
from toongeo.testing.check_face_parser import check_face_parser as check_face_parser
from toongeo.testing.check_hair_finder import check_hair_finder as check_hair_finder
from toongeo.testing.check_hair_modeler import check_hair_modeler as check_hair_modeler
from toongeo.testing.check_landmark_detector import check_landmark_detector as check_landmark_detector
from toongeo.testing.check_landmark_mapper import check_landmark_mapper as check_landmark_mapper
from toongeo.testing.check_regressor import check_regressor as check_regressor
from toongeo.testing.check_texture_generator import check_texture_generator as check_texture_generator
