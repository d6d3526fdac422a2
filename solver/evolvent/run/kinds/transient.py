"""Transient contact of a scene's gears: contact with inertia, over time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from evolvent.dynamics.figures.all import TRANSIENT_PICTURES
from evolvent.dynamics.of_scene import check_positions, drive_settings
from evolvent.dynamics.results.transient.beginning import TRANSIENT_START, beginnings, start_rows
from evolvent.dynamics.results.transient.cases import CasePressures, TransientCase, case_pressures, elements_across
from evolvent.dynamics.results.transient.errors import MovingCompanion, case_errors
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS, TransientFacts, sentences, transient_facts
from evolvent.dynamics.results.transient.rows import TRANSIENT, TRANSIENT_TEETH, tooth_rows, transient_rows
from evolvent.dynamics.transient.own_frequency import own_frequency
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.gears.pressure.contact_cells import coarse_contact
from evolvent.results.drawing.picture_files import Picture
from evolvent.run.call import Call
from evolvent.run.companion import Attempt
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.dynamics.transient.cases import OWN, PairCases
from evolvent.run.dynamics.transient.checks import require_possible, transient_section, unused_keys
from evolvent.run.dynamics.transient.kept_cases import CASES, KeptCases
from evolvent.run.dynamics.transient.moving_companion import moving_companion
from evolvent.run.dynamics.transient.summary_lines import summary_lines
from evolvent.run.kept_pitch import STORED
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent.scene.skips import wanted_output
from evolvent.scene.vibration_limits import doubtful

ANIMATION = "field_of_action.gif"
TABLES = TRANSIENT, TRANSIENT_TEETH, TRANSIENT_START, TRANSIENT_FACTS
UNLIKE_STATICS = (
    "The pitch without inertia does not balance along normals before deflection: it was solved on deflected flanks "
    "(skip deflected-flanks). Motions are computed along normals before deflection; period_energy_error of "
    "transient.json is what they lose."
)


@dataclass(frozen=True)
class SolvedCases:
    """Motions of a pair at each speed and friction coefficient."""

    own: PairCases
    """Cases on the meshes of the scene."""
    found: Mapping[int, MeshPeriods]
    """Number of a case -> its mesh periods; on rank 0 alone."""
    companion: Attempt[MovingCompanion]
    """Motions on the meshes of the error bars."""


@dataclass(frozen=True)
class Transient(Computation[SolvedCases]):
    """Contact with inertia at each speed and friction coefficient, until the motion repeats with the mesh. The ranks
    share speeds and coefficients."""

    name: ClassVar[str] = "transient"
    command: ClassVar[str] = "transient"
    outputs: ClassVar[Outputs] = Outputs(
        tuple(table.name for table in TABLES), TRANSIENT_PICTURES, (f"pictures/{ANIMATION}",), (*STORED, CASES),
        summary_lines,
    )

    def check(self) -> None:
        """Raises InputError without a section [transient]; SceneError for a start from rest without a backlash, for too
        many modes, and for a number of positions without harmonics."""
        transient_section(self.scene)
        check_positions(self.scene)
        require_possible(self.scene)

    def warnings(self) -> Iterator[str]:
        """Warnings on charts, flanks and tips, on keys without effect, and on a vibration that is taken out of its
        range."""
        yield from (*super().warnings(), *unused_keys(self.scene.dynamics or DynamicsSection()))
        yield from doubtful(self.scene.planned_vibration())

    def solve(self, call: Call) -> SolvedCases:
        """Statics and cases on both kinds of meshes, see `Computation.solve`. Raises BackFlanks and Unbalanced, too."""
        pair = self.scene.gear_pair()
        settings = drive_settings(pair, self.scene.dynamics or DynamicsSection())

        def kept(kind: str = "") -> KeptCases:
            return KeptCases.of(self.scene, pair, call.folder.out, kind)

        if call.resume:
            call.on_first(kept().read)  # cases of another scene are refused before anything is removed
        own = PairCases.of(call, self.scene, settings, OWN, call.progress)
        found = own.found(kept())
        companion = call.companion(self.scene, lambda: moving_companion(call, self.scene, settings, kept))
        return SolvedCases(own, found, companion)

    def results(self, call: Call, solved: SolvedCases) -> Results:
        """Tables of the motions, and the animation of that with the largest mesh force."""
        own, pair = solved.own, solved.own.pair
        pressures = case_pressures(pair.model, _cases(solved))
        errors = case_errors(pair.model, pressures, solved.companion.value)
        begun = beginnings(pair.model, pressures, solved.companion.value)
        natural = [own_frequency(pair, static) for static in own.static.solved.by_friction]
        naturals = [natural[i] for _, i in own.tasks]
        facts = transient_facts(pair.model, pressures, errors, [bars for _, bars in begun], pair.frequencies, naturals)
        tables = (
            TRANSIENT.of(transient_rows(pair.model, pressures, errors)),
            TRANSIENT_TEETH.of(tooth_rows(pair.model, pressures, errors)), TRANSIENT_FACTS.of(facts),
            TRANSIENT_START.of(start_rows(pair.model, pressures, begun)),
        )
        mended = own.static.scene != self.scene
        section = transient_section(self.scene)
        said = sentences(facts, self.scene.sweep.positions, section.tolerance, section.spectral_radius)
        said = [*said, *coarse_contact(elements_across(pair.model, pressures))]
        said += [f"{each.case.name}: {bars.said}" for each, bars in zip(pressures, errors) if bars.said]
        said += [UNLIKE_STATICS] * mended + [solved.companion.reason] * bool(solved.companion.reason)
        animated = [self._animation(pressures, facts)] if wanted_output(self.scene).animation else []
        timings = replace(own.static.timings, error_bars=solved.companion.seconds)
        return Results(own.static.scene, tables, said, animated, timings)

    def _animation(self, pressures: list[CasePressures], facts: list[TransientFacts]) -> Picture:
        """Contact lines over time, of the case with the largest mesh force."""

        def animated() -> bytes:
            from evolvent.dynamics.figures.field_of_action import FieldOfAction  # matplotlib takes a second to import

            worst = int(np.argmax([fact.dynamic_factor for fact in facts]))
            return FieldOfAction(self.scene.title, self.scene.gear_pair(), pressures[worst]).animation()

        return Picture(ANIMATION, animated)


def _cases(solved: SolvedCases) -> list[TransientCase]:
    """Cases with their motion, statics and mesh force."""
    own, frictions, static = solved.own, solved.own.scene.contact.friction, solved.own.static.solved.by_friction
    loads = [each.drive.torque / each.lever for each in own.loaded()]
    return [
        TransientCase(speed, frictions[i], solved.found[number], static[i], loads[i])
        for number, (speed, i) in enumerate(own.tasks)
    ]
