"""Parts that nobody here made: what share of their sculptured faces ends with a verified operation, and why not all.

``python -m benchmarks real_parts [FOLDER|PART|RESULT.json] [options]`` takes each STEP file through the command as a
user does: ``inspect --json``, ``plan``, ``verify``, each in a process of its own with the interpreter that runs this,
the plan on one core unless ``--workers`` says more.  Each is bounded in processor time (``--limit``; the judge, who
works with two threads, gets twice that) and in address space (``--memory``); six times as much on the clock counts as
hung.  A plan that runs out of time gets SIGTERM once: what it finished is judged and counted.  As only the command is
run and only what it writes is read, this file measures other versions too: name one by PYTHONPATH.

The tool is the same for all faces of a part: `benchmarks._rack` states the rule; ``--tools`` names a rack in its place
(``general-rack`` is the one that is shipped), with which the whole part is planned, as for a user who names no faces.
Otherwise the faces are all sculptured ones, or ``--sample`` of them, drawn by ``--seed`` and the name of the file, or
``--faces``.  A face is verified where all its operations pass; its area counts without what its plan leaves to
clean-up.  Areas of a whole part are those of its verdict.

``--out`` writes everything as JSON; ``--compare OLD.json`` sets it beside an earlier result and lists what was lost.
A RESULT.json in the folder's place is printed, and compared, as it is.
"""

import argparse
import json
import os
import shutil
import sys
import tempfile
import time
import zlib
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from benchmarks._bounded import Bounds, Ran, python, run
from benchmarks._faces import last_reasons, outcomes, why_stopped
from benchmarks._rack import RackTool, chosen, given

FOLDER = Path(os.environ.get("TOOLAXIS_SHARED", Path(__file__).resolve().parents[2] / "shared")) / "parts"
ENDINGS = (".step", ".stp")
_COMMAND = ("-m", "toolaxis.cli.start")
_COLUMNS = (f"{'part':24} {'tool':12} {'faces':>5} {'sculptured mm2':>14} {'drawn':>5} {'verified':>8} {'% faces':>7} "
            f"{'% area':>6} {'% out':>6} {'planned':>7} {'open':>4} {'inspect':>7} {'plan s':>7} {'judge s':>7} "
            f"{'face s':>7} {'op s':>6} {'clock s':>7} {'MB':>6}")


def _parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(prog="python -m benchmarks real_parts", description=(__doc__ or "").split("\n\n")[0])
    made.add_argument("folder", nargs="?", type=Path, metavar="FOLDER|PART|RESULT.json",
                      help=f"default: {FOLDER} (TOOLAXIS_SHARED names another place)")
    made.add_argument("--tool", metavar="SPEC", help="as `toolaxis plan` takes it; by the rule unless given")
    made.add_argument("--tools", metavar="RACK", help="a rack in place of one tool: a library, its file or its name")
    made.add_argument("--scallop", type=float, metavar="MM", help="goes with the tool unless given")
    made.add_argument("--sample", type=int, metavar="N", help="sculptured faces to draw of each part; all unless given")
    made.add_argument("--seed", type=int, default=1, metavar="S")
    made.add_argument("--faces", metavar="LIST", help="face numbers in place of a sample: 3,5")
    made.add_argument("--only", metavar="NAMES", help="only files whose names begin so: ctc02,nacelle")
    made.add_argument("--limit", type=float, default=600.0, metavar="S",
                      help="processor seconds for each process of a part (default: 600)")
    made.add_argument("--workers", type=int, default=1, metavar="N",
                      help="cores to plan on, which share the processor seconds (default: 1)")
    made.add_argument("--memory", type=float, default=4.0, metavar="GB",
                      help="address space of each process (default: 4)")
    made.add_argument("--keep", type=Path, metavar="DIR", help="keep plans and verdicts there, a folder for each part")
    made.add_argument("--out", type=Path, metavar="FILE.json")
    made.add_argument("--compare", type=Path, metavar="OLD.json")
    return made


def main() -> None:
    """Two faces of each part in the usual folder, where it is there."""
    if not FOLDER.is_dir():
        print(f"not measured: no parts in {FOLDER}; TOOLAXIS_SHARED names the folder that has parts/")
        return
    run_with(["--sample", "2", "--limit", "120"])


def run_with(words: Sequence[str]) -> int:
    """Measure, print and compare as words of the command line say; 0, or 2 where there is nothing to measure."""
    asked = _parser().parse_args(words)
    source = asked.folder or FOLDER
    old = None if asked.compare is None else json.loads(asked.compare.read_text())
    if source.suffix == ".json":
        result = json.loads(source.read_text())
        print(_COLUMNS)
        for part in result["parts"]:
            _print_part(part)
    else:
        files = _files(source, asked.only)
        if not files:
            print(f"no STEP file in {source}: name a folder that has some, or a STEP file", file=sys.stderr)
            return 2
        result = _measured(files, asked)
    _print_total(result)
    if old is not None:
        _print_change(old, result)
    return 0


