"""The study's figures by number, each with its words: from a cube, its records, the validation problems."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.errors import FdspecError, InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.report.finer import OUTPUTS, Finer
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

    from fdspec.figures.page import Figure

RECORD_FIGURES: Final = {
    "FSR1": 10,
    "FSR2": 11,
    "FSR3": 12,
    "FMR1": 13,
    "FMR2": 14,
    "FMR3": 15,
    "FHR1": 16,
    "FHR2": 17,
    "FHR3": 18,
}
"""The study's figure of each of its records."""

LONGEST: Final = 100
"""Characters of a record's name in the name of a file."""

SHOWN: Final = 15.0
"""Seconds of the first validation problem that its figure shows; after them little moves."""

DT_OUT: Final = 2e-3
"""Seconds between the points that it draws."""

PRINTED: Final = 8.4
"""Points of letters in print; matplotlib's small ones, which these pictures have, are then 7."""

SHEET: Final = 15.0
"""Points of letters in pictures of 9 in that a contact sheet shows at less than half that."""

SMALL: Final = 88.0
"""mm; width of a picture that is drawn for the contact sheet."""

SHEET_RATIO: Final = 4.0
"""Stiffness ratio that the contact sheet shows of a record, or the nearest."""

PRINT_RATIOS: Final = (1.0, 4.0, 8.0)
"""Stiffness ratios of the ensemble in print."""

SHOWN_FOUR: Final = 25.0
"""Seconds of the second."""


@dataclass(frozen=True)
class Picture:
    """One figure of the study.

    `number` is the study's, or the record's name where the study has none; `name` begins the file's name;
    `words` is the caption; `make` draws it under a title, over a caption; `printed` draws it for print, at a
    width in mm, as "maps" or "surfaces"; pictures without it are brought to that width as they are.
    """

    number: str
    name: str
    title: str
    words: str
    make: Callable[[str, str], Figure]
    printed: Callable[[float, str], Figure] | None = None

    def draw(self) -> Figure:
        """Make the figure, its number and title above, its caption below."""
        figure = self.make(self.heading, self.caption)
        figure.set_label(self.heading)
        return figure

    def draw_print(self, width: float, kind: str = "maps") -> Figure:
        """Make the figure for a journal: this wide, mm, without title and caption, letters of 7 points."""
        from fdspec.figures import at_width, lettering

        if self.printed is not None:
            figure = self.printed(width, kind)
        else:
            with lettering(PRINTED):
                figure = self.make("", "")
                at_width(figure, width)
        figure.set_label(self.heading)
        return figure

    def draw_small(self) -> Figure:
        """Make the figure for a contact sheet, where many stand on a page."""
        from fdspec.figures import lettering

        if self.printed is not None:
            return self.printed(SMALL, "sheet")
        with lettering(SHEET):
            return self.make("", "")

    @property
    def caption(self) -> str:
        """The caption with its number, as it stands below the picture."""
        head = f"Figure {self.number}." if self.number.isdigit() else f"{self.number}."
        return f"{head} {self.words}"

    @property
    def heading(self) -> str:
        """The title with its number."""
        return f"Figure {self.number}: {self.title}" if self.number.isdigit() else self.title


def study_pictures(cube: xr.Dataset, given: Sequence[GroundMotion] = ()) -> list[Picture]:
    """Return the pictures that a cube gives, in the study's order.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns.
    given : sequence of GroundMotion
        Motions beside the catalogue's that the cube may have been made with.

    Returns
    -------
    list of Picture
        4 and 6, the validation problems, and 7, the frame with its damper, which need no cube; 8 and 9, of
        those records of the cube that are found; one a record, 10 to 18 for those of the study; the ensemble
        and the chart, of two records that are found or more. Nothing is drawn or computed before `draw`,
        and nothing computed twice, however often a picture is drawn.
        Records that are found are drawn on pretensions close together, which are computed for the picture,
        others on the cube's.
    """
    motions, _ = applied_motions(cube, given)
    finer = Finer(cube, motions)
    pictures = [_figure_4(), _figure_6(), _figure_7()]
    if motions:
        pictures += [_figure_8(motions), _figure_9(cube, motions)]
    names = [str(name) for name in cube["record"].values]
    known = sorted((name for name in names if name in RECORD_FIGURES), key=RECORD_FIGURES.__getitem__)
    others = [name for name in names if name not in RECORD_FIGURES]
    pictures += [_of_record(finer, name) for name in (*known, *others)]
    if len(motions) > 1 and finer.able and all(name in cube for name in OUTPUTS):
        pictures += [_ensemble(finer), _chart(finer)]
    return _distinct(pictures)


