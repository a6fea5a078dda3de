"""The excitation of both problems: Kalamata, 13 September 1986, or what stands in for it."""

from __future__ import annotations

import os
from typing import Final

from fdspec.model.motion import GroundMotion
from fdspec.records import load_record, read_record
from fdspec.units import G

PGA: Final = 0.240 * G
"""Peak ground acceleration that the study gives, m/s2."""

DT: Final = 0.00976
"""Time step of the study's accelerogram, s."""

STAND_IN: Final = "FHR2"
"""Catalogue record used by default: Corralitos in the Loma Prieta earthquake, near its fault as well."""


def stand_in() -> GroundMotion:
    """Return the catalogue record that stands in for Kalamata, scaled to its PGA of 0.240 g."""
    return load_record(STAND_IN).scaled_to_pga(PGA)


def read_kalamata(
    path: str | os.PathLike[str],
    *,
    units: str | None = None,
    dt: float | None = None,
    channel: str | None = None,
) -> GroundMotion:
    """Read the user's own file of the Kalamata record and scale it to 0.240 g.

    Parameters
    ----------
    path : path
        The file, of any format that `fdspec.read_record` knows.
    units, dt, channel
        As for `fdspec.read_record`, where the file does not say them; the study's own is sampled at
        0.00976 s.

    Returns
    -------
    GroundMotion
        Scaled to the study's PGA, so that another component serves as the nearest there is.

    Raises
    ------
    RecordError
        When the file cannot be read.
    """
    return read_record(path, units=units, dt=dt, channel=channel, name="Kalamata 1986").scaled_to_pga(PGA)
