"""Deviations of a measured or worn flank from the designed one: a chart over profile and face width, as a CSV file.

    diameter_mm,z_mm,depth_um
    144.2,-10.0,0.3

One line a point of a grid over diameter and height; z_mm, from mid-face, may be left out where the profile is the same
over the face. depth: material missing from the designed flank, modifications included, normal to it; negative where
there is more. Between points the depth is linear in the involute's arc and in z, beyond the chart that of its rim: a
chart may be a little shorter than the face (`face_coverage.py`).
"""

from __future__ import annotations

import csv
import io
import os
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from evolvent.gears.problem.face_coverage import SAME, FaceCoverage
from evolvent_meshes.arrays import Floats, different
from evolvent_meshes.csv_tables import Column, TableError, has_column, read_columns
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.input_checks import Words, array, instance, refuse

DIAMETER, HEIGHT = Column("diameter", (("mm", 1.0),)), Column("z", (("mm", 1.0),))
DEPTH = Column("depth")
DEEPEST = 0.1
"""Largest depth [modules]: more is no flank any more, or another unit."""
WIDEST = 1.5
"""Largest diameter [tip diameters]: beyond it a chart is of another gear."""


@dataclass(frozen=True)
class FlankChart:
    """Depth of material missing from the designed flank, on a grid."""

    diameters: Floats
    """Diameters of the grid (k,), ascending [mm]."""
    heights: Floats
    """Heights of the grid (l,) from mid-face, ascending [mm]; a single one: the same over the face."""
    depth: Floats
    """Missing depth (k, l) normal to the flank; negative where there is more material [mm]."""

    def __post_init__(self) -> None:
        """Raises InputError unless the arrays are those of a grid, of two diameters at least."""
        k, m = np.size(self.diameters), np.size(self.heights)
        if k < 2 or m < 1:
            refuse("flank chart", "two diameters and one height at least", Words(f"{k} and {m}"), "add some")
        for name, shape in (("diameters", (k,)), ("heights", (m,)), ("depth", (k, m))):
            remedy = "depth has a row a diameter and a column a height, in mm"
            object.__setattr__(self, name, array(f"flank chart, {name}", getattr(self, name), (shape,), remedy))
        for name in ("diameters", "heights"):
            if not (np.diff(getattr(self, name)) > 0.0).all():
                refuse(f"flank chart, {name}", "ascending ones", getattr(self, name), "sort them, and depth alike")

    @staticmethod
    def read(file: str | os.PathLike[str]) -> FlankChart:
        """Chart from a CSV file, which is read again only after it has changed. Raises TableError where it cannot be
        read or its points are no grid."""
        instance("flank chart", file, (str, os.PathLike), "give the path of a CSV file")
        path = Path(file)
        try:
            state = path.stat()
        except (OSError, ValueError) as error:  # ValueError: the path has a NUL
            found = error.strerror if isinstance(error, OSError) else "a path with a NUL character"
            remedy = "check the path; where a scene names it, it starts from the scene's folder"
            raise TableError(shown_path(path), "a readable CSV file", str(found), remedy) from error
        return _read(path, state.st_mtime_ns, state.st_size)

    @staticmethod
    def parsed(path: Path) -> FlankChart:
        """Chart from a CSV file, read anew. Raises TableError where its points are no grid."""
        wanted = (DIAMETER, DEPTH, HEIGHT) if has_column(path, HEIGHT) else (DIAMETER, DEPTH)
        d, h, *rest = read_columns(path, wanted)
        z = rest[0] if rest else np.zeros_like(d)
        (diameters, row), (heights, column) = different(d, SAME), different(z, SAME)
        count = np.zeros((len(diameters), len(heights)), dtype=np.int64)
        np.add.at(count, (row, column), 1)
        if len(diameters) < 2 or not (count == 1).all():
            k, m = np.argwhere(count != 1)[0] if (count != 1).any() else (0, 0)
            found = f"{count[k, m]} lines for diameter {diameters[k]:g} mm, z {heights[m]:g} mm, and {len(diameters)}"
            allowed = "every diameter once at every height, and two diameters at least"
            raise TableError(path, allowed, f"{found} diameters", "fill gaps and leave out repeated points")
        depth = np.zeros(count.shape)
        depth[row, column] = h
        return FlankChart(diameters, heights, depth)

    @property
    def varies_over_the_face(self) -> bool:
        """Whether the depth depends on z."""
        return bool(np.ptp(self.depth, axis=1).max() > 0.0)

    def checked(self, path: object, gear: GearParameters, active: tuple[float, float]) -> FlankChart:
        """The chart from the base circle on. path: what a message names; active: diameters of a gear's active flank
        [mm], which it has to cover.

        Raises TableError where it does not, does not suit the face, or is of another size than the gear.
        """
        low, high = active
        slack = 0.02 * (high - low)
        if self.diameters[0] > low + slack or self.diameters[-1] < high - slack:
            wanted = f"diameters over the whole active flank, {low:.4g} to {high:.4g} mm"
            found = f"{self.diameters[0]:.4g} to {self.diameters[-1]:.4g} mm"
            raise TableError(path, wanted, found, "measure further, or mind diameter, not radius")
        if not (self.diameters[0] > 0.0 and self.diameters[-1] <= WIDEST * gear.tip_diameter):
            wanted = f"diameters above 0 up to {WIDEST * gear.tip_diameter:.4g} mm, for a tip of {gear.tip_diameter:g}"
            found = f"{self.diameters[0]:.4g} to {self.diameters[-1]:.4g} mm"
            raise TableError(path, wanted, found, "mind the unit, and which gear the chart is of")
        if problem := self.coverage(gear).problem:
            raise TableError(path, *problem)
        largest = float(np.abs(self.depth).max())
        if largest > DEEPEST * gear.normal_module:
            wanted = f"depths of at most {DEEPEST:g} normal modules, {1e3 * DEEPEST * gear.normal_module:g} µm"
            raise TableError(path, wanted, f"{1e3 * largest:.4g} µm", "is the column's unit right?")
        first = max(0, np.count_nonzero(self.diameters <= gear.base_diameter) - 1)
        return FlankChart(self.diameters[first:], self.heights, self.depth[first:])

    def coverage(self, gear: GearParameters) -> FaceCoverage:
        """Part of a gear's face that the heights cover."""
        return FaceCoverage.of(self.heights, gear.face_width)

    def arcs(self, gear: GearParameters) -> Floats:
        """Involute's length (k,) [mm] from a gear's base circle to the diameters."""
        return np.maximum(self.diameters**2 / 4.0 - gear.base_radius**2, 0.0) / (2.0 * gear.base_radius)

    def at(self, gear: GearParameters, roll_length: Floats, z: Floats) -> Floats:
        """Depth (n,) [mm] at roll lengths √(r² − r_b²) and heights (n,) of a gear; NaN where one of them is NaN."""
        arcs = self.arcs(gear)
        s = np.clip(roll_length**2 / (2.0 * gear.base_radius), arcs[0], arcs[-1])
        if len(self.heights) == 1:
            return np.interp(s, arcs, self.depth[:, 0])
        t = np.clip(z, self.heights[0], self.heights[-1])
        chart = RegularGridInterpolator((arcs, self.heights), self.depth, bounds_error=False)  # NaN is in no bounds
        return np.asarray(chart(np.column_stack([s, t])))

    def text(self) -> str:
        """Text of a CSV file that `read` gives back: diameters to 1e-9 mm, depths to 1e-9 µm."""
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        over_face = len(self.heights) > 1
        writer.writerow(["diameter_mm", *(["z_mm"] if over_face else []), "depth_um"])
        for d, row in zip(self.diameters, self.depth):
            for z, h in zip(self.heights, row):
                writer.writerow([f"{d:.9f}", *([f"{z:.9f}"] if over_face else []), f"{1e3 * h:.9f}"])
        return stream.getvalue()


FlankCharts = tuple[FlankChart | None, FlankChart | None]
"""Deviations of the flanks of pinion and wheel; None: as designed."""


@lru_cache(maxsize=4)
def _read(path: Path, changed: int, size: int) -> FlankChart:
    """Chart from a CSV file. changed, size: time of the last change and size of the file, so that a changed one is read
    again."""
    return FlankChart.parsed(path)


def shown_path(path: Path | str) -> str:
    """A path as it stands in a message, unprintable characters escaped."""
    return str(path) if str(path).isprintable() else ascii(str(path))
