"""Wear of a scene's flanks: blocks of cycles, and the pitch of the unworn pair beside them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar, Self

from evolvent.dynamics.figures.all import OPERATION_PICTURE
from evolvent.dynamics.operating_point import OperatingPoint
from evolvent.dynamics.results.operation import OPERATION_TABLES
from evolvent.results.drawing.picture_files import Picture
from evolvent.run.call import Call
from evolvent.run.computation import Outputs, Results
from evolvent.run.kept_pitch import STORED
from evolvent.run.kinds.run import TABLES, Run, SolvedRun
from evolvent.run.wear_run import wear_scene
from evolvent.scene.line_level import require_resolved
from evolvent.scene.scene import Scene
from evolvent.scene.skips import wanted_output
from evolvent.wear.results.archive import BLOCKS, FILE, VIBRATION
from evolvent.wear.results.report import WEAR, read_worn, wear_report


@dataclass(frozen=True)
class Wear(Run):
    """A run of a scene whose flanks wear."""

    name: ClassVar[str] = "wear"
    in_line_contact: ClassVar[bool] = False
    outputs: ClassVar[Outputs] = Outputs(
        (*TABLES, WEAR.name), (OPERATION_PICTURE,), (*OPERATION_TABLES, BLOCKS.name, VIBRATION.name),
        (FILE, *STORED, "results/errors.npz"),
    )

    @classmethod
    def of(cls, scene: Scene, percents: Sequence[float] = ()) -> Self:
        """The wear of a scene with a section [wear]."""
        return cls(scene)

    def require_level(self) -> None:
        """Raises SceneError for line contact: wear needs the pressure across the contact."""
        require_resolved(self.scene.mesh, "run with [wear]")

    def results(self, call: Call, solved: SolvedRun) -> Results:
        """Tables and pictures of the unworn pair, and of the finished study."""
        own, study = super().results(call, solved), read_worn(call.folder.out)
        drawn = self._worn_pictures(call.folder.out) if wanted_output(self.scene).pictures else ()
        return replace(own, tables=[*own.tables, WEAR.of(wear_report(study))], pictures=[*own.pictures, *drawn])

    def pictures(self, out: Path) -> Iterable[Picture]:
        """Pictures of the unworn pair, and of the finished study."""
        return [*super().pictures(out), *self._worn_pictures(out)]

    def _worn_pictures(self, out: Path) -> Iterable[Picture]:
        from evolvent.wear.results.figures import pictures  # matplotlib takes a second to import

        return pictures(read_worn(out))

    def _pitch(self, call: Call, point: OperatingPoint | None) -> SolvedRun:
        """Solves and stores all blocks. Collective."""
        meshes, timings = wear_scene(call, self.scene, point)
        return SolvedRun(self.scene, call.archive(self.scene), meshes, timings)
