"""The judge's maps beside its verdict: verdict-maps.npz, each operation seen along its axis."""

from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from toolaxis.errors import InvalidInput
from toolaxis.plan.plan import Plan
from toolaxis.verify.axis_view import RestMaterialView, view_along
from toolaxis.verify.verdict import Verdict

NAME = "verdict-maps.npz"
#: Cells of all operations together.
_MOST, _FEWEST = 4_000_000, 10_000


def write_views(plan: Plan, verdict: Verdict, folder: Path) -> None:
    """Write the scallop and gouge maps of every operation that was judged.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    folder : Path
    """
    frames = {op.name: op.frame for op in plan.operations}
    most = max(_MOST // max(len(verdict.operations), 1), _FEWEST)
    arrays: dict[str, Any] = {}
    for found in verdict.operations:
        if not found.maps:
            continue
        frame = frames[found.name]
        assert frame is not None
        view = view_along(found.maps[:len(found.faces)], frame.x, frame.y, frame.origin, min(most, 90_000))
        arrays[f"{found.name}.where"] = np.array([*view.corner, view.cell])
        arrays[f"{found.name}.scallop"], arrays[f"{found.name}.gouge"] = view.scallop, view.gouge
    with (folder / NAME).open("wb") as file:
        np.savez_compressed(file, **arrays)


def read_views(folder: Path) -> dict[str, RestMaterialView]:
    """The maps that `write_views` wrote, by the names of operations; empty where there are none.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    InvalidInput
        When the file is damaged.
    """
    path = folder / NAME
    if not path.is_file():
        return {}
    try:
        with np.load(BytesIO(path.read_bytes()), allow_pickle=False) as held:
            names = [key.removesuffix(".where") for key in held.files if key.endswith(".where")]
            return {name: _view(held[f"{name}.where"], held[f"{name}.scallop"], held[f"{name}.gouge"])
                    for name in names}
    except (OSError, EOFError, ValueError, KeyError, BadZipFile) as reason:
        raise InvalidInput(f"{path} is damaged ({reason}): run toolaxis verify again") from reason


def _view(where: np.ndarray, scallop: np.ndarray, gouge: np.ndarray) -> RestMaterialView:
    if where.shape != (3,) or scallop.ndim != 2 or scallop.shape != gouge.shape or not scallop.size:
        raise ValueError(f"shapes {where.shape}, {scallop.shape} and {gouge.shape} are no map")
    return RestMaterialView(np.array(where[:2], dtype=float), float(where[2]), scallop.astype(np.float32),
                            gouge.astype(np.float32))
