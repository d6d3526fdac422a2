"""`python -m evidence.benchmarks.line.accuracy [--small]`: line contact beside the resolved contact, without
friction, for docs/line_contact.md. Pairs with relief, misaligned ones, random ones; from light loads to the whole one.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from evidence.benchmarks.line.bars import beyond_bars
from evidence.benchmarks.line.pairs import ALL, Case, random_cases
from evidence.benchmarks.line.resolved import ResolvedLoad, ResolvedPitch, resolved_pitch
from evidence.checkout import DOCS
from evidence.tables import Column, Table, write_rows
from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh, loaded_mesh
from evolvent.dynamics.results.curves import LOADED, CoarseExcitation, PitchCurve, pitch_curves
from evolvent.dynamics.results.line_facts import line_facts
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.line.line_gears import LineGears
from evolvent.gears.line.line_result import LineResult
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.pressure.line_peaks import pooled_peaks
from evolvent.gears.problem.gear_problem import MeshSettings
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent_meshes.arrays import Floats

NEAR_END = 0.75
"""Part of half the face width beyond which slices count as those at its ends."""


@dataclass(frozen=True)
class LineRow:
    """Deviations of the line contact of a pair under a torque from the resolved contact, at the same positions."""

    pair: str
    level: str
    """Level at which the contact was resolved."""
    torque_Nm: float
    positions: int
    deflection_um: float
    """Mean transmission error less the unloaded one."""
    position_percent: float
    """Largest deviation of the transmission error of a position, of the mean deflection."""
    peak_to_peak_um: float
    """Peak-to-peak transmission error of the resolved contact."""
    peak_to_peak_off_um: float
    tooth_force_percent: float
    """Largest deviation of a tooth pair's force, of the load."""
    line_load_percent: float
    """Root mean square of the deviations of line loads in the layers of the resolved mesh, of the largest line load."""
    line_load_end_percent: float
    """Root mean square of these deviations in the outer layers of the face alone; nan in the plane."""
    face_load_factor: float
    """K_Hβ of the resolved contact; 1 in the plane."""
    face_load_percent: float
    stiffness_percent: float
    """Largest deviation of a position's tangent stiffness."""
    pressure_percent: float
    """Deviation of Hertz' peak pressure of the line contact from the one fitted to the resolved pressure, in layers
    that bear on no edge, nine in ten."""
    pressure_by_load_percent: float
    """Part of it by the load of the layer: nine in ten of the deviations of Hertz' peak pressure from that for the
    resolved load."""
    on_edges_percent: float
    """Largest part of the load that edges of tips bear in line contact."""
    inside: int
    """Positions whose error bar holds the deviation of the transmission error."""
    peak_to_peak_inside: int
    """1 where the error bar of the peak-to-peak transmission error holds its deviation, else 0."""
    face_load_inside: int
    """1 where the error bar of K_Hβ holds its deviation on the layers of the resolved mesh, else 0; 1 in the plane."""
    resolved_seconds: float
    """Processor time of condensing and positions, all torques of the pair."""
    line_seconds: float


def _yes(inside: int) -> str:
    return "yes" if inside else "no"


TABLE = Table(LineRow, (
    Column("pair", "pair", words=True), Column("resolved at", "level", words=True), Column("N·m", "torque_Nm", ".4g"),
    Column("deflection [µm]", "deflection_um", ".3g"), Column("of a position [%]", "position_percent", ".2f"),
    Column("peak to peak [µm]", "peak_to_peak_um", ".3g"), Column("off by [µm]", "peak_to_peak_off_um", ".3f"),
    Column("tooth force [% of load]", "tooth_force_percent", ".2f"),
    Column("line load, rms [%]", "line_load_percent", ".2f"), Column("at ends [%]", "line_load_end_percent", ".1f"),
    Column("K_Hβ", "face_load_factor", ".3f"), Column("off by [%]", "face_load_percent", ".2f"),
    Column("stiffness [%]", "stiffness_percent", ".2f"), Column("p_0, nine in ten [%]", "pressure_percent", ".1f"),
    Column("by the load [%]", "pressure_by_load_percent", ".1f"),
    Column("load on edges [%]", "on_edges_percent", ".2f"),
    Column("bars of positions hold", lambda row: f"{row.inside} of {row.positions}", words=True),
    Column("of peak to peak, K_Hβ", lambda row: f"{_yes(row.peak_to_peak_inside)}, {_yes(row.face_load_inside)}",
           words=True),
))


def case_rows(case: Case) -> Iterator[LineRow]:
    """A row a torque."""
    yield from rows_beside(case, resolved_pitch(case))


