"""Parts of the classical texture generator."""
