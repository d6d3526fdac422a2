"""Where this checkout lies."""

from __future__ import annotations

from evidence.checkout import ROOT as ROOT
from evidence.checkout import python_path

PYTHONPATH = python_path()
"""For programs that tests start: this checkout's packages, also where another copy is installed."""
