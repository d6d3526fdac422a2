"""Friction loss of a scene's gears over the torque."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.gears.line.line_result import EdgeContact
from evolvent.gears.problem.loss_factor import ohlendorf_loss_factor
from evolvent.gears.shared_gears import SharedGears
from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.results.archive.run_cost import Timings
from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.results.tables.table import SCENE_TITLE, Table
from evolvent.run.call import Call
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.kept_pitch import require_resumable
from evolvent.run.loss_figures import PitchFigures, loss_warnings, pitch_figures
from evolvent.run.solved_pitches import SolvedPitches, solved_pitches
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.load_cases import LoadCase, in_space_sentence, load_cases, under_cases, with_list
from evolvent.scene.scene import Scene, SceneError
from evolvent.scene.schema.errors import InputProblem

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PART = "torque_{}_"
"""Part of the archive with the positions under a torque, by its number."""
MOST_NAMED = 6
"""Largest number of load cases that the foot of the picture names."""
SPEED = 1000.0
"""Speed of the pinion for which the power is given [r/min]."""


@dataclass(frozen=True)
class LossRow:
    """A line of losses.csv: a load and a friction coefficient."""

    case: str
    """Name of the load case, or the part of the scene's torque."""
    torque_Nm: float
    """Torque on the gear that the scene names."""
    torque_on: str
    """Gear on which the torque is held constant, pinion or wheel."""
    driving: str
    """Gear that drives: its power is the input."""
    speed_rpm: float
    """Speed of the pinion in the load case; NaN where it is not given."""
    share_of_life: float
    """Share of the life in the load case; NaN where it is not given."""
    misalignment_um: float
    """Opening of the flanks over the face width, `pair.misalignment_um` or that of the load case."""
    friction: float
    """Friction coefficient μ."""
    loss_percent: float
    """Friction work over the input work of the pitch."""
    loss_percent_error: float
    """Estimated error of the loss."""
    input_at_1000_rpm_W: float
    """Input power at 1000 r/min of the pinion. Where the torque is held on the gear that is driven, the loss adds to
    it."""
    loss_at_1000_rpm_W: float
    """Friction power at 1000 r/min of the pinion. As μ is the same at all speeds, so is the loss in percent, and the
    power is in proportion to the speed."""
    loss_at_1000_rpm_W_error: float
    """Estimated error of the friction power."""
    input_W: float
    """Input power at the speed of the load case; NaN where it is not given."""
    loss_W: float
    """Friction power at this speed."""
    loss_W_error: float
    """Estimated error of this friction power."""
    tooth_loss_factor: float
    """Tooth loss factor H_V: loss over the input and μ; NaN where μ is 0."""
    tooth_loss_factor_error: float
    """Estimated error of the tooth loss factor."""
    ohlendorf_loss_factor: float
    """Tooth loss factor by Ohlendorf's formula, for teeth that share the load equally: from the numbers of teeth, the
    base helix angle and the contact ratios alone; NaN where less than one or more than two pairs are in contact."""

    @property
    def is_named(self) -> bool:
        """Whether the load is a load case of the scene, whose names have no percent sign."""
        return not self.case.endswith("%")


LOSSES = Table("losses.csv", LossRow)
LOSSES_PICTURE = TablePicture("losses.png", (SCENE_TITLE, LOSSES), "evolvent.run.kinds.losses:losses_figure")


def loss_lines(out: Path) -> Iterator[str]:
    """Loss under each load case, of a list of percentages under the heaviest torque, at each friction coefficient."""
    rows = LOSSES.read(out)
    heaviest = max(row.torque_Nm for row in rows)
    for row in (row for row in rows if row.friction and (row.torque_Nm == heaviest or row.is_named)):
        percent = plus_minus(row.loss_percent, row.loss_percent_error, 2)
        power = f"{plus_minus(row.loss_at_1000_rpm_W, row.loss_at_1000_rpm_W_error, 1)} W at {SPEED:g} r/min"
        if math.isfinite(row.speed_rpm):
            power = f"{plus_minus(row.loss_W, row.loss_W_error, 1)} W at {row.speed_rpm:g} r/min"
        factor = plus_minus(row.tooth_loss_factor, row.tooth_loss_factor_error, 4)
        beside = "" if math.isnan(row.ohlendorf_loss_factor) else f" (Ohlendorf {row.ohlendorf_loss_factor:.4f})"
        yield (
            f"{row.case}, {row.torque_Nm:.4g} N·m on the {row.torque_on}, {row.driving} drives, μ = {row.friction:g}: "
            f"loss {percent} % of the input, {power} of the pinion; tooth loss factor {factor}{beside}"
        )


