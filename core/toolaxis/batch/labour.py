"""A process that carries out the jobs of a batch, one after the other: what goes wrong in it stays in it."""

import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import threading
import time
import traceback
from contextlib import suppress
from dataclasses import replace
from errno import EDQUOT, ENOSPC
from math import isfinite
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from toolaxis import __version__
from toolaxis.batch.hand import MEGABYTE, descendants
from toolaxis.batch.task import BatchAnswer, BatchTask, PartBytes
from toolaxis.errors import OUT_OF_MEMORY, InvalidInput, MissingBackend, ToolAxisError, UnsupportedGeometry
from toolaxis.numeric.jit import compilations
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress, TimeLimit
from toolaxis.shape.part import Part

FULL = (ENOSPC, EDQUOT)
#: Parts that are kept in memory for the next jobs.
_KEPT = 4


def answer_task(task: BatchTask, scratch: Path, known: dict[str, Part]) -> BatchAnswer:
    """The answer to a task.

    Parameters
    ----------
    task : BatchTask
    scratch : Path
        Folder for files that nobody else writes to.
    known : dict of str to Part
        Parts that were read before, by SHA-256; parts that are read now are added.

    Returns
    -------
    BatchAnswer
        Failed, with a sentence, where there is no plan; never an exception.
    """
    began, folder = time.monotonic(), scratch / "plan"
    try:
        folder.mkdir()
        if task.version != __version__:
            raise InvalidInput(f"toolaxis is {__version__} here and {task.version} where the batch was started: "
                               "install the same version on all machines")
        outcome, reason, figures = _write_planned(task, scratch, folder, known)
        files = {path.name: path.read_bytes() for path in sorted(folder.iterdir())}
        return BatchAnswer(outcome, "", reason, figures, files, time.monotonic() - began)
    except BaseException as reason:
        cause, said = _failure(reason, task)
        for source in (task.part, *task.obstacles):
            said = said.replace(str(_place(source, scratch)), source.name)
        return BatchAnswer("failed", cause, said, spent=time.monotonic() - began)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _failure(reason: BaseException, task: BatchTask) -> tuple[str, str]:
    """The cause of a failure, and a sentence."""
    if isinstance(reason, MemoryError):
        limit = f": its limit is {task.memory:g} MB" if task.memory else ""
        return "memory", f"it ran out of memory{limit}"
    if isinstance(reason, OSError) and reason.errno in FULL:
        return "disk", f"{reason.strerror}: {reason.filename or 'temporary files'}"
    said = " ".join(str(reason).split())
    if isinstance(reason, TimeoutError):
        return "timeout", said
    if isinstance(reason, ToolAxisError):
        wrong = isinstance(reason, InvalidInput | UnsupportedGeometry | MissingBackend)
        return ("input" if wrong else "error"), said
    return "error", f"{type(reason).__name__}: {said}"


def _write_planned(task: BatchTask, scratch: Path, folder: Path, known: dict[str, Part]) -> tuple[str, str,
                                                                                                  dict[str, Any]]:
    """Write a plan's folder; its outcome, the reason for it and its figures."""
    from toolaxis.job.files.plan_folder import PLAN, read_json, read_plan, write_json, write_plan
    from toolaxis.job.files.verdict_maps import write_views
    from toolaxis.job.output.verify import has_passes, verdict_document, verify_plan
    from toolaxis.job.planning.pipeline import plan

    part, *obstacles = (_part(source, scratch, known) for source in (task.part, *task.obstacles))
    if task.memory is not None:  # once the parts are read: what their kernel takes is looked at from outside
        resource.setrlimit(resource.RLIMIT_DATA, (int(task.memory * MEGABYTE),) * 2)
    progress = Progress(cancelled=TimeLimit(task.minutes).is_up)
    made = plan(part, task.tools, machine=task.machine, obstacles=obstacles or None, workers=1, progress=progress,
                after=[_earlier_plan(one, scratch) for one in task.earlier], **task.options)
    out_of_time = made.outcome == "cancelled"
    if out_of_time and not made.operations:
        raise TimeoutError(f"no face was finished within the {task.minutes:g} min of 'minutes'")
    if made.operations and all(op.orientation.reasons[:1] and op.orientation.reasons[0].startswith(OUT_OF_MEMORY)
                               for op in made.operations):
        raise MemoryError  # nothing is lost with the plan, and the next run tries it again
    made = write_plan(made, folder)
    document = read_json(folder / PLAN)
    document["part"]["source"] = task.part.name
    write_json(document, folder / PLAN)
    verdict, reasons = "", _reasons(made)
    if out_of_time:
        reasons.insert(0, f"planning was stopped when the {task.minutes:g} min of 'minutes' were over")
    if task.verify:
        judged = read_plan(folder)
        found = verify_plan(judged, threads=1)
        written = verdict_document(judged, found)
        write_json(written, folder / "verdict.json")
        write_views(judged, found, folder)
        verdict = "passed" if has_passes(judged, found) else "failed"
        reasons += written["reasons"]
    if task.pictures:
        from toolaxis.job.output.pictures import draw_plan

        draw_plan(made, folder)
    outcome = "complete" if made.outcome == "complete" and verdict != "failed" else "incomplete"
    return outcome, "" if outcome == "complete" else "; ".join(reasons), {**_figures(made), "verdict": verdict}


