"""Where this checkout lies."""

from __future__ import annotations

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PYTHONPATH = os.pathsep.join(str(ROOT / root) for root in ("", "solver", "meshes"))
"""For programs that tests start: this checkout's packages, also where another copy is installed."""
