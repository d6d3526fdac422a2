"""The section [strength]: tooth root stress by the standard, beside that of the contact solution."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, field_validator, model_validator

from evolvent.scene.schema.errors import InputProblem, shown, validation_error
from evolvent.scene.schema.section import SceneSection, as_tuple, key

EDITIONS = "a list of 2006, 2019 or both"
Edition = Literal[2006, 2019]
MOST_GAUGES = 100
Angle = Annotated[float, Field(ge=0, le=90)]
Height = Annotated[float, Field(ge=-500, le=500)]
Length = Annotated[float, Field(gt=0, le=100)]


class GaugesSection(SceneSection):
    """[strength.gauges]: strain gauges along the profile of roots, one for each place of its lists."""

    gear: Annotated[tuple[Literal["pinion", "wheel"], ...], BeforeValidator(as_tuple)] = key(
        "gear of each gauge", f'a list of up to {MOST_GAUGES}, each "pinion" or "wheel"',
        f"name the gear of each gauge; more than {MOST_GAUGES} take another scene", min_length=1, max_length=MOST_GAUGES
    )
    side: Annotated[tuple[Literal["loaded", "back"], ...], BeforeValidator(as_tuple)] = key(
        "root below the loaded flank, or below the back", 'a list of "loaded" and "back", as long as gear', min_length=1
    )
    angle_deg: Annotated[tuple[Angle, ...], BeforeValidator(as_tuple)] = key(
        "angle between the profile's tangent and the tooth's centre line at the middle of each gauge; 30 at the "
        "standard's critical section",
        "a list of numbers from 0 to 90, in degrees, as long as gear",
        min_length=1,
    )
    height_mm: Annotated[tuple[Height, ...], BeforeValidator(as_tuple)] = key(
        "axial position of each gauge, 0 at mid-face; where the pair is solved in 2D (plane strain) it does not count",
        "a list of numbers from -500 to 500, on the face of the gear, in mm, as long as gear",
        min_length=1,
    )
    length_mm: Annotated[tuple[Length, ...], BeforeValidator(as_tuple)] = key(
        "length of each gauge along the profile",
        "a list of numbers above 0 up to 100, in mm, as long as gear",
        min_length=1,
    )

    @model_validator(mode="after")
    def _equally_many(self) -> Self:
        for name in ("side", "angle_deg", "height_mm", "length_mm"):
            found = len(getattr(self, name))
            if found != len(self.gear):
                allowed = f"as many as gear has, {len(self.gear)}"
                raise validation_error(InputProblem(name, f"{found} values", allowed, "give one for each gauge"))
        return self

    def beside_the_face(self, face_widths: Mapping[str, float]) -> InputProblem | None:
        """The problem with the first gauge that lies beside the face of its gear, None where there is none.

        face_widths: of both gears [mm].
        """
        for number, (gear, height) in enumerate(zip(self.gear, self.height_mm), 1):
            half = 0.5 * face_widths[gear]
            if abs(height) > half:
                found = f"{shown(height)} of gauge {number}, on the {gear}"
                allowed = f"from {-half:g} to {half:g} mm, the face of the {gear}"
                remedy = "give the height from mid-face, half of the face width at most"
                return InputProblem("strength.gauges.height_mm", found, allowed, remedy)
        return None


class StrengthSection(SceneSection):
    """[strength]: `evolvent strength` reads it."""

    editions: Annotated[tuple[Edition, ...], BeforeValidator(as_tuple)] = key(
        "editions of ISO 6336-3 by which root stress is computed beside that of finite elements",
        EDITIONS,
        "write strength.editions = [2006, 2019], or one of the two",
        default=(2006, 2019), min_length=1,
    )
    tolerance_class: int | None = key(
        "of ISO 1328-1, the coarser of both gears: up to 4 the edition of 2006 reckons with teeth that share the load, "
        "Y_DT, where the virtual contact ratio is above 2.05; by default it does not",
        "a whole number from 1 to 12",
        needs=("editions",), holding=2006, default=None, ge=1, le=12,
    )

    root_refinement: int = key(
        "elements around the fillets and across the core of a tooth over those of a run, which has six around a fillet",
        "a whole number from 1 to 8",
        "raise it where the error bar of the stress is too wide",
        too_small="give 1 for the roots of a run, 2 for results",
        too_large="lower it: 8 are 48 elements around a fillet",
        default=2, ge=1, le=8,
    )

    gauges: GaugesSection | None = None

    @field_validator("editions")
    @classmethod
    def _different(cls, editions: tuple[Edition, ...]) -> tuple[Edition, ...]:
        if len(set(editions)) < len(editions):
            raise validation_error(InputProblem("", shown(editions), EDITIONS, "name each once"))
        return editions
