"""The best pretension between those of the cube, searched with the engine."""

from __future__ import annotations

from fdspec.errors import InvalidInput
from fdspec.explore.indices import INDICES
from fdspec.explore.packing import pack
from fdspec.explore.rerun import Rerun
from fdspec.scheduling.progress import Shown


def packed_best(
    rerun: Rerun,
    record: int,
    stiffness_ratio: int,
    index: str,
    period: int | None = None,
    going_on: Shown = False,
) -> bytes:
    """Return the best pretension at one period, or at every period of the cube, for the page.

    Over period: ``pretension``, ``start`` and ``end`` of the band within 5 % of the least, kN, ``end``
    infinite where a damper that never slips is within it; ``value``, the index there in the page's unit.

    going_on: told (done, total) between parts of the search; what it raises ends the search.

    Raises
    ------
    InvalidInput
        For an index that is not searched, a position outside the cube, or a record that cannot be found.
    """
    from fdspec.choice import best_pretension  # a quarter of a second that the first page need not wait for

    known = {one.name: (one.measure, one.refined) for one in INDICES}
    measure, refined = known.get(index, ("", None))
    if refined is None:
        raise InvalidInput(f"index must be one that fdspec.best_pretension searches, got {index!r}")
    rerun.check(record=record, stiffness_ratio=stiffness_ratio, period=period or 0)
    cube = rerun.cube
    periods = cube["period"].values if period is None else cube["period"].values[[period]]
    found = rerun.motions.find(str(cube["record"].values[record]))
    best = best_pretension(
        found.motion,
        period=periods,
        stiffness_ratio=[float(cube["stiffness_ratio"].values[stiffness_ratio])],
        index=measure,
        workers=1 if period is not None else None,
        progress=going_on,
        **rerun.frame,
        **rerun.friction,
    ).isel(record=0, stiffness_ratio=0)
    return pack(
        {"index": index, "notice": found.notice},
        {
            "pretension": best["pretension"].values / 1e3,
            "start": best["band_start"].values / 1e3,
            "end": best["band_end"].values / 1e3,
            "value": refined(best).values,
        },
    )
