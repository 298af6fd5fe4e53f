"""The written form of a plan: plan.json, the part's copy and the CL files, whole or not at all."""

import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from toolaxis.cad.load import load
from toolaxis.errors import InvalidInput, about, fault, piece_of
from toolaxis.job.planning.failures import fail_operation, failure_text, fault_text
from toolaxis.plan.document import plan_document, plan_from
from toolaxis.plan.part_document import part_document, part_from
from toolaxis.plan.plan import Plan
from toolaxis.plan.schema import check
from toolaxis.post.apt import operation_text
from toolaxis.post.read_apt import read_apt
from toolaxis.shape.part import Part
from toolaxis.strategies.registry import strategy_of, title_of

PLAN = "plan.json"
#: What a folder may hold of an earlier plan, and of an earlier verdict; the rest in it is the user's and stays.
OF_PLAN = (PLAN, "plan.step", "plan.glb", "verdict.json", "verdict-maps.npz", "report.html", "part.*", "obstacle-*.*",
           "op*.apt", "failed-*.txt", "program-*.*", "setup-*.md", "*.png")
OF_VERDICT = ("verdict.json", "verdict-maps.npz", "op*-verdict.png")


@dataclass(frozen=True)
class StagingFolder:
    """A folder in the making.

    Attributes
    ----------
    folder : Path
        Temporary, beside the place where its files will stand.
    target : Path
        That place.
    """

    folder: Path
    target: Path

    def publish(self, instead_of: Sequence[str] = ()) -> None:
        """Move every file to its place, plan.json last, so that a plan.json is never without its files.

        Parameters
        ----------
        instead_of : sequence of str
            Patterns of files to remove first: `OF_PLAN` or `OF_VERDICT`.
        """
        if not self.target.exists():
            os.replace(self.folder, self.target)
            return
        for pattern in instead_of:
            for path in self.target.glob(pattern):
                path.unlink()
        names = sorted((path.name for path in self.folder.iterdir()), key=lambda name: (name == PLAN, name))
        for name in names:
            os.replace(self.folder / name, self.target / name)


@contextmanager
def stage_folder(target: Path) -> Iterator[StagingFolder]:
    """A stage for a folder; what was not published when the block ends disappears.

    Parameters
    ----------
    target : Path
        Made when the stage is published, with the folders above it.

    Raises
    ------
    InvalidInput
        When the folder cannot be written, before any work is done.
    """
    above = target if target.exists() else target.absolute().parent
    if target.exists() and not target.is_dir():
        raise InvalidInput(f"output folder {target} is a file: give another folder")
    made: list[Path] = []
    try:
        made = make_folders(above)
        folder = Path(tempfile.mkdtemp(prefix=f".{target.name or 'plan'}-", dir=above))
        folder.chmod(0o755)
    except OSError as reason:
        remove_empty(made)
        raise InvalidInput(f"output folder {target} cannot be written ({reason.strerror}): give another") from reason
    try:
        yield StagingFolder(folder, target)
    finally:
        try:
            shutil.rmtree(folder, ignore_errors=True)
        except KeyboardInterrupt:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        finally:
            remove_empty(made)


def make_folders(folder: Path) -> list[Path]:
    """Make a folder and those above it; the ones that were made, the innermost first.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    OSError
        When one cannot be made.
    """
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return missing


def remove_empty(folders: list[Path]) -> None:
    """Remove folders that stayed empty.

    Parameters
    ----------
    folders : list of Path
        The innermost first.
    """
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return


def sha256_of(path: Path) -> str:
    """SHA-256 of a file's bytes, as hexadecimal digits.

    Parameters
    ----------
    path : Path
    """
    return hashlib.sha256(path.read_bytes()).hexdigest()


def write_plan(plan: Plan, folder: Path) -> Plan:
    """Write a plan's files into a folder.

    Parameters
    ----------
    plan : Plan
    folder : Path
        Of a `StagingFolder`.

    Returns
    -------
    Plan
        The plan as it was written: an operation that cannot be written has failed, and keeps no other from the disk.
    """
    part = _write_part(plan.part, folder, "part")
    obstacles = [_write_part(body, folder, f"obstacle-{k}") for k, body in enumerate(plan.obstacles, 1)]
    while True:
        try:
            files = _write_operations(plan, folder)
            document = plan_document(plan, {"part": part, "obstacles": obstacles, **files})
            break
        except Exception as reason:
            plan = _without(plan, reason, folder)
    check(document)
    write_json(document, folder / PLAN)
    return plan


