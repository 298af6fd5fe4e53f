"""Plant faults in a copy of the program and see whether its tests find them: ``python tests/plant_faults.py``.

Each fault is one that a slip of the pen makes: a wrong sign, a dropped term, a swapped bound.  One at a time is put
into a copy of the tree, and the tests of the folder that mirrors its package run there; those of the add-on need
FreeCAD, as in tests/workbench.  A fault that no test finds stands for a place that nobody watches.
"""

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
#: What a copy does without.
LEFT_OUT = shutil.ignore_patterns(".git", ".venv*", "out", "build", ".mypy_cache", ".ruff_cache", ".pytest_cache",
                                  ".import_linter_cache")
#: s; a run that takes longer has found nothing.
LIMIT = 600
#: s that a run which is stopped gets to end what it has started.
PATIENCE = 30
#: What pytest answers with: tests passed, a test failed, and the text cannot even be collected.
PASSED, FAILED, BROKEN = 0, 1, 2


class Fault(NamedTuple):
    """A slip that changes what the program does.

    Attributes
    ----------
    file : str
        From the root of the tree.
    old, new : str
        What stands there, exactly once, and what is put in its place.
    tests : tuple of str
        What ought to find it, below tests/: the folder that mirrors the package, or of a large one the files about the
        same subject, so that a fault takes about a minute.
    """

    file: str
    old: str
    new: str
    tests: tuple[str, ...]


CORE, BENCH = "core/toolaxis/", "workbench/freecad/toolaxis/"
FAULTS = (
    Fault(CORE + "numeric/vectors.py", "np.eye(3) + s * k +", "np.eye(3) - s * k +", ("numeric",)),
    Fault(CORE + "shape/differential.py", "mean + spread, mean - spread, d1", "mean - spread, mean + spread, d1",
          ("shape",)),
    Fault(CORE + "skin/place_kernel.py", "bend[n, c] - first[0, c] * x", "bend[n, c] + first[0, c] * x",
          ("skin",)),
    Fault(CORE + "tools/tool.py", "self.stickout - self.holder[0, 1]]", "self.stickout]", ("tools",)),
    Fault(CORE + "contact/placement.py", "(tool.corner_radius + allowance) * normal",
          "(tool.corner_radius - allowance) * normal",
          ("contact/test_placing.py", "contact/test_recovered.py", "contact/test_frame.py", "contact/test_gouge.py",
           "contact/test_drop.py")),
    Fault(CORE + "cldata/toolpath.py", "& still & (along | both)", "& (along | both)", ("cldata",)),
    Fault(CORE + "machine/kinematics.py", "_about(rows, axis, -angles[:, i])", "_about(rows, axis, angles[:, i])",
          ("machine",)),
    Fault(CORE + "feed/fixed_axis_time.py", "slowest = max(slowest, by_hand)", "slowest = by_hand", ("feed",)),
    Fault(CORE + "job/planning/timing.py", "Feeds(inputs.feedrate / 60,", "Feeds(inputs.feedrate,",
          ("job/test_on_a_machine.py", "job/test_order.py")),
    Fault(CORE + "path/overrun.py", "height = cut.scallop + cut.allowance", "height = cut.scallop", ("path",)),
    Fault(CORE + "collision/index_moves.py", "proven &= gap - swing >= around.required",
          "proven &= gap >= around.required",
          ("contact/test_indexing.py", "contact/test_machinery.py", "contact/test_turning_machinery.py")),
    Fault(CORE + "partition/guillotine.py", "axis[better] = first + k", "axis[better] = k",
          ("partition/test_guillotine.py", "partition/test_regions.py", "partition/test_strips.py",
           "partition/test_times.py")),
    Fault(CORE + "regions/reach_kernel.py", "value - around >= limit", "value + around >= limit", ("regions",)),
    Fault(CORE + "regions/divide_by_reach.py", "held & (reach.depth[number] > _SMALLER)", "held",
          ("regions/test_divide_by_reach.py",)),
    Fault(CORE + "feasibility/feasibility.py", "np.concatenate([self.cloud, self.learnt])) - self.tolerance.gouge",
          "self.cloud) - self.tolerance.gouge",
          ("orient/test_feasible.py", "orient/test_standing.py", "orient/test_normals.py", "orient/test_proof.py",
           "orient/test_best_axis.py")),
    Fault(CORE + "search/infeasibility.py", "(radius + feasibility.allowance) * normals", "radius * normals",
          ("orient/test_sentences.py", "orient/test_search.py", "orient/test_best_axis.py",
           "orient/test_feasible.py")),
    Fault(CORE + "strategies/constant_lead/search.py",
          "if limits is not None and not limits.allowed(axes).all():", "if False:",
          ("orient/test_sturz.py", "orient/test_machines_in_the_search.py")),
    Fault(CORE + "strategies/roughness/roughness.py", "** 2 * rest / 8)", "** 2 * rest / 4)",
          ("contact/test_roughness.py", "contact/test_section_width.py", "orient/test_multiscale.py")),
    Fault(CORE + "shape/counterparts.py", "moved = apply_motion(matrix, face.evaluate(uv).point)",
          "moved = face.evaluate(uv).point",
          ("partition/test_turned.py", "partition/test_blades.py", "partition/test_gaps.py",
           "partition/test_buried.py")),
    Fault(CORE + "bladed/blade_gap.py", "face.normal(here[None])[0] @ (b - a))",
          "face.normal(here[None])[0] @ (a - b))",
          ("partition/test_gaps.py", "partition/test_blades.py")),
    Fault(CORE + "post/indexed_positions.py", "(path.cl - datum) @ turn.T", "path.cl @ turn.T", ("post",)),
    Fault(CORE + "post/read_apt.py", "        table[:, :3] *= self.scale\n", "", ("post",)),
    Fault(CORE + "verify/verdict.py", "/ (area - left) if area > left", "/ area if area > left",
          ("verify/test_verdict.py", "verify/test_view.py", "verify/test_rays_and_maps.py",
           "verify/test_removal.py", "verify/test_seams.py")),
    Fault(CORE + "verify/axis_limits.py", "joints[:, i] - axis.high)", "joints[:, i] - axis.low)",
          ("verify/test_machine_faults.py", "verify/test_verdict.py", "verify/test_bodies.py")),
    Fault(CORE + "plan/document.py", "return np.inf if value is None else value",
          "return 0.0 if value is None else value", ("plan",)),
    Fault(CORE + "report/warnings.py", "if op.done and op.name not in judged]", "if op.name in judged]", ("report",)),
    Fault(CORE + "cad/step/units.py", "    if number in above:\n        return f\"declares the length unit #{number}, "
          "which is defined by itself; {REMEDY}\"\n", "",
          ("cad/test_units.py", "cad/test_bad_files.py", "cad/test_malformed.py")),
    Fault(CORE + "batch/jobfile.py", "\"inputs\": asdict(spec.inputs), \"tools\": [tool_document(tool) "
          "for tool in tools],",
          "\"inputs\": asdict(spec.inputs),",
          ("batch/test_jobfile.py", "batch/test_journal.py", "batch/test_batch.py")),
    Fault(CORE + "cli/verify.py", "return 0 if passes(plan, verdict) else 1", "return 0",
          ("cli/test_commands.py", "cli/test_wrong_input.py")),
    Fault(CORE + "messages/translate.py", "found[0].replace(\", \", \"; \")", "found[0]", ("messages",)),
    Fault(BENCH + "services/time_left.py", "if now - self.begun < _SOON:", "if now < _SOON:",
          ("workbench/test_time_left.py",)),
    Fault(BENCH + "services/path_collisions.py", "known = {k + end: rest for", "known = {k: rest for",
          ("workbench/test_path_collisions.py",)),
    Fault(BENCH + "document/machine_limits.py", "Mounting(load_machine(name), offset, tool.gauge_length)",
          "Mounting(load_machine(name), None, tool.gauge_length)", ("workbench/test_machines.py",)),
    Fault(BENCH + "document/placement.py", "chain.insert(0, other)", "chain.append(other)",
          ("workbench/test_objects_tree.py", "workbench/test_tessellation_offset.py")),
)


