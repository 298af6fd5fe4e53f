"""The files that come with toolaxis and can be given by name."""

import os
import sys
from pathlib import Path


def find_files(kind: str, *suffixes: str) -> dict[str, Path]:
    """Files of one kind by name: from resources of a clone or of an installed wheel.

    Parameters
    ----------
    kind : str
        Name of the folder: "tools", "racks", "machines" or "examples".
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
    folders += [folder / kind for folder in _folders(Path(__file__).resolve().parent)]
    found: dict[str, Path] = {}
    for folder in folders:
        for path in sorted(path for suffix in suffixes for path in folder.glob(f"*{suffix}")):
            found.setdefault(path.stem, path)
    return found


def _folders(package: Path) -> list[Path]:
    """Where the folders of a package's files may stand: in its clone, or where pip puts them.

    pip puts them below the prefix of Python, of the user (``--user``) or of a folder (``--target``): the package is one
    to four folders below each.
    """
    clone, prefix = package.parents[1], Path(sys.prefix)
    if (clone / "resources").is_dir():
        return [clone / "resources", clone, prefix / "share" / "toolaxis"]
    return [above / "share" / "toolaxis" for above in [*package.parents[:4], prefix]]
