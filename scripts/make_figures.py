"""Make every figure of the study: python scripts/make_figures.py study.nc -o DIR

The same as `fdspec figures`, which takes the same arguments. `fdspec sweep -o study.nc` makes the cube.
"""

import sys

from fdspec.cli import main

if __name__ == "__main__":
    sys.exit(main(["figures", *sys.argv[1:]]))
