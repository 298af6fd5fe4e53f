"""Compiling: the switch, the notice, and code kept on disk that must not outlive its sources."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

CORE = Path(__file__).resolve().parents[2] / "core"


def run(script: str, folder: Path, **environment: str) -> str:
    settings = {"PYTHONPATH": os.pathsep.join([str(CORE), str(folder)]), "NUMBA_CACHE_DIR": str(folder / "kept"),
                "PYTHONDONTWRITEBYTECODE": "1"}  # else Python takes a file rewritten within a second for the former one
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=False,
                          env={**os.environ, **settings, **environment})
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


def test_without_numba_the_twins_run(tmp_path: Path) -> None:
    script = """
import sys, numpy as np
from toolaxis.numeric import bspline
from toolaxis.numeric import jit as compiled
from toolaxis.shape.analytic import SphericalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
assert compiled.available == ("numba" in sys.modules) == (sys.argv[-1] == "with")
sphere = SphericalSurface(20.0, (0.0, 1.5), (-1.0, 1.0))
face = Face(sphere.nurbs(), (np.array([[0.1, -0.5], [1.2, -0.5], [0.7, 0.8]]),))
uv = face.grid(9, 9)
work, out = np.empty(bspline.WORK_SHAPE), np.empty((6, 3))
bspline.surface_derivatives(face.surface.data, *uv[0], out, work)
assert np.abs(out - bspline.surface_derivatives_many(face.surface.data, uv[:1])[0]).max() < 1e-10
assert np.abs(np.linalg.norm(nearest(face, [[30.0, 10.0, 0.0]]).point, axis=1) - 20).max() < 1e-9
print("fine", round(face.area, 6))
"""
    without = run(script, tmp_path, TOOLAXIS_NUMBA="0")
    compiled = run("import sys; sys.argv.append('with')\n" + script, tmp_path, NUMBA_CACHE_DIR="")
    assert "fine" in without and without == compiled


def test_the_core_loads_without_numba(tmp_path: Path) -> None:
    script = """
import importlib, pkgutil, sys, toolaxis
for module in pkgutil.walk_packages(toolaxis.__path__, "toolaxis."):
    if not module.name.startswith("toolaxis.cad.") and module.name != "toolaxis.numeric.kernel":
        importlib.import_module(module.name)
assert "numba" not in sys.modules
"""
    run(script, tmp_path, TOOLAXIS_NUMBA="0")


def test_a_broken_numba_gives_one_notice(tmp_path: Path) -> None:
    (tmp_path / "numba.py").write_text("raise SystemError('made for another numpy')")
    path = os.pathsep.join([str(tmp_path), str(CORE)])
    done = subprocess.run([sys.executable, "-c", "from toolaxis.numeric import bspline, polygons, jit\n"
                           "assert not jit.available"], capture_output=True, text=True, timeout=60, check=False,
                          env={**os.environ, "PYTHONPATH": path})
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("numba cannot be used (made for another numpy): slower numpy code runs instead") == 1


def test_without_compilation_kernels_are_plain_functions(tmp_path: Path) -> None:
    script = "from toolaxis.numeric.bspline import find_span as f; import numpy as np; print(f(np.arange(6.0), 1, 2.5))"
    assert run(script, tmp_path, NUMBA_DISABLE_JIT="1").strip() == "2"


NESTED = """from toolaxis.numeric.jit import jit, jit_inline


@jit_inline
def inner(x):
    return x + 1.0


@jit
def middle(x):
    return 2.0 * inner(x)


@jit
def outer(x):
    return middle(x) + inner(x)
"""
UNCOUNTED = """
from typing import NamedTuple
import numpy as np
from toolaxis.numeric import jit

class Pair(NamedTuple):
    first: np.ndarray
    second: np.ndarray

@jit.jit_uncounted_inline
def share(pair, k):
    return pair.first[k] / pair.second[k]

@jit.jit_uncounted
def swap(pair):
    return Pair(pair.second, pair.first)

@jit.jit_uncounted
def kernel(pair, out):
    other = swap(pair)
    for k in range(len(out)):
        out[k] = share(other, k)
"""
COUNT_REFERENCES = """
import sys
from toolaxis.numeric.jit import compilations
seen = compilations()
from uncounted import *
pair, out = Pair(np.array([1.0, 2.0]), np.array([3.0, 5.0])), np.empty(2)
before = [sys.getrefcount(array) for array in (*pair, out)]
for _ in range(1000):
    kernel(pair, out)
