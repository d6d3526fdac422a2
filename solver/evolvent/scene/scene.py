"""The scene: a TOML file, validated into frozen models, and written back with its defaults.

Everything that is wrong with a scene is reported in one `SceneError` before anything is computed or written.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, ValidationError, model_validator

from evolvent.contact.problem.user_warnings import warn_user
from evolvent.fem.material import Material
from evolvent.gears.problem.flank_deviations import DEEPEST, FlankChart
from evolvent.gears.problem.hertz_estimate import HertzEstimate
from evolvent.gears.problem.load_limits import NARROWEST_CONTACT, overload, rounded_down
from evolvent.scene.backlash import backlash_conflict
from evolvent.scene.gear_pair import ImpossibleGears, make_pair
from evolvent.scene.line_level import line_conflict
from evolvent.scene.scene_text import nested_values, scene_text
from evolvent.scene.schema.bodies import MaterialSection, MeshSection
from evolvent.scene.schema.dependence import without_main_key
from evolvent.scene.schema.design import DesignSection
from evolvent.scene.schema.dynamics import DynamicsSection, TransientSection
from evolvent.scene.schema.errors import InputProblem, SceneError, problems_of, shown, validation_error
from evolvent.scene.schema.fatigue import FatigueSection
from evolvent.scene.schema.gears import GearSection, PairSection
from evolvent.scene.schema.load_cases import LoadCaseSection, list_problem
from evolvent.scene.schema.loading import ContactSection, LoadSection, SweepSection
from evolvent.scene.schema.old_names import Warn, new_sections, unsaid
from evolvent.scene.schema.output import ExactSection, OutputSection
from evolvent.scene.schema.section import SceneSection, key, listed
from evolvent.scene.schema.strength import StrengthSection
from evolvent.scene.schema.wear import WearSection
from evolvent.scene.toml_lines import toml_lines
from evolvent.scene.vibration_limits import PlannedVibration, impossible
from evolvent_meshes.csv_tables import TableError
from evolvent_meshes.gears.member import MemberName
from evolvent_meshes.gears.pair import GearPair

__all__ = ["Scene", "SceneError", "kept_scene", "load_scene", "scene_from_text", "scene_from_values"]

GEARS: tuple[MemberName, MemberName] = ("pinion", "wheel")


class Scene(SceneSection):
    """A valid scene, complete with its defaults.

    Raises pydantic.ValidationError when it is constructed directly; `load_scene` and `scene_from_text` raise SceneError
    with one line per problem.
    """

    title: str = key(
        "a name for reports and pictures", "a text of up to 200 characters", default="gear pair", max_length=200
    )
    pair: PairSection
    pinion: GearSection
    wheel: GearSection
    material: MaterialSection = MaterialSection()
    mesh: MeshSection = MeshSection()
    contact: ContactSection = ContactSection()
    load: LoadSection
    load_case: Annotated[tuple[LoadCaseSection, ...], BeforeValidator(listed)] = Field(
        default=(), description="a list of loads"
    )
    sweep: SweepSection = SweepSection()
    wear: WearSection | None = None
    dynamics: DynamicsSection | None = None
    transient: TransientSection | None = None
    strength: StrengthSection | None = None
    fatigue: FatigueSection | None = None
    design: DesignSection | None = None
    output: OutputSection = OutputSection()
    exact: ExactSection = ExactSection()

    @model_validator(mode="after")
    def _keys_have_an_effect(self) -> Self:
        if problems := without_main_key(self):
            raise validation_error(*problems)
        return self

    @model_validator(mode="after")
    def _loads_are_one_list(self) -> Self:
        if problem := list_problem(self.load_case, self.load.percents):
            raise validation_error(problem)
        return self

    @model_validator(mode="after")
    def _line_contact_resolves_no_width(self) -> Self:
        if problem := line_conflict(self.mesh, self.exact):
            raise validation_error(problem)
        return self

    @model_validator(mode="after")
    def _gears_mesh(self) -> Self:
        pinion, wheel = self.pinion.hand or "right", self.wheel.hand
        if self.pair.helix_angle_deg > 0 and wheel == pinion:
            allowed = f"the opposite of pinion.hand, which is {shown(pinion)}"
            remedy = "delete the key, the wheel's hand follows from the pinion's"
            raise validation_error(InputProblem("wheel.hand", shown(wheel), allowed, remedy))
        try:
            self.gear_pair()
        except ImpossibleGears as error:
            raise validation_error(error.problem) from error
        return self

    @model_validator(mode="after")
    def _backlash_follows(self) -> Self:
        given = None if self.dynamics is None else self.dynamics.backlash_um
        if given is not None and (problem := backlash_conflict(self.gear_pair(), given)):
            raise validation_error(problem)
        return self

    @model_validator(mode="after")
    def _torques_suit_the_gears(self) -> Self:
        unit = float(self.changed("load", torque_Nm=1.0).hertz_estimate().half_width(0.0))
        remedy = "the torque, or check that it is in N·m and material.E_GPa in GPa"
        for name, torque in self._torques():
            if not (half_width := unit * math.sqrt(torque)) >= NARROWEST_CONTACT:
                least = (NARROWEST_CONTACT / unit) ** 2
                found = f"{shown(torque)} (Hertz half-width {half_width:.3g} mm)"
                allowed = f"from {least:.3g} N·m on for these gears, a half-width of {NARROWEST_CONTACT:g} mm"
                raise validation_error(InputProblem(name, found, allowed, f"raise {remedy}"))
            if excess := overload(self.changed("load", torque_Nm=torque).hertz_estimate(), self.materials()):
                found, most = f"{shown(torque)} ({excess.why})", rounded_down(torque * excess.allowed_share)
                allowed = f"up to {most} N·m for these gears, as strains must stay small"
                raise validation_error(InputProblem(name, found, allowed, f"lower {remedy}"))
        return self

    def _torques(self) -> list[tuple[str, float]]:
        """Dotted keys of all torques [N·m]."""
        listed = [(f"load_case[{number}].torque_Nm", each.torque_Nm) for number, each in enumerate(self.load_case)]
        return [("load.torque_Nm", self.load.torque_Nm), *listed]

    @model_validator(mode="after")
    def _vibration_is_possible(self) -> Self:
        if (self.dynamics or self.transient) and (problem := impossible(self.planned_vibration())):
            raise validation_error(problem)
        return self

    @model_validator(mode="after")
    def _flanks_are_charted(self) -> Self:
        for name in GEARS:
            try:
                self.flank_chart(name)
            except TableError as error:
                found, remedy = f"{error.place}: {error.found}", f"{error.remedy}; or delete the key"
                raise validation_error(InputProblem(f"{name}.flank_csv", found, error.wanted, remedy)) from error
        return self

    @model_validator(mode="after")
    def _gauges_lie_on_faces(self) -> Self:
        gauges = None if self.strength is None else self.strength.gauges
        widths: dict[str, float] = {name: getattr(self, name).face_width_mm for name in GEARS}
        if gauges is not None and (problem := gauges.beside_the_face(widths)):
            raise validation_error(problem)
        return self

    @model_validator(mode="after")
    def _teeth_are_left(self) -> Self:
        if self.wear is None:
            return self
        most, module = self.wear.cycles, self.pair.normal_module_mm
        rates = self.hertz_estimate().wear_per_cycle(self.wear.pinion_mm2_per_N, self.wear.wheel_mm2_per_N)
        worn = max(rates) * most / module
        if worn > DEEPEST:
            found = f"{shown(most)} (about {worn:.2g} modules of wear at the root)"
            allowed = f"up to {most * DEEPEST / worn:.3g} for these K/H, where {DEEPEST:g} modules are gone"
            remedy = "give fewer cycles, or check that K/H is in mm²/N"
            raise validation_error(InputProblem("wear.cycles", found, allowed, remedy))
        return self

    @model_validator(mode="after")
    def _one_pitch_at_one_friction_wears(self) -> Self:
        if self.wear is not None and len(self.contact.friction) > 1:
            found, allowed = shown(self.contact.friction), "a single one where the flanks wear"
            remedy = "give one coefficient, and a scene for each other one"
            raise validation_error(InputProblem("contact.friction", found, allowed, remedy))
        needed = ("one-pitch", "one pitch is one tooth's passage"), ("deflected-flanks", "they wear undeflected")
        for name, why in needed:
            if self.wear is not None and name in self.exact.parts:
                found, allowed = shown(self.exact.parts), f"the other parts where the flanks wear: {why}"
                raise validation_error(InputProblem("exact.parts", found, allowed, f"leave {name} out"))
        return self

    def flank_chart(self, name: MemberName) -> FlankChart | None:
        """The measured or worn flank of a gear, None where the scene has none. Raises TableError."""
        given: GearSection = getattr(self, name)
        if given.flank_csv is None:
            return None
        pair, path, index = self.gear_pair(), Path(given.flank_csv), GEARS.index(name)
        active = pair.active_start_diameters[index], pair.gears[index].tip_form_diameter
        return FlankChart.read(path).checked(path, pair.gears[index], active)

    def gear_pair(self) -> GearPair:
        """The two gears at their centre distance, with every derived quantity."""
        return make_pair(self.pair, self.pinion, self.wheel)

    def hertz_estimate(self) -> HertzEstimate:
        """Hertz contact of this scene's gears, materials and torque."""
        pair, torque = self.gear_pair(), 1e3 * self.load.torque_Nm
        return HertzEstimate.of(pair, self.materials(), torque if self.load.on == "pinion" else torque / pair.ratio)

    def planned_vibration(self) -> PlannedVibration:
        """Quantities of the scene on which the limits of [dynamics] and [transient] depend."""
        pair, (pinion, wheel) = self.gear_pair(), self.materials()
        force = self.hertz_estimate().pinion_torque / pair.pinion.base_radius
        return PlannedVibration(
            pair, force, (pinion.youngs_modulus, wheel.youngs_modulus), self.dynamics, self.transient
        )

    def materials(self) -> tuple[Material, Material]:
        """Materials of (pinion, wheel)."""
        common = self.material
        pairs = [
            (common.E_GPa if gear.E_GPa is None else gear.E_GPa, common.nu if gear.nu is None else gear.nu)
            for gear in (common.pinion, common.wheel)
        ]
        pinion, wheel = (Material(1e3 * modulus, ratio) for modulus, ratio in pairs)
        return pinion, wheel

    def resolved_toml(self) -> str:
        """The scene as TOML with all its defaults and the meaning of each key; reading it gives the same scene.

        A default that is derived from other keys is a comment, so that it is derived again when these are changed.
        """
        return "\n".join(toml_lines(self, derived_values(self))) + "\n"