def _files(source: Path, only: str | None) -> list[Path]:
    if source.is_file():
        return [source]
    found = sorted(path for path in source.glob("*") if path.suffix.lower() in ENDINGS)
    return found if only is None else [path for path in found if path.name.startswith(tuple(only.split(",")))]


def _measured(files: Sequence[Path], asked: argparse.Namespace) -> dict[str, Any]:
    """All parts, printed and written as they are done."""
    settings = {name: value for name, value in vars(asked).items() if name not in ("folder", "keep", "out", "compare")}
    with tempfile.TemporaryDirectory(prefix="real-parts-") as place:
        seen = run(python("-c", "import toolaxis; print(toolaxis.__version__, toolaxis.__file__)"),
                   Bounds(60.0, _bytes(asked.memory)), Path(place))
    result: dict[str, Any] = {"benchmark": "real_parts", "version": 1, "toolaxis": seen.output.strip(),
                              "settings": settings, "parts": []}
    print(f"toolaxis {result['toolaxis']}\n{settings}\n{_COLUMNS}", flush=True)
    for path in files:
        with tempfile.TemporaryDirectory(prefix="real-parts-") as place:
            part = _measure(path, asked, Path(place))
            if asked.keep is not None:
                shutil.copytree(place, asked.keep / path.stem, dirs_exist_ok=True)
        result["parts"].append(part)
        _print_part(part)
        if asked.out is not None:
            asked.out.write_text(json.dumps(result, indent=1, default=str) + "\n")
    return result


def _bytes(gigabytes: float) -> int:
    return int(gigabytes * 2**30)


def _measure(path: Path, asked: argparse.Namespace, place: Path) -> dict[str, Any]:
    """One part: what it is, the tool, and what became of the faces that were drawn."""
    bounds, began = Bounds(asked.limit, _bytes(asked.memory)), time.monotonic()
    seen = run(python(*_COMMAND, "inspect", "--json", str(path)), bounds, place)
    part: dict[str, Any] = {"part": path.name, "processes": {"inspect": _process(seen)}, "rows": []}
    if seen.code != 0:
        return {**part, "refused": "refused to load" if why_stopped(seen) == "refused" else why_stopped(seen),
                "reasons": list(last_reasons(seen))}
    survey = json.loads(seen.output)
    sculptured = {face["number"]: face["area"] for face in survey["faces"] if face["sculptured"]}
    tool = chosen(survey) if asked.tool is None else given(asked.tool)
    if asked.tools is not None:
        tool = tool._replace(name=asked.tools, file=None)
    scallop = tool.scallop if asked.scallop is None else asked.scallop
    numbers = _numbers(asked, path.name, sculptured)
    areas = {face["number"]: face["area"] for face in survey["faces"] if face["number"] in numbers}
    part.update(faces=len(survey["faces"]), sculptured=len(sculptured), sculptured_area=sum(sculptured.values()),
                unit=survey["unit"], diagonal=survey["diagonal"], warnings=survey["warnings"],
                tool=tool.name, tool_file=tool.file, scallop=scallop, refused="", reasons=[])
    if areas:
        words = [str(path), *_tool_words(tool, asked.tools is not None, place), "--scallop", str(scallop),
                 "--workers", str(asked.workers)]
        whole = asked.tools is not None and asked.sample is None and asked.faces is None
        part["rows"] = _planned_and_judged(part, words, areas, whole, (bounds, place))
    part["wall"] = time.monotonic() - began
    return part


def _numbers(asked: argparse.Namespace, name: str, sculptured: Mapping[int, float]) -> list[int]:
    """The faces to plan: named, drawn, or all sculptured ones.

    Every face number has its own draw, so that a face more or less in one version leaves the others drawn.
    """
    if asked.faces is not None:
        return [int(number) for number in asked.faces.split(",")]
    if asked.sample is None or not sculptured:
        return sorted(sculptured)
    draws = np.random.default_rng([asked.seed, zlib.crc32(name.encode())]).random(max(sculptured) + 1)
    return sorted(sorted(sculptured, key=lambda number: draws[number])[:asked.sample])


def _tool_words(tool: RackTool, is_rack: bool, place: Path) -> list[str]:
    """The command's words for a tool, or a rack."""
    if is_rack:
        return ["--tools", tool.name]
    if tool.file is None:
        return ["--tool", tool.name]
    file = place / "tool.toml"
    file.write_text(tool.file)
    return ["--tool", str(file)]