def applied_motions(
    cube: xr.Dataset, given: Sequence[GroundMotion] = ()
) -> tuple[list[GroundMotion], list[str]]:
    """Find the ground motions that a cube was made with, proved by their checksums.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns.
    given : sequence of GroundMotion
        Where to look before the catalogue, such as what `Study.motions` returns.

    Returns
    -------
    found : list of GroundMotion
        In the cube's order.
    lost : list of str
        Names of those that are nowhere to be found, or are not what they were.
    """
    if "checksum" not in cube.coords:
        return [], [str(name) for name in cube["record"].values]
    by_checksum = {motion.checksum: motion for motion in given}
    found, lost = [], []
    for name, checksum in zip(cube["record"].values, cube["checksum"].values, strict=True):
        motion = by_checksum.get(str(checksum)) or _of_catalogue(str(name), str(checksum))
        if motion is None:
            lost.append(str(name))
        else:
            found.append(motion)
    return found, lost


def _of_catalogue(name: str, checksum: str) -> GroundMotion | None:
    """Load a record of the study by its name, scaled or as recorded, when it is the one."""
    from fdspec.records import load_record

    if name not in RECORD_FIGURES:
        return None
    for scaled in (True, False):
        try:
            motion = load_record(name, scaled=scaled)
        except FdspecError:
            return None
        if motion.checksum == checksum:
            return motion
    return None


def methods_compared() -> dict[str, xr.Dataset]:
    """Solve the first validation problem by every method there is, exact first: what Figure 4 draws.

    Dimova's approximation comes with the study's three tolerances of the sliding velocity, the study's own
    scheme with a step of 1e-5 s, ten times its own, which changes nothing that one can see.
    """
    from fdspec import methods
    from fdspec.runs.simulate import simulate
    from fdspec.validation import kalamata, single_storey_k_braced

    named: dict[str, str | methods.Method] = {
        "exact": methods.EXACT,
        "the study's scheme (Newmark), step 10⁻⁵ s": methods.Newmark(dt=1e-5),
        **{
            f"Dimova, linear within {band:g} m/s": methods.Dimova(velocity_band=band)
            for band in (0.001, 0.005, 0.01)
        },
        "state space with shear balance": methods.StateSpace(),
        "bilinear, brace without mass": methods.Bilinear(),
        "Bouc-Wen": methods.BoucWen(),
        "equivalent linear": methods.EquivalentLinear(),
        "rigid-plastic": methods.RigidPlastic(),
    }
    building, motion = single_storey_k_braced.building(), kalamata.stand_in()
    until = round(SHOWN / motion.dt) + 1
    shown = GroundMotion(motion.acceleration[:until], motion.dt, name=motion.name)
    return {name: simulate(building, shown, method=method, dt_out=DT_OUT) for name, method in named.items()}


