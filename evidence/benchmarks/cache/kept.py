"""`python -m evidence.benchmarks.cache.kept [--small]`: gears condensed with an empty cache and with a filled one, for
docs/cache.md. Each is a process of its own, one rank.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from evidence.benchmarks.gears.checkouts import Checkout
from evidence.benchmarks.measuring import keep_rows
from evidence.checkout import ROOT
from evidence.scenes import HELICAL, PLAIN, SPUR
from evidence.tables import Column, Table

PREPARED = """
import sys, time
from mpi4py import MPI
from evolvent.gears.gear_model import prepare_model
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import load_scene
problem = gear_problem(load_scene(sys.argv[1], sys.argv[2:]))
begin = time.perf_counter()
prepare_model(problem, MPI.COMM_SELF)
print(time.perf_counter() - begin)
"""
CASES = (
    ("He, plane, standard", SPUR, ()),
    ("Yang, quick", HELICAL, ("mesh.level=quick",)),
    ("Yang, standard", HELICAL, ()),
)


@dataclass(frozen=True)
class KeptRow:
    """Meshing and condensing both gears of a pair."""

    pair: str
    empty_seconds: float
    """Wall time with an empty cache, forms compiled before."""
    filled_seconds: float
    """Wall time with a filled cache."""
    megabytes: float
    """Size of what is kept."""


TABLE = Table(KeptRow, (
    Column("pair", "pair", words=True), Column("empty cache [s]", "empty_seconds", ".3g"),
    Column("filled cache [s]", "filled_seconds", ".2g"), Column("kept [MB]", "megabytes", ".0f"),
))


def kept_row(name: str, scene: Path, settings: tuple[str, ...]) -> KeptRow:
    """The row of a pair."""
    with tempfile.TemporaryDirectory() as folder:
        own = Checkout.this(Path(folder))
        for small in (SPUR, HELICAL):  # compiles the forms
            _seconds(folder, small, "mesh.level=quick", "mesh.elements_per_contact_width=0.5")
        own.forget_gears()
        empty, filled = (_seconds(folder, scene, *settings) for _ in range(2))
        return KeptRow(name, empty, filled, 1e-6 * sum(path.stat().st_size for path in own.condensed.iterdir()))


def _seconds(folder: str, scene: Path, *settings: str) -> float:
    """Wall time of preparing the gears of a scene in a new process with this cache folder [s]."""
    environment = {**os.environ, "XDG_CACHE_HOME": folder, "EVOLVENT_CACHE_GB": "10", "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-c", PREPARED, str(scene), *PLAIN, *settings]
    done = subprocess.run(command, env=environment, cwd=ROOT, capture_output=True, text=True, check=True)
    return float(done.stdout)


def said(docs: Path) -> str:
    """The table of docs/cache.md."""
    return TABLE.markdown(TABLE.read(docs / "cache" / "kept.csv"))


def _rows(few: bool) -> Iterator[KeptRow]:
    for each in CASES[: 1 if few else None]:
        yield kept_row(*each)


def main() -> None:
    """Measures all pairs."""
    keep_rows(__doc__, "the first pair alone, to see that everything works", "kept", _rows, "cache")


if __name__ == "__main__":
    main()