def _planned_and_judged(part: dict[str, Any], words: list[str], areas: Mapping[int, float], whole: bool,
                        where: tuple[Bounds, Path]) -> list[dict[str, Any]]:
    bounds, place = where
    folder = place / "plan"
    usual = [*_COMMAND, "plan", *words, "--out", str(folder), "--no-pictures"]
    faces = () if whole else ("--faces", ",".join(map(str, areas)))
    planned = run(python(*usual, *faces), bounds, place)
    part["processes"]["plan"] = _process(planned)
    plan, judged, verdict = _read(folder / "plan.json"), None, None
    if plan is not None and any(op["cl_file"] for op in plan["operations"]):
        twice = bounds._replace(seconds=2 * bounds.seconds)
        judged = run(python(*_COMMAND, "verify", str(folder), "--no-pictures"), twice, place)
        part["processes"]["verify"] = _process(judged)
        verdict = _read(folder / "verdict.json")
    part["outcome"] = None if plan is None else plan["outcome"]
    part["passed"] = None if verdict is None else verdict["passed"]
    part["whole"] = account_of_part(plan, verdict) if whole else None
    return outcomes(areas, plan, planned, verdict, judged)


def account_of_part(plan: Mapping[str, Any] | None, verdict: Mapping[str, Any] | None) -> Mapping[str, float] | None:
    """Areas of a whole part as its verdict tells them; as its plan does where there is nothing to judge.

    Parameters
    ----------
    plan, verdict : mapping or None
        What was written.
    """
    if verdict is not None:
        return verdict.get("part")
    if plan is None or "not_begun" not in plan["part"]:  # a version that knows only of the faces that were begun
        return None
    areas: dict[str, float] = {name: plan["part"][name] for name in ("area", "unreachable", "not_begun")}
    return {**areas, "verified": 0.0}


def _read(path: Path) -> dict[str, Any] | None:
    return json.loads(path.read_text()) if path.is_file() else None


def _process(ran: Ran) -> dict[str, Any]:
    """What a process took, and all that it said."""
    return {"code": ran.code, "ended": ran.ended, "killed": ran.killed, "wall": round(ran.wall, 2),
            "cpu": round(ran.cpu, 2), "peak_mb": round(ran.peak / 1e6, 1), "short_of_memory": ran.short_of_memory,
            "lines": [[round(line.cpu, 2), line.text] for line in ran.lines]}


def _print_part(part: Mapping[str, Any]) -> None:
    processes = part["processes"]
    cpu = {name: f"{processes[name]['cpu']:.1f}" if name in processes else "-"
           for name in ("inspect", "plan", "verify")}
    peak = max(one["peak_mb"] for one in processes.values())
    if part["refused"]:
        print(f"{part['part']:24} {part['refused']}: {part['reasons'][0]} ({cpu['inspect']} s, {peak:.0f} MB)",
              flush=True)
        return
    rows = part["rows"]
    verified = [row for row in rows if row["verified"]]
    area, done = areas_of(part)
    proven = (part.get("whole") or {}).get("unreachable", 0.0)
    shares = f"{_percent(len(verified), len(rows)):>7} {_percent(done, area):>6} {_percent(proven, area):>6}"
    unsafe = [row for row in rows if row["outcome"] in ("failed", "not judged")]
    undone = [row for row in rows if row["outcome"] in ("open", "left")]
    print(f"{part['part']:24} {part['tool']:12} {part['faces']:5d} {part['sculptured_area']:14.1f} {len(rows):5d} "
          f"{len(verified):8d} {shares} {len(unsafe):7d} {len(undone):4d} {cpu['inspect']:>7} {cpu['plan']:>7} "
          f"{cpu['verify']:>7} {_longest(rows, 'plan_seconds'):>7} {_longest(rows, 'judge_seconds'):>6} "
          f"{sum(one['wall'] for one in processes.values()):7.1f} {peak:6.0f}")
    if unsafe:
        faces = ", ".join(f"{row['face']} ({row['kind']})" for row in unsafe)
        print(f"    planned but not verified: {faces}")
    not_begun = (part.get("whole") or {}).get("not_begun", 0.0)
    if not_begun > 0:
        print(f"    not begun: {not_begun:.1f} mm2 ({_percent(not_begun, area)} %)")
    if undone:
        kinds = Counter(row["kind"] for row in undone)
        faces = {kind: ",".join(str(row["face"]) for row in undone if row["kind"] == kind) for kind in kinds}
        print("    open: " + "; ".join(f"{kind} {count} (faces {faces[kind]})" for kind, count in kinds.most_common()))
    sys.stdout.flush()