def checked_text(folder: Path, fault: Fault) -> tuple[Path, str]:
    """The file of a fault below a folder, and what it says.

    Raises
    ------
    LookupError
        When the file is gone, or the old text does not stand there exactly once.
    """
    path = folder / fault.file
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    found = text.count(fault.old)
    if found != 1:
        raise LookupError(f"{fault.file} has the text of its fault {found} times: {fault.old!r}")
    return path, text


def test_files(folder: Path, fault: Fault) -> list[str]:
    """The test files that ought to find a fault, from the root of the tree."""
    found = []
    for name in fault.tests:
        path = folder / "tests" / name
        found += sorted(path.glob("test_*.py")) if path.is_dir() else [path]
    return [path.relative_to(folder).as_posix() for path in found if path.is_file()]


@contextmanager
def copied_tree(root: Path) -> Iterator[Path]:
    """A copy of a tree in a folder for the time being, with its compiled kernels."""
    with tempfile.TemporaryDirectory(prefix="toolaxis-faults-") as folder:
        copy = Path(folder) / "tree"
        shutil.copytree(root, copy, ignore=LEFT_OUT)
        yield copy


@contextmanager
def planted(copy: Path, fault: Fault) -> Iterator[None]:
    """The copy with a fault in it; without it, and as old as before, afterwards."""
    path, text = checked_text(copy, fault)
    before = path.stat()
    path.write_text(text.replace(fault.old, fault.new), encoding="utf-8")
    try:
        yield
    finally:
        path.write_text(text, encoding="utf-8")
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


