"""`toolaxis inspect`: the faces of a part."""

from argparse import Namespace
from collections.abc import Callable
from dataclasses import asdict
from math import degrees
from typing import Any

from toolaxis.cad.load import load
from toolaxis.cli.output import print_json, print_table, say
from toolaxis.job.output.inspect import FaceSummary, survey
from toolaxis.report.tables import number, table
from toolaxis.shape.part import Part
from toolaxis.shape.seams import GREATEST, Seam
from toolaxis.skin.find import find_skins

_COLUMNS = (("face", "right"), ("kind", "left"), ("area mm²", "right"), ("size mm (x y z)", "right"),
            ("least radius mm\nconvex", "right"), ("least radius mm\nconcave", "right"),
            ("normals ±°", "right"), ("notes", "left"))
_SEAM_COLUMNS = (("faces", "left"), ("edge", "left"), ("gap mm", "right"), ("step mm", "right"),
                 ("near mm (x y z)", "right"), ("notes", "left"))
_SKIN_COLUMNS = (("skin", "right"), ("faces", "left"), ("area mm²", "right"))
#: Seams that the table lists; the JSON document has all of them.
_SEAMS = 10


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Print the faces of a part.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop.
    """
    part = load(given.part)
    found = survey(part)
    for warning in part.warnings:
        say(f"toolaxis: warning: {warning}")
    if given.json:
        print_json(_document(part, found))
    else:
        title = f"{given.part}: {len(found)} faces, {len(part.sculptured)} sculptured, file in {part.unit}"
        print_table(table(title, _COLUMNS, [_row(face) for face in found],
                          "* planes, cylinders and cones are not sculptured"))
        skins = find_skins(part)
        if skins.joined:
            rows = [_skin_row(part, k, one) for k, one in enumerate(skins.joined, 1)]
            print_table(table(f"skins: {len(rows)}", _SKIN_COLUMNS, rows, "; ".join(skins.reasons)))
        if part.seams:
            print_table(table(f"faces that do not meet: {len(part.seams)} pairs, the widest gaps first", _SEAM_COLUMNS,
                              [_seam_row(seam) for seam in part.seams[:_SEAMS]],
                              f"steps up to {GREATEST:g} mm are not counted as gouge"))
    return 0


def _skin_row(part: Part, number_: int, faces: tuple[int, ...]) -> list[str]:
    return [str(number_), "+".join(map(str, faces)), number(sum(part.face(n).area for n in faces), 2)]


def _document(part: Part, found: tuple[FaceSummary, ...]) -> dict[str, Any]:
    return {"schema": "toolaxis.inspect", "version": 1, "source": part.source, "sha256": part.sha256,
            "unit": part.unit, "units": {"length": "mm", "angle": "rad"}, "warnings": list(part.warnings),
            "diagonal": part.diagonal, "faces": [asdict(face) for face in found],
            "skins": [list(one) for one in find_skins(part).joined],
            "seams": [seam.document for seam in part.seams]}


def _seam_row(seam: Seam) -> list[str]:
    return [f"{seam.faces[0]} and {seam.faces[1]}", "smooth" if seam.kind == "tangent" else seam.kind,
            number(seam.gap, 4), number(seam.step, 4), " ".join(f"{x:.2f}" for x in seam.point),
            "counts as gouge" if seam.counted else ""]


def _row(face: FaceSummary) -> list[str]:
    notes = [f"{face.holes} hole{'s' * (face.holes > 1)}"] if face.holes else []
    notes += [f"{face.pieces} smooth pieces"] if face.pieces > 1 else []
    notes += [f"within {face.tolerance:.1g} mm"] if face.tolerance > 0 else []
    return [str(face.number), face.kind + ("" if face.sculptured else " *"), number(face.area, 2),
            " x ".join(number(side, 2) for side in face.size), number(face.convex_radius, 2),
            number(face.concave_radius, 2), number(degrees(face.spread), 1), ", ".join(notes)]
