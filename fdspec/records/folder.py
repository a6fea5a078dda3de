"""Where the records are that fdspec ships."""

from __future__ import annotations

from pathlib import Path

from fdspec.errors import RecordError


def records_folder() -> Path:
    """Return the folder of the shipped records and their catalogue.

    A wheel carries it inside the package; a checkout (editable installation) has it at its top.
    """
    here = Path(__file__).resolve().parent
    candidates = (here / "data", here.parent.parent / "records")
    for folder in candidates:
        if (folder / "catalogue.toml").is_file():
            return folder
    looked = " nor ".join(str(folder) for folder in candidates)
    raise RecordError(f"the shipped records are neither in {looked}: install fdspec again")
