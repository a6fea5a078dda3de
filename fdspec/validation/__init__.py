"""The study's two validation problems, one module each: ``building`` makes the frame, ``solve`` simulates it.

Their excitation and their normal forces are not printed: the first is a stand-in unless the user has the
file (`kalamata`), the second an assumption that each problem states.
"""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
