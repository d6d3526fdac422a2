"""The pitch of a scene and that of its coarse companion, both stored, as the figures with error bars need them."""

from __future__ import annotations

from dataclasses import dataclass, replace

from evolvent.results.archive.archive import COARSE
from evolvent.results.archive.run_cost import Timings
from evolvent.results.error_bars.estimation import Companion, estimated_errors
from evolvent.results.run_data import RunData
from evolvent.run.call import Call
from evolvent.run.companion import Attempt, WithCompanion
from evolvent.run.kept_pitch import COMPANION, KeptPitch, Meshes, kept_pitch
from evolvent.scene.scene import Scene
from evolvent.scene.skips import wanted_output


@dataclass(frozen=True)
class SolvedPitches(WithCompanion[KeptPitch]):
    """The pitch of a scene, and that of its coarse companion."""

    @property
    def timings(self) -> Timings:
        """Wall time of both [s]."""
        return replace(self.fine.timings, error_bars=self.coarse.seconds)

    def run_data(self, companion: Companion) -> RunData:
        """The pitch with its figures and, where its scene asks for them, error bars. On rank 0 alone. companion: of
        `companion_of`."""
        run = self.fine.run_data()
        wanted = wanted_output(self.fine.scene).error_bars
        return replace(run, errors=estimated_errors(run, companion)) if wanted else run


def solved_pitches(call: Call, scene: Scene, part: str = "", companion: Meshes = COMPANION) -> SolvedPitches:
    """Solves and stores both pitches. Collective; raises as `kept_pitch`.

    part: of the archive; that of the companion is `COARSE` before it.
    companion: its meshes, and whether every second position is enough.
    """
    fine, coarse = kept_pitch(call, scene, Meshes(part=part)), replace(companion, part=COARSE + part)
    return SolvedPitches(fine, call.companion(scene, lambda: kept_pitch(call, fine.scene, coarse)))


def companion_of(coarse: Attempt[KeptPitch]) -> Companion:
    """The coarse companion of a run with its figures. On rank 0 alone. Raises ArchiveError."""
    return Companion(None if coarse.value is None else coarse.value.run_data(), coarse.reason, coarse.seconds)
