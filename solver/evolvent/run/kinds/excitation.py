"""The excitation of a scene's gears: transmission error and mesh stiffness under a list of torques."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

from evolvent.dynamics.figures.all import EXCITATION_PICTURE
from evolvent.dynamics.of_scene import check_positions
from evolvent.run.call import Call
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.dynamics.excitation import EXCITATION_TABLES, SolvedExcitation, solved_excitation
from evolvent.run.dynamics.excitation_lines import excitation_lines
from evolvent.run.dynamics.kept_positions import KEPT
from evolvent.run.dynamics.scene_torques import SceneTorques, listed_torques
from evolvent.scene.scene import Scene


@dataclass(frozen=True)
class Excitation(Computation[SolvedExcitation]):
    """Positions of a pitch without friction, under each of a list of torques."""

    loads: SceneTorques
    """The scene under its torques."""
    name: ClassVar[str] = "excitation"
    command: ClassVar[str] = "excitation"
    in_line_contact: ClassVar[bool] = True
    outputs: ClassVar[Outputs] = Outputs(
        tuple(table.name for table in EXCITATION_TABLES), (EXCITATION_PICTURE,), stored=KEPT, lines=excitation_lines
    )

    @classmethod
    def of(cls, scene: Scene, percents: Sequence[float] = ()) -> Self:
        """Excitation of a scene under parts of its torque or the loads that it lists. Raises SceneError where one of
        them is refused, or for loads of different misalignment."""
        return cls.under(listed_torques(scene, percents))

    @classmethod
    def under(cls, loads: SceneTorques) -> Self:
        """Excitation of a scene under its torques."""
        return cls(loads.scene, loads)

    @property
    def heaviest(self) -> Scene:
        """The scene under the largest torque."""
        return self.loads.heaviest

    def check(self) -> None:
        """Raises SceneError for a number of positions without harmonics."""
        check_positions(self.scene)

    def solve(self, call: Call) -> SolvedExcitation:
        """Excitation on both kinds of meshes, see `Computation.solve`."""
        return solved_excitation(call, self.loads)

    def results(self, call: Call, solved: SolvedExcitation) -> Results:
        """Tables of the excitation."""
        return Results(
            self.scene, solved.tables(self.loads, self.warnings()), solved.warnings, timings=solved.timings
        )