def _figure_4() -> Picture:
    from fdspec.validation import kalamata, single_storey_k_braced

    solved = cache(methods_compared)

    def make(title: str, caption: str) -> Figure:
        from fdspec.figures import plot_brace_displacements

        return plot_brace_displacements(solved(), title=title, caption=caption, end=SHOWN)

    words = (
        "Displacement of the additional frame relative to the ground by every method for friction, each over "
        "the exact one in grey. Frame 20\u00a0000\u00a0kg, 0.4 s, damping ratio 0.02; additional frame "
        "27\u00a0kg, 0.0684 s; friction coefficient 0.15, normal force assumed "
        f"{_newtons(single_storey_k_braced.NORMAL_FORCE)}. {_excitation(kalamata.stand_in())}"
    )
    title = "displacement of the additional frame of a K-braced frame"
    return Picture("4", "figure-04-additional-frame", title, words, make)


def _figure_6() -> Picture:
    from fdspec.validation import four_storey, kalamata

    solved = cache(four_storey.solve)

    def make(title: str, caption: str) -> Figure:
        from fdspec.figures import plot_bare_and_damped

        return plot_bare_and_damped(*solved(), title=title, caption=caption, end=SHOWN_FOUR)

    words = (
        "Displacement of the floors relative to the ground. First period 1.006 s bare and 0.612 s braced, "
        "damping ratio 0.02, friction coefficient 0.15, normal force assumed "
        f"{_newtons(four_storey.NORMAL_FORCE)} in each storey. {_excitation(kalamata.stand_in())}"
    )
    return Picture(
        "6", "figure-06-four-storeys", "four-storey steel frame, bare and with friction dampers", words, make
    )


def _figure_7() -> Picture:
    from fdspec.figures import sketch_caption

    def make(title: str, caption: str) -> Figure:
        from fdspec.figures import plot_sketch

        return plot_sketch(title=title, caption=caption)

    return Picture("7", "figure-07-damper", "frame with friction damper", sketch_caption(), make)


def _figure_8(motions: Sequence[GroundMotion]) -> Picture:
    def make(title: str, caption: str) -> Figure:
        from fdspec.figures import plot_histories

        return plot_histories(motions, title=title, caption=caption)

    words = f"Ground accelerations, a dot at each peak. Records really used: {_used(motions)}"
    return Picture("8", "figure-08-records", "ground accelerations", words, make)


def _figure_9(cube: xr.Dataset, motions: Sequence[GroundMotion]) -> Picture:
    from fdspec.figures.acceleration import told_parameters

    ratio = float(told_parameters(cube).get("damping_ratio", 0.05))

    def make(title: str, caption: str) -> Figure:
        from fdspec.figures import plot_spectra
        from fdspec.records import catalogue
        from fdspec.signals.spectra import SHORTEST, elastic_spectra

        periods = 0.01 * np.arange(1, round(100.0 * float(cube["period"].values.max())) + 1)
        shortest = SHORTEST * max(motion.dt for motion in motions)
        spectra = elastic_spectra(motions, periods[periods >= shortest], [ratio])
        soils = {entry.name: f"{entry.name}, {entry.soil}" for entry in catalogue()}
        return plot_spectra(spectra, title=title, caption=caption, labels=soils)

    words = (
        f"Peak absolute acceleration of elastic oscillators, damping ratio {ratio:g}. Records really used: "
        f"{_used(motions)}"
    )
    return Picture("9", "figure-09-spectra", "elastic acceleration spectra", words, make)


def _of_record(finer: Finer, record: str) -> Picture:
    from fdspec.figures import acceleration_caption

    number = RECORD_FIGURES.get(record)

    def make(title: str, caption: str) -> Figure:
        from fdspec.figures import plot_acceleration

        return plot_acceleration(finer.of(record), record, title=title, caption=caption)

    def printed(width: float, kind: str) -> Figure:
        from fdspec.figures import plot_acceleration_print

        ratios = finer.cube["stiffness_ratio"].values
        shown = [float(ratios[np.abs(ratios - SHEET_RATIO).argmin()])] if kind == "sheet" else None
        return plot_acceleration_print(
            finer.of(record),
            record,
            width=width,
            kind="maps" if kind == "sheet" else kind,
            stiffness_ratios=shown,
        )

    words = acceleration_caption(finer.cube, record, pretensions=finer.count(record))
    heading = f"absolute acceleration spectra at different pretension forces, {record}"
    safe = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in record).strip(".")[
        :LONGEST
    ]
    name = f"record-{safe or '_'}" if number is None else f"figure-{number}-{record}"
    return Picture(record if number is None else str(number), name, heading, words, make, printed)


