"""The public names: light to import, always the functions, and the same after any import."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import toolaxis as ta

NAMES = ("Tool", "Face", "load", "place", "strip_width", "gouge", "clearance", "sample_points", "estimate", "count",
         "passes", "best_axis", "plan", "verify", "batch", "drop_cutter", "join", "read_cl", "SubSurface",
         "export", "to_trimesh")
HEAVY = ("matplotlib", "scipy", "numba", "OCP", "cadquery", "build123d", "rich")


def python(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_resolves_to_something_callable_with_a_docstring(name: str) -> None:
    thing = getattr(ta, name)
    assert callable(thing) and thing.__doc__
    assert name in dir(ta) and name in ta.__all__


def test_unknown_names_are_attribute_errors() -> None:
    with pytest.raises(AttributeError, match="no attribute 'no_such_name'"):
        _ = ta.no_such_name


def test_subpackages_do_not_take_the_functions_place() -> None:
    code = ("import toolaxis as ta, toolaxis.plan.plan, toolaxis.verify.verdict\n"
            "from toolaxis.plan.plan import Plan\n"
            "import types\n"
            "assert isinstance(ta.plan, types.FunctionType), ta.plan\n"
            "assert isinstance(ta.verify, types.FunctionType), ta.verify\n"
            "from toolaxis import plan, verify\n"
            "assert plan is ta.plan and verify is ta.verify\n")
    python(code)


def test_importing_is_light() -> None:
    code = ("import sys, time, json\nbegan = time.perf_counter()\nimport toolaxis\n"
            "spent = time.perf_counter() - began\n"
            f"print(json.dumps([spent, [m for m in {HEAVY!r} if m in sys.modules]]))")
    runs = [json.loads(python(code)) for _ in range(3)]
    assert min(spent for spent, _ in runs) < 0.3
    assert all(heavy == [] for _, heavy in runs)


def test_a_face_and_a_tool_need_no_cad_kernel_and_no_pictures() -> None:
    code = ("import sys, toolaxis as ta\n"
            "face = ta.Face.from_bspline([[[x, y, 0.01 * x * y] for y in range(4)] for x in range(4)])\n"
            "ta.place(face, ta.Tool.torus(diameter=12, corner_radius=1), [[0.5, 0.5]], [0, 0, 1])\n"
            "assert not {'OCP', 'matplotlib', 'cadquery', 'build123d', 'rich'} & set(sys.modules)\n")
    python(code)


def test_version_is_that_of_the_package() -> None:
    setup = (Path(__file__).parent.parent / "setup.cfg").read_text()
    assert f"version = {ta.__version__}\n" in setup
