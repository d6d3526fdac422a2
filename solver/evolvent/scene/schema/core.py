"""The sections of a scene file: every key with its meaning, unit, default and limits. docs/scene.md lists them.

A key with a unit has it in its name. `Scene` in scene.py puts the sections together.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, JsonValue, field_validator, model_validator

from evolvent.scene.schema.errors import Problem, scene_problem, shown


def key(text: str, allowed: str, remedy: str = "", *, default: Any = ..., **limits: Any) -> Any:
    """A key of the scene: what it is, what it may be, what to do if it is not, its default (none: required)."""
    words: dict[str, JsonValue] = {"allowed": allowed, "remedy": remedy or f"give {allowed.split(',')[0]}"}
    return Field(default, description=text, json_schema_extra=words, **limits)


class Section(BaseModel):
    """A table of the scene file: frozen, no unknown keys, no conversion between types, no NaN or infinity."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


LONGEST = 1e6
"""Diameters and distances [mm]: 1000 teeth of module 50 have 71 m."""
LEAST_HELIX = 1e-3
"""Degrees: over a face of 20 mm, 0.3 µm; less is a spur gear."""
LENGTH = "a number above 0 up to 1e6, in mm"


class Pair(Section):
    """[pair]: what both gears share."""

    normal_module_mm: float = key(
        "normal module m_n",
        "a number from 0.05 to 50, in mm",
        "give the normal (not the transverse) module",
        ge=0.05,
        le=50,
    )
    normal_pressure_angle_deg: float = key(
        "normal pressure angle α_n of the rack", "a number from 10 to 32, in degrees", default=20.0, ge=10, le=32
    )
    helix_angle_deg: float = key(
        "helix angle β at the reference circle, 0 for spur gears",
        f"0, or a number from {LEAST_HELIX:g} to 45, in degrees",
        "give it without a sign and say the direction with pinion.hand",
        default=0.0,
        ge=0,
        le=45,
    )
    centre_distance_mm: float | None = key(
        "centre distance a; by default that of zero backlash",
        LENGTH,
        "delete the key for the centre distance without backlash",
        default=None,
        gt=0,
        le=LONGEST,
    )
    misalignment_um: float = key(
        "opening of the flanks over the face width by misalignment in the plane of action, positive: open at z > 0",
        "a number from -1000 to 1000, in µm over the face width",
        default=0.0,
        ge=-1000,
        le=1000,
    )


    @field_validator("helix_angle_deg")
    @classmethod
    def _helical_or_spur(cls, value: float) -> float:
        if 0.0 < value < LEAST_HELIX:
            allowed = f"0, or a number from {LEAST_HELIX:g} to 45, in degrees"
            raise scene_problem(Problem("", shown(value), allowed, "give 0 for spur gears"))
        return value


ALTERNATIVES = {"tip_diameter_mm": "addendum_coefficient", "root_diameter_mm": "dedendum_coefficient"}
"""A diameter, and the coefficient that gives it instead."""


