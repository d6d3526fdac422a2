"""The part of the error bars that comes from the spacing of positions, against true errors.

Figures of seven pairs at 12 to 40 positions a pitch, even and odd numbers, and at 160 on the same mesh. Each is solved
by itself: with friction a position depends on those before it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from evidence.benchmarks.accuracy.error_bars import FIGURES, SCENES, BarRow, known, solved
from evidence.checkout import DEMOS
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.summary_rows import FrictionRow
from evolvent.scene.scene import Scene, load_scene, scene_from_text

FULL, SMALL = ((12, 20, 21, 33, 40), 160), ((6, 12), 24)
"""Numbers of positions a pitch, and that of the reference."""
SPUR, PLASTIC = SCENES / "spur.toml", SCENES / "plastic.toml"
HELICAL = SCENES / "narrow_helical.toml"
RELIEF = "pinion.tip_relief_um={0}", "wheel.tip_relief_um={0}"
PARABOLIC = 'pinion.tip_relief_form="parabolic"', 'wheel.tip_relief_form="parabolic"'


@dataclass(frozen=True)
class SpacingProblem:
    """A pair on one mesh."""

    name: str
    """As it is called in the table."""
    scene: Scene
    """At any number of positions."""

    def rows(self, positions: int) -> list[FrictionRow]:
        """The figures at so many positions, solved on this rank alone."""
        scene = scene_from_text(self.scene.resolved_toml(), [f"sweep.positions={positions}"])
        return friction_rows(solved(scene))


def problems() -> Iterator[SpacingProblem]:
    """Steel and plastic, spur and helical, with and without tip relief; each without friction and with it."""
    he = load_scene(DEMOS / "he2022.toml", ["contact.friction=[0.0, 0.1]"])
    yield SpacingProblem("steel, no relief", he)
    yield SpacingProblem("steel, linear relief", load_scene(SPUR))
    yield SpacingProblem("steel, parabolic relief", load_scene(SPUR, PARABOLIC))
    yield SpacingProblem("plastic, no relief", load_scene(PLASTIC))
    yield SpacingProblem("plastic, linear relief", load_scene(PLASTIC, relief(30)))
    yield SpacingProblem("helical, no relief", load_scene(HELICAL))
    yield SpacingProblem("helical, linear relief", load_scene(HELICAL, relief(20)))


def relief(depth: float) -> list[str]:
    """Overrides: so many µm off both tips."""
    return [setting.format(depth) for setting in RELIEF]


def measure_spacing(problem: SpacingProblem, counts: Sequence[int], many: int) -> list[BarRow]:
    """One row a number of positions, figure and friction coefficient, without those that are `known`. The reference's
    own error is its own bar."""
    exact = problem.rows(many)
    rows = [
        _row(f"{problem.name}, {count} positions", figure, row, best)
        for count in counts
        for row, best in zip(problem.rows(count), exact)
        for figure in FIGURES
    ]
    return [row for row in rows if not known(row)]


def _row(case: str, figure: str, row: FrictionRow, best: FrictionRow) -> BarRow:
    value, reference, bar, doubt = (
        float(getattr(each, figure)) for each in (row, best, row.spacing_error, best.spacing_error)
    )
    return BarRow(case, figure, row.friction, value, bar, abs(value - reference), doubt)
