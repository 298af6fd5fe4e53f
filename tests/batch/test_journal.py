"""The journal: cut short anywhere, damaged anywhere, on a full disk, it loses nothing that was told."""

import errno
import os
from pathlib import Path

import pytest

from toolaxis.batch.journal import Journal
from toolaxis.errors import JobError

ENTRIES = [{"job": "one", "started": True}, {"job": "zwei äöü", "reason": "line\nbreak", "spent": 0.1},
           {"job": "one", "outcome": "complete"}]


def filled(path: Path) -> bytes:
    journal = Journal(path)
    for entry in ENTRIES:
        journal.append(entry)
    journal.close()
    return path.read_bytes()


def test_what_was_written_is_read_back_and_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "journal"
    filled(path)
    journal = Journal(path)
    assert journal.entries == ENTRIES and journal.damaged == 0
    journal.append({"more": 1})
    journal.close()
    assert Journal(path).entries == [*ENTRIES, {"more": 1}]
    assert [file.name for file in tmp_path.iterdir()] == ["journal"]


def test_cut_short_at_any_byte_it_keeps_all_whole_lines(tmp_path: Path) -> None:
    path = tmp_path / "journal"
    whole = filled(path)
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        journal = Journal(path)
        count = whole[:length].count(b"\n")
        assert journal.entries == ENTRIES[:count] and journal.damaged == 0
        journal.append({"more": 1})
        journal.close()
        assert Journal(path).entries == [*ENTRIES[:count], {"more": 1}]


@pytest.mark.parametrize("spoilt", [b"x", b"\n", b"\xff", b""])
def test_damaged_anywhere_it_keeps_the_other_lines_and_a_copy(tmp_path: Path, spoilt: bytes) -> None:
    path = tmp_path / "journal"
    whole = filled(path)
    for place in range(0, len(whole), 7):
        if whole[place:place + 1] in (spoilt, b"\n"):
            continue
        damaged = whole[:place] + spoilt + whole[place + 1:]
        path.write_bytes(damaged)
        journal = Journal(path)
        journal.close()
        line = whole[:place].count(b"\n")
        assert journal.damaged >= 1 and journal.entries == ENTRIES[:line] + ENTRIES[line + 1:]
        assert journal.kept is not None and journal.kept.read_bytes() == damaged
        again = Journal(path)
        again.close()
        assert again.damaged == 0 and again.entries == journal.entries


def test_a_full_disk_is_a_sentence_and_leaves_no_half_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "journal"
    whole = filled(path)
    journal, write, calls = Journal(path), os.write, []

    def full(number: int, content: bytes) -> int:
        calls.append(content)
        if len(calls) > 1:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(number, content[:10])

    monkeypatch.setattr(os, "write", full)
    with pytest.raises(JobError, match=r"No space left on device.*goes on where it stopped"):
        journal.append({"job": "two"})
    monkeypatch.undo()
    assert path.read_bytes() == whole
    journal.append({"job": "two"})
    journal.close()
    assert Journal(path).entries == [*ENTRIES, {"job": "two"}]
