"""Does the part of the error bars hold that comes from the spacing of positions? Figures of seven pairs at 12 to 40
positions a pitch, even and odd numbers, against those at 160 on the same mesh.

Each is solved by itself: with friction a position depends on those before it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from mpi4py import MPI

from evidence.benchmark.bars import DEMOS, FIGURES, HELICAL, BarRow
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.summary_rows import FrictionRow
from evolvent.run.coarse_run import solved_run
from evolvent.run.pitch_run import pitch_of
from evolvent.scene.scene import Scene, load_scene, scene_from_text

COUNTS = 12, 20, 21, 33, 40
MANY = 160
SPUR = """
title = "spur pair"
[pair]
normal_module_mm = 2.5
normal_pressure_angle_deg = 20.0
[pinion]
teeth = 24
face_width_mm = 15.0
tip_relief_um = 20.0
[wheel]
teeth = 72
face_width_mm = 15.0
tip_relief_um = 20.0
[load]
torque_Nm = 150.0
[contact]
friction = [0.0, 0.1]
"""
PLASTIC = """
title = "plastic pinion on a steel wheel, spur"
[pair]
normal_module_mm = 1.0
normal_pressure_angle_deg = 20.0
[pinion]
teeth = 18
face_width_mm = 8.0
[wheel]
teeth = 40
face_width_mm = 8.0
[material.pinion]
E_GPa = 2.8
nu = 0.38
[load]
torque_Nm = 0.8
[contact]
friction = [0.0, 0.2]
"""
RELIEF = "pinion.tip_relief_um={0}", "wheel.tip_relief_um={0}"
PARABOLIC = 'pinion.tip_relief_form="parabolic"', 'wheel.tip_relief_form="parabolic"'


@dataclass(frozen=True)
class SpacingProblem:
    """A pair on one mesh."""

    name: str
    """As it is called in the table."""
    scene: Scene
    """At any number of positions."""

    def rows(self, positions: int) -> list[FrictionRow]:
        """The figures at so many positions, solved on this rank alone."""
        scene = scene_from_text(self.scene.resolved_toml(), [f"sweep.positions={positions}"])
        run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
        assert run is not None
        return friction_rows(run)


def problems() -> Iterator[SpacingProblem]:
    """Steel and plastic, spur and helical, with and without tip relief; each without friction and with it."""
    he = load_scene(DEMOS / "he2022.toml", ["contact.friction=[0.0, 0.1]"])
    yield SpacingProblem("steel, no relief", he)
    yield SpacingProblem("steel, linear relief", scene_from_text(SPUR))
    yield SpacingProblem("steel, parabolic relief", scene_from_text(SPUR, PARABOLIC))
    yield SpacingProblem("plastic, no relief", scene_from_text(PLASTIC))
    yield SpacingProblem("plastic, linear relief", scene_from_text(PLASTIC, relief(30)))
    yield SpacingProblem("helical, no relief", scene_from_text(HELICAL))
    yield SpacingProblem("helical, linear relief", scene_from_text(HELICAL, relief(20)))


def relief(depth: float) -> list[str]:
    """Overrides: so many µm off both tips."""
    return [setting.format(depth) for setting in RELIEF]


def measure_spacing(problem: SpacingProblem, counts: Sequence[int] = COUNTS, many: int = MANY) -> list[BarRow]:
    """One row a number of positions, figure and friction coefficient; a figure that is exactly zero without friction is
    left out. The reference's own error is its own bar."""
    exact = problem.rows(many)
    return [
        _row(f"{problem.name}, {count} positions", figure, own, best)
        for count in counts
        for own, best in zip(problem.rows(count), exact)
        for figure in FIGURES
        if not (figure == "loss_percent" and own.friction == 0.0)
    ]


def _row(case: str, figure: str, own: FrictionRow, best: FrictionRow) -> BarRow:
    value, reference = float(getattr(own, figure)), float(getattr(best, figure))
    bar, doubt = float(getattr(own.spacing_error, figure)), float(getattr(best.spacing_error, figure))
    return BarRow(case, figure, own.friction, value, bar, abs(value - reference), doubt)
