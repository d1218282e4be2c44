"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.avatar.avatar import Avatar as Avatar
from toongeo.avatar.load_avatar import load_avatar as load_avatar
from toongeo.avatar.make_avatar import make_avatar as make_avatar
