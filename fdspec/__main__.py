"""`python -m fdspec` is the command `fdspec`."""

import sys

from fdspec.cli import main

if __name__ == "__main__":
    sys.exit(main())
