"""Flanks with levels of their own: against exact condensation of the very same cells, and against Hertz.

Exact condensation of Yang's pair at standard, split as its levels split it, takes a dense matrix of 14 GB for each
gear. So the two levels of standard are compared on a pair 4.6 mm wide, and the whole face at quick. Random pairs are
those of the campaign of random scenes, solved without friction.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import nan
from pathlib import Path

import numpy as np

from evidence.benchmarks.accuracy.same_cells import exact_model, fine_nodes, two_level_model
from evidence.benchmarks.accuracy.slice_peaks import slice_peaks
from evidence.robustness.campaigns.random_scenes import random_scene
from evidence.scenes import SPUR, WHOLE_WIDTH, helical_pair_of_width
from evidence.tables import markdown, read_rows
from evolvent.gears.gear_model import GearModel
from evolvent.gears.meshing.flank_levels import levelled_sector
from evolvent.gears.problem.gear_problem import RESOLVED, GearOptions, GearProblem, MeshSettings
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import load_scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

NARROW = 4.6
"""Face width of Yang's pair [mm] on which its line load is the same."""
MODIFIED = ("pinion.lead_crowning_um=5", "pinion.tip_relief_um=10", "pair.misalignment_um=10")
ERROR_BAR, SHARING_BAR = 2e-3, 1e-3
PEAK_BARS = {"nine in ten": 5e-3, "all": 2e-2}
HERTZ_BARS = {"quick": 0.05, "standard": 0.015, "fine": 0.01}
MOST_NODES = 3_000
"""Of the finest flank of a random pair."""
Positions = Sequence[tuple[PositionResult, ...]]


@dataclass(frozen=True)
class AccuracyRow:
    """A figure and what it must not exceed; both relative."""

    case: str
    """Gear pair, mesh level, friction coefficient."""
    what: str
    """Of which quantity, and of how many slices."""
    figure: float
    """Difference from the reference."""
    bar: float
    """NaN where there is none."""

    @property
    def met(self) -> bool:
        """Whether the figure is within its bar."""
        return not self.figure > self.bar


@dataclass(frozen=True)
class Case:
    """A gear pair on one mesh."""

    name: str
    """As in the table."""
    problem: GearProblem
    """With levels."""
    frictions: tuple[float, ...] = (0.0,)
    """Coefficients."""
    positions: int = 10
    """Of a pitch."""


@dataclass(frozen=True)
class Size:
    """What is measured."""

    against_hertz: tuple[Case, ...]
    compared: tuple[Case, ...]
    """With the same cells, condensed exactly."""
    random_pairs: int
    """So many more of them."""


def yang_case(mesh: MeshSettings, width: float, frictions: tuple[float, ...], *settings: str, name: str = "") -> Case:
    """Yang's pair of some face width [mm] under the line load of the whole one. settings: of the scene; name: of what
    they change."""
    problem = gear_problem(helical_pair_of_width(width, *settings))
    named = f"Yang{name}, {width:g} mm, {mesh.level}"
    return Case(named, replace(problem, mesh=replace(mesh, two_level=True)), frictions)


def he_case() -> Case:
    """He's spur pair, solved in space."""
    mesh, options = MeshSettings("quick", two_level=True), GearOptions(in_space=True)
    problem = replace(gear_problem(load_scene(SPUR, [])), mesh=mesh, options=options)
    return Case("He in space, quick", problem, positions=6)


def random_cases(count: int) -> Iterator[Case]:
    """The first helical scenes of the campaign, by seed, whose finest flanks have at most `MOST_NODES` nodes."""
    seed = 0
    while count > 0:
        problem = gear_problem(random_scene(seed, plane=False))
        problem = replace(problem, mesh=MeshSettings("quick", two_level=True))
        small = all(fine_nodes(levelled_sector(problem, member)) <= MOST_NODES for member in Member)
        if small and problem.pair.pinion.base_helix_angle > 0.0:
            yield Case(f"random pair {seed}, quick", problem, positions=3)
            count -= 1
        seed += 1


def rows(size: Size) -> Iterator[AccuracyRow]:
    """Against Hertz, then against the same cells."""
    for case in size.against_hertz:
        model = two_level_model(case.problem)
        yield from hertz_rows(case, model, solved(model, case))
    for case in (*size.compared, *random_cases(size.random_pairs)):
        yield from difference_rows(case)


def solved(model: GearModel, case: Case) -> Positions:
    """A pitch without repetitions: both ways begin alike."""
    pitch = uniform_pitch(model.pair.pinion.z, case.positions)
    return [p.results for p in sweep_pitch(model, pitch, case.frictions, initial_state(case.frictions))]


def hertz_rows(case: Case, model: GearModel, positions: Positions) -> Iterator[AccuracyRow]:
    """Fitted peaks against Hertz for each slice's own line load, at the first friction coefficient."""
    peaks = slice_peaks(model, positions)[0]
    error = np.abs(peaks.peak / peaks.hertz - 1.0)
    for part, kept in (("", np.ones(len(error), dtype=bool)), (", without face ends", ~peaks.near_end)):
        bars = {"nine in ten": HERTZ_BARS[case.problem.mesh.level], "median": nan, "all": nan}
        yield from _quantiles(case.name, f"peaks against Hertz{part}", error[kept], bars)


