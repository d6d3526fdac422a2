"""Both programs on the same blow: the rows of a table, and the forces of a picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.linalg import eigh

from evidence.benchmarks.blow.calculix import by_calculix, natural_frequencies
from evidence.benchmarks.blow.problem import ALL, STEEL, WINDOW, Blow, ForceCourse, by_evolvent
from evidence.tables import Column, Table
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.mass_matrix import mass_matrix
from evolvent.results.drawing import style

BLOWS = Blow(5e-8, 130), Blow(2.5e-8, 260)
MODES, PENALTIES = (ALL, 100, 20), (3e5, 1e6, 3e6)
FREQUENCIES = 10
KEPT, SCATTER, PICTURE = "benchmark/blow.csv", "benchmark/blow_scatter.csv", "pictures/benchmark/blow.png"
"""Below docs/."""
COLOURS = {"Evolvent": style.WHEEL, "CalculiX": style.PINION}


@dataclass(frozen=True)
class Case:
    """A program, its setting, and what it found."""

    program: str
    setting: str
    course: ForceCourse
    reference: ForceCourse
    """Evolvent's with all modes and the same steps."""
    steps: int
    """That were asked for."""

    @property
    def row(self) -> BlowRow:
        """Its line of the table."""
        course, named = self.course, (self.program, self.setting, 1e9 * self.course.time_step)
        if len(course.force) < self.steps:
            return BlowRow(*named, nan, nan, nan, nan, nan, nan, f"stops after {1e6 * course.times[-1]:.2f} µs")
        begin, end = course.contact
        return BlowRow(
            *named, 1e6 * begin, 1e6 * end, 1e6 * course.impulse, float(course.mean.max()),
            course.difference(self.reference), course.energy, "",
        )


@dataclass(frozen=True)
class BlowRow:
    """A line of the table."""

    program: str
    setting: str
    step_ns: float
    begin_us: float
    end_us: float
    impulse: float
    """[mN·s/m], which is 1e-6 N·s/mm."""
    mean_force: float
    difference: float
    energy: float
    note: str
    """Why there are no numbers."""


TABLE: Table[BlowRow] = Table(
    BlowRow,
    (
        Column("", "program", words=True),
        Column("", "setting", words=True),
        Column("step [ns]", "step_ns", "g"),
        Column("first step with a force [µs]", "begin_us", ".3f"),
        Column("last [µs]", "end_us", ".3f"),
        Column("impulse [mN·s/m]", "impulse", ".1f"),
        Column(f"largest mean force over {1e6 * WINDOW:g} µs [N/mm]", "mean_force", ".1f"),
        Column("largest difference of the mean forces from the first line of the same step [%]", "difference", ".1%"),
        Column("energy left [%]", "energy", ".1%"),
    ),
)


def cases(blow: Blow, folder: Path) -> Iterator[Case]:
    """Evolvent's, then CalculiX's, with the steps of a blow."""
    reference = by_evolvent(blow, ALL)
    for modes in MODES:
        setting = "all modes" if modes == ALL else f"{modes} modes of each body"
        course = reference if modes == ALL else by_evolvent(blow, modes)
        yield Case("Evolvent", setting, course, reference, blow.steps)
    for penalty in PENALTIES:
        course = by_calculix(blow, penalty, folder)
        yield Case("CalculiX", f"penalty {penalty:.0e} N/mm³".replace("e+0", "e"), course, reference, blow.steps)


@dataclass(frozen=True)
class Scatter:
    """What differences between the programs are to be seen beside."""

    frequencies: int
    """The lowest natural frequencies of the block that is held."""
    frequency_difference: float
    """Their largest relative difference between the programs."""
    step_difference: float
    """Of Evolvent's averaged forces with all modes, where the step is halved, over the largest."""


def scatter(found: Sequence[Case], folder: Path) -> Scatter:
    """found: of both steps. Raises RunFailed."""
    coarse, fine = (next(case.reference for case in found if case.course.time_step == b.time_step) for b in BLOWS)
    change = np.abs(fine.mean[1::2] - coarse.mean).max() / coarse.mean.max()
    return Scatter(FREQUENCIES, frequency_difference(BLOWS[0], FREQUENCIES, folder), float(change))


def frequency_difference(blow: Blow, count: int, folder: Path) -> float:
    """Largest relative one of the lowest natural frequencies of the block that is held. Raises RunFailed."""
    body = Body(blow.bodies[1], STEEL, (Fixed("bottom"),))
    assembled = assemble(body)
    K, M = (A.tocsr()[assembled.free][:, assembled.free].toarray() for A in (assembled.stiffness, mass_matrix(body)))
    own = np.sqrt(eigh(K, M, eigvals_only=True, subset_by_index=(0, count - 1)))
    return float(np.abs(natural_frequencies(blow, count, folder) / own - 1.0).max())


def picture(shown: Sequence[Case]) -> Figure:
    """Forces over time, at each step and averaged."""
    with style.styled():
        see = (
            f"Steps of {1e9 * shown[0].course.time_step:g} ns. Left: the force at each step. Right: its mean over "
            f"{1e6 * WINDOW:g} µs."
        )
        figure = style.sheet("A block flies against a block", see, (10.0, 4.4))
        left, right = figure.subplots(1, 2, sharex=True, sharey=True)
        for case in shown:
            label, colour = f"{case.program}, {case.setting}", COLOURS[case.program]
            left.plot(1e6 * case.course.times, case.course.force, color=colour, lw=1.0, label=label)
            right.plot(1e6 * case.course.times, case.course.mean, color=colour, lw=1.5, label=label)
        left.set_ylabel("contact force [N/mm]")
        for axes in (left, right):
            axes.set_xlabel("time [µs]")
        right.legend()
    return figure
