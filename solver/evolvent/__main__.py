"""The program `evolvent`, also `python -m evolvent`: the command line, which may be interrupted from its start on."""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from types import FrameType


def main() -> int:
    """Runs the command line and returns the exit status."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _interrupted)
    from evolvent.commands.app import main as command_line

    status = command_line()
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing is left to be kept
    return status


def _interrupted(number: int, frame: FrameType | None) -> None:
    """Ends a process that has not begun, with one line. Libraries that are being imported would turn an exception into
    another one, or into a traceback."""
    with suppress(OSError):  # nobody reads it
        os.write(2, b"evolvent: stopped by SIGINT before it began\n")
    os._exit(128 + number)


if __name__ == "__main__":
    sys.exit(main())
