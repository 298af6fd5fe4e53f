"""All dialects by name."""

from toolaxis.errors import InvalidInput
from toolaxis.post.dialects.fanuc import Fanuc, Iso
from toolaxis.post.dialects.haas import HaasOffset, HaasPlane
from toolaxis.post.dialects.heidenhain import Heidenhain
from toolaxis.post.dialects.linuxcnc import LinuxCnc, LinuxCncPlane
from toolaxis.post.dialects.siemens import Siemens
from toolaxis.post.program import Dialect

#: What the command takes besides the dialects of programs: CL files, which need no machine.
APT = "apt"
DIALECTS: dict[str, Dialect] = {dialect.name: dialect for dialect in (
    Fanuc(), HaasPlane(), HaasOffset(), Siemens(), Heidenhain(), LinuxCncPlane(), LinuxCnc(), Iso())}


def dialect_named(name: str) -> Dialect:
    """The dialect with a name.

    Parameters
    ----------
    name : str

    Raises
    ------
    InvalidInput
        When there is none.
    """
    if name not in DIALECTS:
        raise InvalidInput(f"dialect {name!r} is not known: use {', '.join([*DIALECTS, APT])}")
    return DIALECTS[name]