class Gear(Section):
    """[pinion] and [wheel]."""

    teeth: int = key("number of teeth z", "a whole number from 5 to 1000", "external gears only", ge=5, le=1000)
    face_width_mm: float = key("face width b", "a number from 0.1 to 1000, in mm", ge=0.1, le=1000)
    profile_shift: float = key(
        "profile shift coefficient x, times m_n", "a number from -2 to 2", default=0.0, ge=-2, le=2
    )
    tip_diameter_mm: float | None = key(
        "tip diameter d_a; else from addendum_coefficient", LENGTH, default=None, gt=0, le=LONGEST
    )
    addendum_coefficient: float | None = key(
        "addendum h_a*, d_a = d + 2 m_n (h_a* + x − Δy), Δy ≥ 0 the tip shortening; 1 if there is no tip_diameter_mm",
        "a number from 0.1 to 3, times m_n",
        default=None,
        ge=0.1,
        le=3,
    )
    root_diameter_mm: float | None = key(
        "root diameter d_f; else from dedendum_coefficient", LENGTH, default=None, gt=0, le=LONGEST
    )
    dedendum_coefficient: float | None = key(
        "dedendum h_f*, d_f = d − 2 m_n (h_f* − x); 1.25 if there is no root_diameter_mm",
        "a number from 0.1 to 3, times m_n",
        default=None,
        ge=0.1,
        le=3,
    )
    rack_tip_radius_mm: float | None = key(
        "tip radius of the generating rack in its normal section; 0.38 m_n, or the full round if that is less",
        "a number from 0 to 1e6, in mm",
        "delete the key for the default",
        default=None,
        ge=0,
        le=LONGEST,
    )
    hand: Literal["right", "left"] | None = key(
        "direction of the helix; the pinion's is right by default, the wheel's the other one",
        '"right" or "left"',
        "delete the key for the default",
        default=None,
    )
    bore_diameter_mm: float | None = key(
        "diameter of the bore, where the gear sits rigidly on its shaft; half of the root diameter by default",
        LENGTH,
        "delete the key for the default",
        default=None,
        gt=0,
        le=LONGEST,
    )
    tip_relief_um: float = key(
        "tip relief: material taken off the flank at the tip",
        "a number from 0 to 500, in µm",
        default=0.0,
        ge=0,
        le=500,
    )
    tip_relief_start_diameter_mm: float | None = key(
        "diameter at which the tip relief starts; d_a − m_n by default",
        LENGTH,
        "delete the key for the default",
        default=None,
        gt=0,
        le=LONGEST,
    )
    tip_relief_form: Literal["linear", "parabolic"] = key(
        "how the tip relief grows with the roll distance", '"linear" or "parabolic"', default="linear"
    )
    lead_crowning_um: float = key(
        "lead crowning: material taken off the flank at its ends",
        "a number from 0 to 500, in µm",
        default=0.0,
        ge=0,
        le=500,
    )
    flank_csv: str | None = key(
        "chart of the loaded flank as measured or worn, what is missing of the designed one; looked for in the "
        "scene's folder, or, where --set names it, in the folder where the program runs",
        "the name of a CSV file with diameter_mm, depth_um and perhaps z_mm",
        "delete the key for flanks as designed",
        default=None,
        min_length=1,
        max_length=1000,
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        for first, second in ALTERNATIVES.items():
            one, two = getattr(self, first), getattr(self, second)
            if one is not None and two is not None:
                found = f"{shown(one)} and also {second} = {shown(two)}"
                raise scene_problem(Problem(first, found, "one of the two", f"delete {first} or {second}"))
        return self


class Elastic(Section):
    """[material.pinion] and [material.wheel]: what differs from [material]."""

    E_GPa: float | None = key(
        "Young's modulus E",
        "a number from 0.001 to 2000, in GPa",
        "steel is 210; mind GPa, not MPa",
        default=None,
        ge=1e-3,
        le=2000,
    )
    nu: float | None = key("Poisson's ratio ν", "a number from 0 to 0.49", "steel is 0.3", default=None, ge=0, le=0.49)


class Materials(Section):
    """[material]: both gears, unless a subsection says otherwise."""

    E_GPa: float = key(
        "Young's modulus E",
        "a number from 0.001 to 2000, in GPa",
        "steel is 210; mind GPa, not MPa",
        default=210.0,
        ge=1e-3,
        le=2000,
    )
    nu: float = key("Poisson's ratio ν", "a number from 0 to 0.49", "steel is 0.3", default=0.3, ge=0, le=0.49)
    pinion: Elastic = Elastic()
    wheel: Elastic = Elastic()


Level = Literal["quick", "standard", "fine"]
FEWEST_ELEMENTS = 0.5


def _whole(value: Any) -> int:
    """A whole number as it is; to Python true and 2.0 equal 1 and 2."""
    if type(value) is not int:
        raise ValueError
    return value


class Mesh(Section):
    """[mesh]."""

    level: Level = key(
        "how fine", '"quick", "standard" or "fine"', "quick is for looking, standard for results", default="standard"
    )
    elements_per_contact_width: float | None = key(
        "elements across the Hertz width 2b_H; quick 1.7, standard 3, fine 6 by default, on a stiff pinion at least 3",
        f"a number from {FEWEST_ELEMENTS:g} to 24",
        "delete the key for the level's own",
        default=None,
        ge=FEWEST_ELEMENTS,
        le=24,
    )
    shape: Literal["hexahedron", "tetrahedron"] = key("cells", '"hexahedron" or "tetrahedron"', default="hexahedron")
    order: Annotated[Literal[1, 2], BeforeValidator(_whole)] = key(
        "order of the cells and of the displacement", "1 or 2", default=2
    )


def as_tuple(value: Any) -> Any:
    """One μ or a list of them."""
    return tuple(value) if isinstance(value, (list, tuple)) else (value,)


Coefficient = Annotated[float, Field(ge=0, le=1)]
MOST_COEFFICIENTS = 50


class Contact(Section):
    """[contact]."""

    friction: Annotated[tuple[Coefficient, ...], BeforeValidator(as_tuple)] = key(
        "Coulomb friction coefficient μ, or a list that is computed one after the other",
        f"a number from 0 to 1, or a list of up to {MOST_COEFFICIENTS} different ones",
        "0 is frictionless, lubricated steel gears 0.03 to 0.12, dry steel up to 0.3",
        default=(0.0,),
        max_length=MOST_COEFFICIENTS,
    )

    @field_validator("friction")
    @classmethod
    def _different(cls, values: tuple[float, ...]) -> tuple[float, ...]:
        allowed = f"a number from 0 to 1, or a list of up to {MOST_COEFFICIENTS} different ones"
        if not values:
            raise scene_problem(Problem("", "an empty list", allowed, "give at least one; 0 is frictionless"))
        twice = sorted({value for value in values if values.count(value) > 1})
        if twice:
            found = f"{shown(twice[0])} more than once in {shown(values)}"
            remedy = "delete the repeated ones, they would give the same result"
            raise scene_problem(Problem("", found, allowed, remedy))
        return values


class Load(Section):
    """[load]."""

    torque_Nm: float = key(
        "torque that is held constant",
        "a number above 0 up to 1e7, in N·m",
        "give the torque without a sign, the pinion drives; it acts on the gear that load.on names",
        gt=0,
        le=1e7,
    )
    on: Literal["pinion", "wheel"] = key(
        "the gear on which the torque acts; the other one's rotation is prescribed",
        '"pinion" or "wheel" (or "gear", which is the wheel)',
        default="pinion",
    )

    @field_validator("on", mode="before")
    @classmethod
    def _gear_is_wheel(cls, value: Any) -> Any:
        return "wheel" if value == "gear" else value


class Sweep(Section):
    """[sweep]: one base pitch is solved, the whole engagement is put together from it."""

    positions: int = key(
        "positions a base pitch", "a whole number from 2 to 1000", "20 is usual", default=20, ge=2, le=1000
    )