def difference_rows(case: Case) -> Iterator[AccuracyRow]:
    """A pitch on the levels against the same pitch on the same cells, condensed exactly."""
    levels = two_level_model(case.problem)
    found = solved(levels, case)
    exact = exact_model(case.problem, levels)
    wanted = solved(exact, case)
    both = zip(case.frictions, slice_peaks(levels, found), slice_peaks(exact, wanted), zip(*found), zip(*wanted))
    for friction, peaks, exact_peaks, own, other in both:
        name = f"{case.name}, μ = {friction:g}"
        yield AccuracyRow(name, "peak-to-peak transmission error", peak_to_peak_difference(own, other), ERROR_BAR)
        yield AccuracyRow(name, "mean transmission error", mean_difference(own, other), nan)
        yield AccuracyRow(name, "load sharing, of the load", sharing_difference(own, other), SHARING_BAR)
        error, near_end = peaks.differences(exact_peaks)
        yield from _quantiles(name, "peaks", error, PEAK_BARS)
        yield from _quantiles(name, "peaks beside face ends", error[near_end], dict.fromkeys(PEAK_BARS, nan))


def _quantiles(case: str, what: str, error: Floats, bars: Mapping[str, float]) -> Iterator[AccuracyRow]:
    """The median, nine in ten or all of the errors, as far as they are asked for; none of no slices."""
    share = {"median": 0.5, "nine in ten": 0.9, "all": 1.0}
    for name, bar in bars.items() if len(error) else ():
        yield AccuracyRow(case, f"{what}: {name} of {len(error)}", float(np.quantile(error, share[name])), bar)


def peak_to_peak_difference(found: Sequence[PositionResult], wanted: Sequence[PositionResult]) -> float:
    """Relative, of the transmission error."""
    own, other = (np.ptp([result.transmission_error for result in each]) for each in (found, wanted))
    return float(abs(own / other - 1.0))


def mean_difference(found: Sequence[PositionResult], wanted: Sequence[PositionResult]) -> float:
    """Relative, of the mean transmission error."""
    own, other = (np.mean([result.transmission_error for result in each]) for each in (found, wanted))
    return float(abs(own / other - 1.0))


def sharing_difference(found: Sequence[PositionResult], wanted: Sequence[PositionResult]) -> float:
    """The largest difference of a tooth pair's share of the load, at all positions."""
    return max(
        abs(_share(own, tooth) - _share(other, tooth))
        for own, other in zip(found, wanted)
        for tooth in np.union1d(own.contact.tooth, other.contact.tooth)
    )


def _share(result: PositionResult, tooth: int) -> float:
    """A tooth pair's part of the normal force."""
    c = result.contact
    force = c.pressure * c.weights
    return float(force[c.tooth == tooth].sum() / force.sum())


LEFT_OUT = {
    "peak-to-peak transmission error": "peak-to-peak transmission error",
    "load sharing, of the load": "load sharing, of the load",
    "peaks: nine in ten": "largest pressures of slices, nine in ten",
    "peaks: all": "the same, all",
}
"""Begin of `AccuracyRow.what` -> words of docs/two_level.md."""


def left_out(docs: Path) -> str:
    """The table of docs/two_level.md: how far pairs in levels are from the same cells, condensed exactly. Raises
    ValueError where nothing was measured."""
    path = docs / "benchmark" / "two_level.csv"
    measured, lines = read_rows(path, AccuracyRow), []
    for begin, words in LEFT_OUT.items():
        own = sorted((row for row in measured if row.what.startswith(begin)), key=lambda row: row.figure)
        if len(own) < 3:
            raise ValueError(f"{path}: wanted {begin!r} of three cases, found {len(own)}; measure `two-level`")
        figures = float(np.median([row.figure for row in own])), own[-3].figure, own[-2].figure, own[-1].figure
        lines.append([words, *(f"{100.0 * figure:.2g}" for figure in figures), own[-1].case])
    head = ["% of", f"median of {len(own)} cases", "all but two within", "all but one within", "largest", "of"]
    return markdown(head, lines, range(1, 5))


BOTH = (0.0, 0.3)
FULL = Size(
    against_hertz=tuple(yang_case(MeshSettings(level), WHOLE_WIDTH, (0.0,)) for level in RESOLVED),
    compared=(
        yang_case(MeshSettings("quick"), WHOLE_WIDTH, BOTH),
        replace(yang_case(MeshSettings("standard"), NARROW, BOTH), positions=5),
        yang_case(MeshSettings("quick"), NARROW, BOTH, *MODIFIED, name=" modified and misaligned"),
        he_case(),
    ),
    random_pairs=10,
)
TINY = replace(yang_case(MeshSettings("quick", 1.0), 2.8, (0.0,), *MODIFIED, name=" modified"), positions=2)
SMALL = Size(against_hertz=(TINY,), compared=(TINY,), random_pairs=0)
