"""Compiling hot kernels with numba where it is installed and works.

Many kernels stand beside a plain numpy twin, which is their oracle in tests and what runs where numba is missing or
broken; of others the source runs then.  One notice is given.
"""

import functools
import hashlib
import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numpy

_Function = TypeVar("_Function", bound=Callable[..., Any])


def _load() -> Any:
    if os.environ.get("TOOLAXIS_NUMBA", "1") == "0":
        return None
    try:
        import numba
    except Exception as reason:  # numba raises ImportError, SystemError or AttributeError on a numpy it does not know
        warnings.warn(f"numba cannot be used ({reason}): slower numpy code runs instead", RuntimeWarning, stacklevel=2)
        return None
    return numba


_numba = _load()
available: bool = _numba is not None


def jit(function: _Function) -> _Function:
    """Compile a kernel, or hand it back unchanged where numba cannot be used.

    Compiled code is kept on disk, releases the interpreter lock and divides as IEEE 754 does.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    return _compile(function, False)


def jit_fma(function: _Function) -> _Function:
    """Compile a kernel as `jit` does, with a * b + c rounded once where the processor can.

    For long sums of products; not where a difference of products must vanish exactly.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    return _compile(function, {"contract"})


def jit_fma_inline(function: _Function) -> _Function:
    """Compile a small kernel as `jit_fma` does, and build it into the code of whatever calls it.

    Calls that are left cost a reference count for each array that is passed, more than a short sum of products.
    Python that calls it runs the source.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    return _compile(function, {"contract"}, inline=True)


def jit_inline(function: _Function) -> _Function:
    """Compile a small kernel as `jit` does, and build it into the code of whatever calls it.

    The results are those of `jit` to the last bit; see `jit_fma_inline` for why it is worth it.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    return _compile(function, False, inline=True)


def jit_uncounted(function: _Function) -> _Function:
    """Compile a kernel as `jit_fma` does, without counting references to arrays.

    Counting costs more than a short sum of products, in time to run and to compile.  The kernel must make no arrays,
    which numba refuses, and its arrays must be held by the Python code that calls it; one that returns arrays may be
    called by uncounted kernels only.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    return _compile(function, {"contract"}, counted=False)


def jit_uncounted_inline(function: _Function) -> _Function:
    """Compile a small kernel as `jit_uncounted` does, and build it into the code of whatever calls it.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    return _compile(function, {"contract"}, inline=True, counted=False)


def jit_unfused(function: _Function) -> _Function:
    """Compile a kernel as `jit` does, without counting references to arrays, as `jit_uncounted` says it.

    The results are those of `jit` to the last bit.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    return _compile(function, False, counted=False)


def jit_unfused_inline(function: _Function) -> _Function:
    """Compile a small kernel as `jit_unfused` does, and build it into the code of whatever calls it.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    return _compile(function, False, inline=True, counted=False)


def _kernel_class() -> Any:
    """The class of kernels that are built into one another, or None where this numba has no place for it."""
    try:
        from toolaxis.numeric.kernel import Kernel, can_build_in
    except (ImportError, AttributeError):
        return None
    return Kernel if can_build_in() else None


def _compile(function: _Function, fastmath: bool | set[str], *, inline: bool = False,
             counted: bool = True) -> _Function:
    if _numba is None or _numba.config.DISABLE_JIT:
        return function
    kind = _kernel_class()
    options = {"nogil": True, "error_model": "numpy", "fastmath": fastmath, "forceinline": inline}
    if kind is not None and not counted:  # by itself one that returns arrays needs them counted
        options["_nrt"] = False
    own, stamp = _digest_of(function.__code__.co_filename), _stamp_of(function, repr(options))
    keep = functools.partial(_stamp, stamp if own else None)
    if kind is not None:
        kernel = kind(function, options, keep)
    else:
        kernel = _numba.njit(cache=True, **options)(function)
        keep(kernel)
    kernel.source_stamp = stamp
    result: _Function = kernel
    return result


