"""A study: everything one sweep needs, as a TOML file that a person writes."""

from dataclasses import dataclass, field
from pathlib import Path

from fdspec.model.grid import Grid
from fdspec.model.motion import GroundMotion
from fdspec.runs.after import NOTHING, After
from fdspec.runs.record_scaling import Scaling
from fdspec.runs.study_outputs import ON_REQUEST, OUTPUTS
from fdspec.runs.study_records import STUDY_RECORDS, RecordFile, find_records
from fdspec.runs.study_text import (
    axis_text,
    bool_text,
    device_lines,
    link_tables,
    records_text,
    scaling_text,
    strings_text,
)


@dataclass(frozen=True, eq=False, kw_only=True)
class Study:
    """Hold every argument of a sweep and the records it runs on; without arguments, the study of the nine.

    Parameters
    ----------
    grid : Grid
        Axes and scalars.
    records : tuple of str or RecordFile
        Names of the catalogue, or record files.
    scaled : bool
        Whether the catalogue's stand-ins are scaled to the study's PGA.
    scaling : Scaling or None
        Of every record that has none of its own, after that.
    outputs : tuple of str or None
        Variables of the cube; None for all.
    certify : bool
        Whether the energy balance of every history is checked.
    after : After
        Free vibration after every motion, and whether histories go on until the building is at rest.
    folder : Path
        Where relative paths start: the study file's folder.
    """

    grid: Grid = field(default_factory=Grid.study)
    records: tuple[str | RecordFile, ...] = STUDY_RECORDS
    scaled: bool = True
    scaling: Scaling | None = None
    outputs: tuple[str, ...] | None = None
    certify: bool = True
    after: After = NOTHING
    folder: Path = Path()

    @classmethod
    def read(cls, path: str | Path) -> "Study":
        """Read a study file; a field it does not name has the study's value.

        Raises
        ------
        StudyError
            When the file cannot be used; one line of text for each mistake, with field and line number.
        """
        from fdspec.runs.study_file import text_of

        path = Path(path)
        return cls.parse(text_of(path), name=str(path), folder=path.parent)

    @classmethod
    def parse(cls, text: str, *, name: str = "study", folder: Path = Path()) -> "Study":
        """Read a study from TOML text; `name` stands for the file in error messages."""
        from fdspec.runs.study_file import fields_of

        return cls(folder=folder, **fields_of(text, name, folder))

    def motions(self) -> tuple[GroundMotion, ...]:
        """Load the records, in order.

        Raises
        ------
        RecordError
            When some cannot be used; one line of text for each.
        """
        return find_records(self.records, folder=self.folder, scaled=self.scaled, scaling=self.scaling)

    def to_toml(self) -> str:
        """Return the study as the text of a study file, every field named, to be edited."""
        grid = self.grid
        kinetic = grid.kinetic_friction_coefficient
        outputs = OUTPUTS if self.outputs is None else self.outputs
        return f"""\
# A study of fdspec: every (record, stiffness ratio, pretension, period). Units are SI.
# A field left out has the value of the study on the nine records.

# Names of the catalogue (fdspec records list) or record files, relative to this file; what a file does not
# say of itself goes into a table: {{ path = "a.txt", units = "g", dt = 0.01, channel = "EW", name = "b" }};
# "*.AT2" stands for all files that match.
records = {records_text(self.records)}
# Scale the stand-ins of the catalogue to the study's peak ground acceleration.
scaled = {bool_text(self.scaled)}
# Scale every record: {{ factor }}, {{ pga }}, {{ sa, period }} or {{ target, period }}; m/s2, s. Two periods
# are the ends of a band; a record's own table may say the same of it alone, with pair = its other component.
{scaling_text(self.scaling)}

# Axes: a list, {{ start, stop, step }} or {{ start, stop, num }}, ends included.
# Brace over frame stiffness.
stiffness_ratio = {axis_text(grid.stiffness_ratio)}
# N, the total normal force on the sliding surface; 0 slides freely, inf never.
pretension = {axis_text(grid.pretension)}
# s, of the frame without its brace.
period = {axis_text(grid.period)}
# Factors on all records, a further axis of the cube; left out, there is none.
{"# intensity = [0.5, 1.0, 2.0]" if grid.intensity is None else f"intensity = {axis_text(grid.intensity)}"}

# kg
floor_mass = {grid.floor_mass!r}
# kg; 0.0 is the massless brace.
brace_mass = {grid.brace_mass!r}
# Of the frame without its brace.
damping_ratio = {grid.damping_ratio!r}
friction_coefficient = {grid.friction_coefficient!r}
# While sliding, at most the one above; left out, equal to it.
{"# kinetic_friction_coefficient = 0.4" if kinetic is None else f"kinetic_friction_coefficient = {kinetic!r}"}
# Newtons on the sliding surface for each newton of pretension.
normal_force_factor = {grid.normal_force_factor!r}
# Of the brace on its own.
brace_damping_ratio = {grid.brace_damping_ratio!r}

# Devices of all frames alike; left out, there are none. m, N, N/m.
{device_lines(grid)}
# Variables of the cube; left out, these. Only on request: {", ".join(ON_REQUEST)}.
{"# " if self.outputs is None else ""}outputs = {strings_text(outputs)}
# Check the energy balance of every history.
certify = {bool_text(self.certify)}
# s that each history goes on after its record, the ground at rest.
free_vibration = {self.after.free_vibration!r}
# Go on until no damper can slip any more, and give residuals there; twice the work.
at_rest = {bool_text(self.after.at_rest)}
{link_tables(grid)}"""
