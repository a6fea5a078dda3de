"""Where reader tests find their files."""

from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def shared_records() -> Path:
    """Real files, beside the checkout on some machines; never part of the project."""
    folder = REPOSITORY.parent / "shared" / "records"
    if not folder.is_dir():
        pytest.skip("needs real record files in ../shared/records, which this machine does not have")
    return folder


@pytest.fixture
def fixtures() -> Path:
    """Small files of the project's own making."""
    return REPOSITORY / "tests" / "fixtures" / "records"


@pytest.fixture
def record_file(tmp_path):
    """Write a file with this content and return its path."""

    def write(content: str | bytes, name: str = "record.AT2") -> Path:
        path = tmp_path / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write