def _stamp_of(function: Callable[..., Any], options: str) -> str:
    """What code kept on disk depends on: the text of every kernel it calls, and the constants it was given.

    numba compares the file of the kernel itself only, although the kernels it calls and the numbers that its module
    imports are built into it; older releases compare when the file was written, which says nothing in a fresh clone.
    """
    called, constants = set(), []
    for name, value in function.__globals__.items():
        if hasattr(value, "py_func") and hasattr(value, "source_stamp"):
            called.add(value.source_stamp)
        elif type(value) in (bool, int, float, str, tuple) and not name.startswith("__"):
            constants.append((name, repr(value)))
        elif isinstance(value, type) and hasattr(value, "_fields"):
            constants.append((name, repr(value._fields)))
    own = _digest_of(function.__code__.co_filename) or function.__code__.co_code.hex()
    told = (own, options, numpy.__version__, sorted(called), sorted(constants))
    return hashlib.sha256(repr(told).encode()).hexdigest()


def _stamp(stamp: str | None, kernel: Any) -> None:
    """Let a kernel's code on disk expire with what it depends on; without a stamp numba's own rules stay."""
    store: Any = getattr(getattr(kernel, "_cache", None), "_cache_file", None)
    if stamp is not None and store is not None:
        store._source_stamp = stamp
        _check(store, stamp)


@functools.cache
def _digest_of(file: str) -> str | None:
    """The digest of what a file says, or None where there is no file, as in a notebook."""
    try:
        return hashlib.sha256(Path(file).read_bytes()).hexdigest()
    except OSError:
        return None


def _check(store: Any, stamp: str) -> None:
    """Let code kept on disk say for which arguments it is, and take none for others.

    numba names the file in a list that it writes before the file.  Two processes that compile a kernel for different
    arguments at the same time may choose the same file, and the code for the one is called with the other's arguments.
    Nor does it compare the names of a named tuple's fields: code kept from before two of them changed places reads the
    one for the other.  And a list of code for arguments of a class that is gone, kept by an earlier version, cannot be
    read at all; it is begun anew.
    """
    save, load, read = store.save, store.load, store._load_index

    def listed() -> Any:
        try:
            return read()
        except Exception:  # what reading a pickle may raise is anything
            return {}

    def marked(key: Any, code: Any) -> None:
        save(key, (stamp, _fields_in(key[0]), key, code))

    def checked(key: Any) -> Any:
        try:
            found = load(key)
        except Exception:
            return None
        fits = isinstance(found, tuple) and found[:3] == (stamp, _fields_in(key[0]), key)
        return found[3] if fits else None

    store.save, store.load, store._load_index = marked, checked, listed


def _fields_in(types: Any) -> tuple[Any, ...]:
    """The names of the fields of all named tuples among the types of arguments."""
    fields = getattr(types, "fields", ())
    within = types if isinstance(types, tuple) else getattr(types, "types", ())
    return (fields, *(_fields_in(one) for one in within))


def is_kept(kernel: Any) -> bool:
    """Whether there is code of a kernel on disk, for whatever arguments; true where nothing is ever compiled.

    Parameters
    ----------
    kernel : callable
        Of `jit`.
    """
    store: Any = getattr(getattr(getattr(kernel, "entry", kernel), "_cache", None), "_cache_file", None)
    return store is None or bool(store._load_index())


def compilations() -> Callable[[], int]:
    """Begin to count the kernels that have to be compiled as there is no code for them on disk yet.

    Returns
    -------
    callable
        How many were, since; 0 for ever where numba cannot be used.
    """
    if _numba is None:
        return lambda: 0
    from numba.core import event

    class _Count(event.Listener):
        seen = 0

        def on_start(self, event: Any) -> None:
            self.seen += 1

        def on_end(self, event: Any) -> None:
            pass

    count = _Count()
    event.register("numba:compile", count)  # type: ignore[no-untyped-call]
    return lambda: count.seen


