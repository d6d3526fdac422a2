"""The section [strength]: tooth root stress by the standard, beside that of the contact solution."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, field_validator

from evolvent.scene.schema.errors import InputProblem, shown, validation_error
from evolvent.scene.schema.section import SceneSection, as_tuple, key

EDITIONS = "a list of 2006, 2019 or both"
Edition = Literal[2006, 2019]


class StrengthSection(SceneSection):
    """[strength]: `evolvent strength` reads it."""

    editions: Annotated[tuple[Edition, ...], BeforeValidator(as_tuple)] = key(
        "editions of ISO 6336-3 by which root stress is computed beside that of finite elements",
        EDITIONS,
        default=(2006, 2019), min_length=1,
    )  # fmt: skip
    tolerance_class: int | None = key(
        "of ISO 1328-1, the coarser of both gears: up to 4 the edition of 2006 reckons with teeth that share the load, "
        "Y_DT, where the virtual contact ratio is above 2.05; by default it does not",
        "a whole number from 1 to 12",
        default=None, ge=1, le=12,
    )  # fmt: skip

    root_refinement: int = key(
        "elements around the fillets and across the core of a tooth over those of a run, which has six around a fillet",
        "a whole number from 1 to 8",
        "raise it where the error bar of the stress is too wide",
        default=2, ge=1, le=8,
    )  # fmt: skip

    @field_validator("editions")
    @classmethod
    def _different(cls, editions: tuple[Edition, ...]) -> tuple[Edition, ...]:
        if len(set(editions)) < len(editions):
            raise validation_error(InputProblem("editions", shown(editions), EDITIONS, "name each once"))
        return editions
