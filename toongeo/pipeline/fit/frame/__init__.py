"""The frame in which a fit is solved, and its unknowns."""