def derived_values(scene: Scene) -> dict[str, Any]:
    """Dotted key -> the default that is derived from other keys."""
    pair = scene.gear_pair()
    values: dict[str, Any] = {"pair.centre_distance_mm": pair.centre_distance}
    for name, gear, material in zip(("pinion", "wheel"), pair.gears, scene.materials(), strict=True):
        values |= {
            f"{name}.tip_diameter_mm": gear.tip_diameter,
            f"{name}.root_diameter_mm": gear.root_diameter,
            f"{name}.rack_tip_radius_mm": gear.rack_tip_radius,
            f"{name}.hand": "right" if gear.hand > 0 else "left",
            f"{name}.bore_diameter_mm": gear.bore_diameter,
            f"{name}.tip_relief_start_diameter_mm": gear.modifications.tip_relief_start_diameter,
            f"{name}.root_relief_end_diameter_mm": gear.modifications.root_relief_end_diameter,
            f"{name}.profile_control_diameter_mm": gear.modifications.profile_control_diameter,
            f"{name}.end_relief_length_mm": gear.modifications.end_relief_length,
            f"material.{name}.E_GPa": material.youngs_modulus / 1e3,
            f"material.{name}.nu": material.poissons_ratio,
        }
    return values


def future_warning(sentence: str) -> None:
    """Warns at the user's line of what a later version may not accept."""
    warn_user(sentence, FutureWarning)


