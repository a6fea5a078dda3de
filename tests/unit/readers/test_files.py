"""What every reader refuses before it looks at a number."""

import os

import pytest

from fdspec.errors import RecordError
from fdspec.records import read_record
from fdspec.records.textfile import MAX_BYTES, TextFile, decode


def test_missing_empty_and_irregular_files(tmp_path):
    with pytest.raises(RecordError, match=r"none\.AT2: there is no such file"):
        read_record(tmp_path / "none.AT2")
    with pytest.raises(RecordError, match="is not a regular file"):
        read_record(tmp_path)
    (tmp_path / "empty").touch()
    with pytest.raises(RecordError, match="empty: the file is empty"):
        read_record(tmp_path / "empty")
    (tmp_path / "blank").write_text(" \n\t\r\n")
    with pytest.raises(RecordError, match="blank: the file has no text"):
        read_record(tmp_path / "blank")
    with pytest.raises(RecordError, match=r"cannot be read|no such file"):
        read_record("a\0b")


def test_a_huge_file_is_refused_unread(tmp_path):
    path = tmp_path / "huge.AT2"
    path.touch()
    os.truncate(path, 2_000_000_000)  # sparse: takes no room on the disk
    assert path.stat().st_size > MAX_BYTES
    with pytest.raises(RecordError, match="2000 MB is no single record; expected at most 200 MB"):
        read_record(path)


def test_a_pipe_is_refused_and_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(RecordError, match="is not a regular file"):
        read_record(tmp_path / "pipe")


def test_binary_is_refused(record_file):
    with pytest.raises(RecordError, match="binary file; expected text"):
        read_record(record_file(b"PEER\0\1\2"))


def test_line_numbers_count_what_an_editor_counts():
    assert tuple(decode(b"a\fb\r\nc\rd\n\n\x1a", "f").lines) == ("a\fb", "c", "d")


def test_text_that_is_not_utf8_is_latin_1():
    assert decode("Izmit - Kaynaşlı".encode("iso-8859-9"), "f").lines[0].startswith("Izmit - Kayna")


def test_a_line_beyond_the_end_is_refused():
    text = TextFile("f", ("one",))
    assert text.line(1, "the title") == "one"
    with pytest.raises(RecordError, match="f, line 2: the file ends before the title"):
        text.line(2, "the title")
