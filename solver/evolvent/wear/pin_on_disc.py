"""K/H and its spread from pin-on-disc records: depth over sliding distance under a constant load.

K/H = (dh/ds) A/F (Z. He, Y. Hu, X. Zheng, Y. Yu, Machines 10 (2022) 69, Eq. 3), dh/ds the slope of the straight line
that fits the record after running in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
from scipy import stats

from evolvent.scene.csv_tables import Column, TableError, read_columns, require_ascending
from evolvent_meshes.arrays import Floats

DISTANCE = Column("sliding_distance", (("mm", 1.0), ("m", 1e3), ("km", 1e6)))
DEPTH = Column("depth")
FORCES, DIAMETERS = (1e-6, 1e9), (1e-3, 1e4)
"""On a pin [N], and of it [mm]: from the tip of a microscope to a brake."""
CONFIDENCE = 0.95
FEWEST = 5  # lines: fewer say nothing about the spread
FASTEST = 1e-5
"""K/H [mm²/N] above which units are wrong: mild steel on mild steel, dry, has 4e-6 (J. F. Archard, W. Hirst, The wear
of metals under unlubricated conditions, Proc. R. Soc. A 236 (1956) 397: K = 7e-3 at 1860 MPa)."""


@dataclass(frozen=True)
class PinOnDisc:
    """force [N] on a pin of this diameter [mm]. Raises TableError."""

    force: float
    diameter: float

    def __post_init__(self) -> None:
        for name, value, (low, high), unit in (
            ("force on the pin (--force-N)", self.force, FORCES, "N"),
            ("diameter of the pin (--pin-diameter-mm)", self.diameter, DIAMETERS, "mm"),
        ):  # fmt: skip
            if not low <= value <= high:
                raise TableError(name, f"a number from {low:g} to {high:g} {unit}", f"{value:g}", f"give it in {unit}")

    @property
    def pressure(self) -> float:
        """F/A [MPa]."""
        return self.force / (np.pi * self.diameter**2 / 4.0)


@dataclass(frozen=True)
class Record:
    """Sliding distance and depth (n,) [mm] of one test."""

    name: str
    distance: Floats
    depth: Floats

    @staticmethod
    def read(path: Path, run_in: float = 0.0) -> Record:
        """From a CSV file with the columns sliding_distance_mm, _m or _km and depth_um or _mm, from the distance
        `run_in` [mm] on. Raises TableError."""
        if not run_in >= 0.0:
            wanted, remedy = "a sliding distance from 0 m on", "give how much of the record's beginning is left out"
            raise TableError("running in (--run-in-m)", wanted, f"{1e-3 * run_in:g} m", remedy)
        distance, depth = read_columns(path, (DISTANCE, DEPTH))
        require_ascending(path, "a sliding distance", distance)
        later = distance >= run_in
        if np.count_nonzero(later) < FEWEST:
            wanted, found = f"at least {FEWEST} lines from {1e-3 * run_in:g} m on", f"{np.count_nonzero(later)}"
            raise TableError(path, wanted, found, "give a longer record, or a shorter running in")
        return Record(path.name, distance[later], depth[later])


@dataclass(frozen=True)
class Coefficient:
    """K/H [mm²/N]. low, high: the 95 % confidence interval of the mean: of one record that of its slope, of several
    that of their mean. each: of every record."""

    value: float
    low: float
    high: float
    each: tuple[float, ...]


def coefficient(records: Sequence[Record], test: PinOnDisc) -> Coefficient:
    """Raises TableError where nothing wears, or faster than anything does, or a test is given twice."""
    for one, other in combinations(records, 2):
        if np.array_equal(one.distance, other.distance) and np.array_equal(one.depth, other.depth):
            found, remedy = f"the same lines as in {one.name}", "give each test once: repeating it narrows no interval"
            raise TableError(other.name, "the record of another test", found, remedy)
    with np.errstate(all="ignore"):  # distances too small to be squared give no slope, and that is refused
        fits = [stats.linregress(r.distance, r.depth) for r in records]
    each = np.array([fit.slope / test.pressure for fit in fits])
    for record, own, fit in zip(records, each, fits):
        if not (0.0 < own <= FASTEST and np.isfinite(fit.stderr)):
            remedy = "is the record's depth rising, and are its units, the force in N and the diameter in mm right?"
            raise TableError(record.name, f"a K/H between 0 and {FASTEST:g} mm²/N", f"{own:.3g}", remedy)
    if len(each) == 1:
        error, freedom = fits[0].stderr / test.pressure, len(records[0].distance) - 2
    else:
        error, freedom = each.std(ddof=1) / np.sqrt(len(each)), len(each) - 1
    value, half = float(each.mean()), float(error * stats.t.ppf(0.5 + CONFIDENCE / 2.0, freedom))
    return Coefficient(value, value - half, value + half, tuple(each.tolist()))