@dataclass(frozen=True, eq=False)
class SolvedLoads:
    """The pitch under each load, the lightest first."""

    pitches: list[SolvedPitches]
    """The pitches that have figures."""
    left_out: str = ""
    """Sentence on the heavier loads, which have none in line contact; empty where all have."""


@dataclass(frozen=True)
class Losses(Computation[SolvedLoads]):
    """The pitch with friction under each of a list of loads."""

    name: ClassVar[str] = "losses"
    command: ClassVar[str] = "losses"
    in_line_contact: ClassVar[bool] = True
    outputs: ClassVar[Outputs] = Outputs(
        (LOSSES.name,), (LOSSES_PICTURE,), stored=(f"results/{PART.format(0)}state.npz", "results/*torque_*.npz"),
        lines=loss_lines,
    )

    @classmethod
    def of(cls, scene: Scene, percents: Sequence[float] = ()) -> Self:
        """Losses of a scene under parts of its torque or the loads that it lists."""
        return cls(with_list(scene.model_copy(update={"wear": None}), percents))

    @property
    def sized(self) -> list[Scene]:
        """The scene under each load, the lightest first, on meshes that serve all of them."""
        return list(under_cases(self.scene).values())

    def check(self) -> None:
        """Raises SceneError for a scene without friction."""
        if not any(self.scene.contact.friction):
            found, allowed = "no coefficient but 0", "at least one above 0"
            raise SceneError([InputProblem("contact.friction", found, allowed, "0.05 is usual for lubricated steel")])

    def warnings(self) -> Iterator[str]:
        """Warnings on charts, flanks and tips, loads in space, and an operating speed, which has no effect."""
        yield from (*super().warnings(), *in_space_sentence(self.scene, self.sized))
        if self.scene.dynamics is not None and self.scene.dynamics.operating_rpm is not None:
            yield (
                "dynamics.operating_rpm: without effect on losses.csv, which is under constant torques; `evolvent run` "
                "solves the contact under the mesh force at this speed."
            )

    def solve(self, call: Call) -> SolvedLoads:
        """Both pitches under each load, on gears that are condensed once, see `Computation.solve`. In line contact
        loads are left out from the one on under which edges of tips bear; EdgeContact where it is the lightest."""
        parts = {PART.format(number): scene for number, scene in enumerate(self.sized)}
        call.on_first(lambda: self._check_parts(call, parts))
        gears = SharedGears([gear_problem(scene) for scene in parts.values()])
        solved: list[SolvedPitches] = []
        with call.beginning(self.scene, gears.prepare) as prepare:
            for part, scene in parts.items():
                try:
                    solved.append(solved_pitches(call.preparing(prepare), scene, part))
                except EdgeContact as error:
                    if not solved:
                        raise
                    return SolvedLoads(solved, f"Loads from {scene.load.torque_Nm:.4g} N·m on are left out: {error}.")
        return SolvedLoads(solved)

    def results(self, call: Call, solved: SolvedLoads) -> Results:
        """The table of all loads that have figures."""
        figures = pitch_figures(solved.pitches)
        rows = [row for case, each in zip(load_cases(self.scene), figures) for row in _rows(case, each)]
        timings = sum((load.timings for load in solved.pitches), Timings())
        said = [*loss_warnings(self.scene, solved.pitches, figures), *filter(None, [solved.left_out])]
        return Results(self.scene, [LOSSES.of(rows)], said, timings=timings)

    def _check_parts(self, call: Call, parts: Mapping[str, Scene]) -> None:
        """Raises ArchiveError, before anything is removed, where stored positions belong to another scene. On rank 0
        alone. parts: of the archive, with the scene under each load."""
        for part, scene in parts.items() if call.resume else ():
            require_resumable(scene, call.folder.out, self.command, part, self.scene)