def _percent(some: float, all_: float) -> str:
    return f"{100 * some / all_:.1f}" if all_ > 0 else "-"


def _longest(rows: Sequence[Mapping[str, Any]], name: str) -> str:
    return f"{max(known):.1f}" if (known := [row[name] for row in rows if row[name] is not None]) else "-"


def _print_total(result: Mapping[str, Any]) -> None:
    rows = [row for part in result["parts"] for row in part["rows"]]
    verified = [row for row in rows if row["verified"]]
    areas = [_share(part) for part in result["parts"] if part["rows"]]
    known = [(part["whole"], areas_of(part)[0]) for part in result["parts"] if part.get("whole")]
    told = [(one["verified"] + one["unreachable"]) / area for one, area in known if area > 0]
    print(f"\n{len(result['parts'])} parts, {len(rows)} faces drawn, {len(verified)} verified "
          f"({_percent(len(verified), len(rows))} %); verified share of the drawn area, mean over parts "
          f"{100 * sum(areas) / max(len(areas), 1):.1f} %")
    if told:
        print(f"with what is proven to be out of reach of the rack: {100 * sum(told) / len(told):.1f} %, at least "
              f"{100 * min(told):.1f} %")
    for outcome in ("failed", "not judged", "open", "left"):
        kinds = Counter(row["kind"] for row in rows if row["outcome"] == outcome)
        if kinds:
            print(f"{outcome}: " + ", ".join(f"{kind} {count}" for kind, count in kinds.most_common()))
    print("seconds are of processor time (all threads), clock s apart; planned: has a path that did not pass; face s, "
          "op s: longest of one face to plan, to judge; % out: proven to be out of reach of a rack; MB: greatest "
          "resident set of one process")


def areas_of(part: Mapping[str, Any]) -> tuple[float, float]:
    """Area that was asked for, and what of it is verified, mm^2.

    Parameters
    ----------
    part : mapping
    """
    if part.get("whole"):
        asked = part["whole"]["area"]
        # A version that does not tell what it did not begin knows only of the faces that were begun.
        if part["outcome"] == "cancelled" and "not_begun" not in part["whole"]:
            asked = max(asked, part["sculptured_area"])
        return asked, part["whole"]["verified"]
    return sum(row["area"] for row in part["rows"]), sum(row["verified_area"] for row in part["rows"])


def _share(part: Mapping[str, Any]) -> float:
    area, verified = areas_of(part)
    return verified / area if area > 0 else 0.0


def _print_change(old: Mapping[str, Any], new: Mapping[str, Any]) -> None:
    """Verified area of each part before and now, over faces drawn in both, and faces that are not verified now."""
    before = {part["part"]: part for part in old["parts"]}
    print(f"\nagainst {old['toolaxis']}, over faces drawn in both\n{'part':24} {'mm2 before':>12} {'mm2 now':>12} "
          f"{'change':>12} {'faces before':>12} {'now':>4}")
    for part in new["parts"]:
        if part["part"] not in before:
            print(f"{part['part']:24} was not measured before")
            continue
        was = before.pop(part["part"])
        held = {row["face"]: row for row in was["rows"]}
        both = [(held[row["face"]], row) for row in part["rows"] if row["face"] in held]
        areas = [sum(pair[k]["verified_area"] for pair in both) for k in (0, 1)]
        counts = [sum(pair[k]["verified"] for pair in both) for k in (0, 1)]
        print(f"{part['part']:24} {areas[0]:12.1f} {areas[1]:12.1f} {areas[1] - areas[0]:+12.1f} {counts[0]:12d} "
              f"{counts[1]:4d}" + ("" if areas[1] >= (1 - 1e-3) * areas[0] else "  LESS"))
        if (was.get("tool"), was.get("scallop")) != (part.get("tool"), part.get("scallop")):
            print(f"    another tool: {was.get('tool')}, {was.get('scallop')} mm before, {part.get('tool')}, "
                  f"{part.get('scallop')} mm now")
        for one, other in both:
            if one["verified"] and not other["verified"]:
                print(f"    LOST face {one['face']} ({one['area']:.2f} mm2): {other['outcome']}, {other['kind']}: "
                      f"{next(iter((*other['judge_reasons'], *other['reasons'])), '')}")
        missing = sorted(set(held) - {row["face"] for row in part["rows"]})
        if missing:
            print(f"    not drawn now: faces {', '.join(map(str, missing))}")
    for name in before:
        print(f"{name:24} is not measured now")


if __name__ == "__main__":
    sys.exit(run_with(sys.argv[1:]))
