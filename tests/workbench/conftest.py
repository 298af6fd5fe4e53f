"""Tests of the FreeCAD add-on: plain pytest inside FreeCAD; outside, the files are started in the real FreeCAD.

Which FreeCAD that is says the environment variable TOOLAXIS_FREECAD: the beginning of a command that runs the rest of
it in FreeCAD's Python, with the project as an add-on.  TOOLAXIS_FREECAD_OLD names a second one, which gets all of the
tests too with --long, else OLDER, on what differs between releases; its window opens in its own program alone, not in
Python.  Without the first, a FreeCAD that is installed is looked for; where there is none the tests are skipped, and
the reason is printed.
"""

import atexit
import importlib.util
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SHARED = "TOOLAXIS_TESTS_SHARED"
INSIDE = importlib.util.find_spec("FreeCAD") is not None
MARK, FAILED, CRASHED = "TOOLAXIS-INNER ", "TOOLAXIS-FAILED ", "Fatal Python error"
CRASH = "FreeCAD crashed"
TIME_LIMIT, LONG_TIME_LIMIT = 1200.0, 5400.0
TAIL = 40
INSTALLED = ("freecadcmd", "FreeCADCmd", "freecadcmd-daily"), ("freecad", "FreeCAD", "freecad-daily")
# Files that the older FreeCAD runs without --long, and of which tests, where not of all: what differs between releases
# are CAM's jobs and tools, the kernel that parts are read with, frames in the tree, saved documents, installing, the
# kinds of things that can be selected, and of the panel its fields with their units, the mouse, and making objects.
# What the panel does with a plan once it has one is our own code on the same Qt, and which work offsets, heights and
# refusals jobs get is our own choice: the newer FreeCAD alone runs that.
OLDER = {"test_bad_cases.py": ("test_what_has_no_sculptured_face", "test_edges_selected",
                               "test_a_body_stands_for_its_sculptured_faces",
                               "test_faces_in_containers_links_and_bodies_keep_what_places_them",
                               "test_tools_of_a_cam_job_are_offered_and_other_bodies_can_be_avoided"),
         "test_cam_jobs.py": ("test_the_posted_program_lies_on_the_cl_data",
                              "test_a_program_of_a_tilted_plane_says_so_before_it_moves",
                              "test_each_orientation_is_a_job_and_shares_it",
                              "test_a_clone_that_shows_something_else_is_refused", "test_one_undo_step_and_back",
                              "test_made_again_it_takes_the_place_of_the_old_one",
                              "test_what_a_user_put_into_a_job_stays", "test_a_cutter_comes_back_from_its_bit",
                              "test_turned_copies_of_blades_are_machined_too"),
         "test_install.py": (),
         "test_objects_tree.py": ("test_frames_and_passes_stand_on_the_part_and_follow_it",
                                  "test_inputs_come_back_from_the_operation",
                                  "test_the_tool_stands_on_its_passes_and_moves",
                                  "test_the_tool_is_a_solid_of_revolution_of_its_profile",
                                  "test_a_face_without_an_axis_has_its_reasons_and_no_objects",
                                  "test_a_whole_plan_from_one_call"),
         "test_part_contract.py": (), "test_saved_before.py": (),
         "test_two_setups.py": ("test_it_is_saved_opened_and_planned_again", "test_the_first_is_deleted"),
         "test_work_setup.py": ("test_job_stock_and_program_count_from_a_corner_of_the_stock",
                                "test_a_picked_vertex_moves_along_with_the_part"),
         "test_panel.py": ("test_the_workbench_is_there_with_its_commands",
                           "test_plan_from_selection_to_objects_and_back", "test_pointer_and_click_on_the_map",
                           "test_impossible_values_lock_compute_with_the_reason",
                           "test_a_bare_number_is_millimetres",
                           "test_units_follow_freecads_settings[ImperialDecimal-3]")}
# Files that run in one FreeCAD, one after another: to start it and to load the library takes longer than many of their
# tests.  Where it crashes each of them is run by itself.  Of files that drive the window only short ones: the more
# panels one FreeCAD has opened and closed, the sooner Qt ends in a widget that is gone.
TOGETHER = (("test_cam_jobs.py", "test_install.py", "test_objects_tree.py", "test_saved_before.py",
             "test_work_setup.py"),
            ("test_arguments.py", "test_children.py", "test_choices.py", "test_defaults.py", "test_document_parts.py",
             "test_export.py", "test_loose_faces.py", "test_machines.py", "test_objects_change.py",
             "test_path_collisions.py", "test_playing.py", "test_renumbering.py", "test_tessellation_offset.py",
             "test_time_left.py", "test_translations.py", "test_two_setups.py"),
            ("test_background.py", "test_fields.py", "test_play.py", "test_settings.py", "test_setup_tab.py",
             "test_views.py"),
            ("test_many_jobs.py", "test_moving.py", "test_small_window.py", "test_verify_panel.py"),
            ("test_any_order.py", "test_interruptions.py"))