def _reasons(made: Plan) -> list[str]:
    return [f"face {op.face.label}: {', '.join(op.orientation.reasons) or op.orientation.outcome}"
            for op in made.operations if not op.done and not op.left]


def _figures(made: Plan) -> dict[str, Any]:
    done = [op for op in made.operations if op.done]
    sizes = {"length": made.length, "travel": made.travel, "seconds": made.seconds,
             "gouge": max((op.orientation.gouge for op in done), default=0.0)}
    return {"operations": len(made.operations), "without_axis": sum(not op.done for op in made.operations),
            "orientations": made.orientations, "passes": int(sum(op.orientation.passes for op in done)),
            **{name: float(size) if isfinite(size) else None for name, size in sizes.items()}}


def _earlier_plan(files: dict[str, bytes], scratch: Path) -> Plan:
    """The plan for a setup before, read from its files."""
    from toolaxis.job.files.plan_folder import read_plan

    with tempfile.TemporaryDirectory(prefix="earlier-", dir=scratch) as folder:
        for name, content in files.items():
            (Path(folder) / name).write_bytes(content)
        return read_plan(Path(folder))


def _place(source: PartBytes, scratch: Path) -> Path:
    """Where the file of a source is written to."""
    return scratch / source.sha256 / Path(source.name).name


def _part(source: PartBytes, scratch: Path, known: dict[str, Part]) -> Part:
    """The part of a source, read from a file of its own name where it is a file."""
    found = known.get(source.sha256)
    if found is not None:
        return found
    if source.document:
        from toolaxis.plan.part_document import part_from

        part = part_from(json.loads(source.content))
    else:
        from toolaxis.cad.load import load

        path = _place(source, scratch)
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(source.content)
        part = load(path)
    while len(known) >= _KEPT:
        oldest = next(iter(known))
        del known[oldest]
        shutil.rmtree(scratch / oldest, ignore_errors=True)
    known[source.sha256] = part
    return part


def main(descriptor: int, scratch: Path) -> None:
    """Carry out tasks that come through a pipe until it is closed, whatever is going on then.

    Parameters
    ----------
    descriptor : int
        Of the pipe.
    scratch : Path
        Folder of this process alone; removed at the end.
    """
    with suppress(OSError):  # where memory is short the system is to end this process, not who waits for it
        Path("/proc/self/oom_score_adj").write_text("500")
    compiled, known = compilations(), dict[str, Part]()
    pipe, tasks = Connection(descriptor), SimpleQueue[BatchTask]()
    threading.Thread(target=_listen, args=(pipe, tasks, scratch), daemon=True).start()
    while True:
        found = answer_task(tasks.get(), scratch, known)
        with suppress(BrokenPipeError, ConnectionResetError):  # nobody is there any more: see `_listen`
            pipe.send(replace(found, compiled=compiled() > 0))


def _listen(pipe: Connection, tasks: "SimpleQueue[BatchTask]", scratch: Path) -> None:
    """Take tasks; once nobody is there to give any, end the process with all that it has left behind."""
    alone = False
    try:
        while True:
            tasks.put(pipe.recv())
    except (EOFError, OSError):
        alone = True
    except BaseException:
        traceback.print_exc()  # for whoever waits for an answer
    finally:
        for number in descendants(os.getpid()):
            with suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)
        if alone:
            shutil.rmtree(scratch, ignore_errors=True)
        os._exit(1)


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
