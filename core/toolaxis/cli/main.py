"""The command's parser and exit codes: 0 done, 1 the answer is no, 2 wrong input, 130 interrupted."""

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import NoReturn

from toolaxis import __version__
from toolaxis.cli.stopping import StopSignals
from toolaxis.errors import Cancelled, InvalidInput, MissingBackend, ToolAxisError, UnsupportedGeometry, fault
from toolaxis.plan.choices import DIRECTIONS, ISO, OBJECTIVES, PASSES, SCALLOP
from toolaxis.strategies.registry import strategies, strategy_named
from toolaxis.strategies.strategy import INDEXED, SPHERE
from toolaxis.tools.registry import short_forms
from toolaxis.work import LIMIT, MOVING

DONE, NO, WRONG_INPUT, INTERRUPTED = 0, 1, 2, 130


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one sentence, without the usage.

    Attributes
    ----------
    listed : callable or None
        Makes what the help ends with, where that takes long to find out.
    """

    listed: Callable[[], str] | None = None

    def format_help(self) -> str:
        """The help with what is listed below it."""
        if self.listed is not None:
            self.epilog = self.listed()
        return super().format_help()

    def error(self, message: str) -> NoReturn:
        """Print one sentence and leave with the exit code of wrong input."""
        self.exit(WRONG_INPUT, f"{self.prog}: {message} (see {self.prog} --help)\n")


def parser() -> argparse.ArgumentParser:
    """The parser of the whole command."""
    top = _Parser(prog="toolaxis", description="Tool orientations for multi-axis machining of sculptured surfaces.",
                  epilog="Exit codes: 0 done, 1 the answer is no (no axis found, verification failed), 2 wrong input, "
                         "130 interrupted.")
    top.add_argument("--version", action="version", version=f"toolaxis {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=_Parser)
    _add_inspect(commands)
    _add_plan(commands)
    _add_verify(commands)
    _add_post(commands)
    _add_reschedule(commands)
    _add_report(commands)
    _add_export(commands)
    _add_batch(commands)
    _add_demo(commands)
    return top


def _add_inspect(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("inspect", help="list the faces of a part",
                              description="List faces: number, kind, area, size, curvature, normal spread.")
    sub.add_argument("part", metavar="PART.step")
    sub.add_argument("--json", action="store_true", help="machine-readable result on stdout")
    sub.set_defaults(module="toolaxis.cli.inspect")


def _add_plan(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("plan", help="find axes and passes for the faces of a part",
                              description="Find the best fixed tool axis for each face, with its passes. "
                                          "Lengths in mm, angles in degrees.")
    sub.add_argument("part", metavar="PART.step")
    _add_tool_options(sub)
    _add_face_options(sub)
    _add_division_options(sub)
    _add_search_options(sub)
    _add_other_options(sub)
    sub.set_defaults(module="toolaxis.cli.plan")


def _add_tool_options(sub: _Parser) -> None:
    """The tools, the scallop height and the tolerance."""
    sub.add_argument("--tool", action="append", default=[], metavar="TOOL",
                     help=f"{short_forms('')} (diameter x corner radius x degrees), a TOML or .fctb file, or a name "
                          "from resources/tools; may be repeated (default: the general rack)")
    sub.add_argument("--tools", action="append", default=[], metavar="FILE|FOLDER|NAME",
                     help="tools to choose from: a TOML, .fctl, .csv or .json library, a folder of tool files, or a "
                          "name from resources/racks; may be repeated")
    sub.add_argument("--most-tools", type=int, metavar="N", help="use at most N of the tools")
    sub.add_argument("--scallop", default=SCALLOP, type=float, metavar="MM",
                     help=f"greatest scallop height (default: {SCALLOP:g})")
    sub.add_argument("--tolerance", type=float, metavar="MM",
                     help="machining tolerance: how far the finished surface may be cut too deep (default: 0.01)")


def _add_face_options(sub: _Parser) -> None:
    """The faces, the folder, and what stands around."""
    sub.add_argument("--faces", metavar="LIST",
                     help="face numbers such as 3,5-8, or all; sculptured faces by default; 3+4,7 machines or divides "
                          "faces that continue each other smoothly as one, skins all that can be joined")
    sub.add_argument("--skins", metavar="LIST",
                     help="skins such as 1,3, as toolaxis inspect numbers them: all faces of each as one")
    sub.add_argument("--out", default="out", metavar="DIR", help="folder for plan.json and the rest (default: out)")
    sub.add_argument("--holder", metavar="FILE|SPEC", help="TOML file, or radius,z rows: 10,0;10,40;25,40;25,80")
    sub.add_argument("--stickout", type=float, metavar="MM", help="length from the tip to the holder's lower face")
    sub.add_argument("--obstacles", metavar="FILE", action="append", default=[],
                     help="STEP file of bodies to keep clear of; may be repeated")
    sub.add_argument("--avoid", default="", metavar="LIST",
                     help="faces such as 3,5-8 that no tool may touch: not machined, and kept clear of as obstacles "
                          "are, whatever faces they join")
    sub.add_argument("--held", default="", metavar="SPEC",
                     help="side of the part that is clamped, in coordinates of the part: z<12.5, x>-3, or "
                          "plane:x,y,z,nx,ny,nz (a point of its plane, a direction into it); no tool goes there, and "
                          "what lies in it is not machined")
    sub.add_argument("--after", metavar="DIR", action="append", default=[],
                     help="folder of a plan for an earlier setup of the part: only what it leaves is asked for, "
                          "what was clamped in it included; may be repeated, the first setup first")


def _add_division_options(sub: _Parser) -> None:
    """How faces are divided, and the machine with its limits."""
    sub.add_argument("--regions", type=_count, metavar="N|auto",
                     help="sub-surfaces for each face, an axis each; auto: as many as pay")
    sub.add_argument("--orientations", type=_count, metavar="N|auto",
                     help="at most N different axes in all, shared by the sub-surfaces of all faces; auto: as many as "
                          "the curve of cutting length over their number bends at")
    sub.add_argument("--division", default="", metavar="FILE",
                     help="sub-surfaces given by hand, with the axes and feeds to keep: a JSON file of them, a "
                          "plan.json, or the folder of a plan")
    sub.add_argument("--machine", metavar="NAME|FILE",
                     help="only axes that this machine holds: a name from resources/machines, a TOML or .fcm file")
    sub.add_argument("--offset", metavar="X,Y,Z",
                     help="the part's origin in machine coordinates, all axes at zero, mm (write --offset=-100,0,50 "
                          "for a negative one): no motion leaves the travel of the linear axes")
    sub.add_argument("--origin", default="", metavar="PLACE",
                     help="origin of the work coordinate systems: part:top, stock:top-front-left, the same with "
                          "middle, bottom, right and back (left is -x, front is -y), or point:X,Y,Z (default: the "
                          "origin of the part's own frame)")
    sub.add_argument("--stock-box", default="", metavar="MM",
                     help="margins of the box that the part is cut from: one for all sides, or six for -x,+x,-y,+y,-z,"
                          "+z; the setup sheet tells it")
    sub.add_argument("--clearances", default="", metavar="C,S,H",
                     help="least distances of cutter, shank and holder from all that is not machined, mm (default: "
                          "0.1,0.5,1, of which the shank of a cutter below 5 mm keeps a tenth of its diameter)")
    sub.add_argument("--least-lean", type=float, default=0.0, metavar="DEG",
                     help="least angle between the axis of a ball end, tapered ones too, and the normal at every "
                          "contact: at the tip of a ball the cutting speed is zero (default: 0, none is asked for; "
                          "cutters with a flat bottom always keep half a degree)")
    sub.add_argument("--limits", default="", metavar="SPEC",
                     help="axes that are allowed: cone:0,0,1,45 (within 45 degrees of +z), "
                          "rotary:tilt=-5..110,turn=-360..360, several joined by +")


def _add_search_options(sub: _Parser) -> None:
    """How axes are found and passes lie."""
    sub.add_argument("--method", default=SPHERE, choices=tuple(strategy_named(INDEXED).methods),
                     help="how each sub-surface gets its axis: sphere (default), the whole hemisphere; sectors, the "
                          "projection planes and sectors of zhu2016; jerk, the rotary angles of --machine at which its "
                          "linear axes together have most jerk along the passes; to compare: roman (the axis of "
                          "Roman's rule), normal (the mean normal), one (one axis for all), ball (a ball end of the "
                          "same radius along the mean normal)")
    sub.add_argument("--compare", action="store_true",
                     help="also plan the same faces by the other methods: a table of passes, lengths and times")
    sub.add_argument("--objective", choices=OBJECTIVES,
                     help="what is least: cutting length, number of passes, or the time that --machine takes (default: "
                          "length; time with several tools on a machine that states the limits of its axes)")
    sub.add_argument("--allowance", type=float, default=0.0, metavar="MM", help="stock left on the faces")
    sub.add_argument("--allowance-on", action="append", default=[], metavar="FACES=MM",
                     help="stock left on some faces in place of --allowance, such as 3,5-8=0.3: they are machined to "
                          "that height, and no tool goes deeper there on other faces; may be repeated")
    sub.add_argument("--stock", type=float, default=0.0, metavar="MM",
                     help="what roughing left on the faces of this plan, above the finished surface: shank, holder and "
                          "rapid moves stay clear of all of it (default: 0, no stock is looked out for)")
    sub.add_argument("--greatest-step-over", type=float, default=0.0, metavar="MM",
                     help="greatest distance of neighbouring passes on the face, whatever the scallop height allows "
                          "(default: 0, none)")
    sub.add_argument("--lead", type=float, default=0.0, metavar="MM",
                     help="radius of the arcs on which the tool comes down to passes and is lifted from them, in the "
                          "plane of the surface's normal and the feed: wherever these are proven free, straight ramps "
                          "elsewhere (default: 0, ramps alone)")
    sub.add_argument("--direction", default="zigzag", choices=DIRECTIONS)
    sub.add_argument("--passes", default=ISO, choices=PASSES,
                     help="how passes lie: iso (default), along a parameter of the face; planes, along parallel planes "
                          "that contain the tool axis, in the mean direction of that parameter; scallop, along the "
                          "levels of a field that keeps them as far apart as their strips are wide; auto, the shorter "
                          "of iso and scallop for each face (all but iso with fixed axes only)")
    sub.add_argument("--limit", type=float, default=LIMIT, metavar="WORK",
                     help="most work for one sub-surface, its axis and the proof of its passes, counted in thousands "
                          "of bounds of distances, not in seconds, so that the plan is the same on every machine; an "
                          f"axis that moves is allowed {MOVING:.0f} times that (default: {LIMIT:.0f}, about half a "
                          "minute on one core)")
    sub.add_argument("--minutes", type=float, metavar="MIN",
                     help="stop planning after so many minutes and keep what is finished, the large tools and the "
                          "large sub-surfaces first; how far it comes depends on the machine (default: no limit)")


def _add_other_options(sub: _Parser) -> None:
    """Processes, rates, what is written, and moving axes."""
    sub.add_argument("--workers", type=int, metavar="N", help="cores to plan and draw with; all of them unless given")
    sub.add_argument("--feedrate", type=float, metavar="MM/MIN",
                     help="for all tools (default: each tool's own, else 1000)")
    sub.add_argument("--rapid", type=float, default=10000.0, metavar="MM/MIN",
                     help="rate of rapid traverse where no machine states its own, for times only (default: 10000)")
    sub.add_argument("--spindle", type=float, metavar="RPM",
                     help="for all tools (default: each tool's own, else 10000)")
    sub.add_argument("--no-pictures", action="store_true", help="write no pictures")
    sub.add_argument("--json", action="store_true", help="machine-readable result on stdout")
    default, known = " (default)", strategies().values()
    sub.add_argument("--strategy", default=INDEXED, metavar="NAME",
                     help="; ".join(f"{one.name}{default if one.name == INDEXED else ''}: {one.summary}"
                                    for one in known).replace("%", "%%"))
    kept = [f"{one.name} (default: {1000 * one.roughness:g})" for one in known if one.roughness]
    sub.add_argument("--roughness", type=float, metavar="UM",
                     help=f"greatest Ra across the feed, micrometres, for the strategy {', '.join(kept)}")


def _count(text: str) -> int | str:
    return text if text == "auto" else int(text)


def _add_verify(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("verify", help="judge a plan by material removal",
                              description="Remove material with the tool along the CL files of a plan and compare what "
                                          "is left with the part. Exit code 1 where it fails.")
    sub.add_argument("folder", metavar="DIR", help="folder that toolaxis plan wrote")
    sub.add_argument("--no-pictures", action="store_true", help="write no pictures")
    sub.add_argument("--workers", type=int, metavar="N",
                     help="cores to verify and draw with; all of them unless given")
    sub.add_argument("--json", action="store_true", help="machine-readable result on stdout")
    sub.set_defaults(module="toolaxis.cli.verify")


def _add_post(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("post", help="write an NC program and a setup sheet from a plan",
                              description="Write a plan's operations in the dialect of a control, with a setup sheet.")
    sub.add_argument("folder", metavar="DIR",
                     help="folder that toolaxis plan wrote; or a file made elsewhere, APT or the NC program of a "
                          "five-axis machine: --dialect apt writes it as an APT file beside it, fanuc, siemens and "
                          "heidenhain as a program of --machine with tool centre point control")
    sub.add_argument("--dialect", required=True, metavar="NAME",
                     help="a dialect of those below, or apt (CL files)")
    sub.listed = _dialects_listed
    sub.add_argument("--machine", metavar="NAME|FILE", help="a machine from resources/machines, a TOML or .fcm file")
    sub.add_argument("--offset", metavar="X,Y,Z",
                     help="the part's origin in machine coordinates, all axes at zero, mm: travel is checked with it")
    sub.add_argument("--source", metavar="NAME|FILE",
                     help="of a program made elsewhere: the machine that it was for (default: --machine)")
    sub.add_argument("--feedrate", type=float, metavar="MM/MIN", help="of CL data made elsewhere, in place of its own")
    sub.add_argument("--spindle", type=float, metavar="RPM", help="of CL data made elsewhere, in place of its own")
    sub.add_argument("--retract", type=float, metavar="MM",
                     help="machine coordinate of Z at which rotary axes may turn (default: the end of its travel)")
    sub.add_argument("--clamp", metavar="WORDS", help="words that hold the rotary axes, such as M10,M12")
    sub.add_argument("--unclamp", metavar="WORDS", help="words that let them go, such as M11,M13")
    sub.add_argument("--json", action="store_true", help="machine-readable result on stdout")
    sub.set_defaults(module="toolaxis.cli.post")


def _dialects_listed() -> str:
    """All dialects with what they are called; the geometry of their programs is not imported before."""
    from toolaxis.post.dialects.registry import dialects

    return f"Dialects: {'; '.join(f'{name}: {one.title}' for name, one in dialects().items())}."


def _add_reschedule(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("reschedule", help="give CL data around a blade tool angles that do not turn back",
                              description="Read CL data of four-axis milling around a blade that were made elsewhere, "
                                          "give them tool angles with which the rotary axis does not turn back within "
                                          "a cut, and write them as an APT file, which toolaxis post takes. The ball's "
                                          "centres stay.")
    sub.add_argument("file", metavar="FILE", help="an APT file, or the NC program of --machine")
    sub.add_argument("--tool", required=True, metavar="TOOL",
                     help="with a ball end: ball:8, tapered:6x3x4, a file or a name")
    sub.add_argument("--holder", metavar="FILE|SPEC", help="TOML file, or radius,z rows: 10,0;10,40;25,40;25,80")
    sub.add_argument("--stickout", type=float, metavar="MM", help="length from the tip to the holder's lower face")
    sub.add_argument("--curve", default="least", choices=("least", "keys"),
                     help="least peak acceleration (default), or key points and rounded corners")
    sub.add_argument("--about", metavar="X,Y,Z",
                     help="direction of the rotary axis (default: the one that the tool axes of FILE turn about)")
    sub.add_argument("--part", metavar="PART.step", help="the part in the coordinates of FILE: the new path is proven "
                                                         "against it, or refused")
    sub.add_argument("--depth", type=float, default=0.01, metavar="MM",
                     help="by how much cuts of FILE may lie below the part (default: 0.01)")
    sub.add_argument("--machine", metavar="NAME|FILE", help="the machine of a program; it must be able to follow")
    sub.add_argument("--offset", metavar="X,Y,Z", help="the part's origin in machine coordinates, all axes at zero, mm")
    sub.add_argument("--out", metavar="FILE", help="the APT file (default: NAME-rescheduled.apt beside FILE)")
    sub.add_argument("--json", action="store_true", help="machine-readable result on stdout")
    sub.set_defaults(module="toolaxis.cli.reschedule")


def _add_report(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("report", help="write a plan, or a batch, as HTML pages",
                              description="Write one self-contained HTML page that shows all of a plan and its "
                                          "verdict, or one that lists the jobs of a batch and leads to the page of "
                                          "each; they need no network.")
    sub.add_argument("folder", metavar="DIR", help="folder that toolaxis plan or toolaxis batch wrote")
    sub.add_argument("--out", metavar="FILE", help="the page (default: DIR/report.html)")
    sub.add_argument("--json", action="store_true", help="machine-readable result on stdout")
    sub.set_defaults(module="toolaxis.cli.report")


def _add_export(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("export", help="write a plan for other programs, as STEP or glTF",
                              description="Write a plan as a STEP assembly (part, sub-surfaces as faces, passes at "
                                          "named placements) or as glTF (meshes and lines).")
    sub.add_argument("folder", metavar="DIR", help="folder that toolaxis plan wrote")
    sub.add_argument("--out", metavar="FILE", help="the file, .step or .glb (default: DIR/plan.step)")
    sub.add_argument("--colour", default="sub-surface", choices=("sub-surface", "scallop", "gouge"),
                     help="colours of sub-surfaces in .glb: one each (default), or a map of toolaxis verify")
    sub.add_argument("--json", action="store_true", help="machine-readable result on stdout")
    sub.set_defaults(module="toolaxis.cli.export")


def _add_batch(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("batch", help="plan many parts, each in a process of its own, resumable",
                              description="Plan the jobs of a TOML file ([defaults] and [[jobs]]), each into its own "
                                          "folder. Started again, it goes on where it stopped. Exit code 1 where a job "
                                          "is not complete.")
    sub.add_argument("jobs", metavar="JOBS.toml")
    sub.add_argument("--out", metavar="DIR", help="folder for the jobs' folders (default: out/NAME of the job file)")
    sub.add_argument("--workers", type=int, metavar="N", help="processes; all cores unless given")
    sub.add_argument("--scheduler", metavar="ADDRESS",
                     help="dask.distributed scheduler, such as tcp://host:8786, whose workers take the jobs")
    sub.add_argument("--json", action="store_true", help="machine-readable summary on stdout")
    sub.set_defaults(module="toolaxis.cli.batch")


def _add_demo(commands: "argparse._SubParsersAction[_Parser]") -> None:
    sub = commands.add_parser("demo", help="plan, verify and post an example part in a new folder",
                              description="Write an example part into a new folder, plan it with the general rack on a "
                                          "machine of the library, verify the plan, and write programs and a page. "
                                          "Exit code 1 where the plan fails.")
    sub.add_argument("folder", metavar="DIR", nargs="?", default="toolaxis-demo",
                     help="folder to make (default: toolaxis-demo)")
    sub.add_argument("--no-pictures", action="store_true", help="write no pictures")
    sub.add_argument("--json", action="store_true", help="machine-readable result on stdout")
    sub.set_defaults(module="toolaxis.cli.demo")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words after the command's name; those of the process unless given.

    Returns
    -------
    int
        Exit code.
    """
    given = parser().parse_args(arguments)
    work = import_module(given.module).run
    with StopSignals() as stopping:
        return _answer(work, given, stopping)


def _answer(work: Callable[[argparse.Namespace, Callable[[], bool]], int], given: argparse.Namespace,
            stopping: StopSignals) -> int:
    try:
        code = work(given, stopping.asked)
        sys.stdout.flush()
        return code
    except (KeyboardInterrupt, Cancelled):
        print("toolaxis: interrupted", file=sys.stderr)
        return INTERRUPTED
    except ToolAxisError as reason:
        print(f"toolaxis: {_sentence(reason)}", file=sys.stderr)
        return WRONG_INPUT if _blames_input(reason) else NO
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except Exception as reason:  # a fault of the program that is of no single face
        why = fault(reason)
        print(why.traceback, f"toolaxis: {why.sentence}", sep="", file=sys.stderr)
        return NO


def _sentence(reason: BaseException) -> str:
    return " ".join(str(reason).split())


def _blames_input(reason: BaseException | None) -> bool:
    if reason is None:
        return False
    return isinstance(reason, InvalidInput | UnsupportedGeometry | MissingBackend) or _blames_input(reason.__cause__)


if __name__ == "__main__":
    from toolaxis.cli.start import command

    command()