# each in another Python, where it compiles what the others then find compiled
FIRST = ("cli/test_commands.py", "workbench/test_whole_plans.py", "workbench/gui/test_panel.py")
# What runs outside FreeCAD for longest, the longest first: on one process alone it would keep all waiting at the end.
LONGEST = ("job/test_rack.py", "regions/test_out_of_reach.py", "job/test_run.py", "verify/test_three_judges.py",
           "orient/test_best_axis.py", "numeric/test_jit.py", "messages/test_german.py", "regions/test_axis_lines.py",
           "cad/test_kernel_agreement.py", "job/test_failures.py", "orient/test_four_plus_one.py",
           "regions/test_reach_screen.py", "partition/test_times.py", "job/test_face_by_face.py",
           "verify/test_edges.py", "job/test_pattern.py", "path/test_fields.py", "job/test_step_over.py",
           "tests/test_wheel.py", "regions/test_divide_by_reach.py", "tests/test_readme.py",
           "job/test_page_in_browser.py", "orient/test_passes_along_planes.py", "path/test_mending.py",
           "job/test_stock.py", "orient/test_search.py", "cli/test_kept.py", "tests/test_benchmarks.py",
           "hard/test_axis_of_the_passes.py", "batch/test_cluster.py", "path/test_left_over.py", "cli/test_choices.py",
           "job/test_left_whole.py", "job/test_folder_example.py", "partition/test_regions.py",
           "orient/test_kinematic_axis.py", "contact/test_safety_trimmed.py")
READY = {}
# CAM's modules load Qt, and Qt crashes Python in FreeCAD 1.0 where pytest was loaded before it
STARTER = "import sys, FreeCAD, Path.Main.Job, pytest; sys.exit(pytest.main(sys.argv[1:]))"

if INSIDE:
    import FreeCAD  # noqa: F401  before any test's `import Part`, which crashes alone


def pytest_configure(config):
    if INSIDE and "TOOLAXIS_INNER" in os.environ:
        config.pluginmanager.register(Teller(), "toolaxis-teller")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items):
    """FIRST, then what runs in FreeCAD and LONGEST in turns, then the rest.

    None that takes minutes should begin when all else is done.  What drives a window waits for it half of the time: in
    turns with what computes, it leaves no core idle.
    """
    _put_together(items)
    inside = list(dict.fromkeys(item.path for item in items if isinstance(item, InnerRun)))

    def place(item):
        name = item.path.as_posix()
        for k, end in enumerate(FIRST):
            if name.endswith(end):
                return 0, k
        if isinstance(item, InnerRun):
            return 1, 2 * inside.index(item.path)
        return next(((1, 2 * k + 1) for k, end in enumerate(LONGEST) if name.endswith(end)), (2, 0))

    items.sort(key=place)


def _put_together(items):
    """Let the first of the files that run in one FreeCAD take the others along."""
    groups = {}
    for item in items:
        if isinstance(item, InnerRun):
            group = next((group for group in TOGETHER if item.path.name in group), item.path)
            groups.setdefault((item.variable, group), []).append(item)
    leaders = {found[0]: found for found in groups.values()}
    items[:] = [item.together_with(leaders[item][1:]) if item in leaders else item
                for item in items if item in leaders or not isinstance(item, InnerRun)]


def pytest_terminal_summary(terminalreporter):
    """Tell of every crash of FreeCAD, also where the second run passed."""
    told = {text for reports in terminalreporter.stats.values() for report in reports
            for name, text in getattr(report, "user_properties", ()) if name == CRASH}
    for text in sorted(told):
        terminalreporter.section("FreeCAD crashed and was started again")
        terminalreporter.write_line(text)


def pytest_pycollect_makemodule(module_path, parent):
    return None if INSIDE else InnerFile.from_parent(parent, path=module_path)


