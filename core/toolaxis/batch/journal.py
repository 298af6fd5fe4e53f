"""A journal that survives being killed: lines are only added, with checksums, and on the disk before work goes on."""

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from toolaxis.errors import JobError

_DIGITS = 16


def _line(entry: Mapping[str, Any]) -> bytes:
    body = json.dumps(entry, sort_keys=True, allow_nan=False).encode()
    return _sum(body) + b" " + body + b"\n"


def _sum(body: bytes) -> bytes:
    return hashlib.sha256(body).hexdigest()[:_DIGITS].encode()


def _entry(line: bytes) -> dict[str, Any] | None:
    """What a line says; None where it is damaged."""
    checksum, _, body = line.partition(b" ")
    if checksum != _sum(body):
        return None
    found = json.loads(body)
    return found if isinstance(found, dict) else None


class Journal:
    """The journal in a file, made where there is none.

    A last line that was cut short is what a process leaves that is killed while it writes: it is dropped, as what it
    would have told was not told to anybody yet.  Where other lines are damaged, the file is kept under another name and
    the lines that are whole go on in a new one.

    Parameters
    ----------
    path : Path

    Raises
    ------
    JobError
        When it cannot be read or written.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        #: What it tells, in the order in which it was written.
        self.entries: list[dict[str, Any]] = []
        #: Number of lines that were damaged, and where they are kept.
        self.damaged = 0
        self.kept: Path | None = None
        try:
            content = path.read_bytes() if path.exists() else b""
            self._read(content)
            if self.damaged:
                self._set_aside()
            self._file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o644)
            if not self.damaged:
                os.ftruncate(self._file, content.rfind(b"\n") + 1)
        except OSError as reason:
            raise JobError("journal", str(path), f"it cannot be read or written ({reason.strerror})") from reason

    def _read(self, content: bytes) -> None:
        for line in content[:content.rfind(b"\n") + 1].splitlines():
            entry = _entry(line)
            if entry is None:
                self.damaged += 1
            else:
                self.entries.append(entry)

    def _set_aside(self) -> None:
        """Keep a damaged journal under another name, with a new one of the whole lines in its place."""
        number = 1
        while (kept := self.path.with_name(f"{self.path.name}.damaged-{number}")).exists():
            number += 1
        fresh = self.path.with_name(f".{self.path.name}.new")
        with fresh.open("wb") as file:
            file.write(b"".join(map(_line, self.entries)))
            file.flush()
            os.fsync(file.fileno())
        os.link(self.path, kept)
        os.replace(fresh, self.path)
        self.kept = kept

    def append(self, entry: Mapping[str, Any]) -> None:
        """Write an entry; it is on the disk when this returns, or not in the journal at all.

        Parameters
        ----------
        entry : mapping
            Strings and finite numbers.

        Raises
        ------
        JobError
            When it cannot be written.
        """
        before = os.fstat(self._file).st_size
        line = _line(entry)
        try:
            written = 0
            while written < len(line):
                written += os.write(self._file, line[written:])
            os.fsync(self._file)
        except OSError as reason:
            os.ftruncate(self._file, before)
            raise JobError("journal", str(self.path), f"it cannot be written ({reason.strerror}): free some space and "
                           "run the batch again, it goes on where it stopped") from reason
        self.entries.append(dict(entry))

    def close(self) -> None:
        """Close the file."""
        os.close(self._file)
