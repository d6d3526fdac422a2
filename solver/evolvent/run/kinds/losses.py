"""Friction loss of a scene's gears over the torque."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

from evolvent.check.scene_warnings import flank_warnings
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.gears.shared_gears import SharedGears
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED
from evolvent.results.archive.run_cost import Timings
from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.table import Table
from evolvent.run.call import Call
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.kept_pitch import require_resumable
from evolvent.run.solved_pitches import SolvedPitches, companion_of, solved_pitches
from evolvent.scene.chart_warnings import chart_warnings
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.part_torque import listed_percents, under_torque, with_percents
from evolvent.scene.scene import Scene
from evolvent.scene.skips import skips

PART = "torque_{}_"
"""Part of the archive with the positions under a torque, by its number."""
SPEED = 1000.0
"""Speed of the pinion for which the power is given [r/min]."""


@dataclass(frozen=True)
class LossRow:
    """A line of losses.csv: a torque and a friction coefficient."""

    torque_Nm: float
    """Torque on the gear that the scene names."""
    friction: float
    """Friction coefficient μ."""
    loss_percent: float
    """Friction work over the input work of the pitch."""
    loss_percent_error: float
    """Estimated error of the loss."""
    loss_at_1000_rpm_W: float
    """Friction power at 1000 r/min of the pinion. As μ is the same at all speeds, so is the loss in percent, and the
    power is in proportion to the speed."""
    loss_at_1000_rpm_W_error: float
    """Estimated error of the friction power."""


LOSSES = Table("losses.csv", LossRow)
LOSSES_PICTURE = TablePicture("losses.png", (LOSSES,), "evolvent.run.kinds.losses:losses_picture")


@dataclass(frozen=True)
class Losses(Computation[list[SolvedPitches]]):
    """The pitch with friction under each of a list of torques."""

    name: ClassVar[str] = "losses"
    command: ClassVar[str] = "losses"
    outputs: ClassVar[Outputs] = Outputs(
        (LOSSES.name,), (LOSSES_PICTURE,), stored=(f"results/{PART.format(0)}state.npz", "results/*torque_*.npz")
    )

    @classmethod
    def of(cls, scene: Scene, percents: Sequence[float] = ()) -> Self:
        """Losses of a scene under parts of its torque."""
        unworn = scene.model_copy(update={"wear": None})
        return cls(with_percents(unworn, listed_percents(scene, percents)))

    @property
    def sized(self) -> list[Scene]:
        """The scene under each torque, the lightest first, on meshes that serve all of them."""
        torques = [self.scene.load.torque_Nm * percent / 100.0 for percent in sorted(self.scene.load.percents)]
        one = with_percents(self.scene, ())
        return [under_torque(one, torque, (torques[0], torques[-1])) for torque in torques]

    def warnings(self) -> Iterator[str]:
        """Warnings on charts, flanks and tips."""
        yield from (*chart_warnings(self.scene), *flank_warnings(gear_problem(self.scene)))

    def solve(self, call: Call) -> list[SolvedPitches]:
        """Both pitches under each torque, on gears that are condensed once, see `Computation.solve`."""
        parts = {PART.format(number): scene for number, scene in enumerate(self.sized)}
        call.on_first(lambda: self._check_parts(call, parts))
        gears = SharedGears([gear_problem(scene) for scene in parts.values()])
        with call.beginning(self.scene, gears.prepare) as prepare:
            return [solved_pitches(call.preparing(prepare), scene, part) for part, scene in parts.items()]

    def results(self, call: Call, solved: list[SolvedPitches]) -> Results:
        """The table of all torques."""
        mended = any(load.fine.solved.deflected for load in solved) and skips(self.scene, "deflected-flanks")
        reasons = dict.fromkeys(load.coarse.reason for load in solved if load.coarse.reason)
        runs = (load.run_data(companion_of(load.coarse)) for load in solved)
        rows = [row for run in runs for row in _rows(run)]
        timings = sum((load.timings for load in solved), Timings())
        return Results(self.scene, [LOSSES.of(rows)], [*[ON_DEFLECTED] * mended, *reasons], timings=timings)

    def _check_parts(self, call: Call, parts: Mapping[str, Scene]) -> None:
        """Raises ArchiveError, before anything is removed, where stored positions belong to another scene. On rank 0
        alone. parts: of the archive, with the scene under each torque."""
        for part, scene in parts.items() if call.resume else ():
            require_resumable(scene, call.folder.out, self.command, part)


def _rows(run: RunData) -> Iterator[LossRow]:
    """Losses at each friction coefficient under one torque."""
    power = 1e-3 * run.scene.hertz_estimate().pinion_torque * MeshSpeed(SPEED, run.pair.pinion.z).rad_s  # W
    for index, row in enumerate(friction_rows(run)):
        loss, error = row.loss_percent, run.errors.bar("loss_percent", index)
        watts = power * loss / 100.0, power * error / 100.0
        yield LossRow(run.scene.load.torque_Nm, row.friction, loss, error, *watts)


def losses_picture(rows: Sequence[LossRow]) -> bytes:
    """PNG of the loss in percent, and of the friction power, over the torque."""
    from evolvent.results.drawing.style import foot, friction_colours, png, sheet, styled

    frictions = sorted({row.friction for row in rows})
    most = max(rows, key=lambda row: row.loss_percent)
    with styled():
        where = f"at {most.torque_Nm:.4g} N·m and μ = {most.friction:g}"
        figure = sheet("Friction loss over the torque", f"At most {most.loss_percent:.3g} % of the input, {where}")
        for axes, name, label in zip(
            figure.subplots(1, 2), ("loss_percent", "loss_at_1000_rpm_W"),
            ("loss over input [%]", f"friction power at {SPEED:g} r/min [W]"),
        ):
            for friction, colour in zip(frictions, friction_colours(frictions)):
                own = [row for row in rows if row.friction == friction]
                columns = ([getattr(row, each) for row in own] for each in ("torque_Nm", name, f"{name}_error"))
                axes.errorbar(*columns, color=colour, capsize=3.0, marker="o", label=f"μ = {friction:g}")
            axes.set_ylim(bottom=0.0)
            axes.set_xlabel("torque [N·m]")
            axes.set_ylabel(label)
        axes.legend(loc="best")
        foot(figure, "Bars: estimated error, of mesh and spacing of positions. μ is the same at all speeds.")
        return png(figure)
