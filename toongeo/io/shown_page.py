"""A page in a frame, for notebooks."""

from __future__ import annotations

import html
from dataclasses import dataclass

__all__ = ["ShownPage"]


@dataclass(frozen=True)
class ShownPage:
    """What :meth:`toongeo.Avatar.show` gives: the last line of a notebook's cell shows it.

    Attributes
    ----------
    page : str
        HTML of the whole page, which asks nothing of a network.
    height : int
        Of the frame, px.
    title : str
    """

    page: str
    height: int
    title: str

    def __repr__(self) -> str:
        return f"<page of {self.title}, {len(self.page) / 1e6:.1f} MB>"

    def _repr_html_(self) -> str:
        """A frame that may run the page's scripts and save its pictures, and nothing else of the notebook."""
        return (
            f'<iframe srcdoc="{html.escape(self.page)}" title="{html.escape(self.title)}" '
            f'sandbox="allow-scripts allow-downloads" style="width:100%;height:{self.height}px;border:0"></iframe>'
        )