class Teller:
    """Inside FreeCAD: tells failures at once and in one line what became of all, and leaves before FreeCAD crashes."""

    def __init__(self):
        self.outcomes, self.status = {}, 1

    def pytest_runtest_logreport(self, report):
        if report.outcome != "passed" or (report.when == "call" and report.nodeid not in self.outcomes):
            before = self.outcomes.get(report.nodeid, ["", ""])
            told = [before[1]] if before[0] == "failed" else []  # what comes after a failure does not hide it
            self.outcomes[report.nodeid] = [report.outcome, "\n".join([*told, _tail(str(report.longrepr or ""))])]
        if report.failed:
            sys.__stdout__.write(f"\n{FAILED}{report.nodeid}\n{self.outcomes[report.nodeid][1]}\n")
            sys.__stdout__.flush()

    def pytest_collectreport(self, report):
        if report.outcome != "passed":
            self.outcomes[report.nodeid] = [report.outcome, _tail(str(report.longrepr))]

    def pytest_sessionfinish(self, exitstatus):
        self.status = int(exitstatus)

    @pytest.hookimpl(tryfirst=True)
    def pytest_unconfigure(self):
        sys.__stdout__.write(f"\n{MARK}{json.dumps(self.outcomes)}\n")
        for stream in (sys.stdout, sys.stderr, sys.__stdout__, sys.__stderr__):
            stream.flush()
        os._exit(self.status)


class InnerFile(pytest.File):
    """Outside: a file of tests that runs in FreeCAD."""

    def collect(self):
        if os.environ.get("TOOLAXIS_FREECAD_OLD") and (self.config.getoption("--long") or self.path.name in OLDER):
            yield InnerRun.from_parent(self, name="in the older FreeCAD", variable="TOOLAXIS_FREECAD_OLD")
        yield InnerRun.from_parent(self, name="in FreeCAD", variable="TOOLAXIS_FREECAD")


class InnerFailure(Exception):
    """What the tests inside said."""


class Crash(InnerFailure):
    """FreeCAD ended before its tests did, none of which had failed."""


class InnerRun(pytest.Item):
    """Outside: one run of a file, or of several in one FreeCAD, as one test with the failures of all inside."""

    def __init__(self, variable, others=(), **rest):
        super().__init__(**rest)
        self.variable, self.paths = variable, [self.path, *others]

    def together_with(self, others):
        """A run that takes the files of other runs along in the same FreeCAD."""
        if not others:
            return self
        paths = [item.path for item in others]
        name = f"{self.name}, with {', '.join(path.name for path in paths)}"
        return InnerRun.from_parent(self.parent, name=name, variable=self.variable, others=paths)

    def runtest(self):
        try:
            self.run_inside(self.paths)
        except Crash as reason:
            # Qt now and then ends in a widget that is gone: what the add-on is to blame for ends there again.
            self.user_properties.append((CRASH, f"{self.nodeid}: {reason}"))
            for path in self.paths:
                self.run_inside([path])

    def run_inside(self, paths):
        """Run files in one FreeCAD; fails with what failed there."""
        long = self.config.getoption("--long")
        arguments = ["-p", "no:cacheprovider", *(["--long"] if long else [])]
        for path in paths:
            file = path.relative_to(ROOT).as_posix()
            some = OLDER[path.name] if self.variable == "TOOLAXIS_FREECAD_OLD" and not long else ()
            arguments += [f"{file}::{name}" for name in some] or [file]
        prefix, rest = command_for(self.variable, arguments, window="gui" in self.path.parts)
        folder = prepare(self.path, long)
        older = ["TOOLAXIS_OLDER=1"] if self.variable == "TOOLAXIS_FREECAD_OLD" and not long else []
        known = ["TOOLAXIS_INNER=1", *older, f"{SHARED}={Path(os.environ[SHARED]).relative_to(ROOT).as_posix()}",
                 *([f"TOOLAXIS_PREPARED={folder}"] if folder else []),
                 *(f"{name}={os.environ[name]}" for name in ("TOOLAXIS_SHOTS",) if name in os.environ)]
        limit = len(paths) * (LONG_TIME_LIMIT if long else TIME_LIMIT)
        judge(*ended([*prefix, "env", *known, *rest], limit))

    def repr_failure(self, excinfo):
        told = isinstance(excinfo.value, InnerFailure)
        return str(excinfo.value) if told else super().repr_failure(excinfo)

    def reportinfo(self):
        return self.path, None, f"{self.path.name} {self.name}"


def prepare(path, long):
    """Run the script beside a file of tests that makes what they need from outside FreeCAD; returns its folder."""
    script = path.with_name(f"prepare_{path.stem.removeprefix('test_')}.py")
    if not script.exists() or importlib.util.find_spec("OCP") is None:
        return None
    if path not in READY:
        folder = ROOT / "out" / "freecad" / f"{path.stem.removeprefix('test_')}-{os.getpid()}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        arguments = [str(script), str(folder), *(["--long"] if long else [])]
        output, ending = ended([sys.executable, *arguments], LONG_TIME_LIMIT)
        if ending != "ended with 0":
            raise InnerFailure(f"{script.name} {ending}; its last lines:\n{_tail(output)}")
        READY[path] = folder.relative_to(ROOT).as_posix()
    return READY[path]