def _rows(case: LoadCase, figures: PitchFigures) -> Iterator[LossRow]:
    """Losses at each friction coefficient under one load."""
    run = figures.run
    load, beside = run.scene.load, ohlendorf_loss_factor(run.pair)
    passed = 1e-3 * run.scene.hertz_estimate().pinion_torque * MeshSpeed(SPEED, run.pair.pinion.z).rad_s
    speed, share = (math.nan if each is None else each for each in (case.speed_rpm, case.share_of_life))
    for index, row in enumerate(figures.rows):
        loss, bar = 0.01 * row.loss_percent, 0.01 * run.errors.bar("loss_percent", index)
        delivered = 1.0 - loss if load.on != load.driving else 1.0  # part of the input that the torque is held for
        factor, factor_bar = (each / row.friction if row.friction else math.nan for each in (loss, bar))
        taken, lost, off = passed / delivered, passed * loss / delivered, passed * bar / delivered**2
        yield LossRow(
            case=case.name, torque_Nm=load.torque_Nm, torque_on=load.on, driving=load.driving, speed_rpm=speed,
            share_of_life=share, misalignment_um=case.misalignment_um, friction=row.friction, loss_percent=100.0 * loss,
            loss_percent_error=100.0 * bar, input_at_1000_rpm_W=taken, loss_at_1000_rpm_W=lost,
            loss_at_1000_rpm_W_error=off, input_W=taken * speed / SPEED, loss_W=lost * speed / SPEED,
            loss_W_error=off * speed / SPEED, tooth_loss_factor=factor, tooth_loss_factor_error=factor_bar,
            ohlendorf_loss_factor=beside,
        )


def losses_figure(title: str, rows: Sequence[LossRow]) -> Figure:
    """Loss in percent, and friction power, over the torque."""
    from evolvent.results.drawing.style import foot, friction_colours, sheet

    frictions = sorted({row.friction for row in rows})
    most = max(rows, key=lambda row: row.loss_percent)
    figure = sheet(
        "Friction loss over the torque",
        f"{title}. The {most.driving} drives. At most {most.loss_percent:.3g} % of the input, at {most.torque_Nm:.4g} "
        f"N·m on the {most.torque_on} and μ = {most.friction:g}, tooth loss factor {most.tooth_loss_factor:.3g}",
    )
    for axes, name, label in zip(
        figure.subplots(1, 2), ("loss_percent", "loss_at_1000_rpm_W"),
        ("loss over input [%]", f"friction power at {SPEED:g} r/min [W]"),
    ):
        for friction, colour in zip(frictions, friction_colours(frictions)):
            own = [row for row in rows if row.friction == friction]
            values, bars = ([getattr(row, each) for row in own] for each in (name, f"{name}_error"))
            known = {"yerr": bars, "capsize": 3.0} if np.isfinite(bars).all() else {}
            torques = [row.torque_Nm for row in own]
            axes.errorbar(torques, values, color=colour, marker="o", label=f"μ = {friction:g}", **known)
        axes.set_xlim(left=0.0)
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel(f"torque on the {most.torque_on} [N·m]")
        axes.set_ylabel(label)
    axes.legend(loc="best")
    said = ["Bars: estimated error, of mesh and spacing of positions."] * math.isfinite(most.loss_percent_error)
    named = dict.fromkeys(f"{row.case} {row.torque_Nm:.4g} N·m" for row in rows if row.is_named)
    listed = [f"Loads: {', '.join(named)}."] if 0 < len(named) <= MOST_NAMED else []
    foot(figure, *said, *listed, "μ is the same at all speeds.")
    return figure
