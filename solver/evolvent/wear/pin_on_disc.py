"""K/H and its spread from pin-on-disc records: depth over sliding distance under a constant load.

K/H = (dh/ds) A/F with the slope dh/ds of the straight line fitted to the record after running in.

Source: Z. He, Y. Hu, X. Zheng, Y. Yu, Machines 10 (2022) 69, Eq. 3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
from scipy import stats

from evolvent_meshes.arrays import Floats
from evolvent_meshes.csv_tables import Column, TableError, read_columns, require_ascending

DISTANCE = Column("sliding_distance", (("mm", 1.0), ("m", 1e3), ("km", 1e6)))
DEPTH = Column("depth")
FORCES, DIAMETERS = (1e-6, 1e9), (1e-3, 1e4)
"""Range of the force on a pin [N] and of its diameter [mm], from a microscope's tip to a brake."""
CONFIDENCE = 0.95
MIN_LINES = 5  # fewer give no useful spread
MAX_COEFFICIENT = 1e-5
"""K/H [mm²/N] above which the units must be wrong: dry mild steel on mild steel has 4e-6 (J. F. Archard, W. Hirst, The
wear of metals under unlubricated conditions, Proc. R. Soc. A 236 (1956) 397: K = 7e-3 at 1860 MPa)."""


@dataclass(frozen=True)
class PinOnDisc:
    """Conditions of a pin-on-disc test.

    force: normal force on the pin [N].
    diameter: of the pin [mm].

    Raises TableError for values outside FORCES and DIAMETERS.

    >>> round(PinOnDisc(force=500.0, diameter=6.0).pressure, 3)
    17.684
    """

    force: float
    diameter: float

    def __post_init__(self) -> None:
        for name, value, (low, high), unit in (
            ("force on the pin (--force-N)", self.force, FORCES, "N"),
            ("diameter of the pin (--pin-diameter-mm)", self.diameter, DIAMETERS, "mm"),
        ):
            if not low <= value <= high:
                raise TableError(name, f"a number from {low:g} to {high:g} {unit}", f"{value:g}", f"give it in {unit}")

    @property
    def pressure(self) -> float:
        """Mean pressure F/A [MPa]."""
        return self.force / (np.pi * self.diameter**2 / 4.0)


@dataclass(frozen=True)
class Record:
    """Record of one test.

    name: file name, for messages.
    distance: (n,) sliding distance [mm].
    depth: (n,) worn depth of the pin [mm].
    """

    name: str
    distance: Floats
    depth: Floats

    @staticmethod
    def read(path: Path, run_in: float = 0.0) -> Record:
        """Reads a CSV file with the columns sliding_distance_mm (or _m, _km) and depth_um (or _mm).

        run_in: sliding distance [mm] before which lines are left out. Raises TableError.
        """
        if not run_in >= 0.0:
            wanted, remedy = "a sliding distance from 0 m on", "give the distance up to which lines are left out"
            raise TableError("running in (--run-in-m)", wanted, f"{1e-3 * run_in:g} m", remedy)
        distance, depth = read_columns(path, (DISTANCE, DEPTH))
        require_ascending(path, DISTANCE, "a sliding distance", distance)
        later = distance >= run_in
        if np.count_nonzero(later) < MIN_LINES:
            wanted, found = f"at least {MIN_LINES} lines from {1e-3 * run_in:g} m on", f"{np.count_nonzero(later)}"
            raise TableError(path, wanted, found, "give a longer record, or a shorter running in")
        return Record(path.name, distance[later], depth[later])


@dataclass(frozen=True)
class Coefficient:
    """Measured wear coefficient K/H [mm²/N].

    value: mean of all records.
    low, high: 95 % confidence interval: of the slope of one record, or of the mean of several.
    each: of every record.
    """

    value: float
    low: float
    high: float
    each: tuple[float, ...]


def coefficient(records: Sequence[Record], test: PinOnDisc) -> Coefficient:
    """K/H from one or more records of the same test conditions.

    Raises TableError where a K/H is not between 0 and MAX_COEFFICIENT, or a record is given twice.

    >>> distance = np.linspace(0.0, 1e7, 11)  # 10 km
    >>> record = Record("a.csv", distance, 2.446e-9 * distance)  # 2.446 µm per km
    >>> f"{coefficient([record], PinOnDisc(force=500.0, diameter=6.0)).value:.4e} mm²/N"
    '1.3832e-10 mm²/N'
    """
    for one, other in combinations(records, 2):
        if np.array_equal(one.distance, other.distance) and np.array_equal(one.depth, other.depth):
            found, remedy = f"the same lines as in {one.name}", "give each test once: repeating it narrows no interval"
            raise TableError(other.name, "the record of another test", found, remedy)
    with np.errstate(all="ignore"):  # distances too small to be squared give no slope, and that is refused
        fits = [stats.linregress(r.distance, r.depth) for r in records]
    each = np.array([fit.slope / test.pressure for fit in fits])
    for record, ratio, fit in zip(records, each, fits):
        if not (0.0 < ratio <= MAX_COEFFICIENT and np.isfinite(fit.stderr)):
            remedy = "is the record's depth rising, and are its units, the force in N and the diameter in mm right?"
            raise TableError(record.name, f"a K/H between 0 and {MAX_COEFFICIENT:g} mm²/N", f"{ratio:.3g}", remedy)
    if len(each) == 1:
        error, freedom = fits[0].stderr / test.pressure, len(records[0].distance) - 2
    else:
        error, freedom = each.std(ddof=1) / np.sqrt(len(each)), len(each) - 1
    value, half = float(each.mean()), float(error * stats.t.ppf(0.5 + CONFIDENCE / 2.0, freedom))
    return Coefficient(value, value - half, value + half, tuple(each.tolist()))
