"""What is done with a ground motion before and beside a frame: processing, intensity, spectra."""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
