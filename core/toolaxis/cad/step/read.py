"""STEP files, read by a kernel in a process of its own so that a crash or a hang stays there; by FreeCAD inside it."""

import hashlib
import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from typing import Any

import toolaxis
from toolaxis.cad.build_part import part_from_record
from toolaxis.cad.shape_data import Transfer
from toolaxis.cad.step.precheck import ACCEPT, UNDECLARED, StepText, read_text
from toolaxis.cad.unit_checks import unit_warnings
from toolaxis.errors import InvalidInput, MissingBackend, UnsupportedGeometry
from toolaxis.shape.part import Part

COMMAND = ("-m", "toolaxis.cad.step.worker")


def read_step(path: str | PathLike[str], time_limit: float | None = None, accept_lost_faces: bool = False) -> Part:
    """Read a part from a STEP file.

    Parameters
    ----------
    path : path
    time_limit : float, optional
        s for the CAD kernel; a minute and another 20 s for each megabyte unless given.
    accept_lost_faces : bool
        Go on, with a warning, when faces of the file are damaged or did not survive the transfer.

    Raises
    ------
    InvalidInput
        When the file is missing, empty, cut short, not STEP, holds numbers that are not finite or entities twice, only
        refers to other files, hangs or crashes the kernel, or has damaged or lost faces.
    UnsupportedGeometry
        When none of its faces can be used.
    MissingBackend
        When no CAD kernel is installed.
    """
    file = Path(path)
    text = read_text(file, accept_lost_faces)
    found = _transfer(file, text, time_limit)
    lost = _sentence_on_lost_faces(file, text, found)
    if lost and not accept_lost_faces:
        raise InvalidInput(f"{lost}; {ACCEPT}")
    record = found.record
    if record.unit == UNDECLARED != text.unit:
        raise InvalidInput(f"{file} declares the length unit {text.unit}, and the CAD kernel finds none: export the "
                           "part again")
    record.warnings += [*text.notes, *([lost] if lost else _dangling(text)), *_split(text, found)]
    digest = hashlib.sha256(file.read_bytes()).hexdigest()
    part = part_from_record(record, str(file), digest)
    return part.with_warnings(*unit_warnings(part))


@contextmanager
def readable(file: Path, text: StepText) -> Iterator[Path]:
    """A file that a kernel can read: the one given, or one for the time being with its text as it was mended.

    Parameters
    ----------
    file : Path
    text : StepText
        Of the file.
    """
    if not text.changed:
        yield file
        return
    with tempfile.TemporaryDirectory(prefix="toolaxis-") as folder:
        mended = Path(folder) / "mended.step"
        mended.write_bytes(text.content)
        yield mended


def _transfer(file: Path, text: StepText, time_limit: float | None) -> Transfer:
    """What the kernel makes of a file."""
    if find_spec("OCP") is not None:
        return _in_child(file, text, 60.0 + 20.0 * len(text.content) / 1e6 if time_limit is None else time_limit)
    if "FreeCAD" not in sys.modules:
        raise MissingBackend("reading STEP files needs a CAD kernel: pip install 'toolaxis[cadquery]'")
    from toolaxis.cad.freecad.shapes import step_record

    try:
        with readable(file, text) as source:
            return step_record(source, text)
    except (InvalidInput, UnsupportedGeometry) as reason:
        raise type(reason)(f"{file}: {reason}") from reason


def _in_child(file: Path, text: StepText, limit: float) -> Transfer:
    with tempfile.TemporaryDirectory(prefix="toolaxis-") as folder, readable(file, text) as source:
        order, target = Path(folder) / "order", Path(folder) / "outcome"
        order.write_bytes(pickle.dumps(text.order, protocol=pickle.HIGHEST_PROTOCOL))
        outcome = _outcome(_run([str(source.resolve()), str(target), str(order)], file, limit), target, file)
    if outcome[0] == "failed":
        raise outcome[1](f"{file}: {outcome[2]}{_cause(text) if outcome[1] is InvalidInput else ''}")
    assert isinstance(outcome[1], Transfer)
    return outcome[1]


def _run(arguments: list[str], file: Path, limit: float) -> "subprocess.CompletedProcess[bytes]":
    root = str(Path(toolaxis.__file__).parents[1])
    paths = [root, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "TOOLAXIS_NUMBA": "0"}
    command = [sys.executable, *COMMAND, *arguments]
    try:
        # In a session of its own: Ctrl-C in a terminal goes to every process of the group, and would look like a crash.
        return subprocess.run(command, env=environment, capture_output=True, timeout=limit, check=False,
                              stdin=subprocess.DEVNULL, start_new_session=True)
    except subprocess.TimeoutExpired as reason:
        raise InvalidInput(f"{file} kept the CAD kernel busy for more than {limit:.0f} s: repair the geometry, or "
                           "raise time_limit") from reason


def _outcome(child: "subprocess.CompletedProcess[bytes]", target: Path, file: Path) -> tuple[Any, ...]:
    if child.returncode == 0 and target.exists():
        outcome: tuple[Any, ...] = pickle.loads(target.read_bytes())
        return outcome
    last = child.stderr.decode(errors="replace").strip().splitlines()[-1:]
    why = f"signal {-child.returncode}" if child.returncode < 0 else (last[0] if last else f"exit {child.returncode}")
    raise InvalidInput(f"{file} crashed the CAD kernel ({why}): repair the geometry and export it again")


def _sentence_on_lost_faces(file: Path, text: StepText, found: Transfer) -> str:
    """A sentence about the faces that the kernel was given and has not made."""
    promised, cause = text.order.promised, _cause(text, found.lost)
    missing = len(found.lost) or promised - found.distinct
    if missing <= 0:
        return ""
    named = ", ".join(f"{number} (#{entity})" for entity, number in list(found.lost.items())[:3])
    which = f": face{'s' * (missing > 1)} {named}{', ...' * (missing > 3)}" if named else ""
    return f"{file} lost {missing} of its {promised} faces in transfer{cause}{which}"


def _cause(text: StepText, lost: Iterable[int] = ()) -> str:
    """What the text lacks, in brackets behind what went wrong."""
    if text.dangling:
        return f" (its text refers to #{text.dangling[0]}, which is not defined)"
    alone = text.homeless.intersection(lost)
    return f" (#{min(alone)} stands in no product of the file)" if alone else ""


def _split(text: StepText, found: Transfer) -> list[str]:
    """A sentence where a kernel has made more faces than there are in the file."""
    if found.split:
        entity, count = next(iter(found.split.items()))
        return [f"the CAD kernel made {count} faces of the file's face #{entity}: look at them before they are "
                "machined"]
    if found.distinct > text.order.promised > 0:
        return [f"the CAD kernel made {found.distinct} faces of the {text.order.promised} in the file: look at them "
                "before they are machined"]
    return []


def _dangling(text: StepText) -> list[str]:
    if not text.dangling:
        return []
    return [f"the file refers to #{text.dangling[0]}, which it does not define; no face was lost"]
