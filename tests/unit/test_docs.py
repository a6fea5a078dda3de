"""What the documentation generates: every command and option has its place, and no clock fails a build."""

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import click
import pytest

from fdspec.cli.commands import fdspec as group

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def reference() -> str:
    spec = importlib.util.spec_from_file_location("generated", DOCS / "generated.py")
    assert spec is not None
    assert spec.loader is not None
    module: ModuleType = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.commands()


def commands(within: click.Group, path: str) -> list[tuple[str, click.Command]]:
    context = click.Context(within, info_name=path)
    found = []
    for name in within.list_commands(context):
        command = within.get_command(context, name)
        assert command is not None
        found.append((f"{path} {name}", command))
        if isinstance(command, click.Group):
            found += commands(command, f"{path} {name}")
    return found


def test_the_reference_has_every_command_and_every_option(reference: str) -> None:
    assert len(commands(group, "fdspec")) >= 15
    for path, command in commands(group, "fdspec"):
        assert f"# `{path}`\n" in reference, path
        section = reference.partition(f"# `{path}`\n")[2].partition("\n#")[0]
        for parameter in command.params:
            if isinstance(parameter, click.Option) and not isinstance(command, click.Group):
                assert parameter.opts[0] in section, (path, parameter.name)


def test_no_clock_fails_the_build() -> None:
    text = (DOCS / "conf.py").read_text(encoding="utf-8")
    assert "logger.warning" not in text
    assert "nb_execution_timeout = 3600" in text


def test_pages_assume_no_published_package() -> None:
    """Nothing is on an index yet: what is installed is a clone."""
    for path in [*DOCS.glob("*.md"), *DOCS.glob("howto/*.md")]:
        if path.name != "records.md":
            assert "pip install 'fdspec" not in path.read_text(encoding="utf-8"), path.name


def test_no_line_of_prose_begins_with_a_per_cent_sign() -> None:
    """To MyST it is a comment, and the rest of the sentence is gone from the page."""
    pages = dict.fromkeys([*DOCS.rglob("*.md"), *DOCS.parent.glob("*.md")], r"^\s*%")
    notebooks = dict.fromkeys((DOCS.parent / "notebooks").glob("*.py"), r"^#\s+%(?!%)")
    found = [
        f"{path.name}: {line}"
        for path, comment in (pages | notebooks).items()
        if "_build" not in path.parts
        for line in path.read_text(encoding="utf-8").splitlines()
        if re.match(comment, line)
    ]
    assert found == []
