"""`python -m evolvent` is the command `evolvent`."""

from __future__ import annotations

import sys

from evolvent.cli import main

if __name__ == "__main__":
    sys.exit(main())
