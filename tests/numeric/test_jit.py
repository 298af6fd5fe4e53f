"""Compiling: the switch, the notice, and code kept on disk that must not outlive its sources."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

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
    assert "fine" in without and without == run("import sys; sys.argv.append('with')\n" + script, tmp_path)


def test_the_core_loads_without_numba(tmp_path: Path) -> None:
    script = """
import importlib, pkgutil, sys, toolaxis
for module in pkgutil.walk_packages(toolaxis.__path__, "toolaxis."):
    if not module.name.startswith("toolaxis.cad.") and module.name != "toolaxis.numeric.kernel":
        importlib.import_module(module.name)
assert "numba" not in sys.modules
"""
    run(script, tmp_path, TOOLAXIS_NUMBA="0")


def test_uncounted_kernels_hold_no_arrays_and_hand_them_to_one_another(tmp_path: Path) -> None:
    (tmp_path / "inner.py").write_text("""
import sys
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
""")
    script = """
from inner import *
compiled = jit.compilations()
pair, out = Pair(np.array([1.0, 2.0]), np.array([3.0, 5.0])), np.empty(2)
before = [sys.getrefcount(array) for array in (*pair, out)]
for _ in range(1000):
    kernel(pair, out)
assert [sys.getrefcount(array) for array in (*pair, out)] == before
assert out.tolist() == [3.0, 2.5]
print(compiled())
"""
    assert int(run(script, tmp_path)) == 3
    assert int(run(script, tmp_path)) == 0


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


def test_kept_code_expires_with_what_it_calls(tmp_path: Path) -> None:
    pytest.importorskip("numba")
    inner = "from toolaxis.numeric.jit import jit\n\n\n@jit\ndef inner(x):\n    return x + {}\n"
    (tmp_path / "outer_kernel.py").write_text("from inner_kernel import inner\nfrom toolaxis.numeric.jit import "
                                              "jit\n\n\n@jit\ndef outer(x):\n    return inner(x)\n")
    script = "from outer_kernel import outer; print(outer(1.0), sum(outer.stats.cache_hits.values()))"
    source, answers = tmp_path / "inner_kernel.py", []
    for term in ("1.0", None, "20.0"):
        if term:
            source.write_text(inner.format(term))
        answers.append(run(script, tmp_path).split())
    assert [float(answer) for answer, _ in answers] == [2.0, 2.0, 21.0]
    assert [hits for _, hits in answers] == ["0", "1", "0"]


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


def test_kernels_within_others_are_no_machine_code_of_their_own(tmp_path: Path) -> None:
    pytest.importorskip("numba")
    (tmp_path / "nested.py").write_text(NESTED)
    script = ("import nested\nprint(nested.outer(1.0), nested.middle.signatures, 'entry' in vars(nested.middle))\n"
              "print(nested.middle(1.0), nested.inner(1), nested.inner(1.5))")
    first, second = run(script, tmp_path), run(script, tmp_path)
    assert first.split("\n")[:2] == ["6.0 [(float64,)] False", "4.0 2.0 2.5"]
    assert second.split("\n")[:2] == ["6.0 [] False", "4.0 2.0 2.5"]
    assert len(list((tmp_path / "kept").rglob("*.nbc"))) == 4


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


def test_kept_code_expires_with_imported_constants(tmp_path: Path) -> None:
    pytest.importorskip("numba")
    (tmp_path / "scaled_kernel.py").write_text("from scale import SCALE\nfrom toolaxis.numeric.jit import "
                                               "jit\n\n\n@jit\ndef scaled(x):\n    return SCALE * x\n")
    script = "from scaled_kernel import scaled; print(scaled(1.5), sum(scaled.stats.cache_hits.values()))"
    answers = []
    for scale in ("2.0", "2.0", "4.0"):
        (tmp_path / "scale.py").write_text(f"SCALE = {scale}\n")
        answers.append(run(script, tmp_path).split())
    assert answers == [["3.0", "0"], ["3.0", "1"], ["6.0", "0"]]


def test_kept_code_expires_when_fields_change_places(tmp_path: Path) -> None:
    """Also where the kernel's module does not know the named tuple that it is handed."""
    pytest.importorskip("numba")
    (tmp_path / "first_kernel.py").write_text("from toolaxis.numeric.jit import jit\n\n\n"
                                              "@jit\ndef low(pair):\n    return pair[0].low\n")
    script = ("from first_kernel import low\nfrom span import Span\n"
              "print(low((Span(low=1.0, high=2.0), 3)), sum(low.stats.cache_hits.values()))")
    answers = []
    for names in ("low high", "low high", "high low"):
        fields = "".join(f"    {name}: float\n" for name in names.split())
        (tmp_path / "span.py").write_text(f"from typing import NamedTuple\n\n\nclass Span(NamedTuple):\n{fields}")
        answers.append(run(script, tmp_path).split())
    assert answers == [["1.0", "0"], ["1.0", "1"], ["1.0", "0"]]


