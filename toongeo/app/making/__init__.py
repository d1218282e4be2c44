"""Parts of ``toongeo make``."""
