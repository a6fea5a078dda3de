"""The edge of the command line: exit codes, a line an error, warnings, interrupts, a reader that leaves."""

import os
import subprocess
import sys
import types
import warnings
from collections.abc import Callable

import click
import pytest

from fdspec import __version__
from fdspec.cli import main
from fdspec.cli.commands import COMMANDS
from fdspec.errors import IntegrationError, RecordError, StoreError, StudyError

HEAVY = {"dask", "matplotlib", "netCDF4", "numba", "numpy", "pandas", "pydantic", "rich", "scipy", "xarray"}

Run = Callable[[Callable[[], object]], int]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run a function as the command `fdspec try`; return the exit code."""

    def as_command(function: Callable[[], object]) -> int:
        module = types.ModuleType("fdspec_try")
        module.command = click.command("try")(function)  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, "fdspec_try", module)
        monkeypatch.setitem(COMMANDS, "try", ("fdspec_try:command", "Try."))
        return main(["try"])

    return as_command


def raising(error: BaseException) -> Callable[[], None]:
    def command() -> None:
        raise error

    return command


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (RecordError("mine.AT2, line 3: expected 5 numbers, found 4"), 2),
        (StudyError("mine.toml, line 3: period: must hold at least one value"), 2),
        (StoreError("cannot write cube.nc: it is a folder"), 2),
        (click.UsageError("Give either --slip-force or --pretension."), 2),
        (IntegrationError("the history ended with status transition_cap_reached"), 1),
        (MemoryError("Unable to allocate 3 TiB"), 1),
    ],
)
def test_an_error_is_one_line_and_a_code(
    run: Run, capsys: pytest.CaptureFixture[str], error: Exception, code: int
) -> None:
    assert run(raising(error)) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("fdspec: error: ")
    assert str(error) in err
    assert err.count("\n") == 1


def test_several_mistakes_are_a_line_each(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(raising(StudyError("a.toml, line 1: x\na.toml, line 2: y"))) == 2
    assert capsys.readouterr().err == "fdspec: error: a.toml, line 1: x\nfdspec: error: a.toml, line 2: y\n"


def test_an_interrupt_ends_with_130(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(raising(KeyboardInterrupt())) == 130
    assert capsys.readouterr().err.strip() == "fdspec: interrupted"


def test_a_fault_of_the_program_keeps_its_traceback(run: Run) -> None:
    with pytest.raises(ZeroDivisionError):
        run(raising(ZeroDivisionError()))


def test_a_warning_is_one_line(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    def command() -> None:
        warnings.warn("the unit\nlooks wrong", UserWarning, stacklevel=1)
        click.echo("done")

    assert run(command) == 0
    assert capsys.readouterr() == ("done\n", "fdspec: warning: the unit looks wrong\n")


def test_the_way_warnings_are_shown_is_restored(run: Run) -> None:
    before = warnings.showwarning
    assert run(lambda: None) == 0
    assert warnings.showwarning is before


def test_a_wrong_option_names_itself_and_where_help_is(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["records", "list", "--jsn"]) == 2
    err = capsys.readouterr().err
    assert err.startswith("fdspec: error: No such option '--jsn'")
    assert "fdspec records list --help" in err


def test_a_wrong_command_is_answered_with_the_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["swep"]) == 2
    assert "Did you mean 'sweep'?" in capsys.readouterr().err
    assert main(["zzz"]) == 2
    assert "Did you mean" not in capsys.readouterr().err


def test_no_command_shows_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    assert "Commands:" in capsys.readouterr().err


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"fdspec {__version__}\n"


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    out = capsys.readouterr().out
    for name, (_, line) in COMMANDS.items():
        assert name in out
        assert " ".join(line.split()[:3]) in out


@pytest.mark.parametrize(
    "arguments",
    [
        *(["--help"], ["--version"], ["records", "--help"]),
        *([name, "--help"] for name in COMMANDS),
        *(["records", name, "--help"] for name in ("list", "show", "check", "convert", "figures")),
    ],
    ids=" ".join,
)
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    code = (
        "import sys; from fdspec.cli import main; code = main(sys.argv[1:]);"
        "print(code, *{name.partition('.')[0] for name in sys.modules})"
    )
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code, *arguments], check=True, capture_output=True, text=True
    )
    last = done.stdout.splitlines()[-1].split()
    assert last[0] == "0"
    assert HEAVY & set(last[1:]) == set()


def test_a_reader_that_goes_away_is_no_error() -> None:
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-W", "error", "-m", "fdspec", "records", "list"],
        check=False,
        stdout=write,
        stderr=subprocess.PIPE,
        text=True,
    )
    os.close(write)
    assert done.stderr == ""
    assert done.returncode == 1