def test_kept_code_of_a_class_that_is_gone_is_compiled_anew(tmp_path: Path) -> None:
    """An earlier version kept code for arguments of a class that another one does not have any more."""
    pytest.importorskip("numba")
    (tmp_path / "low_kernel.py").write_text("from toolaxis.numeric.jit import jit\n\n\n"
                                            "@jit\ndef low(pair):\n    return pair[0].low\n")
    answers = []
    for name in ("Span", "Range", "Range"):
        (tmp_path / "span.py").write_text("from typing import NamedTuple\n\n\n"
                                          f"class {name}(NamedTuple):\n    low: float\n")
        script = (f"from low_kernel import low\nfrom span import {name}\n"
                  f"print(low(({name}(low=1.0), 3)), sum(low.stats.cache_hits.values()))")
        answers.append(run(script, tmp_path).split())
    assert answers == [["1.0", "0"], ["1.0", "0"], ["1.0", "1"]]


def test_kept_code_for_other_arguments_is_not_taken(tmp_path: Path) -> None:
    """Two processes that compile at the same time may both write the file of the first's code."""
    pytest.importorskip("numba")
    (tmp_path / "half_kernel.py").write_text("from toolaxis.numeric.jit import jit\n\n\n"
                                             "@jit\ndef half(x):\n    return x[0] / 2\n")
    script = ("import numpy as np\nfrom half_kernel import half\n"
              "print(half(np.array([3.0])), half(np.array([3])), sum(half.stats.cache_hits.values()))")
    answers = [run(script, tmp_path).split()]
    one, two = sorted((tmp_path / "kept").rglob("*.nbc"))
    first = one.read_bytes()
    one.write_bytes(two.read_bytes())
    two.write_bytes(first)
    answers += [run(script, tmp_path).split() for _ in range(2)]
    assert [answer[:2] for answer in answers] == [["1.5", "1.5"]] * 3
    assert [answer[2] for answer in answers] == ["0", "0", "2"]


def test_nothing_else_imports_numba() -> None:
    importing = re.compile(r"^\s*(import|from) numba\b", re.MULTILINE)
    guilty = [str(path.relative_to(CORE)) for path in CORE.rglob("*.py") if importing.search(path.read_text())]
    assert sorted(guilty) == ["toolaxis/numeric/jit.py", "toolaxis/numeric/kernel.py"]


def test_what_has_to_be_compiled_is_counted(tmp_path: Path) -> None:
    (tmp_path / "one.py").write_text("from toolaxis.numeric.jit import jit\n\n\n"
                                     "@jit\ndef double(x):\n    return 2 * x\n")
    script = ("from toolaxis.numeric.jit import compilations\nseen = compilations()\nimport one\n"
              "assert one.double(1.5) == 3.0\nprint('seen', seen())")
    counts = [run(script, tmp_path, **environment) for environment in ({}, {}, {"TOOLAXIS_NUMBA": "0"})]
    assert [text.strip() for text in counts] == ["seen 1", "seen 0", "seen 0"]