def _ensemble(finer: Finer) -> Picture:
    from fdspec.figures import ensemble_caption

    def make(title: str, caption: str) -> Figure:
        from fdspec.figures import plot_ensemble

        return plot_ensemble(finer.together(), title=title, caption=caption)

    def printed(width: float, _: str) -> Figure:
        from fdspec.figures import plot_ensemble

        ratios = finer.cube["stiffness_ratio"].values
        shown = [ratio for ratio in PRINT_RATIOS if np.isclose(ratios, ratio).any()]
        return plot_ensemble(finer.together(), width=max(width, 120.0), stiffness_ratios=shown or None)

    names = [str(name) for name in finer.motions]
    words = ensemble_caption(finer.cube.sel(record=names))
    title = f"{len(names)} records together: reduction of peak acceleration against the bare frame"
    return Picture("Ensemble", "ensemble", title, words, make, printed)


def _chart(finer: Finer) -> Picture:
    def make(title: str, caption: str) -> Figure:
        from fdspec.figures import plot_chart

        return plot_chart(finer.for_chart(), title=title, caption=caption)

    words = (
        "Peak absolute acceleration of the floor over the peak ground acceleration (PGA), median over "
        f"{', '.join(finer.motions)}, against the slip force F over floor mass times PGA: so divided the "
        "numbers hold for any floor mass and any loudness. A line a period of the frame without brace, a dot "
        "at its least; shaded: from the 16th to the 84th percentile of the records at 0.5 s. SR: stiffness "
        "of the brace over that of the frame."
    )
    title = "peak acceleration over slip force, in units of floor mass and ground peak"
    return Picture("Chart", "chart", title, words, make)


def _distinct(pictures: Sequence[Picture]) -> list[Picture]:
    """Number what would become one file: of records named "a/b" and "a:b" the second is ``record-a_b-2``.

    Names that differ in case alone are one file on some systems.
    """
    taken: set[str] = set()
    named = []
    for picture in pictures:
        name, number = picture.name, 1
        while name.casefold() in taken:
            number += 1
            name = f"{picture.name}-{number}"
        taken.add(name.casefold())
        named.append(replace(picture, name=name))
    return named


def chosen(pictures: Sequence[Picture], only: Sequence[str]) -> list[Picture]:
    """Return those of these numbers or names, in their order.

    Raises
    ------
    InvalidInput
        When one is not there.
    """
    numbers = [picture.number for picture in pictures]
    named = {one.casefold() for one in only}
    for one in only:
        if one.casefold() not in {number.casefold() for number in numbers}:
            raise InvalidInput(f"there is no figure {one!r}; this cube gives {', '.join(numbers)}")
    return [one for one in pictures if one.number.casefold() in named] if only else list(pictures)


def _excitation(motion: GroundMotion) -> str:
    return f"Excitation: {motion.source}, scaled to {motion.pga / G:.3g} g in place of Kalamata 1986, NS."


def _used(motions: Sequence[GroundMotion]) -> str:
    told = [f"{motion.name}: {motion.source or 'unknown'}{_times(motion)}" for motion in motions]
    return "; ".join(_unframed(text) for text in told) + "."


def _times(motion: GroundMotion) -> str:
    return "" if motion.scale_factor == 1.0 else f", times {motion.scale_factor:.3g}"


def _unframed(text: str) -> str:
    """Leave out what the name before it says already."""
    name, _, rest = text.partition(": ")
    return f"{name}, {rest}".replace(f", stand-in for the study's {name}: ", " (stand-in) ")


def _newtons(force: float) -> str:
    return f"{force / 1e3:g} kN"
