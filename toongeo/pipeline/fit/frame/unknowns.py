"""Where each unknown of the fit lies in the vector that is optimised."""

from dataclasses import dataclass

__all__ = ["Unknowns"]


@dataclass(frozen=True)
class Unknowns:
    """Layout ``[identity, expression, rotation vector (3), log scale, translation (2)]`` of the vector ``x``.

    In perspective the inverse distance of the viewer, 1/mm, follows.
    """

    n_identity: int
    n_expression: int
    perspective: bool = False

    @property
    def identity(self) -> slice:
        return slice(0, self.n_identity)

    @property
    def expression(self) -> slice:
        return slice(self.n_identity, self.n_coefficients)

    @property
    def shape(self) -> slice:
        """Identity and expression together: all that the vertices are linear in."""
        return slice(0, self.n_coefficients)

    @property
    def rotation(self) -> slice:
        return slice(self.n_coefficients, self.n_coefficients + 3)

    @property
    def log_scale(self) -> int:
        return self.n_coefficients + 3

    @property
    def translation(self) -> slice:
        return slice(self.n_coefficients + 4, self.n_coefficients + 6)

    @property
    def pose(self) -> slice:
        """Rotation, scale and translation together."""
        return slice(self.n_coefficients, self.n_coefficients + 6)

    @property
    def inverse_distance(self) -> int:
        """Of the viewer, where the scale is that of the frame; only in perspective."""
        return self.n_coefficients + 6

    @property
    def n_coefficients(self) -> int:
        return self.n_identity + self.n_expression

    @property
    def size(self) -> int:
        return self.n_coefficients + 6 + int(self.perspective)
