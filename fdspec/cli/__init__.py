"""The command line, `fdspec`. No science here; every command loads what it needs when it runs."""

from fdspec.cli.main import main, run

__all__ = ["main", "run"]
