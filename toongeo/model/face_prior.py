"""What is known about a face before its picture is seen."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from toongeo._read_only import read_only, restored

__all__ = ["FacePrior"]


@dataclass(frozen=True, eq=False)
class FacePrior:
    """Which identities are likely, and where annotators see the landmarks of a face.

    Attributes
    ----------
    mean : (k,) float64
        Of the identity coefficients; about it they are independent, with unit variance.
    landmark_offsets : (68, 3) float64, mm, model frame
        Mean displacement from the landmark of the model to the annotated point. For a jaw point it starts at
        the visible point of its contour line.
    landmark_covariance : (68, 3, 3) float64, mm^2, model frame
        Covariance of this displacement between people and poses.
    scan_offsets : (68, 3) float64, mm, model frame, or None
        The mean displacement where the points are those of a mesh of scans, whose definition of the landmarks differs
        from that of people who annotate pictures.
    n_principal : int or None
        The first so many identity modes are principal axes of people, and those to draw random faces from; None: all.

    Raises
    ------
    ValueError
        If shapes do not fit or a covariance is not positive definite.
    """

    mean: NDArray[np.float64]
    landmark_offsets: NDArray[np.float64]
    landmark_covariance: NDArray[np.float64]
    scan_offsets: NDArray[np.float64] | None = None
    n_principal: int | None = None

    __setstate__ = restored

    def __post_init__(self) -> None:
        for name, shape in {
            "mean": (np.size(self.mean),),
            "landmark_offsets": (68, 3),
            "landmark_covariance": (68, 3, 3),
            "scan_offsets": (68, 3),
        }.items():
            if name == "scan_offsets" and self.scan_offsets is None:
                continue
            if np.shape(getattr(self, name)) != shape:
                raise ValueError(f"{name}: expected shape {shape}, got {np.shape(getattr(self, name))}")
        matrices = self.landmark_covariance
        symmetric = np.allclose(matrices, np.swapaxes(matrices, -1, -2))
        if not (symmetric and np.linalg.eigvalsh(matrices).min() > 0):
            raise ValueError("landmark_covariance: expected symmetric positive definite matrices")
        if self.n_principal is not None and not 0 < self.n_principal <= np.size(self.mean):
            raise ValueError(f"n_principal: expected 1 to {np.size(self.mean)} or None, got {self.n_principal!r}")
        read_only(self, *(field.name for field in fields(self)))