def load_scene(path: Path | str, overrides: Sequence[str] = (), warn: Warn = future_warning) -> Scene:
    """Reads, overrides and validates a scene file.

    overrides: "section.key=value" with a TOML value, as `--set` takes them. warn: is given a sentence on each old name
    of a key or value. Raises SceneError.
    """
    path = Path(path)
    return scene_from_text(scene_text(path), overrides, str(path), path.parent, warn)


def kept_scene(path: Path) -> Scene:
    """The scene that a run has written, by whatever names its version had. Raises SceneError."""
    return load_scene(path, warn=unsaid)


def scene_from_text(
    text: str, overrides: Sequence[str] = (), source: str = "", folder: Path = Path(), warn: Warn = future_warning
) -> Scene:
    """A scene from TOML text; see load_scene.

    source: named in messages. folder: to which paths in the text are relative; paths in overrides are relative to the
    current folder.
    """
    try:
        return scene_from_values(nested_values(text, overrides, folder, warn))
    except SceneError as error:
        raise SceneError(error.problems, source) from error.__cause__


def scene_from_values(values: Mapping[str, Any]) -> Scene:
    """A scene from nested dictionaries; see load_scene."""
    try:
        return Scene.model_validate(new_sections(values, future_warning))
    except ValidationError as error:
        raise SceneError(problems_of(error, Scene)) from error
