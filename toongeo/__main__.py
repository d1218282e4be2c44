"""``python -m toongeo`` is the command ``toongeo``."""

import sys

from toongeo.app.cli import main

if __name__ == "__main__":
    sys.exit(main())
