"""Friction loss of solved pitches: their figures with error bars, and warnings on them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from evolvent.gears.solution.certified_pitch import ON_DEFLECTED
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import RELIEVE, about_spacing, tip_edge_contact
from evolvent.results.tables.summary_rows import FrictionRow
from evolvent.run.solved_pitches import SolvedPitches, companion_of
from evolvent.scene.scene import Scene
from evolvent.scene.skips import skips


@dataclass(frozen=True, eq=False)
class PitchFigures:
    """A pitch under one torque."""

    run: RunData
    """The pitch with its error bars."""
    rows: Sequence[FrictionRow]
    """Figures of the pitch, a row a friction coefficient."""


def pitch_figures(solved: Sequence[SolvedPitches]) -> list[PitchFigures]:
    """Figures of solved pitches. On rank 0 alone. Raises ArchiveError."""
    runs = (load.run_data(companion_of(load.coarse)) for load in solved)
    return [PitchFigures(run, friction_rows(run)) for run in runs]


def loss_warnings(
    scene: Scene, solved: Sequence[SolvedPitches], figures: Sequence[PitchFigures]
) -> Iterator[str]:
    """Warnings on the pitches of a scene under several torques, the lightest first: on deflected flanks, on a failed
    companion, on edges that bear and on the spacing of positions. figures: of `pitch_figures`."""
    if any(load.fine.solved.deflected for load in solved) and skips(scene, "deflected-flanks"):
        yield ON_DEFLECTED
    yield from dict.fromkeys(load.coarse.reason for load in solved if load.coarse.reason)
    yield from _about_heaviest(figures)


def _about_heaviest(figures: Sequence[PitchFigures]) -> Iterator[str]:
    """Warnings on edges that bear and on the spacing of positions, for the heaviest torque that has them."""
    edges, spaced = "", ""
    for each in figures:
        under = f"under {each.run.scene.load.torque_Nm:.4g} N·m"
        if found := tip_edge_contact(each.run):
            edges = f"{found}, {under}: the friction of edges, where pressures are singular, is in the loss; {RELIEVE}."
        said = about_spacing(each.run, each.rows, ["loss_percent"])
        spaced = next((f"{under}: {sentence}" for sentence in said), spaced)
    yield from filter(None, (edges, spaced))
