"""The files that come with toolaxis and can be given by name."""

import os
import sys
from pathlib import Path


def find_files(kind: str, *suffixes: str) -> dict[str, Path]:
    """Files of one kind by name: from resources of a clone or of an installed wheel.

    Parameters
    ----------
    kind : str
        Name of the folder: "tools", "racks" or "machines".
    *suffixes : str
        Endings that count, such as ".toml".

    Returns
    -------
    dict of str to Path
        A folder of one's own, in the environment variable TOOLAXIS_TOOLS, TOOLAXIS_RACKS or
        TOOLAXIS_MACHINES, comes first.
    """
    own = os.environ.get(f"TOOLAXIS_{kind.upper()}")
    folders = [Path(own)] if own else []
    folders += [Path(__file__).resolve().parents[2] / "resources" / kind,
                Path(sys.prefix) / "share" / "toolaxis" / kind]
    found: dict[str, Path] = {}
    for folder in folders:
        for path in sorted(path for suffix in suffixes for path in folder.glob(f"*{suffix}")):
            found.setdefault(path.stem, path)
    return found
