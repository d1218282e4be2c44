"""Parts of the photometric fit."""
