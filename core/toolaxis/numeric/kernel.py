"""Kernels that are built into other kernels, and made machine code of where Python calls them.

numba by itself optimizes every kernel together with all that it calls, and makes machine code of it with its wrappers
for Python, at each level of calls anew.  Here a kernel that another one calls is typed and translated once; what Python
calls is optimized as a whole and kept on disk.  That takes half the time, and the numbers stay the same.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cached_property
from typing import IO, Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import AnnotateTypes, NativeLowering

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

#: How long another process is waited for that compiles the same kernel, and between looks, s.
_PATIENCE, _PAUSE = 120.0, 0.02
#: What of numba's own must be there for it; where a release does without, each kernel is compiled as numba does.
_STEPS = ("_optimize_final_module", "_finalize_final_module", "_finalize_dynamic_globals",
          "_verify_declare_only_symbols", "_finalized")
_FLAGS = ("no_compile", "no_cpython_wrapper", "no_cfunc_wrapper")


class PartLibrary(JITCodeLibrary):
    """Code that is linked into other code only."""

    def _optimize_final_module(self) -> None:
        """Left to what it is linked into."""

    def _finalize_final_module(self) -> None:
        """Close it without making machine code."""
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


class PartKey:
    """Names the code of a part where numba looks for what to call."""


@register_pass(mutates_CFG=False, analysis_only=False)
class OpenPart(LoweringPass):
    """Gives the code that follows a library that is linked only."""

    _name = "toolaxis_open_part"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """See numba's manual, "Customizing the compiler"."""
        state.library = PartLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return True


@register_pass(mutates_CFG=False, analysis_only=False)
class ClosePart(LoweringPass):
    """Makes a part known to what calls it."""

    _name = "toolaxis_close_part"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """See numba's manual, "Customizing the compiler"."""
        key = PartKey()
        state.targetctx.insert_user_function(key, state.cr.fndesc, [state.library])
        state.cr = state.cr._replace(cfunc=key)
        return True


class PartCompiler(CompilerBase):
    """Compiles a part: as numba does, up to the code that is linked."""

    def define_pipelines(self) -> list[Any]:
        """See numba's manual, "Customizing the compiler"."""
        for flag in _FLAGS:
            setattr(self.state.flags, flag, True)
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(OpenPart, AnnotateTypes)
        passes.add_pass_after(ClosePart, NativeLowering)
        passes.finalize()
        return [passes]


class KeptKernel(CPUDispatcher):
    """What Python calls: compiled as a whole and kept on disk, by one process while others wait for it."""

    def compile(self, sig: Any) -> Any:
        """The code for arguments of given types, from disk where it is there."""
        with _alone(self):
            return super().compile(sig)


@contextmanager
def _alone(kernel: Any) -> Iterator[None]:
    """Until it is left, other processes that want the same kernel's code wait, but not for ever.

    Where there are no locks, or no place for them, nobody waits.
    """
    index = getattr(getattr(kernel._cache, "_cache_file", None), "_index_path", None)
    if fcntl is None or index is None:
        yield
        return
    try:
        lock = open(f"{index}.lock", "ab")
    except OSError:
        yield
        return
    with lock:
        end = time.monotonic() + _PATIENCE
        while not _locked(lock) and time.monotonic() < end:
            time.sleep(_PAUSE)
        try:
            yield
        finally:
            with suppress(OSError):  # for forked processes too, which hold the file open
                fcntl.flock(lock, fcntl.LOCK_UN)


def _locked(lock: IO[bytes]) -> bool:
    """Whether it is this process's now, or nobody's as this file system has no locks."""
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True


class Kernel(CPUDispatcher):
    """A part to kernels that call it, and compiled by itself where Python does.

    Parameters
    ----------
    function : callable
    options : dict
        Of numba's `njit`.
    keep : callable
        Called with what Python calls, once there is one: sees to its code on disk.
    """

    def __init__(self, function: Callable[..., Any], options: dict[str, Any],
                 keep: Callable[[Any], None]) -> None:
        options = {"nopython": True, "boundscheck": None, **options}
        super().__init__(py_func=function, locals={}, targetoptions=options, pipeline_class=PartCompiler)
        self._options, self._keep = options, keep

    def add_overload(self, cres: Any) -> None:
        """Keep a part for kernels; Python cannot call it."""
        self.overloads[tuple(cres.signature.args)] = cres

    @cached_property
    def entry(self) -> Any:
        """What Python calls."""
        made = KeptKernel(py_func=self.py_func, locals={}, targetoptions=self._options)
        made.enable_caching()
        self._keep(made)
        return made

    def __call__(self, *args: Any, **named: Any) -> Any:
        """Call it from Python."""
        return self.entry(*args, **named)

    @property
    def stats(self) -> Any:
        """How often code for what Python calls was found on disk."""
        return self.entry.stats


def can_build_in() -> bool:
    """Whether this release of numba has what building kernels in stands on."""
    return (all(hasattr(JITCodeLibrary, step) for step in _STEPS)
            and all(hasattr(Flags, flag) for flag in _FLAGS))
