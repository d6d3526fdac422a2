"""Contact fatigue of a scene's flanks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

from evolvent.gears.pressure.contact_cells import coarse_contact
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED
from evolvent.results.mesh_facts import cells_across
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import RELIEVE, about_spacing, tip_edge_contact
from evolvent.run.call import Call
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.kept_pitch import COMPANION, STORED
from evolvent.run.solved_pitches import SolvedPitches, companion_of, solved_pitches
from evolvent.run.strength.fatigue_lines import fatigue_lines
from evolvent.scene.schema.fatigue import FatigueSection
from evolvent.scene.skips import wanted_output
from evolvent.strength.fatigue.flank_fatigue import FatigueMaterial, FlankFatigue, fatigue_of_both
from evolvent.strength.fatigue.flank_loads import FlankLoads, LoadedPosition
from evolvent.strength.results.fatigue_facts import FATIGUE_FACTS, fatigue_facts, warnings_of
from evolvent.strength.results.fatigue_rows import FATIGUE, FATIGUE_DEPTH, FATIGUE_LIFE, FATIGUE_MAP, FATIGUE_SECTION
from evolvent.strength.results.fatigue_tables import depth_rows, fatigue_rows, life_rows, map_rows, section_rows
from evolvent.strength.results.friction_fatigue import FrictionFatigue, zone_ends
from evolvent.strength.results.pictures import FATIGUE_PICTURE

TABLES = FATIGUE, FATIGUE_LIFE, FATIGUE_MAP, FATIGUE_DEPTH, FATIGUE_SECTION, FATIGUE_FACTS


@dataclass(frozen=True)
class Fatigue(Computation[SolvedPitches]):
    """The pitch of a run, and criteria of fatigue over flank and depth under its pressures and friction."""

    name: ClassVar[str] = "fatigue"
    command: ClassVar[str] = "fatigue"
    outputs: ClassVar[Outputs] = Outputs(
        tuple(table.name for table in TABLES), (FATIGUE_PICTURE,), stored=STORED, lines=fatigue_lines
    )

    def solve(self, call: Call) -> SolvedPitches:
        """Both pitches, see `Computation.solve`. Changes with friction are compared between meshes at the worst of all
        positions, so that the companion has them all."""
        return solved_pitches(call, self.scene, companion=replace(COMPANION, thinned=False))

    def results(self, call: Call, solved: SolvedPitches) -> Results:
        """Tables of the criteria, and warnings where figures do not hold."""
        companion = companion_of(solved.coarse)
        run, beside = solved.run_data(companion), companion.run
        found = [_fatigue(run, k, run.errors.bar("max_pressure_MPa", k), beside) for k in range(len(run.frictions))]
        facts = [
            fatigue_facts(run.pair, each, _positions(run, k), run.inner_path, _materials(run))
            for k, each in enumerate(found)
        ]
        tables = (
            FATIGUE.of(fatigue_rows(run.pair, found)), FATIGUE_LIFE.of(life_rows(found, _section(run).exponents)),
            FATIGUE_MAP.of(map_rows(run.pair, found)), FATIGUE_DEPTH.of(depth_rows(run.pair, found)),
            FATIGUE_SECTION.of(section_rows(run.pair, found)), FATIGUE_FACTS.of(facts),
        )
        said = [ON_DEFLECTED] if solved.fine.scene != self.scene else []
        said += [run.errors.missing] if wanted_output(self.scene).error_bars and run.errors.missing else []
        said += [*_about(run), *(sentence for pair in zip(facts, found) for sentence in warnings_of(*pair))]
        return Results(solved.fine.scene, tables, said, timings=solved.timings)


def _about(run: RunData) -> Iterator[str]:
    """Warnings on the pressures from which fatigue is computed."""
    if edges := tip_edge_contact(run):
        yield f"{edges}: what lies within the tip-edge zones has no figures; {RELIEVE}."
    yield from coarse_contact(cells_across(run))
    yield from about_spacing(run, friction_rows(run), ["max_pressure_MPa"])


def _section(run: RunData) -> FatigueSection:
    return run.scene.fatigue or FatigueSection()


def _positions(run: RunData, index: int) -> list[LoadedPosition]:
    """Loaded positions of the pitch at the friction coefficient with this index."""
    return [
        LoadedPosition(k, each[index].result, each[index].cut, run.flank.z) for k, each in enumerate(run.positions)
    ]


def _fatigue(run: RunData, index: int, error: float, coarse: RunData | None) -> FrictionFatigue:
    """Fatigue of both flanks at the friction coefficient with this index. error: of the largest pressure [MPa]."""
    gears = _flanks(run, index, run.inner_path)
    ends = zone_ends(run.pair, run.inner_path)
    largest = float(gears[0].loads.peak.max(initial=0.0)) or float("nan")
    beside = None if coarse is None else _flanks(coarse, index, run.inner_path)
    return FrictionFatigue(run.frictions[index], gears, error / largest, ends, beside)


def _flanks(run: RunData, index: int, inner: tuple[float, float]) -> tuple[FlankFatigue, FlankFatigue]:
    """Fatigue of the flanks of pinion and wheel. inner: roll distances [mm] between the tip-edge zones."""
    section, friction = _section(run), run.frictions[index]
    loads = FlankLoads.joined([each.loads(inner) for each in _positions(run, index)])
    return fatigue_of_both(loads, friction, section.depths, _materials(run))


def _materials(run: RunData) -> tuple[FatigueMaterial, FatigueMaterial]:
    """Materials of pinion and wheel for the criteria."""
    section = _section(run)
    pinion, wheel = (
        FatigueMaterial(
            each.poissons_ratio, each.lame[1], section.yield_stress_MPa, section.tension_factor,
            section.compression_factor, section.normal_factor,
        )
        for each in run.scene.materials()
    )
    return pinion, wheel
