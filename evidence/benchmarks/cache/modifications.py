"""`python -m evidence.benchmarks.cache.modifications [--small]`: gears condensed without their modifications, which are
in the gap, beside gears condensed on meshes that have them, for docs/cache.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evidence.benchmarks.line.pairs import FINE, Case, case, relieved
from evidence.benchmarks.measuring import keep_rows
from evidence.scenes import HELICAL, SPUR
from evidence.tables import Column, Table
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.line.line_start import with_line_starts
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult

POSITIONS = 8
ONE_MESH = 'exact.parts=["two-level"]'
"""Setting of pairs in space that would have levels, which are never condensed with modifications."""
QUICK = "mesh.level=quick", ONE_MESH


@dataclass(frozen=True)
class ModificationsRow:
    """Deviations of gears condensed without modifications from those condensed with them, at 8 positions, μ = 0."""

    pair: str
    mean_um: float
    """Mean transmission error."""
    position_percent: float
    """Largest deviation of a position's transmission error, of the mean."""
    peak_to_peak_um: float
    """Peak-to-peak transmission error."""
    peak_to_peak_off_nm: float
    stiffness_percent: float
    """Largest deviation of a position's tangent stiffness."""
    pressure_percent: float
    """Largest deviation of a position's largest nodal pressure."""


TABLE = Table(ModificationsRow, (
    Column("pair", "pair", words=True), Column("mean transmission error [µm]", "mean_um", ".3g"),
    Column("off at a position [%]", "position_percent", ".3f"), Column("peak to peak [µm]", "peak_to_peak_um", ".3g"),
    Column("off by [nm]", "peak_to_peak_off_nm", ".1f"), Column("stiffness [%]", "stiffness_percent", ".3f"),
    Column("largest nodal pressure [%]", "pressure_percent", ".2f"),
))


def cases() -> Iterator[Case]:
    """Pairs with reliefs and crowning, in the plane and in space, on one mesh a sector."""
    whole = (100.0,)
    yield case("He, plane, quick, 20 µm", SPUR, whole, *relieved(20.0), "mesh.level=quick")
    yield case("He, plane, standard, 40 µm linear", SPUR, whole, *relieved(40.0, "linear"))
    yield case("He, plane, fine, 80 µm", SPUR, whole, *relieved(80.0), *FINE)
    yield case("He in space, quick, 20 µm, crowned 15 µm", SPUR, whole, *relieved(20.0), "pinion.lead_crowning_um=15",
               *QUICK)
    yield case("Yang, quick, 60 µm, crowned 10 µm", HELICAL, whole, *relieved(60.0), "pinion.lead_crowning_um=10",
               *QUICK)


def modifications_row(pair: Case) -> ModificationsRow:
    """The row of a pair."""
    found, wanted = ([*map(_figures, _pitch(pair, as_meshed))] for as_meshed in (False, True))
    own, other = np.array(found).T, np.array(wanted).T
    off = np.abs(own / other - 1.0).max(axis=1)
    mean = float(other[0].mean())
    return ModificationsRow(
        pair.name, 1e3 * mean, 100.0 * float(np.abs(own[0] - other[0]).max()) / mean, 1e3 * float(np.ptp(other[0])),
        1e6 * float(np.ptp(own[0]) - np.ptp(other[0])), 100.0 * float(off[1]), 100.0 * float(off[2]),
    )


def _pitch(pair: Case, as_meshed: bool) -> list[PositionResult]:
    """Positions of a pitch without friction."""
    model = with_line_starts(prepare_model(pair.problem, MPI.COMM_SELF, as_meshed=as_meshed).model)
    pitch = uniform_pitch(pair.problem.pair.pinion.z, POSITIONS)
    return list(certified_pitch(model, pitch, (0.0,), MPI.COMM_SELF).by_friction[0])


def _figures(position: PositionResult) -> tuple[float, float, float]:
    """Transmission error [mm], tangent stiffness [N/mm], largest pressure [MPa]."""
    return position.transmission_error, position.stiffness, float(position.contact.pressure.max())


def said(docs: Path) -> str:
    """The table of docs/cache.md."""
    return TABLE.markdown(TABLE.read(docs / "cache" / "modifications.csv"))


def main() -> None:
    """Measures all pairs."""
    small = "the first pair alone, to see that everything works"
    rows = lambda few: map(modifications_row, [*cases()][: 1 if few else None])  # noqa: E731
    keep_rows(__doc__, small, "modifications", rows, "cache")


if __name__ == "__main__":
    main()