@pytest.fixture(scope="module")
def prepared(request):
    """The folder that the script beside these tests filled outside FreeCAD."""
    name = request.path.stem.removeprefix("test_")
    folder = ROOT / os.environ.get("TOOLAXIS_PREPARED", f"out/freecad/{name}")
    if not folder.is_dir():
        pytest.skip(f"outside FreeCAD: python tests/workbench/prepare_{name}.py out/freecad/{name}")
    return folder


def _module(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def contract():
    """The checks that every adapter has to pass."""
    return _module(ROOT / "tests" / "cad" / "contract.py")


@pytest.fixture(scope="session")
def parts():
    """Small parts for the tests of objects."""
    return _module(ROOT / "tests" / "workbench" / "objects_parts.py")


@pytest.fixture(scope="session")
def whole_parts():
    """Parts that are planned as a whole, and a rack for one of them."""
    return _module(ROOT / "tests" / "workbench" / "whole_parts.py")


@pytest.fixture(scope="session")
def posting():
    """What reads programs of FreeCAD's post-processor back."""
    return _module(ROOT / "tests" / "workbench" / "posting.py")


@pytest.fixture
def document():
    """A document, closed afterwards."""
    import FreeCAD

    made = FreeCAD.newDocument("Objects")
    name = made.Name
    yield made
    if name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)


def command_for(variable, arguments, window):
    """The command that runs pytest in FreeCAD, before and after its environment; skips where there is no FreeCAD."""
    prefix, start = shlex.split(os.environ.get(variable, "")), ROOT / "tests" / "workbench" / "start.py"
    if prefix and window and variable == "TOOLAXIS_FREECAD_OLD":
        return prefix, [f"TOOLAXIS_ARGUMENTS={json.dumps(arguments)}", "freecad", start.relative_to(ROOT).as_posix()]
    if prefix:
        return prefix, ["python3", "-c", STARTER, *arguments]
    found = next(filter(None, map(shutil.which, INSTALLED[window])), None)
    reason = os.environ.get("TOOLAXIS_FREECAD_MISSING", "none is installed")
    if found is None:
        pytest.skip(f"no FreeCAD: {reason} (TOOLAXIS_FREECAD names one; see tests/workbench/conftest.py)")
    if window and sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        pytest.skip("no display for FreeCAD's window: run under Xvfb")
    return [], [f"TOOLAXIS_ARGUMENTS={json.dumps(arguments)}", found, str(start)]


def ended(command, limit):
    """What a command wrote and how it ended; after a limit of seconds it is ended with all that it started."""
    process = subprocess.Popen(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, start_new_session=True)
    try:
        return process.communicate(timeout=limit)[0].decode(errors="replace"), f"ended with {process.returncode}"
    except subprocess.TimeoutExpired:
        output = b""
    for sign in (signal.SIGTERM, signal.SIGKILL):
        os.killpg(process.pid, sign)
        try:
            output = process.communicate(timeout=15)[0]
            break
        except subprocess.TimeoutExpired:
            continue
    return output.decode(errors="replace"), f"did not end within {limit:.0f} s"


def judge(output, ending):
    """Fail with what failed inside, or where nothing ran; skip where all was skipped."""
    line = next((line for line in reversed(output.splitlines()) if line.startswith(MARK)), None)
    if line is None:
        kind = InnerFailure if f"\n{FAILED}" in output or "did not end" in ending else Crash
        raise kind(f"FreeCAD {ending} without telling what its tests did; its last lines:\n{_told(output)}")
    outcomes = json.loads(line.removeprefix(MARK))
    failures = [f"{name} failed inside FreeCAD\n{text}" for name, (kind, text) in outcomes.items() if kind == "failed"]
    if failures:
        raise InnerFailure("\n\n".join([*failures, f"{len(failures)} of {len(outcomes)} failed inside FreeCAD"]))
    reasons = [text for kind, text in outcomes.values() if kind == "skipped"]
    if not outcomes or ending not in ("ended with 0", "ended with 5"):
        raise InnerFailure(f"no test failed inside FreeCAD, but it {ending}; its last lines:\n{_tail(output)}")
    if len(reasons) == len(outcomes):
        pytest.skip(f"all inside were skipped, the first because of {reasons[0]}")


def _told(output):
    """What failed before FreeCAD ended and where it crashed, else the last lines."""
    lines = output.splitlines()
    crash = next((k for k, line in enumerate(lines) if line.startswith(CRASHED)), len(lines))
    failed = next((k for k, line in enumerate(lines[:crash]) if line.startswith(FAILED)), crash)
    told = [*lines[failed:crash][:TAIL], *lines[crash:crash + TAIL]]
    return "\n".join(told) if told else _tail(output)


def _tail(text):
    return "\n".join(text.splitlines()[-TAIL:])
