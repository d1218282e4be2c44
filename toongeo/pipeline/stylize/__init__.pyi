"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.stylize.match_style import match_style as match_style
from toongeo.pipeline.stylize.style import STYLES as STYLES
from toongeo.pipeline.stylize.style import Style as Style
from toongeo.pipeline.stylize.stylize import stylize as stylize
from toongeo.pipeline.stylize.velocity_warp import VelocityWarp as VelocityWarp
