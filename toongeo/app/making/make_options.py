"""What ``toongeo make`` is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from toongeo._brief_repr import brief_repr
from toongeo.app.commands.path_is import path_is
from toongeo.avatar.save_avatar import writer_for
from toongeo.model import MorphableModel
from toongeo.pipeline.align.denoise_landmarks import Noise, check_noise
from toongeo.pipeline.texture.bake_texture import check_size

__all__ = ["MakeOptions"]


@dataclass(frozen=True, eq=False)
class MakeOptions:
    """Options of :func:`toongeo.make_avatar` and of :meth:`toongeo.Avatar.save`, the same for all heads.

    Attributes
    ----------
    model, noise, snap, photometric, method, rig, style, hair, hair_mask, texture_size
        Of :func:`toongeo.make_avatar`; the mask is a file.
    format : str, optional
    saving : Mapping
        Of :meth:`toongeo.Avatar.save`.
    json : bool
        Print the report as JSON, and all else on standard error.
    """

    model: MorphableModel | None = None
    noise: Noise = "auto"
    snap: bool = False
    photometric: bool | Literal["auto"] = "auto"
    method: Literal["cartoon", "caricature"] = "cartoon"
    rig: Literal["transfer", "caricature"] = "transfer"
    style: str | None = None
    hair: bool = True
    hair_mask: Path | None = None
    texture_size: int = 1024
    format: str | None = None
    saving: Mapping[str, Any] = field(default_factory=dict)
    json: bool = False

    __repr__ = brief_repr

    def check(self, output: Path) -> None:
        """Refuse what no head could be made with, or not be saved with under this name.

        Raises
        ------
        ValueError, ImportError
            As :func:`toongeo.make_avatar` and :meth:`toongeo.Avatar.save`, before any work.
        """
        with path_is("output"):
            writer_for(output, self.format, self.saving)
        check_noise(self.noise)
        check_size(self.texture_size)
        if output.suffix.lower() == ".vrm" and self.model is not None and not self.model.has("eyes"):
            raise ValueError("model: expected one with eyeballs for .vrm, whose bones turn them, got one without")

    def making(self) -> dict[str, Any]:
        """Arguments of :func:`toongeo.make_avatar`."""
        names: tuple[str, ...] = ("model", "noise", "snap", "photometric", "method", "rig", "style")
        names += ("hair", "hair_mask", "texture_size")
        return {name: getattr(self, name) for name in names}
