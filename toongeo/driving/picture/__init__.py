"""A performer's own skin, found again in every frame."""
