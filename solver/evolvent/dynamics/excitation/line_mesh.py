"""The mesh under several torques in line contact: each position is made once, for all torques."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.line.line_gears import LineGears, LinePosition
from evolvent.gears.line.line_result import FACE_LOAD_OFF, PRESSURE_OFF, LineResult
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True, eq=False)
class LineFigures:
    """Figures that a line contact has beside those of the mesh, at n positions under m torques."""

    on_edges: Floats
    """(n, m) part of the load that edges of tips bear."""
    pressure: Floats
    """(n, m) largest of Hertz' p_0 away from edges of tips and from starts of linear reliefs [MPa]."""
    layer_load: Floats
    """(n, m, l) load per face width in thirds of the layers of the mesh over that of the whole face."""

    @staticmethod
    def of(columns: Floats) -> LineFigures:
        """The figures in the order of `line_figures`, behind those of the mesh (n, m, 2 + l)."""
        return LineFigures(columns[..., 0], columns[..., 1], columns[..., 2:])

    @property
    def face_load_factor(self) -> Floats:
        """K_Hβ (m,) (ISO 6336-1:2006, 7.2.2) under each torque: the largest load of a third of a layer in the mean
        over the positions; 1 in the plane."""
        return np.asarray(self.layer_load.mean(axis=0).max(axis=-1))

    @property
    def is_plane(self) -> bool:
        """Whether the gears are solved in the plane, where K_Hβ is no result."""
        return self.layer_load.shape[-1] == 1

    def face_load_error(self, coarse: LineFigures) -> Floats:
        """Error of K_Hβ (m,): the difference to that of a companion, with layers of twice the size, and `FACE_LOAD_OFF`
        of the factor."""
        other = coarse.face_load_factor
        return np.asarray(np.abs(self.face_load_factor - other) + FACE_LOAD_OFF * self.face_load_factor)

    @property
    def largest_pressure_MPa(self) -> Floats:
        """Largest p_0 (m,) over the pitch under each torque [MPa]."""
        return np.asarray(self.pressure.max(axis=0))

    def pressure_error(self, coarse: LineFigures) -> Floats:
        """Error of the largest p_0 (m,) [MPa]: the difference to that on a companion's meshes, and `PRESSURE_OFF`."""
        own = self.largest_pressure_MPa
        return np.asarray(np.abs(own - coarse.largest_pressure_MPa) + PRESSURE_OFF * own)

    def lightest(self, count: int) -> LineFigures:
        """Figures under the lightest torques alone."""
        return LineFigures(self.on_edges[:, :count], self.pressure[:, :count], self.layer_load[:, :count])


def line_figures(gears: LineGears, torques: Sequence[float], angles: Floats) -> Iterator[Floats]:
    """Figures (m, 6 + l) of positions one after the other, under each torque [N·mm]: those of `figures_of`, then of
    `LineFigures`.

    The loads act along the normals of the helicoids, so that the torques of both gears have the ratio of the base radii
    exactly, and no position stores power. Raises NotConverged, TooWide.
    """
    for angle in angles:
        yield figures_at(gears, gears.position(float(angle)), torques)


def figures_at(gears: LineGears, position: LinePosition, torques: Sequence[float]) -> Floats:
    """Figures (m, 6 + l) of a position of these gears, see `line_figures`. Raises NotConverged, TooWide."""
    radius, width, layers = gears.base_radius, gears.width_factor, gears.layers
    ratio = gears.pair.pinion.base_radius / radius
    rows = []
    for torque in torques:
        found = LineResult.of(position, torque / radius / width)
        load, given = found.equilibrium.load, torque / width * ratio
        mesh = found.transmission_error, found.equilibrium.stiffness * width, given, 0.0
        more = found.position.on_edges(load), found.largest_pressure(gears.pair)
        rows.append([*mesh, *more, *found.layer_load(layers)])
    return np.array(rows)
