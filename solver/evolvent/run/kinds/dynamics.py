"""The vibration of a scene's gears over the speed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from evolvent.dynamics.figures.all import EXCITATION_PICTURE, VIBRATION_PICTURES
from evolvent.dynamics.of_scene import check_vibration, drive_settings
from evolvent.dynamics.results.histories import HISTORIES, history_rows
from evolvent.dynamics.results.response import BRANCH, DYNAMICS, RESPONSE, branch_rows, response_rows, summary
from evolvent.dynamics.results.spectrum import SPECTRUM, spectrum_rows
from evolvent.dynamics.results.torque_map import TORQUE_MAP
from evolvent.fem.parallel.ranks import together
from evolvent.run.call import Call
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.dynamics.bodies import with_bodies
from evolvent.run.dynamics.excitation import EXCITATION_TABLES, SolvedExcitation, solved_excitation
from evolvent.run.dynamics.kept_positions import KEPT
from evolvent.run.dynamics.scene_torques import SceneTorques, scene_torques
from evolvent.run.dynamics.summary_lines import summary_lines
from evolvent.run.dynamics.vibration import SweptVibration, swept_vibration
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent.scene.vibration_limits import doubtful

BODIES = "gear bodies"
TABLES = *EXCITATION_TABLES, RESPONSE, BRANCH, DYNAMICS, SPECTRUM, HISTORIES, TORQUE_MAP


@dataclass(frozen=True)
class SolvedDynamics:
    """Excitation of a pair, and its vibration over the speed."""

    excitation: SolvedExcitation
    """Excitation under all torques."""
    vibration: SweptVibration | None
    """Vibration, on rank 0 alone."""


@dataclass(frozen=True)
class Dynamics(Computation[SolvedDynamics]):
    """The excitation by the mesh, then steady states, jumps, spectra and motions of a pair that runs up and down."""

    name: ClassVar[str] = "dynamics"
    command: ClassVar[str] = "dynamics"
    in_line_contact: ClassVar[bool] = True
    outputs: ClassVar[Outputs] = Outputs(
        tuple(table.name for table in TABLES), (EXCITATION_PICTURE, *VIBRATION_PICTURES), stored=KEPT,
        lines=summary_lines,
    )

    @property
    def heaviest(self) -> Scene:
        """The scene under the largest torque of its excitation."""
        return self._loads.heaviest

    def check(self) -> None:
        """Raises SceneError where the vibration cannot be computed, or one of the torques is refused."""
        check_vibration(self.scene)
        _ = self._loads

    def warnings(self) -> Iterator[str]:
        """Warnings on charts, flanks and tips, and on a vibration that is taken out of its range."""
        yield from (*super().warnings(), *doubtful(self._loads.scene.planned_vibration()))

    def solve(self, call: Call) -> SolvedDynamics:
        """Excitation, stored position by position, and the vibration on it. Raises NoSteadyState, too."""
        loads, section = self._loads, self._section
        settings = drive_settings(loads.problem.pair, section, loads.problem.driving)
        call.progress.stage(BODIES)
        settings = with_bodies(settings, loads.problem, section, call.comm)
        excitation = solved_excitation(call, loads)

        def swept() -> SweptVibration:
            return swept_vibration(excitation, loads, section, settings, call.progress)

        return SolvedDynamics(excitation, together(call.comm, lambda: swept() if call.comm.rank == 0 else None))

    def results(self, call: Call, solved: SolvedDynamics) -> Results:
        """Tables of excitation and vibration."""
        vibration = solved.vibration
        assert vibration is not None
        excited = list(solved.excitation.warnings)
        said = [*self.warnings(), *excited, *vibration.warnings]
        pair, swept, errors = vibration.own.drive, vibration.swept, vibration.errors
        facts = summary(pair, vibration.settings, swept, *vibration.share, vibration.iso, errors, tuple(said))
        tables = [
            *solved.excitation.tables(self._loads, super().warnings()),
            RESPONSE.of(response_rows(pair, swept, vibration.own.found, vibration.iso, errors)),
            BRANCH.of(branch_rows(pair, swept)), DYNAMICS.of(facts),
            SPECTRUM.of(spectrum_rows(pair, swept, vibration.own.found)),
            HISTORIES.of(history_rows(vibration.motions)), TORQUE_MAP.of(vibration.over_torque.rows),
        ]
        said = [*excited, *vibration.warnings]
        return Results(self._loads.scene, tables, said, timings=solved.excitation.timings)

    @cached_property
    def _loads(self) -> SceneTorques:
        """The scene under the torques of its excitation."""
        return scene_torques(self.scene, self._section.torque_percents)

    @property
    def _section(self) -> DynamicsSection:
        return self.scene.dynamics or DynamicsSection()
