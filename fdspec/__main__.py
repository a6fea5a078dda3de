"""`python -m fdspec` is the command `fdspec`."""

from fdspec.cli import run

if __name__ == "__main__":
    run()
