"""What is said about a head that was made."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from toongeo._brief_repr import brief_repr
from toongeo.app.making.head_jobs import HeadJob
from toongeo.avatar.avatar import Avatar

__all__ = ["MadeHead"]

_COARSE = "coarse:   the model's face alone"
_HELD_OUT = "held out: points predicted by the others"
_FORCED = "aligned:  forced, tells nothing of the face"
_SMOOTHED = "aligned:  what smoothing left of the noise"


@dataclass(frozen=True, eq=False)
class MadeHead:
    """A head and how well it is known: figures that tell something, apart from those that are forced.

    Attributes
    ----------
    job : HeadJob
    avatar : Avatar
    held_out : part -> RMS, or None
        As of :func:`toongeo.held_out_errors`; None where it does not apply.
    """

    job: HeadJob
    avatar: Avatar
    held_out: Mapping[str, float] | None = None

    __repr__ = brief_repr

    @property
    def is_forced(self) -> bool:
        """Whether the aligned face goes through its landmarks, whatever they are: not if their noise was taken out."""
        return self.avatar.face.report.noise is None

    def lines(self) -> list[str]:
        """The report in short lines of text."""
        report, quality = self.avatar.report, self.avatar.report.quality
        fields = self.to_dict()
        rows = [
            f"{part:<9}{_percent(report.coarse[part], 2)}{_percent((self.held_out or {}).get(part), 2)}"
            f"{_percent(report.aligned[part], 3)}"
            for part in report.coarse
        ]
        lids, lips, colours = fields["lids_closed"], fields["lips_closed"], fields["photometric_residual"]
        seconds = fields["seconds"]
        return [
            "landmark error, RMS / outer-eye distance",
            "part         coarse  held out   aligned",
            *rows,
            _COARSE,
            *([] if self.held_out is None else [_HELD_OUT]),
            _FORCED if self.is_forced else _SMOOTHED,
            *([] if colours is None else [f"colours:  off by {100 * colours:.1f} % RMS (photometric)"]),
            *([] if None in lids else [f"lids:     a blink closes {lids[0]:.0%} left, {lids[1]:.0%} right"]),
            *([] if lips is None else [f"lips:     sealed to {lips:.0%} below an open jaw"]),
            f"self-intersecting: {len(quality.intersecting)} of {quality.selected} triangles of the face",
            *(f"{stage:<9}{time:7.2f} s" for stage, time in seconds.items()),
            f"{'in all':<9}{sum(seconds.values()):7.2f} s",
            *(f"warning: {warning}" for warning in report.warnings),
        ]

    def to_dict(self) -> dict[str, Any]:
        """The report as numbers, texts, lists and None, for JSON.

        Landmark errors are fractions of the outer-eye distance by part, None where a part has none; the residual is a
        root mean square of colours in 0..1; lids (left, right) and lips are shares that close.
        """
        report, rig, photometric = self.avatar.report, self.avatar.rig.report, self.avatar.fit.photometric
        return {
            "image": str(self.job.image),
            "output": str(self.job.output),
            "landmark_error": {
                "coarse": _finite(report.coarse),
                "held_out": None if self.held_out is None else _finite(self.held_out),
                "aligned": _finite(report.aligned),
                "aligned_is_forced": self.is_forced,
            },
            "photometric_residual": None if photometric is None else photometric.residual_after,
            "lids_closed": [_share(rig.closure_left), _share(rig.closure_right)],
            "lips_closed": _share(rig.lips_closure),
            "self_intersecting": [len(report.quality.intersecting), report.quality.selected],
            "seconds": dict(report.seconds),
            "warnings": list(report.warnings),
        }


def _finite(errors: Mapping[str, float]) -> dict[str, float | None]:
    return {part: error if math.isfinite(error) else None for part, error in errors.items()}


def _share(percent: float | None) -> float | None:
    return None if percent is None else percent / 100


def _percent(error: float | None, digits: int) -> str:
    return f"{'-':>10}" if error is None or not math.isfinite(error) else f"{100 * error:8.{digits}f} %"
