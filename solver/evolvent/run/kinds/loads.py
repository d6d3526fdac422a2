"""A scene under a list of loads: a run for each, on gears that are condensed once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

from evolvent.gears.shared_gears import SharedGears
from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.results.tables.load_table import LOADS, LoadRuns, load_results, run_folder
from evolvent.run.call import Call
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.compute import compute
from evolvent.run.folder_checks import check_folder
from evolvent.run.kept_pitch import require_resumable
from evolvent.run.kinds.run import Run
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.load_cases import in_space_sentence, load_cases, under_cases, with_list
from evolvent.scene.scene import Scene
from evolvent.scene.schema.errors import InputProblem, SceneError

LOADS_PICTURE = TablePicture("loads.png", (LoadRuns(),), "evolvent.results.figures.load_list:loads_figure")


@dataclass(frozen=True)
class Loads(Computation[None]):
    """Runs under some loads, one after the other, each in a folder of its own."""

    runs: Mapping[str, Run]
    """Name of its folder -> run under each load, on meshes that serve all of them; the heaviest first."""
    name: ClassVar[str] = "loads"
    command: ClassVar[str] = "loads"
    in_line_contact: ClassVar[bool] = True
    outputs: ClassVar[Outputs] = Outputs((LOADS.name,), (LOADS_PICTURE,), stored=(LOADS.name,))
    is_list: ClassVar[bool] = True

    @classmethod
    def of(cls, scene: Scene, percents: Sequence[float] = ()) -> Self:
        """Runs of a scene under parts of its torque or the loads that it lists. percents: different ones. Raises
        SceneError where the gears wear, or where one of the loads is refused."""
        if scene.wear is not None:
            found, allowed = "a load list of gears that wear", "a scene without [wear]"
            raise SceneError([InputProblem("wear", found, allowed, "delete the section, or take `evolvent run`")])
        listed = with_list(scene, percents)
        scenes = reversed(under_cases(listed).items())
        return cls(listed, {run_folder(case): Run(each) for case, each in scenes})

    @property
    def sized(self) -> list[Scene]:
        """Scenes of all runs."""
        return [run.scene for run in self.runs.values()]

    def require_level(self) -> None:
        """Raises SceneError where its runs do."""
        for run in self.runs.values():
            run.require_level()

    def warnings(self) -> Iterable[str]:
        """A warning on loads in space beside those of the runs."""
        return in_space_sentence(self.scene, self.sized)

    def solve(self, call: Call) -> None:
        """Computes the runs; those that are complete stay. Collective; raises what `compute` does."""
        call.on_first(lambda: self._check_folders(call))
        gears = SharedGears([gear_problem(run.scene) for run in self.runs.values()])
        with call.beginning(self.scene, gears.prepare) as prepare:
            for name, run in self.runs.items():
                compute(run, call.folder.out / name, replace(call.options, prepare=prepare, label=name))

    def results(self, call: Call, solved: None) -> Results:
        """The table of all runs."""
        rows = [each.row for each in load_results(call.folder.out, load_cases(self.scene))]
        return Results(self.scene, [LOADS.of(rows)])

    def _check_folders(self, call: Call) -> None:
        """Raises FolderError and ArchiveError, before the first run is computed, where one cannot go on."""
        for name, run in self.runs.items():
            folder = call.folder.out / name
            check_folder(run, folder, call.options)
            if call.resume:
                require_resumable(run.scene, folder, self.command)
