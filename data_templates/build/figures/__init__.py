"""Heads that no person has: caricatures of the deformation space, and faces drawn in the plane as cartoonists do."""

from figures.exaggerated_head import exaggerated_head
from figures.random_figure import random_figure

__all__ = ["exaggerated_head", "random_figure"]
