"""The command as a process: Ctrl-C is answered in one line from the first moment that Python leaves to a program."""

import os
import signal
import sys
from types import FrameType
from typing import NoReturn


def command() -> NoReturn:
    """Run the command as a process and leave with its exit code.

    Until the work begins Ctrl-C ends the process at once, as there is nothing to clear up; once it is done there is
    nothing left to stop.
    """
    signal.signal(signal.SIGINT, _leave)
    from toolaxis.cli.main import main

    code = main()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.exit(code)


def _leave(number: int, frame: FrameType | None) -> NoReturn:
    os.write(2, b"toolaxis: interrupted\n")
    os._exit(130)


if __name__ == "__main__":
    command()
