"""The vibration of a scene's gears over speed and torque: the same force surface and gears under other static loads."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.oscillator.steady_state import NoSteadyState
from evolvent.dynamics.pair_model import DriveSettings, drive
from evolvent.dynamics.results.torque_map import MapRow, map_rows
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.run.dynamics.speeds import sweep_at
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class TorqueMap:
    """Rows of torque_map.csv, and warnings on them."""

    rows: tuple[MapRow, ...]
    """Rows of the map, those of the lightest torque first."""
    warnings: tuple[str, ...]
    """Warnings on the rows, a sentence each."""


def torque_map(
    excitation: MeshExcitation,
    problem: GearProblem,
    settings: DriveSettings,
    torques: Sequence[float],
    speeds: Floats,
    computed: Callable[[], None] = lambda: None,
) -> TorqueMap:
    """The pair under torques (m,) [N·mm], at most the heaviest of the excitation, at ascending speeds (n,) [r/min]. One
    without steady states to be found has no rows and a warning: the others are not lost for it.

    problem: its pair, and the gear that the torque is on.
    computed: called after each torque.
    """
    rows: list[MapRow] = []
    warnings: list[str] = []
    for torque in sorted(torques):
        pair = drive(problem.pair, excitation, torque / problem.base_radius, settings)
        try:
            rows += map_rows(1e-3 * torque, pair, sweep_at(pair, speeds))
        except NoSteadyState as error:
            warnings.append(f"torque_map.csv: nothing under {1e-3 * torque:.4g} N·m: {error}")
        computed()
    if settings.mesh == "force_surface":
        warnings += _beyond(rows, float(excitation.loaded.forces[-1]))
    return TorqueMap(tuple(rows), tuple(warnings))


def _beyond(rows: Sequence[MapRow], heaviest: float) -> list[str]:
    """Warning of torques under which the mesh force leaves the force surface. heaviest: load of its heaviest torque
    [N]."""
    shares: dict[float, float] = {}
    for row in rows:
        shares[row.torque_Nm] = max(row.largest_force_N / heaviest, shares.get(row.torque_Nm, 0.0))
    beyond = [f"{torque:.4g} N·m ({share:.3g} times)" for torque, share in shares.items() if share > 1.0]
    if not beyond:
        return []
    return [
        f"torque_map.csv: the largest mesh force is beyond that of the heaviest torque under {', '.join(beyond)}; "
        "there it goes on straight. Add heavier torques to dynamics.torque_percents"
    ]
