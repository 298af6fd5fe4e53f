"""Blades of a plan as a JSON document, and back."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from toolaxis.plan.blades import BladeClearance, Blades, Gap, PlannedBlade

Document = dict[str, Any]


def blades_document(blades: Blades | None) -> Document | None:
    """Blades as numbers, mm and mm^2; None where the plan has none.

    Parameters
    ----------
    blades : Blades or None
    """
    if blades is None:
        return None
    return {
        "point": blades.point.tolist(),
        "axis": blades.axis.tolist(),
        "hub": list(blades.hub),
        "blades": [_blade_document(blade) for blade in blades.blades],
        "gap": _gap_document(blades.gap),
        "copies": [{"operation": copy, "of": source} for copy, source in sorted(blades.copies.items())],
        "searched": list(blades.searched),
        "clearances": [_clearance_document(clearance) for clearance in blades.room],
    }


def _blade_document(blade: PlannedBlade) -> Document:
    faces = {name: list(numbers) for name, numbers in blade.faces.items()}
    return {"faces": faces, "area": blade.area, "left": blade.left}


def _gap_document(gap: Gap) -> Document:
    places = np.asarray(gap.places, dtype=float)
    return {"distance": gap.distance, "places": places.tolist()}


def _clearance_document(clearance: BladeClearance) -> Document:
    return {
        "to": clearance.to,
        "component": clearance.component,
        "distance": float(clearance.distance),
        "operation": clearance.operation,
        "face": clearance.face,
    }


def blades_from(document: Mapping[str, Any] | None, operations: int) -> Blades | None:
    """The blades that `blades_document` wrote.

    Parameters
    ----------
    document : mapping or None
    operations : int
        How many the plan has.

    Raises
    ------
    InvalidInput
        When an operation is named that the plan does not have.
    """
    if document is None:
        return None
    point = np.array(document["point"], dtype=float)
    axis = np.array(document["axis"], dtype=float)
    hub = tuple(document["hub"])
    planned = tuple(_blade_from(one) for one in document["blades"])
    gap = Gap(document["gap"]["distance"], np.array(document["gap"]["places"], dtype=float))
    copies = {pair["operation"]: pair["of"] for pair in document["copies"]}
    searched = tuple(document["searched"])
    clearances = tuple(BladeClearance(**one) for one in document["clearances"])
    blades = Blades(point, axis, hub, planned, gap, copies, searched, clearances)
    return blades.checked(operations)


def _blade_from(document: Mapping[str, Any]) -> PlannedBlade:
    faces = {name: tuple(numbers) for name, numbers in document["faces"].items()}
    return PlannedBlade(faces, document["area"], document["left"])
