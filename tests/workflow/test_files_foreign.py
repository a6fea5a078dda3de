"""Programs outside Python read the files, every number to the bit; CI installs them."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fdspec import store
from tests.cubes import synthetic_cube, synthetic_history

pytestmark = pytest.mark.foreign


def run(program: str, *arguments: object) -> str:
    if shutil.which(program) is None:
        pytest.skip(f"{program} is not installed (Debian: netcdf-bin, r-cran-ncdf4)")
    command = [program, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout.decode()


def ncdump(path: Path, name: str) -> str:
    """Return the values of a variable as ncdump prints them, every digit."""
    text = run("ncdump", "-p", "9,17", "-v", name, path).split("data:")[1]
    return re.search(rf"\b{name} =(.*?);", text, re.DOTALL)[1]


@pytest.mark.parametrize(
    "name", ["peak_acceleration", "transitions", "status", "pga", "period", "slip_force"]
)
def test_ncdump_reads_the_numbers_of_a_cube(tmp_path, name):
    cube = synthetic_cube()
    store.save(cube, tmp_path / "cube.nc")
    numbers = np.array([float(word) for word in ncdump(tmp_path / "cube.nc", name).split(",")])
    np.testing.assert_array_equal(numbers, cube[name].to_numpy().ravel())


def test_ncdump_reads_the_text_of_a_cube(tmp_path):
    store.save(synthetic_cube(["FSR1", "FMR2"]), tmp_path / "cube.nc")
    assert re.findall(r'"(.*?)"', ncdump(tmp_path / "cube.nc", "record_id")) == ["FSR1", "FMR2"]
    assert re.findall(r'"(.*?)"', ncdump(tmp_path / "cube.nc", "event")) == ["event 0", "event 1"]


def test_ncdump_reads_a_history(tmp_path):
    history = synthetic_history()
    store.save(history, tmp_path / "history.nc")
    for name in ["time", "displacement", "phase", "transition_time"]:
        numbers = np.array([float(word) for word in ncdump(tmp_path / "history.nc", name).split(",")])
        np.testing.assert_array_equal(numbers, history[name].to_numpy().ravel())


R_PRINTS = r"""
library(ncdf4)
arguments <- commandArgs(trailingOnly = TRUE)
file <- nc_open(arguments[1])
for (name in arguments[-1]) {
  values <- as.vector(ncvar_get(file, name))
  if (is.character(values)) writeLines(values) else writeLines(sprintf("%.17g", values))
}
"""


def r(folder: Path, path: Path, *names: str) -> list[str]:
    script = folder / "read.R"
    script.write_text(R_PRINTS, encoding="utf-8")
    return run("Rscript", "--vanilla", script, path, *names).splitlines()


def test_r_reads_a_cube(tmp_path):
    cube = synthetic_cube(["FSR1", "FMR2"])
    path = tmp_path / "cube.nc"
    store.save(cube, path)
    # R's first dim is netCDF's last, so its vector runs in the order of numpy's.
    for name in ["peak_acceleration", "transitions", "braced_acceleration", "period"]:
        numbers = np.array(r(tmp_path, path, name), dtype=float)
        np.testing.assert_array_equal(numbers, cube[name].to_numpy().ravel())
    assert r(tmp_path, path, "record_id") == ["FSR1", "FMR2"]


def test_r_reads_an_export(tmp_path):
    cube = synthetic_cube()
    store.export(cube, tmp_path / "one.nc", record="FSR1")
    numbers = np.array(r(tmp_path, tmp_path / "one.nc", "peak_displacement"), dtype=float)
    np.testing.assert_array_equal(numbers, cube["peak_displacement"].sel(record="FSR1").to_numpy().ravel())


def test_r_reads_a_csv(tmp_path):
    cube = synthetic_cube()
    store.export(cube, tmp_path / "one.csv", record="FSR1")
    script = tmp_path / "read.R"
    script.write_text(
        "table <- read.csv(commandArgs(trailingOnly = TRUE), comment.char = '#')\n"
        "writeLines(sprintf('%.17g', table$peak_acceleration))\n",
        encoding="utf-8",
    )
    numbers = np.array(run("Rscript", "--vanilla", script, tmp_path / "one.csv").splitlines(), dtype=float)
    # R's own reading of decimals may miss the last bit.
    expected = cube["peak_acceleration"].sel(record="FSR1").to_numpy().ravel()
    np.testing.assert_allclose(numbers, expected, rtol=1e-15)