def _borrowed() -> Any:
    if _numba is None:
        return lambda array: array
    from numba.core import cgutils
    from numba.extending import intrinsic

    null: Any = cgutils.get_null_value

    @intrinsic
    def borrow(context: Any, array: Any) -> Any:
        """The array without its owner."""
        def generate(target: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            view = target.make_array(signature.args[0])(target, builder, value=arguments[0])
            view.meminfo = null(view.meminfo.type)
            view.parent = null(view.parent.type)
            return view._getvalue()

        return array(array), generate

    return borrow


borrowed = _borrowed()
"""Inside kernels: a view of an array that nobody counts.  Handing an array to a built-in kernel costs an atomic count,
up and down; handing on a borrowed one costs nothing.  The array must outlive the view: borrow only what the caller
holds, since an array made in the kernel is freed after its own last use, whatever its views do."""


def _compile_lanes() -> tuple[Callable[..., Any], ...]:
    """What `toolaxis.numeric.lanes` tells of, as parts of compiled code."""
    if _numba is None or _numba.config.DISABLE_JIT:
        return ()
    from llvmlite import ir
    from numba.core import cgutils, types
    from numba.extending import intrinsic, models, register_model

    class LanesType(types.Type):
        pass

    pointer: Any = cgutils.get_item_pointer
    kind, four, index = LanesType("Lanes"), ir.VectorType(ir.DoubleType(), 4), ir.IntType(32)
    register_model(LanesType)(functools.partial(models.PrimitiveModel, be_type=four))

    def spread(builder: Any, number: Any) -> Any:
        undefined = ir.Constant(four, ir.Undefined)
        first = builder.insert_element(undefined, number, index(0))
        return builder.shuffle_vector(first, undefined, ir.Constant(ir.VectorType(index, 4), [0] * 4))

    @intrinsic
    def no_lanes(context: Any) -> Any:
        def generate(target: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return ir.Constant(four, [0.0] * 4)

        return kind(), generate

    @intrinsic
    def load_lanes(context: Any, table: Any, i: Any, j: Any) -> Any:
        def generate(target: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            array = target.make_array(table)(target, builder, value=arguments[0])
            places = [[*arguments[1:], target.get_constant(types.intp, k)] for k in range(4)]
            each = [pointer(target, builder, table, array, place, wraparound=False) for place in places]
            if table.layout == "C":
                return builder.load(builder.bitcast(each[0], four.as_pointer()), align=8)
            lanes = ir.Constant(four, ir.Undefined)
            for k in range(4):
                lanes = builder.insert_element(lanes, builder.load(each[k]), index(k))
            return lanes

        return kind(table, types.intp, types.intp), generate

    @intrinsic
    def add_scaled(context: Any, total: Any, share: Any, lanes: Any) -> Any:
        def generate(target: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            total, share, lanes = arguments
            product = builder.fmul(spread(builder, share), lanes, flags=("contract",))
            return builder.fadd(total, product, flags=("contract",))

        return kind(kind, types.float64, kind), generate

    @intrinsic
    def scale(context: Any, share: Any, lanes: Any) -> Any:
        def generate(target: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return builder.fmul(spread(builder, arguments[0]), arguments[1])

        return kind(types.float64, kind), generate

    @intrinsic
    def shrink(context: Any, share: Any, lanes: Any) -> Any:
        def generate(target: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return builder.fdiv(arguments[1], spread(builder, arguments[0]))

        return kind(types.float64, kind), generate

    @intrinsic
    def lane(context: Any, lanes: Any, k: Any) -> Any:
        def generate(target: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return builder.extract_element(arguments[0], arguments[1])

        return types.float64(kind, types.intp), generate

    return no_lanes, load_lanes, add_scaled, scale, shrink, lane


lane_parts = _compile_lanes()
"""The functions of `toolaxis.numeric.lanes` for kernels; none where the source runs."""
