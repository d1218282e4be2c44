"""An avatar in a notebook whose weights go both ways."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from toongeo.app.editor.anywidget_adapter import notebook_widget
from toongeo.avatar import Avatar
from toongeo.avatar.avatar import Weights
from toongeo.avatar.save_avatar import avatar_page
from toongeo.model.anatomy.gaze import GAZE_NAMES

__all__ = ["AvatarWidget"]


class AvatarWidget:
    """The page of an avatar in a notebook, moved by code and by hand; needs the extra ``notebook``.

    Show it as the last line of a cell. :attr:`weights` is what its sliders show; assigning to it moves them.

    Parameters
    ----------
    avatar : Avatar
    weights : mapping or array, optional
        Where to start, as for :meth:`toongeo.Avatar.vertices`.
    height : int
        Of the page, px.
    **options
        ``crop quantize texture animation`` as of :meth:`toongeo.Avatar.save` for ``.html``.

    Raises
    ------
    ImportError
        If ``anywidget`` is not installed; names the package.
    ValueError
        For weights as :meth:`toongeo.Avatar.vertices`.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> avatar = tg.make_avatar(img, landmarks, hair=False)
    >>> widget = tg.AvatarWidget(avatar, {"jawOpen": 0.5})  # the last line of a cell shows it
    >>> widget.weights["jawOpen"]
    0.5
    >>> widget.weights = {"mouthSmileLeft": 1.0}
    """

    def __init__(self, avatar: Avatar, weights: Weights = None, *, height: int = 520, **options: Any) -> None:
        self._avatar = avatar
        start = self._named(weights)
        page = avatar_page(avatar, "avatar", framed=True, **options)
        settings = {"page": page, "height": int(height)}
        self.widget = notebook_widget(settings, script="widget.js", style=None, name="AvatarWidget")
        self.widget.weights = start

    @property
    def weights(self) -> dict[str, float]:
        """Weights by name as they are now, without zeros."""
        return {name: weight for name, weight in self.widget.weights.items() if weight}

    @weights.setter
    def weights(self, weights: Weights) -> None:
        self.widget.weights = self._named(weights)

    def on_change(self, act: Callable[[Mapping[str, float]], None]) -> None:
        """Call a function with the weights whenever they change, by code or by hand."""
        self.widget.observe(lambda change: act(self.weights), names="weights")

    def _named(self, weights: Weights) -> dict[str, float]:
        names = (*self._avatar.names, *GAZE_NAMES)
        return dict(zip(names, np.asarray(self._avatar.rig.weights(weights)).tolist(), strict=True))

    def _repr_mimebundle_(self, **options: Any) -> Any:
        return self.widget._repr_mimebundle_(**options)
