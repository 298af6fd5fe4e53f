"""Many parts in a batch: local processes or a cluster, resumed where it was stopped."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, closing, suppress
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

from toolaxis.batch.folder import BatchFolder
from toolaxis.batch.hand import by_hand
from toolaxis.batch.jobfile import CheckedJob, read_jobs
from toolaxis.batch.summary import JobRow
from toolaxis.batch.task import BatchAnswer, BatchTask
from toolaxis.errors import Cancelled, InvalidInput, JobError
from toolaxis.job.planning.parallel import check_workers
from toolaxis.numeric.shares import count_cores
from toolaxis.progress import NO_PROGRESS, Progress


@dataclass(frozen=True)
class Batch:
    """What a batch came to.

    Attributes
    ----------
    folder : Path
        It holds a folder for each job that has a plan, summary.csv, summary.json and the journal.
    rows : tuple of JobRow
        One for each job, in the order of the jobs.
    cancelled : bool
        Whether the user stopped it.
    repeated : int
        Number of jobs that were finished before.
    """

    folder: Path
    rows: tuple[JobRow, ...]
    cancelled: bool
    repeated: int

    @property
    def complete(self) -> bool:
        """Whether every job has its plan, with an axis for each sub-surface, and no verdict is fail."""
        return all(row.outcome == "complete" for row in self.rows)


def batch(jobs: str | PathLike[str] | Iterable[Mapping[str, Any]], out: str | PathLike[str], *,
          workers: int | None = None, scheduler: str | None = None, told: Callable[[str], None] | None = None,
          progress: Progress = NO_PROGRESS) -> Batch:
    """Plan many parts, each in a process that may fail by itself, and go on where an earlier run was stopped.

    A job is finished when its folder is in its place; it is then not done again, however the run ended, unless the job
    was changed: its part, tool, machine or settings, or the version of toolaxis.  A job that failed (its process
    crashed, or used up its time or memory) is reported, does not stop the others, and is tried again by the next run.

    Parameters
    ----------
    jobs : path or iterable of mappings
        A TOML file with [defaults] and [[jobs]], or the jobs themselves.  Each has the keys of `toolaxis.plan` and of
        the command: part, tool, scallop, faces, holder, stickout, obstacles, regions, orientations, machine, offset,
        limits, allowance, allowance_on, stock, greatest_step_over, lead, origin, stock_box, avoid, held, after, method,
        strategy, objective, direction, clearances, least_lean (degrees) and roughness (micrometres) as in the command,
        feedrate, spindle, rapid, compare; and name (that of its folder; the part's file unless given), verify,
        pictures, minutes, timeout (s) and memory (MB).  Parts and obstacles in mappings may be anything that
        `toolaxis.load` takes, tools a Tool, machines a Machine.  `after` names jobs before it, for earlier setups of
        the same part.
    out : path
        Folder of the batch, made where there is none.
    workers : int, optional
        Processes; as many as there are cores unless given.  The plans are the same for any number.
    scheduler : str, optional
        Address of a dask.distributed scheduler whose workers take the jobs instead.  They need toolaxis, but no file
        of this machine.
    told : callable, optional
        Takes a sentence for each job that ends and for what else is to be known.
    progress : Progress

    Returns
    -------
    Batch

    Raises
    ------
    InvalidInput
        Before any work, when a job is wrong, another batch is at work in the folder, or no scheduler answers.
    MissingBackend
        When a scheduler is given and dask.distributed is not installed.
    JobError
        When the disk is full, the folder was moved away, or the scheduler is gone; what was finished stays.
    """
    wanted = read_jobs(jobs)
    count = _count(workers, scheduler)
    with ExitStack() as stack:
        client = None
        if scheduler is not None:
            from toolaxis.batch.cluster import by_cluster, connect_to_scheduler

            client = stack.enter_context(connect_to_scheduler(scheduler))
        folder = stack.enter_context(BatchFolder(Path(out)))
        run = _Run(wanted, folder, told or (lambda _: None), progress)
        run.look()
        engine = by_hand(run.tasks(), count, folder.work) if client is None else \
            by_cluster(client, run.tasks(), run.told)
        return run.carried_out(engine)


def _count(workers: int | None, scheduler: str | None) -> int:
    check_workers(workers)
    if scheduler is not None and workers is not None:
        raise InvalidInput("the workers of a cluster are its own: give either a scheduler or a number of workers")
    return count_cores() if workers is None else workers


class _Run:
    """One run of a batch: what is finished, what is at work, and what is still to be done."""

    def __init__(self, wanted: tuple[CheckedJob, ...], folder: BatchFolder, told: Callable[[str], None],
                 progress: Progress) -> None:
        self.told = told
        self._wanted, self._folder, self._progress = {job.name: job for job in wanted}, folder, progress
        self._rows = {job.name: _row(job) for job in wanted}
        self._ended = 0

    def look(self) -> None:
        """Find the jobs that are finished."""
        spent = {entry["job"]: entry["spent"] for entry in self._folder.journal.entries if "spent" in entry}
        for job in self._wanted.values():
            found = self._folder.finished(job)
            if found is not None:
                self._ended += 1
                self._rows[job.name] = _row(job, BatchAnswer(found["outcome"], "", found["reason"], found["figures"],
                                                             spent=spent.get(job.name, 0.0)))
        self._repeated = self._ended
        self._tell_notes()
        if self._ended:
            self.told(f"{self._ended} of {len(self._wanted)} jobs are finished already")
        self._report()

    def tasks(self) -> Iterator[BatchTask | None]:
        """The jobs that are not finished, each written down as begun when it is asked for; None while all that are left
        go on after one that is at work."""
        left = [job for job in self._wanted.values() if self._rows[job.name].outcome == "not done"]
        while left:
            job = next(filter(self._may_begin, left), None)
            if job is None:
                yield None
                continue
            left.remove(job)
            try:
                task = self._complete_task(job)
            except InvalidInput as reason:
                self._take(job, BatchAnswer("failed", "input", str(reason)))
                continue
            self._folder.check()
            self._folder.started(job)
            yield task

    def _may_begin(self, job: CheckedJob) -> bool:
        """Whether all jobs have ended after which a job goes on."""
        return all(self._rows[name].outcome != "not done" for name in job.after)

    def _complete_task(self, job: CheckedJob) -> BatchTask:
        """A task with the plans for the setups before it.

        Raises
        ------
        InvalidInput
            When one of them has no plan, or a file cannot be read any more.
        """
        task = job.task()
        for name in job.after:
            if self._rows[name].outcome == "failed":
                raise InvalidInput(f"job {name}, after which this one goes on, has no plan: see to that one first")
        return replace(task, earlier=tuple(map(self._folder.files_of, job.after)))

    def carried_out(self, answers: Iterator[tuple[BatchTask, BatchAnswer] | None]) -> Batch:
        """The batch, once all its jobs have ended or the user has stopped it."""
        cancelled = False
        try:
            with closing(answers):  # type: ignore[type-var]
                for item in answers:
                    self._progress.check()
                    self._folder.check()
                    if item is not None:
                        self._take(self._wanted[item[0].name], item[1])
        except Cancelled:
            cancelled = True
        except BaseException as reason:
            with suppress(JobError):
                self._summarise()
            if isinstance(reason, OSError):
                raise JobError("jobs", str(self._folder.path), f"processes cannot be started or their files not be "
                               f"written ({reason.strerror}): nothing that was finished is lost; run the batch again "
                               "once that is mended") from reason
            raise
        self._summarise()
        return Batch(self._folder.path, tuple(self._rows.values()), cancelled, self._repeated)

    def _summarise(self) -> None:
        if self._folder.stands:
            self._folder.summarise(list(self._rows.values()))

    def _take(self, job: CheckedJob, answer: BatchAnswer) -> None:
        """Keep an answer."""
        if answer.cause == "disk":
            raise JobError("jobs", job.name, f"the disk is full ({answer.reason}): nothing that was finished is lost; "
                           "free some space and run the batch again")
        self._folder.keep(job, answer)
        self._rows[job.name] = _row(job, answer)
        self._ended += 1
        why = f": {answer.reason}" if answer.reason else ""
        self.told(f"job {job.name}: {answer.outcome}{why}")
        self._tell_notes()
        self._report()

    def _tell_notes(self) -> None:
        while self._folder.notes:
            self.told(self._folder.notes.pop(0))

    def _report(self) -> None:
        with suppress(Cancelled):
            self._progress.report("jobs", self._ended, len(self._wanted))


def _row(job: CheckedJob, answer: BatchAnswer | None = None) -> JobRow:
    spec = job.spec
    first = (job.name, spec.part, job.spec.tool, spec.machine, spec.inputs.scallop)
    if answer is None:
        return JobRow(*first)
    return JobRow(*first, answer.outcome, answer.cause, answer.reason, answer.figures,
                  "" if answer.outcome == "failed" else job.name, answer.spent)
