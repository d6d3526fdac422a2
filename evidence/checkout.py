"""The folders of this checkout."""

from __future__ import annotations

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DEMOS = ROOT / "demos"
DOCS = ROOT / "docs"


def python_path(root: Path = ROOT) -> str:
    """PYTHONPATH of a checkout's packages, for programs that are started: also where another copy is installed."""
    return os.pathsep.join(str(root / folder) for folder in ("", "solver", "meshes"))
