"""What the command prints on stdout: a table for people, or JSON for programs."""

import json
import sys
from typing import Any

from rich.console import Console
from rich.table import Table


def print_table(made: Table) -> None:
    """Print a table; as wide as it needs where the output is no terminal.

    Parameters
    ----------
    made : rich.table.Table
    """
    terminal = sys.stdout.isatty()
    Console(file=sys.stdout, width=None if terminal else 200, highlight=False).print(made)


def print_json(document: Any) -> None:
    """Print a document as strict JSON.

    Parameters
    ----------
    document : object
    """
    print(json.dumps(document, indent=1, allow_nan=False))


def say(text: str) -> None:
    """Print a message for the user on stderr.

    Parameters
    ----------
    text : str
    """
    print(text, file=sys.stderr, flush=True)
