"""The command ``toongeo model``."""
