"""A computation of a scene, such as a run or its root strength, as `compute`, `plot` and studies know it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar, Generic, Self, TypeVar

from evolvent.check.scene_warnings import flank_warnings
from evolvent.results.archive.run_cost import Cost, Timings
from evolvent.results.drawing.picture_files import Picture
from evolvent.results.drawing.table_pictures import TablePicture, from_tables
from evolvent.results.tables.table import Filled
from evolvent.run.call import Call
from evolvent.scene.chart_warnings import chart_warnings
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.line_level import require_resolved
from evolvent.scene.scene import Scene

Solved = TypeVar("Solved")


@dataclass(frozen=True)
class Outputs:
    """Files that a computation leaves below OUT, beside scene, log and cost."""

    tables: tuple[str, ...]
    """Names of its tables."""
    pictures: tuple[TablePicture, ...] = ()
    """Pictures that are drawn from its tables alone."""
    others: tuple[str, ...] = ()
    """Names of all other files but stored results."""
    stored: tuple[str, ...] = ()
    """Patterns of the stored results that `--resume` goes on from; the first one is there before all others."""
    lines: Callable[[Path], Iterable[str]] = lambda out: ()
    """Key figures in words, from the tables below OUT."""

    @property
    def results(self) -> tuple[str, ...]:
        """Names of all files that tell of results, without stored ones."""
        return *self.tables, *(f"pictures/{picture.name}" for picture in self.pictures), *self.others


@dataclass(frozen=True)
class Results:
    """Results of a computation, ready to be written."""

    scene: Scene
    """Scene as it was solved, on deflected flanks where its pitch needs them."""
    tables: Sequence[Filled] = ()
    """Tables with their rows, in the order of writing."""
    warnings: Sequence[str] = ()
    """Warnings on the results, a sentence each."""
    pictures: Sequence[Picture] = ()
    """Pictures beyond those from tables alone."""
    timings: Timings = field(default_factory=Timings)
    """Wall time of the stages before the output [s]."""
    complete: Callable[[Callable[[], Cost]], None] = lambda cost: None
    """Writes further files once tables and pictures are there. It is given a function that returns the cost of all that
    was computed so far. Raises WriteError, FolderError."""


@dataclass(frozen=True)
class Computation(ABC, Generic[Solved]):
    """A computation of one scene. `compute` gives all of them the same abilities: folder, lock, log, cost, progress,
    resuming, error bars by a coarse companion, tables, pictures."""

    scene: Scene
    """Scene to be computed."""
    name: ClassVar[str]
    """Name of the computation in a study."""
    command: ClassVar[str]
    """Command of the program that computes it."""
    outputs: ClassVar[Outputs]
    """Files that the computation leaves."""
    in_line_contact: ClassVar[bool] = False
    """Whether it can be computed in line contact."""
    is_list: ClassVar[bool] = False
    """Whether it consists of computations in folders of their own, which display their progress themselves."""

    @classmethod
    def of(cls, scene: Scene, percents: Sequence[float] = ()) -> Self:
        """The computation of a scene, whose wear is left out. percents: torques in percent of the scene's, where the
        computation takes several."""
        return cls(scene.model_copy(update={"wear": None}))

    @property
    def sized(self) -> Iterable[Scene]:
        """Scenes whose memory is looked at before anything is computed."""
        return [self.scene]

    def require_level(self) -> None:
        """Raises SceneError for line contact where the contact has to be resolved."""
        if not self.in_line_contact:
            require_resolved(self.scene.mesh, self.command)

    def check(self) -> None:
        """Refuses scenes that cannot be computed, before anything is written. On rank 0 alone. Raises InputError."""

    @property
    def heaviest(self) -> Scene:
        """The scene under the largest of its torques."""
        return max(self.sized, key=lambda scene: scene.load.torque_Nm)

    def warnings(self) -> Iterable[str]:
        """Warnings that are known before anything is computed, a sentence each: by default those on charts, flanks and
        tips, under the largest torque. On rank 0 alone."""
        yield from (*chart_warnings(self.heaviest), *flank_warnings(gear_problem(self.heaviest)))

    @abstractmethod
    def solve(self, call: Call) -> Solved:
        """Solves the scene and, where it asks for error bars, its coarse companion; each result is stored as soon as
        it is there. Collective. Raises NotConverged, SearchError, BalanceError, MeshError, ArchiveError, WriteError."""

    @abstractmethod
    def results(self, call: Call, solved: Solved) -> Results:
        """Tables, warnings, further pictures and files of the solution. On rank 0 alone."""

    def pictures(self, out: Path) -> Iterable[Picture]:
        """Pictures of a finished computation, to be drawn again from its folder. Raises SceneError, ArchiveError."""
        return from_tables(self.outputs.pictures, out)

    def lines(self, out: Path) -> Iterable[str]:
        """Key figures of a finished computation in words, to be printed at its end."""
        return self.outputs.lines(out)

    @property
    def files(self) -> Sequence[str]:
        """Names of tables and pictures that are named at the end, where they exist."""
        return self.outputs.results
