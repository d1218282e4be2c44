"""Settings of a fit that belong together."""

from __future__ import annotations

from dataclasses import dataclass

from toongeo.pipeline.fit.check_positive import check_positive

__all__ = ["JawOptions", "PriorOptions", "SolverOptions"]


@dataclass(frozen=True)
class PriorOptions:
    """What is taken for likely before a picture is seen.

    Attributes
    ----------
    identity_weight, expression_weight : float
        ``w_id`` and ``w_exp`` of Eq. 6 (Pan et al. 2024).
    landmark_deviation : float
        Standard deviation of the misfit of a coordinate that is expected of people, in outer-eye distances. Where a
        face (a caricature, say) misses its landmarks by more, ``w_r`` grows with the square of the misfit.
    pitch_deviation : float, degrees
        Standard deviation of the pitch of heads in pictures.
    max_deviation : float
        Bound of identity and unnamed expression coefficients, in standard deviations from the likeliest ones.

    Raises
    ------
    ValueError
        If one of them is not a positive finite number.

    Examples
    --------
    >>> import toongeo as tg
    >>> tg.FitOptions(prior=tg.PriorOptions(identity_weight=0.5)).prior.max_deviation  # likeness before likelihood
    3.0
    >>> tg.PriorOptions(max_deviation=0.0)
    Traceback (most recent call last):
    ...
    ValueError: max_deviation: expected a finite number > 0, got 0.0
    """

    identity_weight: float = 1.0
    expression_weight: float = 4.0
    landmark_deviation: float = 0.014
    pitch_deviation: float = 6.0
    max_deviation: float = 3.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            check_positive(name, value)


@dataclass(frozen=True)
class JawOptions:
    """How the 17 points of the jaw count.

    Attributes
    ----------
    weight : float
        ``w_n`` of Eq. 4; the inner points have 1 (on average, where the model knows the noise of each). Where an
        annotator puts a jaw point is a matter of taste, and with full weight they made the face worse in 3D than the
        mean face is.
    tangent : float in [0, 1]
        How much an error along the jaw's outline counts against one across it.

    Raises
    ------
    ValueError
        If a number is negative or not finite, or the tangent greater than 1.

    Examples
    --------
    >>> import toongeo as tg
    >>> options = tg.FitOptions(jaw=tg.JawOptions(weight=0.2))  # trust the points of the jaw more
    >>> options.jaw.tangent
    0.35
    >>> tg.JawOptions(tangent=2.0)
    Traceback (most recent call last):
    ...
    ValueError: tangent: expected a number in [0, 1], got 2.0
    """

    weight: float = 0.015
    tangent: float = 0.35

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            check_positive(name, value, zero=True)
        if self.tangent > 1:
            raise ValueError(f"tangent: expected a number in [0, 1], got {self.tangent!r}")


@dataclass(frozen=True)
class SolverOptions:
    """When a minimisation ends.

    Attributes
    ----------
    max_passes : int
        How often at most the jaw points are placed anew on their lines.
    tolerance : float
        Relative change of the loss at which a pass stops.
    max_evaluations : int
        Of the loss, in one pass.
    max_seconds : float or None
        Of one pass; None: no limit. With a limit two runs may end at different faces.

    Raises
    ------
    ValueError
        If a limit is not positive, or a count no integer.

    Examples
    --------
    >>> import toongeo as tg
    >>> tg.FitOptions(solver=tg.SolverOptions(max_passes=1)).solver.max_evaluations
    2000
    >>> tg.SolverOptions(max_passes=0)
    Traceback (most recent call last):
    ...
    ValueError: max_passes: expected an integer >= 1, got 0
    """

    max_passes: int = 4
    tolerance: float = 1e-6
    max_evaluations: int = 2000
    max_seconds: float | None = None

    def __post_init__(self) -> None:
        check_positive("tolerance", self.tolerance)
        for name in ("max_passes", "max_evaluations"):
            check_positive(name, getattr(self, name), whole=True)
        if self.max_seconds is not None:
            check_positive("max_seconds", self.max_seconds)
