"""Machines whose bodies are STEP files: each solid is taken as its convex hull, which holds it."""

from dataclasses import replace

import numpy as np

from toolaxis.cad.load import load
from toolaxis.collision.index_moves import hull_of
from toolaxis.errors import InvalidInput
from toolaxis.machine import library as catalogue
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.machine import Machine
from toolaxis.shape.bounding.bounding_tree import forest


def load_machine(text: str) -> Machine:
    """A machine from its name in the library, a TOML file with the STEP files of its bodies, or a .fcm file of FreeCAD.

    Parameters
    ----------
    text : str

    Raises
    ------
    InvalidInput
        When there is no such machine, its file does not describe one, or a STEP file cannot be read.
    MissingBackend
        When a body is a STEP file and no CAD library is installed.
    """
    return with_hulls(catalogue.load_machine(text))


def with_hulls(machine: Machine) -> Machine:
    """A machine with its STEP files read; as it is where it has none.

    Parameters
    ----------
    machine : Machine
        Files are in machine coordinates, all axes at zero.

    Raises
    ------
    InvalidInput
        When a file cannot be read, or holds nothing.
    """
    if not any(body.kind == "step" for body in machine.bodies):
        return machine
    return replace(machine, bodies=tuple(piece for body in machine.bodies
                                         for piece in (_hulls(body) if body.kind == "step" else (body,))))


def _hulls(body: MachineBody) -> tuple[MachineBody, ...]:
    try:
        part = load(body.file)
    except InvalidInput as reason:
        raise InvalidInput(f"body {body.name}: {reason}") from reason
    if not part.faces:
        raise InvalidInput(f"body {body.name}: {body.file} has no faces: give a file with solids")
    if part.left_out:  # The hull of the rest does not hold the body.
        raise InvalidInput(f"body {body.name}: {body.file}: {part.left_out[0]}")
    found = []
    for solid in part.bodies:
        shape = hull_of(forest([part.face(number) for number in solid.faces]))
        found.append(MachineBody(body.name, body.carried, "points", shape.centre[0], float(np.max(shape.ball))))
    return tuple(found)
