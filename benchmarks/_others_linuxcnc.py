"""LinuxCNC without a machine: its interpreter rs274, and its kinematics modules called directly.

Debian's package linuxcnc-uspace is unpacked, not installed.  A kinematics module is a library that asks LinuxCNC's
hardware layer for its parameters; `_LAYER` stands in for that layer and gives it plain memory, so that what is
calculated is LinuxCNC's own machine code.
"""

import ctypes
import os
import re
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from benchmarks._others import Array, Unavailable

#: Where the package is unpacked; TOOLAXIS_LINUXCNC names another folder that holds its `usr`.
HOME = Path(__file__).resolve().parents[1] / ".venv" / "rs274"
#: rs274 reads offsets and tools before the program has chosen its unit, in inches.
INCH = 25.4

_MOVE = re.compile(r"STRAIGHT_(TRAVERSE|FEED)\(([^)]*)\)")
_OFFSET = re.compile(r"SET_G5X_OFFSET\(\d+, ([^)]*)\)")
_LENGTH = re.compile(r"USE_TOOL_LENGTH_OFFSET\(([-\d.]+) ([-\d.]+) ([-\d.]+)")

_LAYER = r"""
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
static struct { char name[64]; void *at; } pins[64];
static int count;
static int keep(const char *name, void **at) {
    *at = pins[count].at = calloc(1, 8);
    strncpy(pins[count++].name, name, 63);
    return 0;
}
#define NAMED char name[64]; va_list rest; va_start(rest, form); vsnprintf(name, 64, form, rest); va_end(rest)
int hal_init(const char *name) { return 1; }
int hal_exit(int id) { return 0; }
int hal_ready(int id) { return 0; }
void *hal_malloc(long size) { return calloc(1, size); }
int hal_pin_bit_new(const char *name, int way, void **at, int id) { return keep(name, at); }
int hal_pin_s32_new(const char *name, int way, void **at, int id) { return keep(name, at); }
int hal_pin_float_new(const char *name, int way, void **at, int id) { return keep(name, at); }
int hal_pin_float_newf(int way, void **at, int id, const char *form, ...) { NAMED; return keep(name, at); }
void rtapi_print(const char *form, ...) {}
void rtapi_print_msg(int level, const char *form, ...) {}
double *parameter(const char *name) {
    for (int k = 0; k < count; k++) if (!strcmp(pins[k].name, name)) return pins[k].at;
    return 0;
}
"""


class LinuxCnc(NamedTuple):
    """Where LinuxCNC is.

    rs274 : str, its interpreter.
    environment : dict, what the interpreter runs in.
    modules : Path, the folder of its kinematics modules.
    """

    rs274: str
    environment: dict[str, str]
    modules: Path


def find_linuxcnc(fetch: bool = False) -> LinuxCnc:
    """LinuxCNC as it is installed or unpacked.

    Parameters
    ----------
    fetch : bool
        Whether Debian's packages are fetched and unpacked where it is not.

    Raises
    ------
    Unavailable
    """
    installed = shutil.which("rs274")
    if installed:
        return LinuxCnc(installed, dict(os.environ), Path("/usr/lib/linuxcnc/modules"))
    home = Path(os.environ.get("TOOLAXIS_LINUXCNC", HOME))
    own = home / "usr" / "bin" / "rs274"
    if not own.is_file() and fetch:
        unpack_linuxcnc(home)
    if not own.is_file():
        raise Unavailable("LinuxCNC's rs274 is not installed (make test-all fetches it where apt-get works)")
    libraries = [home / "usr" / "lib", *(home / "usr" / "lib").glob("*-linux-gnu")]
    environment = {**os.environ, "LD_LIBRARY_PATH": ":".join(map(str, libraries))}
    return LinuxCnc(str(own), environment, home / "usr" / "lib" / "linuxcnc" / "modules")


def unpack_linuxcnc(folder: Path) -> None:
    """Fetch Debian's packages with LinuxCNC and unpack them.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    Unavailable
        Where that does not work.
    """
    if not (shutil.which("apt-get") and shutil.which("dpkg")):
        raise Unavailable("there is no apt-get here")
    needs = subprocess.run(["apt-cache", "depends", "linuxcnc-uspace"], capture_output=True, text=True, check=False)
    names = re.findall(r"Depends: (libboost-python\S*|libmodbus\S*|libtirpc3\S*)", needs.stdout)
    folder.mkdir(parents=True, exist_ok=True)
    got = subprocess.run(["apt-get", "download", "linuxcnc-uspace", *names], cwd=folder, capture_output=True, text=True,
                         check=False)
    if got.returncode:
        raise Unavailable(f"apt-get does not fetch linuxcnc-uspace: {got.stderr.strip()[-200:]}")
    for package in folder.glob("*.deb"):
        subprocess.run(["dpkg", "-x", package.name, "."], cwd=folder, check=True)
        package.unlink()