assert [sys.getrefcount(array) for array in (*pair, out)] == before
assert out.tolist() == [3.0, 2.5]
print(seen())
"""
KERNEL = "from toolaxis.numeric.jit import jit\n\n\n@jit\ndef "
NAMED = "from typing import NamedTuple\n\n\nclass {}(NamedTuple):\n{}"
HITS = "sum({}.stats.cache_hits.values())"


class Kept(NamedTuple):
    """Kernels, and what three processes, one after the other, find beside them: texts of files that stay, what each
    process runs, and a file that is written anew before each of them."""

    sources: dict[str, str]
    code: tuple[str, str, str]
    changing: tuple[str, tuple[str, str, str]] | None = None


def fields(names: str, name: str = "Span") -> str:
    return NAMED.format(name, "".join(f"    {name}: float\n" for name in names.split()))


def of_class(name: str) -> str:
    return (f"from low_kernel import low\nfrom span_class import {name}\n"
            f"print(low(({name}(low=1.0), 3)), {HITS.format('low')})")


INNER, SCALED = KERNEL + "inner(x):\n    return x + {}\n", KERNEL + "scaled(x):\n    return SCALE * x\n"
KEPT = {
    "callee": Kept({"outer_kernel.py": f"from inner_kernel import inner\n{KERNEL}outer(x):\n    return inner(x)\n"},
                   (f"from outer_kernel import outer; print(outer(1.0), {HITS.format('outer')})",) * 3,
                   ("inner_kernel.py", (INNER.format("1.0"), INNER.format("1.0"), INNER.format("20.0")))),
    "constant": Kept({"scaled_kernel.py": "from scale import SCALE\n" + SCALED},
                     (f"from scaled_kernel import scaled; print(scaled(1.5), {HITS.format('scaled')})",) * 3,
                     ("scale.py", ("SCALE = 2.0\n", "SCALE = 2.0\n", "SCALE = 4.0\n"))),
    "fields": Kept({"first_kernel.py": KERNEL + "low(pair):\n    return pair[0].low\n"},
                   ("from first_kernel import low\nfrom span_fields import Span\n"
                    f"print(low((Span(low=1.0, high=2.0), 3)), {HITS.format('low')})",) * 3,
                   ("span_fields.py", (fields("low high"), fields("low high"), fields("high low")))),
    "class": Kept({"low_kernel.py": KERNEL + "low(pair):\n    return pair[0].low\n"},
                  (of_class("Span"), of_class("Range"), of_class("Range")),
                  ("span_class.py", (fields("low"), fields("low", "Range"), fields("low", "Range")))),
    "arguments": Kept({"half_kernel.py": KERNEL + "half(x):\n    return x[0] / 2\n"},
                      ("import numpy as np\nfrom half_kernel import half\n"
                       f"print(half(np.array([3.0])), half(np.array([3])), {HITS.format('half')})",) * 3),
    "nested": Kept({"nested.py": NESTED},
                   ("import nested as n\nprint(n.outer(1.0), n.middle.signatures, 'entry' in vars(n.middle))\n"
                    "print(n.middle(1.0), n.inner(1), n.inner(1.5))",) * 3),
    "uncounted": Kept({"uncounted.py": UNCOUNTED}, (COUNT_REFERENCES,) * 3),
    "counted": Kept({"one.py": KERNEL + "double(x):\n    return 2 * x\n"},
                    ("from toolaxis.numeric.jit import compilations\nseen = compilations()\nimport one\n"
                     "assert one.double(1.5) == 3.0\nprint(seen())",) * 3),
}
TELL_ALL = """
import contextlib, io, json
told = {}
for name, code in CODE.items():
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(code, {})
    told[name] = out.getvalue()
print(json.dumps(told))
"""


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the kernels of KEPT lie, and their code on disk below it."""
    pytest.importorskip("numba")
    folder = tmp_path_factory.mktemp("kept")
    for one in KEPT.values():
        for name, text in one.sources.items():
            (folder / name).write_text(text)
    return folder


@pytest.fixture(scope="module")
def answers(kept: Path) -> list[dict[str, str]]:
    """What all kernels of KEPT say in three processes: to start one for each of them takes most of the time."""
    told = []
    for turn in range(3):
        for one in KEPT.values():
            if one.changing is not None:
                (kept / one.changing[0]).write_text(one.changing[1][turn])
        code = {name: one.code[turn] for name, one in KEPT.items()}
        told.append(json.loads(run(f"CODE = {code!r}\n{TELL_ALL}", kept).splitlines()[0]))
        if turn == 0:  # two processes that compile at the same time may both write the file of the first's code
            one, two = sorted((kept / "kept").rglob("half_kernel*.nbc"))
            first = one.read_bytes()
            one.write_bytes(two.read_bytes())
            two.write_bytes(first)
    return told


def words_of(answers: list[dict[str, str]], name: str) -> list[list[str]]:
    return [one[name].split() for one in answers]


def test_uncounted_kernels_hold_no_arrays_and_hand_them_to_one_another(answers: list[dict[str, str]]) -> None:
    assert words_of(answers, "uncounted") == [["3"], ["0"], ["0"]]


def test_kept_code_expires_with_what_it_calls(answers: list[dict[str, str]]) -> None:
    assert words_of(answers, "callee") == [["2.0", "0"], ["2.0", "1"], ["21.0", "0"]]


def test_kept_code_expires_with_imported_constants(answers: list[dict[str, str]]) -> None:
    assert words_of(answers, "constant") == [["3.0", "0"], ["3.0", "1"], ["6.0", "0"]]


