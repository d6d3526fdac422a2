"""The sections [contact], [load] and [sweep]: friction, torque and the positions to be solved."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, field_validator, model_validator

from evolvent.scene.schema.errors import InputProblem, shown, validation_error
from evolvent.scene.schema.section import SceneSection, as_tuple, key, listed

Coefficient = Annotated[float, Field(ge=0, le=1)]
MOST_TORQUES = 30
"""Largest number of torques of a load list or an excitation; each costs as much as a run of all positions."""
PERCENTS = f"a list of up to {MOST_TORQUES} different numbers above 0 up to 1000"
MOST_COEFFICIENTS = 50
"""Largest number of friction coefficients of a scene."""
COEFFICIENTS = f"a number from 0 to 1, or a list of up to {MOST_COEFFICIENTS} different ones"


class ContactSection(SceneSection):
    """[contact]: friction of the flanks."""

    friction: Annotated[tuple[Coefficient, ...], BeforeValidator(as_tuple)] = key(
        "Coulomb friction coefficient μ, or a list that is computed one after the other",
        COEFFICIENTS,
        "0 is frictionless, lubricated steel gears 0.03 to 0.12, dry steel up to 0.3",
        default=(0.0,),
        max_length=MOST_COEFFICIENTS,
    )

    @field_validator("friction")
    @classmethod
    def _different(cls, values: tuple[float, ...]) -> tuple[float, ...]:
        if not values:
            remedy = "give at least one; 0 is frictionless"
            raise validation_error(InputProblem("", "an empty list", COEFFICIENTS, remedy))
        twice = sorted({value for value in values if values.count(value) > 1})
        if twice:
            found = f"{shown(twice[0])} more than once in {shown(values)}"
            remedy = "delete the repeated ones, they would give the same result"
            raise validation_error(InputProblem("", found, COEFFICIENTS, remedy))
        return values


class LoadSection(SceneSection):
    """[load]: the torque."""

    torque_Nm: float = key(
        "torque that is held constant",
        "a number above 0 up to 1e7, in N·m",
        "give the torque in N·m; it acts on the gear that load.on names",
        too_small="give a torque above 0 without a sign, the pinion drives unless load.driving is the wheel; it acts "
        "on the gear that load.on names",
        too_large="mind the unit: give the torque in N·m, 1 N·m is 1000 N·mm",
        gt=0,
        le=1e7,
    )
    on: Literal["pinion", "wheel"] = key(
        "the gear on which the torque acts; the other one's rotation is prescribed",
        '"pinion" or "wheel" (or "gear", which is the wheel)',
        default="pinion",
    )
    driving: Literal["pinion", "wheel"] = key(
        "the gear that drives; the flanks that bear are the same, so where the wheel drives both gears turn the other "
        "way round, and friction acts in the opposite direction",
        '"pinion" or "wheel" (or "gear", which is the wheel)',
        default="pinion",
    )
    mesh_torques_Nm: tuple[float, float] | None = key(
        "range of torques that the meshes are made for: elements small enough for the lightest one, fine flanks long "
        "enough for the heaviest; flanks with levels take as many as each torque needs; `evolvent loads` and "
        "studies set it, `evolvent excitation` and `dynamics` take elements for load.torque_Nm unless it is given, and "
        "flanks that are fine for the heaviest torque of their list: with another list figures differ, within their "
        "error bars",
        "two ascending numbers above 0, the second one at least load.torque_Nm",
        "give the lightest and the heaviest torque, or delete the key: the mesh is then that of load.torque_Nm alone",
        default=None,
    )

    percents: tuple[Annotated[float, Field(gt=0, le=1000)], ...] = key(
        "torques of `evolvent loads`, `losses`, `excitation` and `design`, in percent of load.torque_Nm; --percent "
        "replaces them",
        PERCENTS, "25, 50 and 100, for example; by default the command has a list of its own", default=(),
        max_length=MOST_TORQUES,
    )

    @field_validator("percents")
    @classmethod
    def _different_percents(cls, values: tuple[float, ...]) -> tuple[float, ...]:
        if twice := [value for value in values if values.count(value) > 1]:
            found = f"{shown(twice[0])} more than once in {shown(values)}"
            raise validation_error(InputProblem("", found, PERCENTS, "delete the repeated ones"))
        return values

    _tuples = field_validator("mesh_torques_Nm", "percents", mode="before")(listed)

    @model_validator(mode="after")
    def _meshes_serve_the_torque(self) -> Self:
        if (served := self.mesh_torques_Nm) and not (0.0 < served[0] <= served[1] and self.torque_Nm <= served[1]):
            allowed = f"two ascending numbers above 0, the second one at least load.torque_Nm, {shown(self.torque_Nm)}"
            remedy = "give the lightest and the heaviest torque, or delete the key"
            raise validation_error(InputProblem("mesh_torques_Nm", shown(served), allowed, remedy))
        return self

    @field_validator("on", "driving", mode="before")
    @classmethod
    def _gear_is_wheel(cls, value: Any) -> Any:
        return "wheel" if value == "gear" else value


class SweepSection(SceneSection):
    """[sweep]: the positions of one angular pitch 2π/z_1, from which the whole engagement is assembled."""

    positions: int = key(
        "positions per angular pitch 2π/z_1 (one mesh cycle)",
        "a whole number from 2 to 1000",
        "20 is usual",
        default=20,
        ge=2,
        le=1000,
    )
