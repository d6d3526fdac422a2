"""`python -m evidence.benchmarks.line.friction [--small]`: line contact with friction beside the resolved
contact, at μ = 0 and 0.1 over the same periodic pitch, for docs/line_contact.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evidence.benchmarks.line.bars import beyond_bars
from evidence.benchmarks.line.pairs import ALL
from evidence.benchmarks.measuring import keep_rows
from evidence.tables import Column, Table
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.line.line_sweep import line_sweep
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent_meshes.arrays import Floats

FRICTION, POSITIONS = 0.1, 20
PAIRS: tuple[tuple[str, float], ...] = (
    ("He, plane", 30.0), ("He, plane", 100.0), ("He, linear relief, plane", 100.0), ("He, lead crowning", 30.0),
    ("He, lead crowning", 100.0), ("He, half the face, lead crowning", 5.0), ("He, misaligned 20 µm", 100.0),
    ("He, half the face, misaligned 20 µm", 10.0), ("He, half the face, misaligned 20 µm", 30.0),
    ("Yang, relieved", 5.0), ("Yang, relieved", 30.0), ("Yang, relieved", 100.0), ("Yang, misaligned 20 µm", 10.0),
    ("Yang, misaligned 20 µm", 30.0), ("Yang, misaligned 20 µm", 100.0),
    ("Yang, half the face, misaligned 20 µm", 30.0), ("Yang, half the face, misaligned 20 µm", 100.0),
)
"""Pair and torque in percent."""
BARS: tuple[tuple[str, str, float], ...] = (
    ("a position", "position_percent", 0.3), ("tooth forces", "tooth_force_percent", 0.5),
    ("loss", "loss_off_percent", 1.0),
)
"""Figure, its column and its bar [%]."""


@dataclass(frozen=True)
class FrictionRow:
    """Deviations of a pair in line contact from the resolved contact, at 20 positions of a periodic pitch."""

    pair: str
    level: str
    """Level at which the contact was resolved."""
    torque_Nm: float
    deflection_um: float
    """Mean transmission error at μ = 0.1 less the unloaded one."""
    loss_percent: float
    """Friction work over input work of the resolved contact."""
    loss_off_percent: float
    """Deviation of the loss, of the loss."""
    tooth_force_percent: float
    """Largest deviation of a tooth pair's force at μ = 0.1, of the load."""
    without_tooth_force_percent: float
    """Largest deviation of a tooth pair's force at μ = 0, of the load."""
    position_percent: float
    """Largest deviation of the transmission error of a position at μ = 0.1, of the deflection."""
    without_position_percent: float
    """Largest deviation of the transmission error at μ = 0, of the mean deflection."""
    peak_to_peak_um: float
    """Peak-to-peak transmission error of the resolved contact at μ = 0.1."""
    peak_to_peak_off_um: float
    other_torque_percent: float
    """Largest deviation of the torque on the gear on which it is not given."""


TABLE = Table(FrictionRow, (
    Column("pair", "pair", words=True), Column("resolved at", "level", words=True), Column("N·m", "torque_Nm", ".4g"),
    Column("deflection [µm]", "deflection_um", ".3g"), Column("loss [%]", "loss_percent", ".3f"),
    Column("off by [% of it]", "loss_off_percent", ".2f"),
    Column("tooth force [% of load]", "tooth_force_percent", ".2f"),
    Column("at μ = 0", "without_tooth_force_percent", ".2f"), Column("of a position [%]", "position_percent", ".2f"),
    Column("at μ = 0", "without_position_percent", ".2f"), Column("peak to peak [µm]", "peak_to_peak_um", ".3g"),
    Column("off by [µm]", "peak_to_peak_off_um", ".3f"), Column("other torque [%]", "other_torque_percent", ".2f"),
))


def friction_row(name: str, percent: float) -> FrictionRow:
    """The row of a pair of `ALL` under a part of its torque."""
    own = next(case for case in ALL if case.name == name).problem
    problem = replace(own, torque=own.torque * percent / 100.0)
    pitch, frictions = uniform_pitch(problem.pair.pinion.z, POSITIONS), (0.0, FRICTION)
    resolved = certified_pitch(prepare_model(problem).model, pitch, frictions, MPI.COMM_SELF).by_friction
    model = prepare_model(replace(problem, mesh=MeshSettings("line"))).model
    lines = list(zip(*(each.results for each in line_sweep(model, pitch, frictions, MPI.COMM_SELF))))
    unloaded = unloaded_error(RigidFlanks(problem.pair, problem.flanks), np.array(pitch.angles), problem.torque_on)
    smooth, rubbing = (_Both(problem, unloaded, *each) for each in zip(resolved, lines))
    loss = rubbing.losses
    return FrictionRow(
        name, own.mesh.level, 1e-3 * problem.torque, 1e3 * rubbing.deflection, 100.0 * loss[0],
        100.0 * (loss[1] / loss[0] - 1.0), 100.0 * rubbing.tooth_force, 100.0 * smooth.tooth_force,
        100.0 * rubbing.position, 100.0 * smooth.position, 1e3 * float(np.ptp(rubbing.errors[0])),
        1e3 * float(np.ptp(rubbing.errors[1]) - np.ptp(rubbing.errors[0])), 100.0 * rubbing.other_torque,
    )


@dataclass(frozen=True, eq=False)
class _Both:
    """A pitch at a friction coefficient, resolved and in line contact."""

    problem: GearProblem
    unloaded: Floats
    resolved: Sequence[PositionResult]
    lines: Sequence[PositionResult]

    @property
    def errors(self) -> Floats:
        """Transmission errors (2, n) [mm]."""
        return np.array([[each.transmission_error for each in part] for part in (self.resolved, self.lines)])

    @property
    def deflection(self) -> float:
        """Mean deflection of the resolved contact [mm]."""
        return float(np.mean(self.errors[0] - self.unloaded))

    @property
    def position(self) -> float:
        """Largest deviation of a transmission error, over the deflection."""
        return float(np.abs(self.errors[1] - self.errors[0]).max()) / self.deflection

    @property
    def tooth_force(self) -> float:
        """Largest deviation of a tooth pair's force, over the load."""
        worst = 0.0
        for result, line in zip(self.resolved, self.lines):
            whole = float((result.contact.weights * result.contact.pressure).sum())
            for tooth in {*result.contact.tooth.tolist(), *line.contact.tooth.tolist()}:
                off = line.contact.normal_force(tooth) - result.contact.normal_force(tooth)
                worst = max(worst, abs(off) / whole)
        return worst

    @property
    def losses(self) -> tuple[float, float]:
        """Friction work over input work."""
        first, second = (
            sum(each.friction_loss for each in part) / sum(each.torques[0] for each in part)
            for part in (self.resolved, self.lines)
        )
        return first, second

    @property
    def other_torque(self) -> float:
        """Largest deviation of the torque on the other gear, over that torque."""
        other = self.problem.torque_on.mate
        return max(abs(b.torques[other] / a.torques[other] - 1.0) for a, b in zip(self.resolved, self.lines))


def said(docs: Path) -> str:
    """The table of docs/line_contact.md, and what in it is beyond the bars."""
    rows = TABLE.read(docs / "line_contact" / "friction.csv")
    return f"{TABLE.markdown(rows)}\n\nBeyond the bars, of {len(rows)} pitches: {beyond_bars(rows, BARS)}."


def main() -> None:
    """Measures all pairs."""
    small = "the first pair alone, to see that everything works"
    keep_rows(__doc__, small, "friction", lambda few: (friction_row(*each) for each in PAIRS[: 1 if few else None]))


if __name__ == "__main__":
    main()