def interpret(linuxcnc: LinuxCnc, text: str, folder: Path, length: float = 0.0,
              offsets: tuple[Array, ...] = ()) -> str:
    """The canonical moves that the interpreter makes of a program.

    Parameters
    ----------
    linuxcnc : LinuxCnc
    text : str
        Of the program.
    folder : Path
        For its files.
    length : float
        Of tool 1 in the tool table, mm.
    offsets : tuple of (3,) array
        Work offsets G54, G55 and so on, mm.

    Raises
    ------
    Unavailable
        Where the interpreter does not start.
    """
    (folder / "tool.tbl").write_text(f"T1 P1 Z{length / INCH:.9f} D12\n")
    (folder / "program.ngc").write_text(text)
    rows = {5161 + k: 0.0 for k in range(9)} | {5181 + k: 0.0 for k in range(9)} | {5220: 1.0}
    rows |= {5221 + 20 * k + i: float(value) / INCH for k, offset in enumerate(offsets)
             for i, value in enumerate(offset)}
    (folder / "offsets.var").write_text("".join(f"{key}\t{value:.9f}\n" for key, value in sorted(rows.items())))
    made = subprocess.run([linuxcnc.rs274, "-g", "-t", "tool.tbl", "-v", "offsets.var", "program.ngc"], cwd=folder,
                          env=linuxcnc.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=60, check=False)
    if "error while loading shared libraries" in made.stderr:
        raise Unavailable(made.stderr.strip())
    assert made.returncode == 0 and "PROGRAM_END" in made.stdout, made.stderr + made.stdout[-500:]
    return made.stdout


def joints_after_length(canon: str) -> list[Array]:
    """Joint positions X, Y, Z in mm and A, B, C in degrees, (n, 6), of every stretch that begins with G43.

    Parameters
    ----------
    canon : str
        Canonical moves: places in the work offset, without the length of the tool.
    """
    offset, length, found = np.zeros(3), np.zeros(3), list[list[Array]]()
    for line in canon.splitlines():
        shift, tool, move = _OFFSET.search(line), _LENGTH.search(line), _MOVE.search(line)
        if shift:
            offset = np.array([float(word) for word in shift[1].split(",")[:3]])
        if tool:
            length = np.array([float(tool[k]) for k in (1, 2, 3)])
            found += [[]] if length.any() else []
        if move and found:
            row = np.array([float(word) for word in move[2].split(",")])
            found[-1].append(row + np.concatenate([offset + length, np.zeros(3)]))
    return [np.array(rows) for rows in found]


class Kinematics:
    """Forward kinematics of one of LinuxCNC's modules, with the control of the tool's tip switched on."""

    def __init__(self, linuxcnc: LinuxCnc, module: str, rotary: str, **parameters: float) -> None:
        """Load the module.

        Parameters
        ----------
        linuxcnc : LinuxCnc
        module : str
            Such as "xyzac-trt-kins".
        rotary : str
            Letters of its rotary axes, in the order of its joints.
        **parameters : float
            By name, underlines for dashes, mm.
        """
        path = linuxcnc.modules / f"{module}.so"
        if not path.is_file():
            raise Unavailable(f"the package holds no {module}")
        layer = _layer()
        self._module, self._rotary = _started(path), rotary
        for name, value in parameters.items():
            at = layer.parameter(f"{module}.{name.replace('_', '-')}".encode())
            assert at, f"{module} has no parameter {name}"
            at[0] = value
        self._length = parameters.get("tool_offset", 0.0)

    def poses(self, joints: Array) -> tuple[Array, Array]:
        """Tips, mm, and tool axes on the table, (n, 3) each, at joint positions.

        The axis is where the tip goes when the Z joint alone moves up by 1 mm.

        Parameters
        ----------
        joints : (n, 6) array
            X, Y, Z in mm; A, B, C in degrees.
        """
        own = joints[:, [0, 1, 2, *("ABC".index(name) + 3 for name in self._rotary)]]
        tips = np.array([self._forward(row) for row in own])
        raised = np.array([self._forward(row) for row in own + np.array([0, 0, 1.0, 0, 0])])
        return tips - [0, 0, self._length], raised - tips

    def _forward(self, row: Array) -> Array:
        """X, Y, Z of LinuxCNC's pose; the length of the tool is still in Z, as the interpreter adds it to what a
        program says."""
        place, flags = (ctypes.c_double * 9)(), (ctypes.c_ulong * 2)()
        assert self._module.kinematicsForward((ctypes.c_double * 16)(*row), place, flags,
                                              ctypes.byref(flags, ctypes.sizeof(ctypes.c_ulong))) == 0
        return np.array(place[:3])


@cache
def _started(path: Path) -> ctypes.CDLL:
    """A module that has made its parameters, which it does once in a process."""
    module = ctypes.CDLL(str(path))
    assert module.rtapi_app_main() == 0
    return module


@cache
def _layer() -> ctypes.CDLL:
    """What stands in for the hardware layer, compiled and loaded so that modules find its functions."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if not compiler:
        raise Unavailable("there is no C compiler here")
    with tempfile.TemporaryDirectory() as folder:
        source, library = Path(folder) / "layer.c", Path(folder) / "layer.so"
        source.write_text(_LAYER)
        subprocess.run([compiler, "-shared", "-fPIC", "-w", "-o", str(library), str(source)], check=True)
        layer = ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    layer.parameter.restype = ctypes.POINTER(ctypes.c_double)
    return layer