def test_kept_code_expires_when_fields_change_places(answers: list[dict[str, str]]) -> None:
    """Also where the kernel's module does not know the named tuple that it is handed."""
    assert words_of(answers, "fields") == [["1.0", "0"], ["1.0", "1"], ["1.0", "0"]]


def test_kept_code_of_a_class_that_is_gone_is_compiled_anew(answers: list[dict[str, str]]) -> None:
    """An earlier version kept code for arguments of a class that another one does not have any more."""
    assert words_of(answers, "class") == [["1.0", "0"], ["1.0", "0"], ["1.0", "1"]]


def test_kept_code_for_other_arguments_is_not_taken(answers: list[dict[str, str]]) -> None:
    """Two processes that compile at the same time may both write the file of the first's code."""
    assert words_of(answers, "arguments") == [["1.5", "1.5", "0"], ["1.5", "1.5", "0"], ["1.5", "1.5", "2"]]


def test_kernels_within_others_are_no_machine_code_of_their_own(answers: list[dict[str, str]], kept: Path) -> None:
    first, second, _ = (one["nested"].split("\n")[:2] for one in answers)
    assert first == ["6.0 [(float64,)] False", "4.0 2.0 2.5"]
    assert second == ["6.0 [] False", "4.0 2.0 2.5"]
    assert len(list((kept / "kept").rglob("nested*.nbc"))) == 4


def test_what_has_to_be_compiled_is_counted(answers: list[dict[str, str]], kept: Path) -> None:
    assert words_of(answers, "counted") == [["1"], ["0"], ["0"]]
    assert run(KEPT["counted"].code[0], kept, TOOLAXIS_NUMBA="0").split() == ["0"]


def test_a_kernel_is_compiled_by_one_process_while_others_wait(tmp_path: Path) -> None:
    """The second takes from disk what the first compiled meanwhile; the first holds its lock for two seconds more."""
    pytest.importorskip("numba")
    (tmp_path / "nested.py").write_text(NESTED)
    slow = ("import time\nfrom numba.core.dispatcher import Dispatcher\ncompiled = Dispatcher.compile\n"
            "def late(kernel, types):\n    print('begun', flush=True)\n    time.sleep(2)\n"
            "    return compiled(kernel, types)\n"
            "import nested\nnested.outer.entry\nDispatcher.compile = late\n")
    tell = "print(nested.outer(1.0), sum(nested.outer.stats.cache_hits.values()))"
    settings = {"PYTHONPATH": os.pathsep.join([str(CORE), str(tmp_path)]), "NUMBA_CACHE_DIR": str(tmp_path / "kept")}
    with subprocess.Popen([sys.executable, "-c", slow + tell], stdout=subprocess.PIPE, text=True,
                          env={**os.environ, **settings}) as first:
        assert first.stdout is not None and first.stdout.readline().strip() == "begun"
        assert run("import nested\n" + tell, tmp_path).split() == ["6.0", "1"]
        assert first.communicate(timeout=60)[0].splitlines()[-1] == "6.0 0"


def test_where_numba_cannot_build_kernels_in_each_is_compiled(tmp_path: Path) -> None:
    pytest.importorskip("numba")
    (tmp_path / "nested.py").write_text(NESTED)
    script = ("import sys\nsys.modules['toolaxis.numeric.kernel'] = None\nimport nested\n"
              "print(nested.outer(1.0), type(nested.outer).__name__, sum(nested.outer.stats.cache_hits.values()))")
    assert [run(script, tmp_path).strip() for _ in range(2)] == ["6.0 CPUDispatcher 0", "6.0 CPUDispatcher 1"]
    assert len(list((tmp_path / "kept").rglob("*.nbc"))) == 3


def test_kept_code_serves_another_clone(tmp_path: Path) -> None:
    """The text of the sources decides, not where they lie or when they were written."""
    pytest.importorskip("numba")
    script = "from twice_kernel import twice; print(twice(1.5), sum(twice.stats.cache_hits.values()))"
    source = "from toolaxis.numeric.jit import jit\n\n\n@jit\ndef twice(x):\n    return {} * x\n"
    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    (first / "twice_kernel.py").write_text(source.format("2.0"))
    assert run(script, first, NUMBA_CACHE_DIR="").split() == ["3.0", "0"]
    shutil.copytree(first, second)
    os.utime(second / "twice_kernel.py", (1e9, 1e9))
    assert run(script, second, NUMBA_CACHE_DIR="").split() == ["3.0", "1"]
    written = os.stat(second / "twice_kernel.py")
    (second / "twice_kernel.py").write_text(source.format("4.0"))
    os.utime(second / "twice_kernel.py", ns=(written.st_atime_ns, written.st_mtime_ns))
    assert run(script, second, NUMBA_CACHE_DIR="").split() == ["6.0", "0"]


def test_nothing_else_imports_numba() -> None:
    importing = re.compile(r"^\s*(import|from) numba\b", re.MULTILINE)
    guilty = [str(path.relative_to(CORE)) for path in CORE.rglob("*.py") if importing.search(path.read_text())]
    assert sorted(guilty) == ["toolaxis/numeric/jit.py", "toolaxis/numeric/kernel.py"]
