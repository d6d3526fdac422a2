"""Cases of a transient on disk: a call that was stopped resumes with those that are missing.

    OUT/results/transient_1500rpm_0.npz    a speed whose motion has ended, at the first friction coefficient
    OUT/results/transient_coarse_*.npz, transient_finer_*.npz     the same of the companion that gives the error bars

Cases depend on the scene but for its list of speeds, to which more can be added; by default they depend on the highest
speed, too: time steps at it say which natural modes move (`dynamics.transient.driven_pair`). They depend on
all friction coefficients, as the damping is that of the statics at the first one.

A case is written when it ends, by the rank that computed it. Ranks write files of their own; the list of files in the
folder takes each one's line whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from evolvent.dynamics.transient.divided_steps import StepsTaken
from evolvent.dynamics.transient.pair_transient import PairMoment
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.dynamics.transient.step_balance import Residuals, StepEnergies
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.archive import fingerprint
from evolvent.results.archive.position_arrays import archived_result, result_arrays
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.store import Arrays, Store
from evolvent.results.tables.table import SCENE_TITLE
from evolvent.run.dynamics.transient.checks import transient_section
from evolvent.scene.differences import differences
from evolvent.scene.scene import Scene, SceneError, kept_scene
from evolvent_meshes.gears.pair import GearPair

CASES = "results/transient_*.npz"
"""Pattern of the files of all cases."""
COARSE, FINER_STEPS = "_coarse", "_finer"
"""Kinds of cases of the companion: in the time steps of the scene, and in shorter ones."""
BEGINNING = "beginning/"


@dataclass(frozen=True)
class KeptCases:
    """Archived cases of a scene."""

    cases: Store
    """Files with the identity of everything in the scene that a case depends on."""
    names: tuple[str, ...]
    """Names of the cases by their numbers: every speed at every friction coefficient."""
    pair: GearPair
    """Geometry of the gear pair."""
    kind: str = ""
    """Kind of the cases: empty for those that are reported, else `COARSE` or `FINER_STEPS`."""

    @staticmethod
    def of(scene: Scene, pair: GearPair, out: Path, kind: str = "") -> KeptCases:
        """Archived cases of a scene with a section [transient], below OUT. kind: empty for those that are reported,
        else `COARSE` or `FINER_STEPS`."""
        section = transient_section(scene)
        names = [f"{speed:.17g}rpm_{i}" for speed in section.speeds_rpm for i in range(len(scene.contact.friction))]
        highest = (max(section.speeds_rpm),) if section.modes_per_harmonic is None else ()
        identity = fingerprint(scene.changed("transient", speeds_rpm=highest))
        cases = Store(RunFolder(out), identity, partial(another, scene))
        return KeptCases(cases, tuple(names), pair, kind)

    def read(self) -> dict[int, MeshPeriods]:
        """Number of a finished case -> its mesh periods. Raises ArchiveError."""
        read = {number: self.cases.read(self._name(name), self._periods) for number, name in enumerate(self.names)}
        return {number: periods for number, periods in read.items() if periods is not None}

    def write(self, number: int, found: MeshPeriods) -> None:
        """Archives a case. Raises WriteError, FolderError."""
        arrays = _moments_arrays(found.moments, "") | _moments_arrays(found.beginning, BEGINNING) | {
            "errors": found.errors, "changes": found.changes, "wanted": found.wanted,
            "residuals": astuple(found.residuals), "lowest_error": found.lowest_error,
        }
        self.cases.write(self._name(self.names[number]), arrays)

    def _name(self, what: str) -> str:
        return f"results/transient{self.kind}_{what}.npz"

    def _periods(self, arrays: Arrays) -> MeshPeriods:
        return MeshPeriods(
            self._moments(arrays, ""), arrays["errors"], arrays["changes"], float(arrays["wanted"]),
            Residuals(*arrays["residuals"].tolist()), float(arrays["lowest_error"]), self._moments(arrays, BEGINNING),
        )

    def _moments(self, arrays: Arrays, start: str) -> tuple[PairMoment, ...]:
        columns = (arrays[start + name].tolist() for name in ("moments", "balances", "energies", "steps"))
        return tuple(
            PairMoment(time, result, force, rate, Residuals(*balances), StepEnergies(*energies), _steps(*steps))
            for result, (time, force, rate), balances, energies, steps in zip(self._positions(arrays, start), *columns)
        )

    def _positions(self, arrays: Arrays, start: str) -> list[PositionResult]:
        return [archived_result(arrays, f"{start}{k}/", self.pair) for k in range(int(arrays[f"{start}positions"]))]


def another(scene: Scene, path: Path) -> str:
    """Message on an archived case of another scene than this one, with the keys that differ from the scene of the
    folder."""
    try:
        differing = differences(kept_scene(path.parent.parent / SCENE_TITLE.name), scene)
    except SceneError:
        differing = ""
    difference = f": this one has {differing}" if differing else ""
    return (
        f"{path}: wanted a result of this scene, found that of another one{difference}; --resume goes on with the "
        "scene and the settings that it was called with, to which lower speeds may be added, with "
        "transient.modes_per_harmonic higher ones, too; --out names another folder, --overwrite computes anew"
    )


def _steps(accepted: float, rejected: float, *others: float) -> StepsTaken:
    """Counts and figures of the time steps from an archived row of numbers."""
    return StepsTaken(int(accepted), int(rejected), *others)


def _moments_arrays(moments: Sequence[PairMoment], start: str) -> Arrays:
    columns = {
        "moments": [(moment.time, moment.mesh_force, moment.rate) for moment in moments],
        "balances": [astuple(moment.residuals) for moment in moments],
        "energies": [astuple(moment.energies) for moment in moments],
        "steps": [astuple(moment.steps) for moment in moments],
    }
    results = _positions_arrays([moment.result for moment in moments], start)
    return results | {f"{start}{name}": np.asarray(column) for name, column in columns.items()}


def _positions_arrays(results: Sequence[PositionResult], start: str) -> Arrays:
    named = [(f"{start}{k}/", result_arrays(result)) for k, result in enumerate(results)]
    positions = {f"{place}{name}": np.asarray(value) for place, arrays in named for name, value in arrays.items()}
    return positions | {f"{start}positions": np.asarray(len(results))}
