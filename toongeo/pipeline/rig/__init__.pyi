"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.pipeline.rig.animator import Animator as Animator
from toongeo.pipeline.rig.build_rig import build_rig as build_rig
from toongeo.pipeline.rig.eyes.close_lids import close_lids as close_lids
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes as Eyes
from toongeo.pipeline.rig.eyes.fit_eyes import fit_eyes as fit_eyes
from toongeo.pipeline.rig.eyes.fit_lids import fit_lids as fit_lids
from toongeo.pipeline.rig.eyes.keep_lids_outside import keep_lids_outside as keep_lids_outside
from toongeo.pipeline.rig.foreign.rig_mesh import rig_mesh as rig_mesh
from toongeo.pipeline.rig.mouth.fit_mouth import fit_mouth as fit_mouth
from toongeo.pipeline.rig.neutral_face import neutral_face as neutral_face
from toongeo.pipeline.rig.rig import Rig as Rig
from toongeo.pipeline.rig.rig import RigReport as RigReport