def environment_of(root: Path, copy: Path) -> dict[str, str]:
    """The environment in which the copy is what is imported, by Python and by the FreeCAD that it names."""
    inner = {name: value.replace(str(root), str(copy)).replace(str(ROOT), str(copy))
             if name.startswith("TOOLAXIS_") else value for name, value in os.environ.items()}
    inner.pop("TOOLAXIS_FREECAD_OLD", None)
    return {**inner, "PYTHONPATH": str(copy / "core"), "TOOLAXIS_SHARED": str(copy / "none")}


def run_tests(copy: Path, files: list[str], environment: dict[str, str]) -> tuple[int | None, str]:
    """What pytest answers and prints; None instead of an answer where it takes longer than `LIMIT`."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-n0", "-p", "no:cacheprovider", "-rf", *files]
    process = subprocess.Popen(command, cwd=copy, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, start_new_session=True)
    try:
        said, _ = process.communicate(timeout=LIMIT)
        return process.returncode, said
    except subprocess.TimeoutExpired:
        return None, ""
    finally:
        _end(process)


def _end(process: subprocess.Popen[str]) -> None:
    """End a run of pytest as Ctrl-C does, so that it ends what it has started, and at once where it does not."""
    for how, patience in ((signal.SIGINT, PATIENCE), (signal.SIGKILL, None)):
        if process.poll() is not None:
            return
        os.killpg(process.pid, how)
        with suppress(subprocess.TimeoutExpired):
            process.wait(patience)


def failed_test(said: str) -> str:
    """The first test, or file, that pytest says has failed; empty where it names none."""
    found = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", said, re.MULTILINE)
    return found[1] if found else ""


def verdict_of(answer: int | None, said: str) -> str:
    """What became of a fault: found and by which test, not found, or not run."""
    if answer in (FAILED, BROKEN) and failed_test(said):
        return f"found by {failed_test(said).removeprefix('tests/')}"
    if answer is None:
        return f"NOT FOUND within {LIMIT} s"
    if answer == PASSED and not re.search(r"^\.|\.\s*\[", said, re.MULTILINE):
        return "not run: its tests were skipped"
    return "NOT FOUND" if answer == PASSED else f"not run: {said.strip().splitlines()[-1:]}"


def find_in_older_tree(root: Path, fault: Fault) -> Fault | None:
    """A fault as it can be planted in a tree with other files: where its text stands once; None where it does not."""
    holders = [path for name in (CORE, BENCH) for path in sorted((root / name).rglob("*.py"))
               if fault.old in path.read_text(encoding="utf-8")]
    if len(holders) != 1 or holders[0].read_text(encoding="utf-8").count(fault.old) != 1:
        return None
    moved = fault._replace(file=holders[0].relative_to(root).as_posix())
    return moved if test_files(root, moved) else None


def plant(root: Path, faults: dict[int, Fault]) -> int:
    """Plant faults, print what became of each, and return how many were not found."""
    found, lost = 0, 0
    with copied_tree(root) as copy:
        environment = environment_of(root, copy)
        for number, fault in faults.items():
            began = time.monotonic()
            with planted(copy, fault):
                answer, said = run_tests(copy, test_files(copy, fault), environment)
            verdict = verdict_of(answer, said)
            # what runs in FreeCAD is named by its file and words that pytest takes for no test
            again = re.sub(r"::in FreeCAD.*", "", failed_test(said))
            if verdict.startswith("found") and run_tests(copy, [again], environment)[0] != PASSED:
                verdict = f"not run: {again} fails without the fault too"
            found += verdict.startswith("found")
            lost += verdict.startswith("NOT")
            print(f"{number:2d}  {fault.file}: {verdict}  ({time.monotonic() - began:.0f} s)", flush=True)
    print(f"{found} of {found + lost} found, {len(faults) - found - lost} not run")
    return lost


def main(words: list[str]) -> int:
    """0 where all faults are found, 1 where one is not, 2 where the text of one is not there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", type=int, nargs="+", metavar="N", choices=range(1, len(FAULTS) + 1),
                        help=f"numbers of the faults, 1 to {len(FAULTS)}")
    parser.add_argument("--folder", type=Path, default=ROOT, help="the tree that is copied (this one)")
    parser.add_argument("--skip-missing", action="store_true",
                        help="for an older tree: plant a fault in whatever file has its text, and leave out those "
                             "whose text stands in none")
    given = parser.parse_args(words)
    root = given.folder.resolve()
    try:
        faults = {number: FAULTS[number - 1] for number in given.only or range(1, len(FAULTS) + 1)}
        if given.skip_missing:
            found = {number: find_in_older_tree(root, fault) for number, fault in faults.items()}
            faults = {number: fault for number, fault in found.items() if fault is not None}
        for fault in faults.values():
            checked_text(root, fault)
        return 1 if plant(root, faults) else 0
    except LookupError as reason:
        print(f"plant_faults: {reason}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
