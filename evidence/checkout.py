"""Where this checkout lies."""

from __future__ import annotations

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DEMOS = ROOT / "demos"
DOCS = ROOT / "docs"
PYTHONPATH = os.pathsep.join(str(ROOT / root) for root in ("", "solver", "meshes"))
"""For programs that are started: this checkout's packages, also where another copy is installed."""
