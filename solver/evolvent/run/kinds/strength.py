"""Root strength of a scene's gears."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

from evolvent.gears.solution.certified_pitch import ON_DEFLECTED
from evolvent.results.tables.run_warnings import RELIEVE
from evolvent.run.call import Call
from evolvent.run.companion import WithCompanion
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.kept_pitch import STORED
from evolvent.run.strength.pitch_roots import PitchRoots, pitch_roots, root_meshes
from evolvent.run.strength.summary_lines import summary_lines
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.schema.strength import StrengthSection
from evolvent.strength.results.gauge_table import GAUGES, gauge_rows
from evolvent.strength.results.pictures import ROOT_STRESS_PICTURE
from evolvent.strength.results.tables import (
    ROOT_STRESS,
    STRENGTH,
    FrictionRoots,
    formula_rows,
    formula_warnings,
    root_stress_rows,
    strength_rows,
)
from evolvent.strength.root_surface import compression_side, tension_side
from evolvent.strength.solution.root_stress import NO_DEEP_TEETH
from evolvent.strength.standard.root_stress import RootLoad
from evolvent.strength.strain_gauges import Gauge, gauge_places
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData

SolvedRoots = WithCompanion[PitchRoots]
"""Root stresses on the meshes of the results and, at the same positions, on those of the error bars."""


@dataclass(frozen=True)
class Strength(Computation[SolvedRoots]):
    """The pitch with roots finer than a run's, the stress there, and that of ISO 6336-3 beside it."""

    name: ClassVar[str] = "strength"
    command: ClassVar[str] = "strength"
    outputs: ClassVar[Outputs] = Outputs(
        (STRENGTH.name, ROOT_STRESS.name, GAUGES.name), (ROOT_STRESS_PICTURE,),
        stored=(*STORED, "results/angle_*.npz"), lines=summary_lines,
    )

    def check(self) -> None:
        """Raises InputError where the standard does not cover the gears, or a strain gauge does not lie on a root."""
        for load in self._loads:
            tuple(formula_rows(load, self._section.editions, self._tolerance_class))
        problem, gauges = gear_problem(self.scene), self._gauges
        for member in sorted({gauge.member for gauge in gauges}):
            made = root_meshes(self.scene)[0].mesh(problem, member)
            mesh = made if isinstance(made, MeshData) else made.mesh
            for gauge in gauges:
                if gauge.member is member:
                    side = tension_side if gauge.loaded_side else compression_side
                    gauge_places(gauge, side(mesh, problem.pair.gears[member]))

    def warnings(self) -> Iterator[str]:
        """Warnings on charts, formulas, flanks and tips."""
        yield from (*super().warnings(), *formula_warnings(self._loads))

    def solve(self, call: Call) -> SolvedRoots:
        """Roots on both kinds of meshes, see `Computation.solve`."""
        own, coarse = root_meshes(self.scene)
        fine = pitch_roots(call, self.scene, own)
        again = call.companion(self.scene, lambda: pitch_roots(call, fine.scene, coarse, fine.angles))
        return SolvedRoots(fine, again)

    def results(self, call: Call, solved: SolvedRoots) -> Results:
        """Tables of stresses, roots and gauges."""
        scene, coarse = solved.fine.scene, solved.coarse.value
        roots = [
            FrictionRoots(friction, own, None if coarse is None else coarse.roots[index], scene.mesh.order)
            for index, (friction, own) in enumerate(zip(scene.contact.friction, solved.fine.roots))
        ]
        editions, tolerance = self._section.editions, self._tolerance_class
        rows = [row for load in self._loads for row in strength_rows(load, roots, editions, tolerance)]
        tables = (
            STRENGTH.of(rows), ROOT_STRESS.of(root_stress_rows(roots)),
            GAUGES.of(gauge_rows(self._gauges, roots, scene.materials())),
        )
        timings = replace(solved.fine.timings, error_bars=solved.coarse.seconds)
        return Results(scene, tables, list(self._warnings(solved)), timings=timings)

    def _warnings(self, solved: SolvedRoots) -> Iterator[str]:
        """Warnings on the results."""
        if solved.fine.scene != self.scene:
            yield ON_DEFLECTED
        if solved.fine.tip_edges:
            yield (
                f"{solved.fine.tip_edges}: what an edge bears its neighbours do not, so that shares of the load and "
                f"stresses at the roots rest on contact of edges; {RELIEVE}."
            )
        if solved.coarse.reason:
            yield solved.coarse.reason

    @property
    def _section(self) -> StrengthSection:
        return self.scene.strength or StrengthSection()

    @property
    def _tolerance_class(self) -> int:
        return self._section.tolerance_class or NO_DEEP_TEETH

    @cached_property
    def _loads(self) -> tuple[RootLoad, RootLoad]:
        """Loads of the roots of pinion and wheel for the standard."""
        problem = gear_problem(self.scene)
        pinion, wheel = (RootLoad(problem.pair, member, problem.pinion_torque) for member in Member)
        return pinion, wheel

    @property
    def _gauges(self) -> list[Gauge]:
        """Strain gauges of the scene."""
        given = self._section.gauges
        if given is None:
            return []
        columns = given.gear, given.side, given.angle_deg, given.height_mm, given.length_mm
        return [
            Gauge(Member.named(gear), side == "loaded", math.radians(angle), z, length, number)
            for number, (gear, side, angle, z, length) in enumerate(zip(*columns, strict=True), 1)
        ]
