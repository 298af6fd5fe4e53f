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
    return {"point": blades.point.tolist(), "axis": blades.axis.tolist(), "hub": list(blades.hub),
            "blades": [{"faces": {name: list(faces) for name, faces in one.faces.items()}, "area": one.area,
                        "left": one.left} for one in blades.blades],
            "gap": {"distance": blades.gap.distance, "places": np.asarray(blades.gap.places, dtype=float).tolist()},
            "copies": [{"operation": copy, "of": source} for copy, source in sorted(blades.copies.items())],
            "searched": list(blades.searched),
            "clearances": [{"to": room.to, "component": room.component, "distance": float(room.distance),
                            "operation": room.operation, "face": room.face} for room in blades.room]}


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
    blades = tuple(PlannedBlade({name: tuple(faces) for name, faces in one["faces"].items()}, one["area"], one["left"])
                   for one in document["blades"])
    gap = Gap(document["gap"]["distance"], np.array(document["gap"]["places"], dtype=float))
    return Blades(np.array(document["point"], dtype=float), np.array(document["axis"], dtype=float),
                  tuple(document["hub"]), blades, gap,
                  {pair["operation"]: pair["of"] for pair in document["copies"]}, tuple(document["searched"]),
                  tuple(BladeClearance(**room) for room in document["clearances"])).checked(operations)
