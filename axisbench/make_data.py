"""Make the data of the benchmark from code and seeds: the same bytes every time."""

import json
from importlib.util import find_spec
from pathlib import Path

from axisbench.faces import FaceData, build_faces
from axisbench.problem import DATA


def write_faces(folder: Path) -> list[Path]:
    """Write the control points of every face; the files.

    Parameters
    ----------
    folder : Path
        Made where it is not there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    return [_write_face(folder / f"{name}.json", one) for name, one in build_faces().items()]


def _write_face(path: Path, face: FaceData) -> Path:
    path.write_text(json.dumps(face.document(), separators=(",", ":")) + "\n", encoding="utf-8")
    return path


def write_parts(folder: Path) -> list[Path]:
    """Write every part as STEP; the files, none where CadQuery is not installed.

    Parameters
    ----------
    folder : Path
        Made where it is not there.
    """
    if find_spec("cadquery") is None:
        return []
    from axisbench.parts import PARTS, write_part

    folder.mkdir(parents=True, exist_ok=True)
    return [write_part(name, build(), folder) for name, build in PARTS.items()]


def rebuild(folder: Path = DATA) -> int:
    """Write all data and say what was written; how many files there are.

    Parameters
    ----------
    folder : Path
        The benchmark's own unless given.
    """
    faces, parts = write_faces(folder / "faces"), write_parts(folder / "parts")
    print(f"{len(faces)} faces and {len(parts)} parts written to {folder}")
    if not parts:
        print("parts are as they came: install CadQuery (pip install cadquery) to make them anew")
    return len(faces) + len(parts)
