"""Flank modifications of a scene that vary: a search in line contact, the best variants with the contact resolved."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from typing import ClassVar, Self

import numpy as np

from evolvent.check.design_rows import design_refusals
from evolvent.dynamics.of_scene import check_positions
from evolvent.gears.shared_gears import SharedGears
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.results.archive.run_cost import Timings
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.results.tables.table import SCENE_TITLE, Filled
from evolvent.run.call import Call
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.design.checked import BEST, Checked, ranked
from evolvent.run.design.design_lines import BEST_SCENE, SECTION, design_lines, design_warnings
from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.evaluation import KEPT, Evaluation, Variants, design_store, kept_variants, no_variants
from evolvent.run.design.ranking import Ranking
from evolvent.run.design.search import search
from evolvent.run.design.solved_variant import LOST, shared_gears, solved_variant
from evolvent.run.design.tables import BAND, DESIGN, variant_rows
from evolvent.run.design.variant_mesh import VariantMesh
from evolvent.run.dynamics.scene_torques import SceneTorques, listed_torques
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.line_level import LINE
from evolvent.scene.load_cases import under_torque
from evolvent.scene.scene import Scene
from evolvent.scene.schema.design import LOSS, DesignSection, expanded
from evolvent.scene.schema.errors import NOTHING, InputProblem, SceneError
from evolvent.scene.skips import line_scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.modifications.modifications import OVER_FACE
from evolvent_meshes.gears.pair import GearPair

PICTURE = TablePicture("design.png", (SCENE_TITLE, SECTION, DESIGN, BEST), "evolvent.run.design.figures:design_figure")


@dataclass(frozen=True)
class SolvedDesign:
    """Variants of a scene, and the best of them."""

    variants: Variants
    """All that were computed."""
    checked: tuple[Checked, ...]
    """The best variants, the best one first, and the scene as it stands."""
    search_seconds: float
    """Wall time of the search, with its gears [s]."""

    @property
    def timings(self) -> Timings:
        """Wall time of all [s]; the gears in line contact count as positions."""
        return sum((each.timings for each in self.checked), Timings().then_solved(self.search_seconds))

    @property
    def best(self) -> Checked | None:
        """The best variant; None where none is allowed."""
        return self.checked[0] if self.checked[0].rank else None


@dataclass(frozen=True)
class Design(Computation[SolvedDesign]):
    """Variants of a scene's flank modifications under each of a list of torques."""

    loads: SceneTorques
    """The scene under its torques."""
    name: ClassVar[str] = "design"
    command: ClassVar[str] = "design"
    in_line_contact: ClassVar[bool] = True
    outputs: ClassVar[Outputs] = Outputs(
        (DESIGN.name, BEST.name, BAND.name), (PICTURE,), (BEST_SCENE,),
        (KEPT, "results/excitation_*.npz", f"results/*{LOST}*.npz"), design_lines,
    )

    @classmethod
    def of(cls, scene: Scene, percents: Sequence[float] = ()) -> Self:
        """Variants of a scene under parts of its torque or the loads that it lists. Raises SceneError where one of them
        is refused, or for loads of different misalignment."""
        loads = listed_torques(scene, percents)
        return cls(loads.scene, loads)

    @property
    def section(self) -> DesignSection:
        """The section [design]. Raises SceneError where the scene has none."""
        if self.scene.design is None:
            found, remedy = NOTHING, 'write for example design.vary = [["both.tip_relief_um", 0.0, 60.0, 5.0]]'
            raise SceneError([InputProblem("design", found, "a section with what varies", remedy)])
        return self.scene.design

    @cached_property
    def on_lines(self) -> Scene:
        """The scene in line contact under its lightest torque."""
        return line_scene(under_torque(self._solved, 1e-3 * self.loads.torques[0]))

    @property
    def _over_face(self) -> list[str]:
        """Keys that vary or deviate over the face of a spur pair, whose variants are all computed in space then."""
        names = [*expanded(self.section.vary), *expanded(self.section.tolerances)]
        is_spur = self.scene.pair.helix_angle_deg == 0.0
        return [name for name in names if is_spur and name.partition(".")[2] in (*OVER_FACE, "misalignment_um")]

    @cached_property
    def _solved(self) -> Scene:
        """The scene as it is computed, in line contact and with the contact resolved."""
        own = self.loads.scene.exact.parts
        if not self._over_face or "plane" in own:
            return self.loads.scene
        return self.loads.scene.changed("exact", parts=(*own, "plane"))

    @property
    def space(self) -> DesignSpace:
        """The variants."""
        return DesignSpace(self.on_lines, self.section)

    @property
    def sized(self) -> list[Scene]:
        """Scenes whose memory is looked at: in line contact and, where that is verified, with the contact resolved."""
        return [self.on_lines, *([self._solved] if self._verified else [])]

    @property
    def heaviest(self) -> Scene:
        """The scene under the largest torque."""
        return self.loads.heaviest

    @property
    def _verified(self) -> int:
        """Number of the best variants whose contact is resolved."""
        return 0 if self.scene.mesh.level == LINE else self.section.verified

    def check(self) -> None:
        """Raises SceneError without a section [design], for a loss without one friction coefficient, for K_Hβ of gears
        in the plane, and for a number of positions without harmonics."""
        if problems := design_refusals(self.scene, self.section):
            raise SceneError(problems)
        if "face_load_factor" in self.section.asked and gear_problem(self.on_lines).is_plane:
            found, allowed = "face_load_factor of gears in the plane", "figures that they have"
            remedy = "leave it out, or let a modification over the face or pair.misalignment_um vary or deviate"
            raise SceneError([InputProblem("design", found, allowed, remedy)])
        check_positions(self.scene)

    def warnings(self) -> Iterable[str]:
        """Warnings on charts and flanks, and on a spur pair that is computed in space."""
        yield from super().warnings()
        if self._over_face:
            yield (
                f"In space, as {', '.join(self._over_face)} varies over the face: the transmission error of a spur "
                "pair differs from that in the plane by some per cent."
            )

    def solve(self, call: Call) -> SolvedDesign:
        """Searches variants, then checks the best, see `Computation.solve`."""
        space, store = self.space, design_store(call, self.space, self.loads.torques)
        size = len(space.keys), len(self.loads.torques)
        known = call.on_first(lambda: kept_variants(store, *size)) if call.resume else no_variants(*size)
        gears = SharedGears([self._on_lines(space.as_it_stands).problem])
        begin = time.perf_counter()
        with call.beginning(self.scene, gears.prepare) as prepare:
            shared = call.preparing(prepare)
            evaluation = Evaluation(call, store, cache(lambda: self._mesh(shared)), known)
            evaluation.expected = 1 + min(self.section.size, self.section.samples)
            evaluation.of(space.as_it_stands[None])
            search(space, evaluation, bool(self._verified))
            found, seconds = evaluation.asked, time.perf_counter() - begin
            best = Ranking(self.section, found.figures, bool(self._verified)).checked
            checked = [self._checked(call, shared, n, found.values[n]) for n in dict.fromkeys([0, *best])]
            checked = ranked(checked, best, self.section, size[1])
            if self.section.tolerances:
                within = [space.deviating(found.values[each.variant]) if each.rank else None for each in checked]
                checked = [replace(each, band=b if b is None else evaluation.of(b)) for each, b in zip(checked, within)]
        return SolvedDesign(found, tuple(checked), seconds)

    def results(self, call: Call, solved: SolvedDesign) -> Results:
        """Tables of all variants and of the best ones, and the scene with the best one."""
        space = self.space
        best = [row for each in solved.checked for row in each.rows(self.loads.torques, self.loads.cases)]
        tables = [DESIGN.of(variant_rows(self.section, space.keys, solved.variants)), BEST.of(best)]
        if solved.best is not None and solved.best.band is not None:
            tables.append(BAND.of(variant_rows(self.section, space.keys, solved.best.band)))
        if solved.best is not None:
            chosen = replace(space, scene=self._solved).scene_of(solved.variants.values[solved.best.variant])
            text = chosen.model_copy(update={"design": None}).resolved_toml()
            tables.append(Filled(BEST_SCENE, partial(_write_scene, text)))
        said = design_warnings(space, solved.variants, solved.checked, solved.best, bool(self._verified))
        return Results(self.scene, tables, [*said], timings=solved.timings)

    def _on_lines(self, variant: Floats) -> SceneTorques:
        """A variant (k,) in line contact under all torques."""
        return replace(self.loads, scene=self.space.scene_of(variant))

    def _resolved(self, variant: Floats) -> SceneTorques:
        """A variant (k,) at the level of the scene under all torques."""
        return replace(self.loads, scene=replace(self.space, scene=self._solved).scene_of(variant))

    def _mesh(self, call: Call) -> VariantMesh:
        """The condensed gears for all variants. Collective."""
        space, loads = self.space, self._on_lines(self.space.as_it_stands)
        angles = np.array(uniform_pitch(loads.problem.pair.pinion.z, self.scene.sweep.positions).angles)
        model = call.gears(loads.problem).model

        def pair_of(variant: Floats) -> GearPair:
            return space.scene_of(variant).gear_pair()

        return VariantMesh.of(model, pair_of, loads.torques, angles, space.friction)

    def _checked(self, call: Call, shared: Call, number: int, variant: Floats) -> Checked:
        """A variant (k,) with its error bars and, where that is asked for, with the contact resolved. Collective.
        shared: call with the gears in line contact."""
        name, has_loss = _hash(variant), LOSS in self.section.asked
        line = solved_variant(shared, self._on_lines(variant), f"line_{name}", has_loss)
        if not self._verified:
            return Checked(number, line)
        loads = self._resolved(variant)
        resolving = call.preparing(shared_gears(loads).prepare) if has_loss else call
        return Checked(number, line, solved_variant(resolving, loads, f"resolved_{name}", has_loss))


def _write_scene(text: str, folder: RunFolder) -> None:
    """Writes the scene with the best variant."""
    folder.write_text(BEST_SCENE, text)


def _hash(variant: Floats) -> str:
    """Name of a variant (k,) in the names of files, whatever its number."""
    return hashlib.sha256(variant.tobytes()).hexdigest()[:12]
