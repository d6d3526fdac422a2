"""Contact fatigue from Python: criteria below a line contact of given loads, and of the flanks of a solved pitch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evolvent.fem.material import STEEL, Material
from evolvent.gears.gear_model import GearModel
from evolvent.gears.solution.solver import check_friction, check_resolved
from evolvent.results.solution.pitch import PitchSolution
from evolvent.scene.schema.fatigue import FatigueSection
from evolvent.strength.fatigue.flank_fatigue import FatigueMaterial, fatigue_of_both, flank_fatigue
from evolvent.strength.fatigue.flank_loads import FlankLoads, LoadedPosition
from evolvent.strength.fatigue.half_plane import HertzTractions, plane_strain
from evolvent.strength.results.fatigue_facts import FatigueFacts, fatigue_facts
from evolvent.strength.results.fatigue_rows import FatigueMapRow, FatigueRow
from evolvent.strength.results.fatigue_tables import depth_rows, fatigue_rows, map_rows, section_rows
from evolvent.strength.results.friction_fatigue import FrictionFatigue, zone_ends
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import Words, instance, members, number, numbers, refuse, vector

DEFAULT = FatigueSection()
"""Depths and factors of a scene that names none."""


@dataclass(frozen=True)
class FatigueSettings:
    """Depths, and data of the material for the criteria; those of the section [fatigue] of a scene by default."""

    depths: tuple[float, ...] = DEFAULT.depths
    """Depths over the half-width of the contact, ascending from 0, the surface."""
    yield_stress: float | None = DEFAULT.yield_stress_MPa
    """Yield stress of the criterion of Fatemi and Socie [MPa]; None leaves it out."""
    tension_factor: float = DEFAULT.tension_factor
    """Factor a of the criterion of Dang Van under hydrostatic tension."""
    compression_factor: float = DEFAULT.compression_factor
    """Factor a of the criterion of Dang Van under hydrostatic compression."""
    normal_factor: float = DEFAULT.normal_factor
    """Factor k of the criterion of Fatemi and Socie."""

    def __post_init__(self) -> None:
        """Raises InputError."""
        numbers("depths", self.depths)
        for depth in self.depths:
            number("depths", depth, "numbers from 0 on, in half-widths", "0 is the surface", lambda z: z >= 0.0)
        if len(self.depths) == 0 or not (np.diff(self.depths) > 0.0).all():
            refuse("depths", "ascending numbers", list(self.depths), "write sorted(depths)")
        for name in ("tension_factor", "compression_factor", "normal_factor"):
            number(name, getattr(self, name), "a number from 0 on", "give a number", lambda a: a >= 0.0)
        if self.yield_stress is not None:
            number("yield_stress", self.yield_stress, "a number above 0, in MPa", "None for none", lambda σ: σ > 0.0)

    def of(self, material: Material) -> FatigueMaterial:
        """Data for the criteria of an elastic material."""
        return FatigueMaterial(
            material.poissons_ratio, material.lame[1], self.yield_stress, self.tension_factor, self.compression_factor,
            self.normal_factor,
        )


USUAL = FatigueSettings()
"""Settings of a scene that names none."""


@dataclass(frozen=True, eq=False)
class ContactFatigue:
    """Criteria at m depths below a line contact that passes once."""

    depths: Floats
    """Depths (m,) below the surface [mm]."""
    values: dict[str, Floats]
    """Name of each criterion -> its values (m,) [MPa]; of fatemi_socie a strain."""


@dataclass(frozen=True, eq=False)
class PitchFatigue:
    """Contact fatigue of both flanks of a gear pair, at each friction coefficient of a solved pitch."""

    pair: GearPair
    """Gear pair."""
    by_friction: tuple[FrictionFatigue, ...]
    """Criteria at the points of both flanks and the depths below them."""
    facts: tuple[FatigueFacts, ...]
    """Facts on the contact solution at each friction coefficient; the keys of fatigue.json. Error bars are NaN."""

    @property
    def largest(self) -> list[FatigueRow]:
        """Largest value of each criterion over both flanks at each place; the columns of fatigue.csv. Error bars are
        NaN."""
        return list(fatigue_rows(self.pair, self.by_friction))

    @property
    def over_flank(self) -> list[FatigueMapRow]:
        """Each criterion at all points of both flanks; the columns of fatigue_map.csv."""
        return list(map_rows(self.pair, self.by_friction))

    def save(self, path: Path | str) -> Path:
        """Writes `over_flank` to a CSV file, and returns its path; creates missing folders. Raises InputError for
        another ending, WriteError."""
        from evolvent.results.solution.user_files import save_rows

        return save_rows(path, self.over_flank)

    def plot(self, path: Path | str) -> Path:
        """Draws the criterion of Dang Van over the pinion's flank and the depth, and three criteria below its most
        loaded point, to a PNG file, and returns its path; creates missing folders. Raises InputError for another
        ending, WriteError."""
        from evolvent.results.solution.user_files import save_picture
        from evolvent.strength.results.fatigue_picture import fatigue_figure

        title = f"Gear pair {self.pair.pinion.z}/{self.pair.wheel.z}"
        section, below = (list(rows(self.pair, self.by_friction)) for rows in (section_rows, depth_rows))
        return save_picture(path, fatigue_figure, title, self.facts, self.over_flank, section, below)


def contact_fatigue(
    peak_pressure: float, half_width: float, friction: float = 0.0, material: Material = STEEL,
    settings: FatigueSettings = USUAL,
) -> ContactFatigue:
    """Criteria of contact fatigue below a line contact with Hertz' pressure that slides over an elastic half-plane, in
    plane strain.

    peak_pressure: p0 [MPa]; half_width: b across the contact [mm]; friction: μ.

    Raises InputError.

    Examples:
        >>> from evolvent.fatigue import contact_fatigue
        >>> below = contact_fatigue(peak_pressure=1000.0, half_width=0.2)
        >>> int(below.values["maximum_shear"].max())
        300
    """
    _check(peak_pressure, half_width, friction)
    instance("material", material, Material, "write Material(youngs_modulus, poissons_ratio), settings=... behind")
    _check_settings(settings)
    columns = (np.full(1, float(each)) for each in (0.0, 0.0, peak_pressure, half_width, friction))
    loads = FlankLoads(np.zeros((1, 3), dtype=int), *columns)
    found = flank_fatigue(loads, friction, settings.depths, settings.of(material))
    return ContactFatigue(found.depths_mm[0], {each.name: values[0] for each, values in found.values.items()})


def passing_stress(
    places: Sequence[float] | Floats, depth: float, peak_pressure: float, half_width: float, friction: float = 0.0,
    poissons_ratio: float = STEEL.poissons_ratio,
) -> Floats:
    """Stress tensors (k, 3, 3) [MPa] at a point below a line contact that passes over it: the history that criteria
    such as `dang_van` take. Axes: x along the surface, y along the contact line, z into the body.

    places: of the point from the contact's middle (k,) [mm]. depth: of the point [mm]. Further arguments are those of
    `contact_fatigue`.

    Raises InputError.
    """
    _check(peak_pressure, half_width, friction)
    number("depth", depth, "a number from 0 on, in mm", "0 is the surface", lambda z: z >= 0.0)
    number("poissons_ratio", poissons_ratio, "a number from 0 to 0.5", "steel has 0.3", lambda ν: 0.0 <= ν <= 0.5)
    wanted, remedy = "finite numbers, in mm", "write np.linspace(first, last, count)"
    count = np.asarray(places, dtype=object).size  # also of rows of different lengths, which are refused next
    x = np.array(vector("places", places, (count,), wanted, remedy))
    tractions = HertzTractions(half_width, peak_pressure, friction)
    return plane_strain(tractions.stress(x, np.full_like(x, depth)), poissons_ratio)


def _check(peak_pressure: float, half_width: float, friction: float) -> None:
    """Raises InputError for loads that no contact has."""
    number("peak_pressure", peak_pressure, "a number above 0, in MPa", "give the peak p0", lambda p: p > 0.0)
    number("half_width", half_width, "a number above 0, in mm", "give half of the width 2b", lambda b: b > 0.0)
    check_friction(friction)


def _check_settings(settings: FatigueSettings) -> None:
    """Raises InputError unless these are settings."""
    instance("settings", settings, FatigueSettings, "write FatigueSettings(), or leave it out")


def pitch_fatigue(
    gears: GearModel, pitches: Sequence[PitchSolution], settings: FatigueSettings = USUAL
) -> PitchFatigue:
    """Contact fatigue of both flanks from a solved pitch, as of `evolvent fatigue`, without error bars.

    gears: those of the pitches. pitches: of `solve_pitches`, one a friction coefficient. Changes are over the first;
        where that is 0, criteria that are 0 without friction have none, NaN.

    Raises InputError.
    """
    check_resolved(gears)
    _check_settings(settings)
    solved = members("pitches", pitches, (PitchSolution,), "pitch_fatigue(gears, solve_pitches(gears, [0.0, 0.1]))")
    if not solved:
        refuse("pitches", "one solution at least", [], "write pitch_fatigue(gears, [pitch])")
    for pitch in solved:
        if (pitch.pair, pitch.load) != (gears.pair, gears.load):
            refuse("pitches", "those of these gears", Words(_difference(gears, pitch)), "solve them with these gears")
    pinion, wheel = (settings.of(body.material) for body in gears.bodies)
    found, facts, heights = [], [], gears.bodies[0].z
    for pitch in solved:
        inner, solutions = pitch.pressure.inner_path, zip(pitch.results, pitch.pressure.cuts)
        positions = [LoadedPosition(k, result, cut, heights) for k, (result, cut) in enumerate(solutions)]
        loads = FlankLoads.joined([each.loads(inner) for each in positions])
        both = fatigue_of_both(loads, pitch.friction, settings.depths, (pinion, wheel))
        found.append(FrictionFatigue(pitch.friction, both, math.nan, zone_ends(gears.pair, inner)))
        facts.append(fatigue_facts(gears.pair, found[-1], positions, inner, (pinion, wheel)))
    return PitchFatigue(gears.pair, tuple(found), tuple(facts))


def _difference(gears: GearModel, pitch: PitchSolution) -> str:
    """Words on a pitch that was solved with other gears."""
    if pitch.pair != gears.pair:
        return "a pitch of another gear pair"
    if pitch.load.driving is not gears.load.driving:
        return f"a pitch that the {pitch.load.driving.label} drives"
    one, other = (
        f"{1e-3 * gears.width_factor * load.torque:.5g} N·m on the {load.on.label}" for load in (pitch.load, gears.load)
    )
    return f"a pitch under {one} beside gears under {other}"