def rows_beside(case: Case, resolved: ResolvedPitch) -> Iterator[LineRow]:
    """Rows of a case whose contact was resolved."""
    problem, angles, torques = case.problem, resolved.angles, resolved.torques
    on_lines, begin = replace(problem, mesh=MeshSettings("line")), time.process_time()
    lines = prepare_model(on_lines).model
    mesh = loaded_mesh(lines, torques, angles)
    seconds = time.process_time() - begin
    coarse = loaded_mesh(prepare_model(on_lines, mesh=companion_mesh).model, torques, angles)
    unloaded = unloaded_error(RigidFlanks(problem.pair, problem.flanks), angles, problem.torque_on)
    excitation = MeshExcitation(unloaded, mesh)
    companion = CoarseExcitation(MeshExcitation(unloaded, coarse))
    facts, curves = line_facts(excitation, companion), list(pitch_curves(excitation, companion))
    gears = LineGears.of(lines)
    positions = [gears.position(float(angle)) for angle in angles]
    for j, torque in enumerate(torques):
        force = torque / lines.base_radius / lines.width_factor
        found = [LineResult.of(position, force) for position in positions]
        bar = float(facts.face_load_factor_error[j])
        both = _Both(case, resolved.under[j], found, mesh, curves[j], bar, j)
        yield both.row(torque, unloaded, (resolved.seconds, seconds))


@dataclass(frozen=True, eq=False)
class _Both:
    """A pair under a torque, resolved and in line contact."""

    case: Case
    resolved: ResolvedLoad
    lines: list[LineResult]
    mesh: LoadedMesh
    curves: Mapping[str, PitchCurve]
    """Quantities of the line contact with their error bars."""
    face_load_error: float
    """Error of K_Hβ of the line contact; nan in the plane."""
    number: int
    """Index of the torque."""

    def row(self, torque: float, unloaded: Floats, seconds: tuple[float, float]) -> LineRow:
        error, line = self.resolved.error, self.mesh.errors[:, self.number]
        off, deflection = line - error, float(np.mean(error - unloaded))
        stiffness = self.resolved.stiffness
        loads, ends, (pressures, by_load) = self._slices()
        factors = self._face_load()
        peak_off = float(np.ptp(line) - np.ptp(error))
        assert self.mesh.line is not None
        return LineRow(
            self.case.name, self.case.problem.mesh.level, 1e-3 * torque, len(error), 1e3 * deflection,
            100.0 * float(np.abs(off).max()) / deflection, 1e3 * float(np.ptp(error)), 1e3 * peak_off,
            100.0 * self._tooth_forces(), 100.0 * loads, 100.0 * ends, factors[0],
            100.0 * (factors[1] / factors[0] - 1.0),
            100.0 * float(np.abs(self.mesh.stiffness[:, self.number] / stiffness - 1.0).max()), 100.0 * pressures,
            100.0 * by_load, 100.0 * float(self.mesh.line.on_edges[:, self.number].max()),
            int((1e3 * np.abs(off) <= self.curves[LOADED].bars).sum()),
            int(1e3 * abs(peak_off) <= self.curves[LOADED].varying_error(lambda values: float(np.ptp(values)))),
            int(np.isnan(self.face_load_error) or abs(factors[1] - factors[0]) <= self.face_load_error), *seconds,
        )

    def _tooth_forces(self) -> float:
        """Largest deviation of a tooth pair's force, over the load."""
        worst = 0.0
        for forces, line in zip(self.resolved.forces, self.lines):
            for tooth in {*forces, *line.teeth}:
                own = line.force(tooth) if tooth in line.teeth else 0.0
                worst = max(worst, abs(own - forces.get(tooth, 0.0)) / sum(forces.values()))
        return worst

    def _slices(self) -> tuple[float, float, tuple[float, float]]:
        """Root mean square of the deviations of line loads, over the largest one: of all slices, and of those at the
        ends of the face; and nine in ten of the deviations of peak pressures, whole and by the load alone."""
        off, at_end, peaks, largest = [], [], [], 0.0
        half = 0.5 * self.case.problem.pair.face_width
        for cut, line in zip(self.resolved.cuts, self.lines):
            largest = max(largest, float(cut.line_load.max()))
            fitted = pooled_peaks(cut)
            for tooth in np.unique(cut.tooth):
                own = cut.tooth == tooth
                load = self._mean_load(line, int(tooth), cut.z[own], cut.width[own])
                off.append(load - cut.line_load[own])
                at_end.append(np.abs(cut.z[own]) > NEAR_END * half)
                known = np.isfinite(fitted[own]) & (load > 0.1 * largest)
                radius = self._radius(line, int(tooth), cut.z[own])[known]
                p0 = np.sqrt(load[known] * line.position.system.modulus / (np.pi * radius))
                by_load = np.sqrt(load[known] / cut.line_load[own][known])
                peaks.append(np.abs(np.stack([p0 / fitted[own][known], by_load]) - 1.0))
        every, ends, pressures = np.concatenate(off), np.concatenate(at_end), np.concatenate(peaks, axis=1)
        rms = [float(np.sqrt(np.mean(part**2))) / largest if len(part) else np.nan for part in (every, every[ends])]
        if not pressures.size:
            return rms[0], rms[1], (np.nan, np.nan)
        whole, by_load = (float(each) for each in np.quantile(pressures, 0.9, axis=1))
        return rms[0], rms[1], (whole, by_load)

    def _mean_load(self, line: LineResult, tooth: int, z: Floats, width: Floats) -> Floats:
        """Mean load per length (k,) of a tooth pair in slices of some extent along z."""
        if tooth not in line.teeth:
            return np.zeros_like(z)
        if self.case.problem.is_plane:
            return np.full_like(z, line.force(tooth))
        force = line.force_below(tooth, z + 0.5 * width) - line.force_below(tooth, z - 0.5 * width)
        return force * line.cosine / width

    def _radius(self, line: LineResult, tooth: int, z: Floats) -> Floats:
        """Relative radius of curvature (k,) of a tooth pair's line at heights (k,)."""
        own = line.position.stations.tooth == tooth
        if not own.any():
            return np.full_like(z, np.nan)
        return np.interp(z, line.position.stations.z[own], line.position.system.radius[own])

    def _face_load(self) -> tuple[float, float]:
        """K_Hβ of both, on the layers of the resolved mesh, in the mean over the positions."""
        cuts, face = self.resolved.cuts, self.case.problem.pair.face_width
        if self.case.problem.is_plane:
            return 1.0, 1.0
        z, first = np.unique(np.round(np.concatenate([cut.z for cut in cuts]), 6), return_index=True)
        width = np.concatenate([cut.width for cut in cuts])[first]
        resolved, lines = np.zeros_like(z), np.zeros_like(z)
        for cut, line in zip(cuts, self.lines):
            np.add.at(resolved, np.searchsorted(z, np.round(cut.z, 6)), cut.line_load)
            lines += sum(self._mean_load(line, tooth, z, width) for tooth in line.teeth)
        first_factor, second = (float(each.max() * face / (each @ width)) for each in (resolved, lines))
        return first_factor, second


