"""Provenance: the global attributes that say what made a dataset, from what, and when."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from typing import Any, Final, Protocol

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.version import __version__

STUDY: Final = "Numerical methodology for dynamic analysis of buildings with friction dampers"
"""Title of the study that fdspec follows."""

STAND_IN: Final = "stand-in for "
"""How the source of a ground motion begins when the motion stands in for a record that cannot be shipped."""

OWN: Final = "the user's own "
"""How the source begins when a record of the study is read from a file that its user linked."""


class Motion(Protocol):
    """What provenance tells of a ground motion."""

    @property
    def name(self) -> str:
        """Its name in the `record` coordinate."""

    @property
    def checksum(self) -> str:
        """SHA-256 of its numbers."""

    @property
    def source(self) -> str:
        """Where it was read from."""

    @property
    def history(self) -> tuple[str, ...]:
        """What was done to it since."""


def provenance(
    title: str,
    parameters: Mapping[str, object],
    motions: Iterable[Motion],
    *,
    command: str = "fdspec",
    comment: str = "",
    now: datetime | None = None,
) -> dict[str, str]:
    """Return the global attributes of a dataset.

    Parameters
    ----------
    title : str
        What the dataset is, in a few words.
    parameters : mapping
        Every parameter that shaped it; numbers, text, arrays, and mappings and sequences of them.
        An infinite number becomes the text "inf", as JSON has none.
    motions : iterable of GroundMotion
        The ground motions, as they were applied; listed under ``records`` in the parameters.
    command : str
        What was called, for the line of history: ``fdspec.sweep``.
    comment : str
        What else a reader must know. Which records are stand-ins, and which of the study's are the user's own
        files, is told in any case.
    now : datetime, optional
        Time of creation with its zone. Otherwise SOURCE_DATE_EPOCH where it is set, for files that repeat
        to the byte, else the clock.

    Returns
    -------
    dict of str
        CF's title, source, history, references and comment; Conventions; ``fdspec_version``; ``parameters``
        as one JSON text.

    Raises
    ------
    InvalidInput
        For a parameter that JSON cannot hold, or a SOURCE_DATE_EPOCH that is no whole number of seconds.
    """
    applied = tuple(motions)
    records = [
        {
            "name": motion.name,
            "checksum": motion.checksum,
            "source": motion.source,
            "history": list(motion.history),
        }
        for motion in applied
    ]
    content = {**{name: _plain(name, value) for name, value in parameters.items()}, "records": records}
    comments = (origins(applied), comment)
    attributes = {
        "Conventions": "CF-1.11",
        "title": title,
        "source": f"fdspec {__version__}, {_way(parameters)}",
        "history": f"{_created(now)} {command} (fdspec {__version__})",
        "references": STUDY,
        "comment": " ".join(text for text in comments if text),
        "fdspec_version": __version__,
        "parameters": json.dumps(content, allow_nan=False),
    }
    return {name: text for name, text in attributes.items() if text}


def _way(parameters: Mapping[str, object]) -> str:
    """How the motion was integrated, in a few words."""
    if "method" in parameters:
        return f"method {parameters['method']} of the study's comparison"
    return "exact piecewise integration of stick-slip motion"


def origins(motions: Iterable[Motion]) -> str:
    """Say which of the study's records were read from the user's own files, and which are stand-ins.

    Empty when there are neither; files read by their path are nobody's stand-ins.
    """
    known = tuple(motions)
    own = [motion.name for motion in known if motion.source.startswith(OWN)]
    stand_ins = [motion.name for motion in known if motion.source.startswith(STAND_IN)]
    told = []
    if own:
        told.append(f"From the user's own files: {', '.join(own)}.")
    if stand_ins:
        told.append(
            f"Stand-ins: {', '.join(stand_ins)}. Each is another real record of the same earthquake; "
            "the study's own files cannot be shipped."
        )
    return " ".join(told)


def _created(now: datetime | None) -> str:
    if now is None:
        epoch = os.environ.get("SOURCE_DATE_EPOCH")
        if epoch is None:
            now = datetime.now(UTC)
        else:
            try:
                now = datetime.fromtimestamp(int(epoch), UTC)
            except (ValueError, OverflowError, OSError) as error:
                raise InvalidInput(
                    f"SOURCE_DATE_EPOCH is {epoch!r}; it should be whole seconds since 1970"
                ) from error
    if now.tzinfo is None:
        raise InvalidInput(f"now is {now!r}; it should carry its time zone")
    return now.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def _plain(name: str, value: Any) -> object:
    """Return what JSON can hold: no numpy types, no infinities."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if value is None or isinstance(value, str | bool | int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, Mapping):
        return {str(key): _plain(f"{name}.{key}", item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(name, item) for item in value]
    raise InvalidInput(
        f"parameter {name} is {value!r}; it should be numbers, text, or lists and mappings of them"
    )
