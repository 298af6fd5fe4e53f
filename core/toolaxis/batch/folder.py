"""The folder of a batch: one folder for each finished job, whole or not at all, a journal, and a lock."""

import hashlib
import json
import os
import shutil
import socket
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from toolaxis.batch.jobfile import CheckedJob
from toolaxis.batch.journal import Journal
from toolaxis.batch.summary import JobRow, summary_csv, summary_document
from toolaxis.batch.task import BatchAnswer
from toolaxis.errors import InvalidInput, JobError, MissingBackend
from toolaxis.job.files.plan_folder import make_folders, remove_empty

JOB, JOURNAL, LOCK, WORK = "job.json", "journal.jsonl", ".lock", ".work"
_SUMMARIES = ("summary.csv", "summary.json")
#: What other commands write into the folder of a job from its plan.
_DERIVED = ("report.html", "plan.step", "plan.glb")


class BatchFolder:
    """The folder of a batch, for this process alone until the block ends.

    Parameters
    ----------
    path : Path
        Made where it does not exist.

    Raises
    ------
    InvalidInput
        When the folder cannot be written, or another batch is at work in it.
    JobError
        When its journal cannot be written.
    MissingBackend
        When the system has no locks.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        #: Where jobs write what is not finished.
        self.work = path / WORK
        #: Sentences about what was found.
        self.notes: list[str] = []
        self._made: list[Path] = []
        self._new = self._answered = False

    def __enter__(self) -> "BatchFolder":
        if self.path.exists() and not self.path.is_dir():
            raise InvalidInput(f"output folder {self.path} is a file: give another name with --out")
        try:
            self._made = make_folders(self.path)
            self._lock = _lock_folder(self.path)
            self._place = os.stat(self.path).st_ino
        except OSError as reason:
            remove_empty(self._made)
            raise self._refusal(reason) from reason
        try:
            self._new = not (self.path / JOURNAL).exists()
            shutil.rmtree(self.work, ignore_errors=True)
            self.work.mkdir()
            self.journal = Journal(self.path / JOURNAL)
        except BaseException as reason:
            self._leave()
            if isinstance(reason, OSError):
                raise self._refusal(reason) from reason
            raise
        self._answered = any("outcome" in entry for entry in self.journal.entries)
        if self.journal.damaged:
            self.notes.append(f"{self.journal.damaged} lines of the journal are damaged: it is kept as "
                              f"{self.journal.kept}, and jobs whose folders are whole stay finished")
        return self

    def _refusal(self, reason: OSError) -> InvalidInput:
        return InvalidInput(f"output folder {self.path} cannot be written ({reason.strerror}): give another with --out")

    def __exit__(self, kind: type[BaseException] | None, reason: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.journal.close()
        self._leave()

    def _leave(self) -> None:
        """Remove what is not a result; the folder too, and its journal, where they were made for nothing."""
        if self.stands:
            shutil.rmtree(self.work, ignore_errors=True)
            if self._new and not self._answered:
                for name in (JOURNAL, *_SUMMARIES):
                    (self.path / name).unlink(missing_ok=True)
            (self.path / LOCK).unlink(missing_ok=True)
        os.close(self._lock)
        remove_empty(self._made)

    @property
    def stands(self) -> bool:
        """Whether the folder is still where it was."""
        try:
            return os.stat(self.path).st_ino == self._place
        except OSError:
            return False

    def check(self) -> None:
        """Stop where the folder is no longer there.

        Raises
        ------
        JobError
            When it was moved away or removed.
        """
        if not self.stands:
            raise JobError("jobs", str(self.path), "the folder of the batch was moved away: put it back and run the "
                           "batch again, it goes on where it stopped")

    def finished(self, job: CheckedJob) -> dict[str, Any] | None:
        """What a folder tells of a job that is finished; None where the job is still to be done.

        Parameters
        ----------
        job : CheckedJob

        Raises
        ------
        InvalidInput
            When there is something of that name that no batch has made.
        """
        target = self.path / job.name
        if job.name.casefold() in (JOURNAL, *_SUMMARIES):
            raise InvalidInput(f"a job cannot be called {job.name!r}, which is a file of the batch: give it another "
                               "name")
        if not target.exists():
            if any((entry.get("job"), entry.get("key")) == (job.name, job.key)
                   and entry.get("outcome") in ("complete", "incomplete") for entry in self.journal.entries):
                self.notes.append(f"job {job.name} was finished, but its folder is gone: it is planned again")
            return None
        found = _read(target)
        if found is None or found["name"] != job.name:
            raise InvalidInput(f"{target} is there, and no batch has made it: give the job another name, or the batch "
                               "another folder with --out")
        if found["key"] != job.key:
            self.notes.append(f"job {job.name} is not the one that was planned: it is planned again")
            return None
        missing = sorted(name for name in found["files"] if not (target / name).is_file())
        if missing:
            self.notes.append(f"job {job.name} was finished, but its {missing[0]} is gone: it is planned again")
            return None
        return found

    def files_of(self, name: str) -> dict[str, bytes]:
        """The files of a job that has a plan, by their names.

        Parameters
        ----------
        name : str
            Of the job.

        Raises
        ------
        InvalidInput
            When a file of it cannot be read any more.
        """
        target = self.path / name
        found = _read(target) or {"files": {}}
        try:
            return {one: (target / one).read_bytes() for one in found["files"]}
        except OSError as reason:
            raise InvalidInput(f"job {name}, after which this one goes on, has lost {reason.filename}: run it "
                               "again") from reason

    def started(self, job: CheckedJob) -> None:
        """Write down that a job begins.

        Parameters
        ----------
        job : CheckedJob
        """
        self.journal.append({"job": job.name, "key": job.key, "started": True})

    def keep(self, job: CheckedJob, answer: BatchAnswer) -> None:
        """Put the folder of a job in its place, if it has one, and write down what came of it.

        Parameters
        ----------
        job : CheckedJob
        answer : BatchAnswer

        Raises
        ------
        JobError
            When something cannot be written; what was there before stays.
        """
        if answer.outcome != "failed":
            try:
                self._publish(job, answer)
            except OSError as reason:
                self.check()
                raise JobError("jobs", job.name, f"its folder cannot be written ({reason.strerror}): nothing that was "
                               "finished is lost; free some space and run the batch again") from reason
        self.journal.append({"job": job.name, "key": job.key, "outcome": answer.outcome, "cause": answer.cause,
                             "reason": answer.reason, "spent": answer.spent})
        self._answered = True

    def _publish(self, job: CheckedJob, answer: BatchAnswer) -> None:
        stage = Path(tempfile.mkdtemp(prefix="stage-", dir=self.work))
        try:
            stage.chmod(0o755)
            document = {"schema": "toolaxis.job", "version": 1, "name": job.name, "key": job.key,
                        "outcome": answer.outcome, "reason": answer.reason, "figures": answer.figures,
                        "files": {name: hashlib.sha256(content).hexdigest() for name, content in answer.files.items()}}
            text = json.dumps(document, indent=1, allow_nan=False) + "\n"
            for name, content in {**answer.files, JOB: text.encode()}.items():
                _write_synced(stage / name, content)
            _sync_names(stage)
            self._swap(stage, self.path / job.name)
        finally:
            shutil.rmtree(stage, ignore_errors=True)

    def _swap(self, stage: Path, target: Path) -> None:
        """Put a folder in its place; an earlier one stays under another name where somebody else put files into it."""
        if target.exists():
            ours = {JOB, *_DERIVED, *(_read(target) or {"files": {}})["files"]}
            own = any(path.name not in ours for path in target.iterdir())
            number = 1
            while (kept := target.with_name(f"{target.name}.earlier-{number}")).exists():
                number += 1
            os.replace(target, kept if own else self.work / f"old-{stage.name}")
            if own:
                self.notes.append(f"{kept} keeps what was in the folder of job {target.name}, for its further files")
        os.replace(stage, target)
        _sync_names(self.path)

    def summarise(self, rows: Sequence[JobRow]) -> None:
        """Write the summary as CSV and JSON.

        Parameters
        ----------
        rows : sequence of JobRow

        Raises
        ------
        JobError
            When it cannot be written.
        """
        texts = (summary_csv(rows), json.dumps(summary_document(rows), indent=1, allow_nan=False) + "\n")
        try:
            for name, text in zip(_SUMMARIES, texts, strict=True):
                _write_synced(self.work / name, text.encode())
                os.replace(self.work / name, self.path / name)
        except OSError as reason:
            raise JobError("summary", str(self.path), f"it cannot be written ({reason.strerror}); the jobs' folders "
                           "are whole") from reason


def _read(target: Path) -> dict[str, Any] | None:
    """The job.json of a folder; None where there is none."""
    try:
        found = json.loads((target / JOB).read_text(encoding="utf-8"))
        known = found["schema"] == "toolaxis.job" and {"name", "key", "files", "figures", "reason"} <= set(found)
        return found if known else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _write_synced(path: Path, content: bytes) -> None:
    with path.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


def _sync_names(folder: Path) -> None:
    """Bring the names in a folder to the disk."""
    number = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(number)
    finally:
        os.close(number)


def _lock_folder(folder: Path) -> int:
    """A lock on a folder, which goes with the process that holds it."""
    try:
        import fcntl
    except ImportError as reason:
        raise MissingBackend("batches need a system with POSIX locks, such as Linux: plan the parts one by one here") \
            from reason
    path = folder / LOCK
    while True:
        number = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = os.read(number, 200).decode(errors="replace").strip()
            os.close(number)
            raise InvalidInput(f"another batch is at work in {folder} ({holder}): wait for it, or give another folder "
                               "with --out") from None
        if path.exists() and os.stat(path).st_ino == os.fstat(number).st_ino:
            with suppress(OSError):  # a full disk: the others are not told who holds it
                os.ftruncate(number, 0)
                os.write(number, f"process {os.getpid()} on {socket.gethostname()}".encode())
            return number
        os.close(number)  # it was removed meanwhile by whoever held it
