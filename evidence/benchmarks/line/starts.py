"""`python -m evidence.benchmarks.line.starts [--small]`: Newton iterations and searches of the resolved
contact without friction, from the nominal contact lines, from the position before and from line contact, for
docs/line_contact.md."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from unittest.mock import patch

import numpy as np

from evidence.benchmarks.line.pairs import Case, case, relieved
from evidence.benchmarks.measuring import keep_rows
from evidence.scenes import HELICAL, SPUR
from evidence.tables import Column, Table
from evolvent.dynamics.excitation.loaded_mesh import searched_positions, under_torques
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.line.line_start import with_line_starts
from evolvent.gears.sweep import position_search
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent_meshes.arrays import Floats

QUICK = "mesh.level=quick"
CASES = (
    replace(case("He, plane", SPUR, (5.0, 30.0, 100.0), *relieved(20.0)), positions=20),
    replace(case("He, lead crowning", SPUR, (30.0, 100.0), *relieved(20.0), "pinion.lead_crowning_um=5", QUICK),
            positions=20),
    replace(case("Yang, relieved", HELICAL, (10.0, 30.0, 100.0), *relieved(60.0), QUICK), positions=20),
    case("Yang, relieved", HELICAL, (30.0, 100.0), *relieved(60.0)),
)
"""Pairs, those in the plane first."""


@dataclass(frozen=True)
class StartRow:
    """Cost of the positions of a pitch under a torque from three starts."""

    pair: str
    level: str
    torque_Nm: float
    positions: int
    without: int
    """Positions that have no start from line contact."""
    nominal_mean: float
    """Newton iterations of the first search of a position from the nominal contact lines, mean over the positions."""
    nominal_most: int
    last_mean: float
    """Iterations from the rotation and the contact patch of the position before, of all positions but the first one."""
    last_most: int
    line_mean: float
    """Iterations from line contact alone, of the positions that have such a start."""
    line_most: int
    nominal_searches: float
    """Searches of a position, mean over the positions."""
    last_searches: float
    line_searches: float
    nominal_seconds: float
    """Processor time of a position [s], mean over the positions."""
    last_seconds: float
    line_seconds: float
    differ_nm: float
    """Largest difference of the transmission error from the nominal contact lines and from line contact."""


def _mean(name: str) -> Column:
    label = {"nominal": "nominal lines", "last": "position before", "line": "line contact"}[name]
    return Column(
        f"iterations from {label}",
        lambda row: f"{getattr(row, name + '_mean'):.1f} ({getattr(row, name + '_most')})", words=True,
    )


def _three(label: str, names: str, digits: str) -> Column:
    starts = "nominal", "last", "line"
    return Column(label, lambda row: " / ".join(f"{getattr(row, f'{s}_{names}'):{digits}}" for s in starts), words=True)


TABLE = Table(StartRow, (
    Column("pair", "pair", words=True), Column("level", "level", words=True), Column("N·m", "torque_Nm", ".4g"),
    Column("positions", "positions", "d"), Column("without start", "without", "d"),
    _mean("nominal"), _mean("last"), _mean("line"),
    _three("searches a position", "searches", ".2f"), _three("processor time of a position [s]", "seconds", ".2g"),
    Column("apart [nm]", "differ_nm", ".2g"),
))


def case_rows(given: Case) -> Iterator[StartRow]:
    """A row a torque."""
    problem = given.problem
    angles = np.array(uniform_pitch(problem.pair.pinion.z, given.positions).angles)
    without = prepare_model(problem).model
    model = with_line_starts(without)
    assert model.starts is not None
    model.starts(model, 0.0)  # makes the compliance of the flanks, once for all positions
    for percent in given.percents:
        torque = problem.torque * percent / 100.0
        cold, lines = (under_torques(each, [torque])[0] for each in (without, model))
        nominal = _swept(_alone(cold, angles), cold)
        last = _swept(_one_after_the_other(cold, angles), cold)
        started = np.array([model.starts(lines, float(angle)) is not None for angle in angles])
        line = _swept(_alone(lines, angles[started]), lines)
        yield StartRow(
            given.name, problem.mesh.level, 1e-3 * torque, len(angles), int((~started).sum()),
            nominal.mean, nominal.most, last.after_first.mean, last.after_first.most, line.mean, line.most,
            nominal.searches, last.searches, line.searches, nominal.seconds, last.seconds, line.seconds,
            1e6 * float(np.abs(nominal.errors[started] - line.errors).max()),
        )


def _alone(model: GearModel, angles: Floats) -> Iterator[SharedPosition]:
    """Positions each by itself."""
    for angle in angles:
        yield shared_position(model, float(angle), (0.0, 0.0), [0.0], None, exact=True)


def _one_after_the_other(model: GearModel, angles: Floats) -> Iterator[SharedPosition]:
    for (position,) in searched_positions([model], angles):
        yield position


@dataclass(frozen=True, eq=False)
class _Swept:
    """Cost of positions and their transmission errors."""

    iterations: tuple[tuple[int, ...], ...]
    """Newton iterations of each search of each position."""
    seconds: float
    errors: Floats

    @property
    def mean(self) -> float:
        return float(np.mean([first for first, *_ in self.iterations]))

    @property
    def most(self) -> int:
        return max(first for first, *_ in self.iterations)

    @property
    def searches(self) -> float:
        return float(np.mean([len(each) for each in self.iterations]))

    @property
    def after_first(self) -> _Swept:
        return replace(self, iterations=self.iterations[1:])


def _swept(positions: Iterator[SharedPosition], model: GearModel) -> _Swept:
    """Solves positions, and counts the Newton iterations of their searches."""
    counts: list[int] = []
    iterations, errors, begin = [], [], time.process_time()
    with patch.object(position_search, "frictionless", _counted(counts)):
        for position in positions:
            iterations.append(tuple(counts))
            counts.clear()
            stand = position.contact.stand.turned(model.load.on, float(position.smooth.motion[0]))
            errors.append(stand.transmission_error)
    seconds = (time.process_time() - begin) / len(errors)
    return _Swept(tuple(iterations), seconds, np.array(errors))


def _counted(counts: list[int]) -> Callable[..., object]:
    solve = position_search.frictionless

    def counted(*arguments: object, **options: object) -> object:
        found = solve(*arguments, **options)  # type: ignore[arg-type]
        counts.append(found.iterations)
        return found

    return counted


def said(docs: Path) -> str:
    """The table for docs/line_contact.md."""
    return TABLE.markdown(TABLE.read(docs / "line_contact" / "starts.csv"))


def rows(small: bool) -> Iterator[StartRow]:
    """Rows of all pairs, or of two positions of the first one."""
    for each in [replace(CASES[0], positions=2, percents=(100.0,))] if small else CASES:
        yield from case_rows(each)


def main() -> None:
    """Measures all pairs."""
    keep_rows((__doc__ or "").partition(",")[0], "two positions of a pair in the plane", "starts", rows)


if __name__ == "__main__":
    main()
