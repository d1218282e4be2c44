"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.protocols.cameras import Camera as Camera
from toongeo.protocols.cameras import HeadCamera as HeadCamera
from toongeo.protocols.coefficients import Coefficients as Coefficients
from toongeo.protocols.coefficients import Regressor as Regressor
from toongeo.protocols.expressions import ExpressionDriver as ExpressionDriver
from toongeo.protocols.expressions import LandmarkMapper as LandmarkMapper
from toongeo.protocols.face_parse import FaceLabel as FaceLabel
from toongeo.protocols.face_parse import FaceParse as FaceParse
from toongeo.protocols.face_parse import FaceParser as FaceParser
from toongeo.protocols.face_parse import HairFinder as HairFinder
from toongeo.protocols.face_parse import HairMask as HairMask
from toongeo.protocols.faces import FittedFace as FittedFace
from toongeo.protocols.faces import HairModeler as HairModeler
from toongeo.protocols.landmarks import LandmarkDetection as LandmarkDetection
from toongeo.protocols.landmarks import LandmarkDetector as LandmarkDetector
from toongeo.protocols.stylizers import PictureWarp as PictureWarp
from toongeo.protocols.stylizers import Stylized as Stylized
from toongeo.protocols.stylizers import Stylizer as Stylizer
from toongeo.protocols.textures import TextureGenerator as TextureGenerator
from toongeo.protocols.textures import TextureGeometry as TextureGeometry
