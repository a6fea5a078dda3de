"""Draw the pictures of README and the documentation's first page: `python scripts/make_pictures.py`.

They are kept in docs/images, since README is read where nothing can be drawn; the sketch also among the
assets of `fdspec explore`, whose page is put together without matplotlib.
"""

from pathlib import Path

import fdspec
from fdspec.figures import encode, plot_choice_index, plot_sketch
from fdspec.runs.study_records import STUDY_RECORDS

ROOT = Path(__file__).parents[1]

IMAGES, ASSETS = ROOT / "docs" / "images", ROOT / "fdspec" / "explore" / "assets"


def main() -> None:
    """Draw the sketch, and the response of the study's frame over pretension under its nine records."""
    (IMAGES / "sketch.png").write_bytes(encode(plot_sketch(), "png"))
    (ASSETS / "sketch.svg").write_bytes(encode(plot_sketch(), "svg", author="fdspec"))
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=1.0)
    motions = [fdspec.load_record(name) for name in STUDY_RECORDS]
    choice = fdspec.choose(frame, motions, stiffness_scale=[1])
    (IMAGES / "response.png").write_bytes(encode(plot_choice_index(choice), "png"))


if __name__ == "__main__":
    main()
