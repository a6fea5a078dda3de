"""A file appears as a whole or not at all, and whether it can be is known beforehand."""

import os
import re
import stat
from pathlib import Path

import pytest

from fdspec.errors import StoreError
from fdspec.store.replacing import check_writable, replacing


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def complaint(text: str) -> str:
    return re.escape(text)


def test_check_leaves_nothing_behind(tmp_path):
    assert check_writable(tmp_path / "cube.nc") == (tmp_path / "cube.nc").resolve()
    assert names(tmp_path) == []


def test_check_takes_any_of_netcdf_names(tmp_path):
    for name in ["cube", "cube.nc", "cube.NC4", "cube.v2.nc"]:
        check_writable(tmp_path / name)


def test_missing_folder(tmp_path):
    path = tmp_path / "results" / "cube.nc"
    with pytest.raises(
        StoreError, match=complaint(f"{path}: there is no folder {path.parent}; make it first")
    ):
        check_writable(path)
    assert names(tmp_path) == []


def test_a_folder_is_no_file(tmp_path):
    with pytest.raises(StoreError, match="it is a folder; name a file, such as .*cube.nc"):
        check_writable(tmp_path)


def test_a_file_in_the_folders_place(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(StoreError, match="there is no folder"):
        check_writable(tmp_path / "file" / "cube.nc")


def test_a_suffix_of_another_format_is_not_overwritten(tmp_path):
    study = tmp_path / "study.toml"
    study.write_text("precious")
    with pytest.raises(StoreError, match=complaint("the name should end in .nc or .nc4 or")):
        check_writable(study)
    assert study.read_text() == "precious"


def test_a_device_is_no_file():
    with pytest.raises(StoreError, match="no regular file"):
        check_writable(os.devnull)


def test_existing_file_may_be_kept(tmp_path):
    path = tmp_path / "cube.nc"
    path.write_text("old")
    check_writable(path)
    with pytest.raises(StoreError, match="exists already"):
        check_writable(path, overwrite=False)


def test_write_protected_file(tmp_path, monkeypatch):
    path = tmp_path / "cube.nc"
    path.write_text("old")
    # Root may write anywhere, so the answer of the system is given here.
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(StoreError, match="write-protected"):
        check_writable(path)


def test_folder_that_takes_no_files(tmp_path, monkeypatch):
    def refuse(**_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("fdspec.store.replacing.tempfile.TemporaryFile", refuse)
    with pytest.raises(
        StoreError, match=r"takes no files \(Permission denied\); give a file in another folder"
    ):
        check_writable(tmp_path / "cube.nc")


def test_file_appears_at_the_end_with_the_usual_permissions(tmp_path):
    path = tmp_path / "cube.nc"
    with replacing(path) as part:
        assert part.parent == tmp_path.resolve()
        part.write_text("new")
        assert not path.exists()
    assert path.read_text() == "new"
    assert names(tmp_path) == ["cube.nc"]
    usual = tmp_path / "usual"
    usual.write_text("")
    assert stat.S_IMODE(path.stat().st_mode) == stat.S_IMODE(usual.stat().st_mode)


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError, SystemExit, MemoryError])
def test_any_error_keeps_the_old_file_and_removes_the_new(tmp_path, error):
    path = tmp_path / "cube.nc"
    path.write_text("old")

    def write_half() -> None:
        with replacing(path) as part:
            part.write_text("half")
            raise error

    with pytest.raises(error):
        write_half()
    assert path.read_text() == "old"
    assert names(tmp_path) == ["cube.nc"]


def test_an_error_of_the_system_becomes_ours(tmp_path):
    with pytest.raises(StoreError, match="cube.nc: No space left on device"), replacing(tmp_path / "cube.nc"):
        raise OSError(28, "No space left on device")
    assert names(tmp_path) == []


def test_nothing_written_is_an_error(tmp_path):
    with pytest.raises(StoreError, match="No such file"), replacing(tmp_path / "cube.nc"):
        pass


def test_a_link_is_followed(tmp_path):
    (tmp_path / "disk").mkdir()
    target = tmp_path / "disk" / "cube.nc"
    link = tmp_path / "cube.nc"
    link.symlink_to(target)
    with replacing(link) as part:
        part.write_text("new")
    assert link.is_symlink()
    assert target.read_text() == "new"