def _write_operations(plan: Plan, folder: Path) -> dict[str, Any]:
    """Write the CL files, and what tells of failures; their names."""
    names: list[str | None] = []
    failures: list[str | None] = []
    for op in plan.operations:
        names.append(None if op.path is None else f"{op.name}.apt")
        told = op.failed and (plan.blades is None or op.number not in plan.blades.copies)
        failures.append(f"failed-{op.name}.txt" if told else None)
        if op.path is not None:
            with about(op.face.label):
                text = operation_text(op, plan.inputs)
            (folder / f"{op.name}.apt").write_text(text, encoding="ascii")
        if told:
            (folder / f"failed-{op.name}.txt").write_text(failure_text(plan, op), encoding="utf-8")
    whole = "failed-plan.txt" if plan.faults else None
    if whole:
        (folder / whole).write_text("\n".join(fault_text(plan, one) for one in plan.faults), encoding="utf-8")
    return {"operations": names, "failures": failures, "failure": whole}


def _without(plan: Plan, reason: Exception, folder: Path) -> Plan:
    """A plan without the operation that cannot be written."""
    lost = {op.number: fail_operation(op, fault(reason)) for op in plan.operations
            if op.face.label == piece_of(reason) and not op.failed}
    if not lost:
        raise reason
    for op in lost.values():
        (folder / f"{op.name}.apt").unlink(missing_ok=True)
    outcome = "incomplete" if plan.outcome == "complete" else plan.outcome
    return replace(plan, operations=tuple(lost.get(op.number, op) for op in plan.operations), outcome=outcome)


def write_json(document: Any, path: Path) -> None:
    """Write a document as strict JSON (no NaN, no infinity).

    Parameters
    ----------
    document : object
    path : Path
    """
    path.write_text(json.dumps(document, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _write_part(part: Part, folder: Path, stem: str) -> dict[str, str]:
    """Copy the file that a part came from, or write its faces, none joined, where there is none (any more)."""
    part = part.original or part
    source = Path(part.source) if part.source and part.sha256 else None
    if source is not None and source.is_file() and sha256_of(source) == part.sha256:
        path = folder / f"{stem}{source.suffix.lower()}"
        shutil.copyfile(source, path)
    else:
        path = folder / f"{stem}.json"
        write_json(part_document(part), path)
    return {"file": path.name, "sha256": sha256_of(path)}


def read_json(path: Path) -> Any:
    """Read a JSON file.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InvalidInput
        When it is missing, cannot be read, or is not JSON.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InvalidInput(f"{path} does not exist: give a folder that toolaxis plan wrote") from None
    except (OSError, UnicodeDecodeError) as reason:
        raise InvalidInput(f"{path} cannot be read: {reason}") from reason
    except json.JSONDecodeError as reason:
        raise InvalidInput(f"{path} is not JSON, or was cut short: {reason}; make the plan again") from reason


def read_plan(folder: Path) -> Plan:
    """Read a plan back from its folder: the tool paths are those of the CL files.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    InvalidInput
        When a file is missing, broken, or not the one that was planned with.
    """
    document = read_json(folder / PLAN)
    check(document)
    strategy = strategy_of(document["inputs"]["method"])
    part = _read_part(folder, document["part"])
    obstacles = [_read_part(folder, record) for record in document["obstacles"]]
    paths = [None if op["cl_file"] is None else _read_path(folder, op["cl_file"]) for op in document["operations"]]
    plan = plan_from(document, part, obstacles, paths)
    titled = tuple(replace(one, title=title_of(one.method)) for one in plan.baselines)
    return replace(plan, baselines=titled, at_points=strategy.at_points)


def _inside(folder: Path, name: str) -> Path:
    path = folder / name
    if Path(name).name != name:
        raise InvalidInput(f"{PLAN} names the file {name!r}: a plain name in the same folder is needed")
    if not path.is_file():
        raise InvalidInput(f"{path} does not exist: the plan's folder is incomplete; make the plan again")
    return path


def _read_part(folder: Path, record: dict[str, str]) -> Part:
    path = _inside(folder, record["file"])
    found = sha256_of(path)
    if found != record["sha256"]:
        raise InvalidInput(f"{path} has changed since the plan was made (SHA-256 {found[:12]}..., planned with "
                           f"{record['sha256'][:12]}...): make the plan again")
    return part_from(read_json(path), found) if path.suffix == ".json" else load(path)


def _read_path(folder: Path, name: str) -> Any:
    path = _inside(folder, name)
    try:
        return read_apt(path.read_text(encoding="utf-8")).path
    except (InvalidInput, UnicodeDecodeError) as reason:
        raise InvalidInput(f"{path}: {reason}") from reason