def said(docs: Path) -> str:
    """The table of docs/line_contact.md."""
    return TABLE.markdown(TABLE.read(docs / "line_contact" / "accuracy.csv"))


BARS: tuple[tuple[str, str, float], ...] = (
    ("a position", "position_percent", 0.3), ("tooth forces", "tooth_force_percent", 0.5),
    ("line load", "line_load_percent", 3.0), ("line load at the ends of the face", "line_load_end_percent", 5.0),
    ("K_Hβ", "face_load_percent", 1.0), ("stiffness", "stiffness_percent", 0.5), ("p_0", "pressure_percent", 1.5),
    ("p_0 by the load", "pressure_by_load_percent", 1.5),
)
"""Figure, its column and its bar [%]."""


def beyond(docs: Path) -> str:
    """Sentence of docs/line_contact.md on rows beyond the bars, of those where no edge bears."""
    rows = [row for row in TABLE.read(docs / "line_contact" / "accuracy.csv") if row.on_edges_percent < 1.0]
    held = sum(row.inside for row in rows), sum(row.positions for row in rows)
    space = [row for row in rows if row.face_load_factor > 1.0]  # it is 1 in the plane
    return (
        f"Beyond the bars, of {len(rows)} rows: {beyond_bars(rows, BARS)}. Error bars hold at {held[0]} of "
        f"{held[1]} positions, {sum(row.peak_to_peak_inside for row in rows)} of {len(rows)} peak-to-peak values and "
        f"{sum(row.face_load_inside for row in space)} of {len(space)} face load factors in space."
    )


def main() -> None:
    """Measures all pairs; each row is kept as soon as it is there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="the first pair alone, to see that everything works")
    parser.add_argument("--pair", help="pairs whose name begins so; the others keep their rows")
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    path, cases = given.out / "line_contact" / "accuracy.csv", [*ALL, *random_cases()]
    chosen = cases[:1] if given.small else [case for case in cases if case.name.startswith(given.pair or "")]
    rows = {case.name: [row for row in TABLE.read(path) if row.pair == case.name] for case in cases}
    for case in chosen:
        rows[case.name] = []
        for row in case_rows(case):
            rows[case.name].append(row)
            print(row, flush=True)
        write_rows(path, [row for each in rows.values() for row in each])


if __name__ == "__main__":
    main()
