"""The section [design]: flank modifications that vary, and what they are to be good for."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, NamedTuple, Self, get_args

from pydantic import BeforeValidator, ValidationError, field_validator, model_validator

from evolvent.scene.schema.errors import InputProblem, shown, validation_error
from evolvent.scene.schema.flank import MOST, FlankKeys
from evolvent.scene.schema.section import SceneSection, key, listed

BOTH, PAIR = "both", "pair"
"""Section of a key that pinion and wheel share, and of those of the pair."""
MODIFICATIONS = tuple(name for name, field in FlankKeys.model_fields.items() if name.endswith(("_um", "_mm")))
"""Keys of [pinion] and [wheel] that may vary."""
MISALIGNMENT = f"{PAIR}.misalignment_um"
"""Key that may deviate, but is nobody's choice."""
Figure = Literal[
    "transmission_error_peak_to_peak_um", "face_load_factor", "largest_pressure_MPa", "loss_percent",
    "transmission_error_first_harmonic_um",
]
FIGURES: tuple[Figure, ...] = get_args(Figure)
"""Figures of a variant that can be targets and have limits."""
LOSS: Figure = "loss_percent"
"""Friction loss over the input of the pitch: computed where it is a target or has a limit."""
HARMONIC: Figure = "transmission_error_first_harmonic_um"
"""Amplitude of the first mesh harmonic of the transmission error."""
ROUNDING = 1e-6
"""Part of a range by which its steps may miss its end."""
CORNERS = 5
"""Largest number of deviations of which all combinations of extreme values are computed."""
SPREAD = 32
"""Number of combinations of deviations between the extreme ones."""
PERCENTS = 25.0, 50.0, 75.0, 100.0
"""Torques of `evolvent design` where none are given [% of load.torque_Nm]."""
MOST_VARIABLES, MOST_SAMPLES, MOST_VERIFIED = 8, 100_000, 10
KEY = (
    f"pinion, wheel or {BOTH} (the same on both gears), a dot, and one of {', '.join(MODIFICATIONS)}"
)


class Vary(NamedTuple):
    """A modification that varies in steps."""

    key: str
    """Dotted key of the scene, or `both` and the key of a gear."""
    lowest: float
    """Lowest value."""
    highest: float
    """Highest value."""
    step: float
    """Distance of the values."""

    @property
    def size(self) -> int:
        """Number of values."""
        return math.floor((self.highest - self.lowest) / self.step * (1.0 + ROUNDING)) + 1


class Tolerance(NamedTuple):
    """A deviation in production."""

    key: str
    """Dotted key of the scene; with `both` each gear deviates by itself."""
    amount: float
    """Largest deviation to either side."""


class Limit(NamedTuple):
    """A limit of a figure under every torque."""

    figure: Figure
    """Name of the figure."""
    most: float
    """Largest value that is allowed."""


def rows(kind: type[Vary] | type[Tolerance] | type[Limit]) -> BeforeValidator:
    """Validator that makes rows of a list of lists; other values are left for the schema to refuse."""

    def made(value: Any) -> Any:
        if not isinstance(value, (list, tuple)):
            return value
        fits = [isinstance(row, (list, tuple)) and len(row) == len(kind._fields) for row in value]
        if not all(fits):
            wrong = value[fits.index(False)]
            wanted = f"rows [{', '.join(kind._fields)}]"
            raise validation_error(InputProblem("", shown(wrong), wanted, f"write each row as {wanted[5:]}"))
        return tuple(kind(*row) for row in value)

    return BeforeValidator(made)


class DesignSection(SceneSection):
    """[design]: `evolvent design` reads it."""

    vary: Annotated[tuple[Vary, ...], rows(Vary)] = key(
        "modifications that vary: rows of key, lowest value, highest value, step",
        f"a list of 1 to {MOST_VARIABLES} rows [key, lowest, highest, step]",
        'write for example vary = [["both.tip_relief_um", 0.0, 60.0, 5.0]]', min_length=1, max_length=MOST_VARIABLES,
    )
    targets: Annotated[tuple[Figure, ...], BeforeValidator(listed)] = key(
        "figures that are to be small, each by its largest value under all torques; the best variant has the smallest "
        "first one, of several those variants are marked that no other one beats in all",
        f"a list of 1 to {len(FIGURES)} of {', '.join(FIGURES)}", default=FIGURES[:1], min_length=1,
        max_length=len(FIGURES),
    )
    limits: Annotated[tuple[Limit, ...], rows(Limit)] = key(
        "largest values of figures, under every torque: rows of figure and value",
        f"a list of rows [figure, largest value], each of another figure: {', '.join(FIGURES)}",
        'write for example limits = [["face_load_factor", 1.3]]', default=(),
    )
    search: Literal["optimum", "sobol"] = key(
        'how variants are chosen where there are more than samples: "optimum" by differential evolution towards the '
        'targets, "sobol" evenly, by a Sobol sequence; else all are computed',
        '"optimum" or "sobol"', default="optimum",
    )
    samples: int = key(
        "largest number of variants that the search computes", f"a whole number from 1 to {MOST_SAMPLES:,}",
        default=500, ge=1, le=MOST_SAMPLES,
    )
    tolerances: Annotated[tuple[Tolerance, ...], rows(Tolerance)] = key(
        f"deviations in production, for the bands of the best variants: rows of key and amount to either side; also "
        f"{MISALIGNMENT}",
        f"a list of up to {MOST_VARIABLES} rows [key, amount]",
        'write for example tolerances = [["both.tip_relief_um", 5.0]]', default=(), max_length=MOST_VARIABLES,
    )
    verified: int = key(
        "number of the best variants whose contact is resolved, at the level of the scene, and that of the scene as it "
        "stands beside them; 0: none",
        f"a whole number from 0 to {MOST_VERIFIED}", default=1, ge=0, le=MOST_VERIFIED,
    )

    @property
    def size(self) -> int:
        """Number of variants: combinations of the values of all that varies."""
        return math.prod(row.size for row in self.vary)

    @property
    def deviations(self) -> int:
        """Number of variants within the tolerances of one, with itself; 0 without tolerances."""
        count = len(expanded(self.tolerances))
        corners, ones = (2**count if count <= CORNERS else 0), (2 * count if count > 1 else 0)
        return 1 + corners + ones + SPREAD if count else 0

    @property
    def asked(self) -> set[Figure]:
        """Figures that are targets or have limits."""
        return {*self.targets, *(limit.figure for limit in self.limits)}

    @model_validator(mode="after")
    def _keys_are_modifications(self) -> Self:
        for part, listed_rows, others in (("vary", self.vary, ()), ("tolerances", self.tolerances, (MISALIGNMENT,))):
            for row in listed_rows:
                section, _, name = row.key.partition(".")
                gears = section in ("pinion", "wheel", BOTH) and name in MODIFICATIONS
                if not gears and row.key not in others:
                    allowed = KEY + "".join(f", or {each}" for each in others)
                    raise validation_error(InputProblem(part, shown(row.key), allowed, "see docs/flank_design.md"))
            if twice := sorted({each for each in expanded(listed_rows) if expanded(listed_rows).count(each) > 1}):
                problem = InputProblem(part, f"{twice[0]} more than once", "each key once", "delete one of its rows")
                raise validation_error(problem)
        return self

    @model_validator(mode="after")
    def _values_are_allowed(self) -> Self:
        for row in self.vary:
            name = row.key.partition(".")[2]
            for value in (row.lowest, row.highest):
                try:
                    FlankKeys.model_validate({name: value})
                except ValidationError as error:
                    words = FlankKeys.model_fields[name].json_schema_extra
                    allowed = str(words["allowed"]) if isinstance(words, dict) else ""
                    found = f"{shown(value)} of {row.key}"
                    raise validation_error(InputProblem("vary", found, allowed, "mend that row")) from error
        return self

    @field_validator("vary")
    @classmethod
    def _ascending(cls, values: tuple[Vary, ...]) -> tuple[Vary, ...]:
        for row in values:
            if not (row.lowest < row.highest and 0.0 < row.step <= row.highest - row.lowest):
                allowed = "a lowest value below the highest, and a step above 0 that is not larger than their distance"
                raise validation_error(InputProblem("", shown(list(row)), allowed, "mend that row"))
            steps = (row.highest - row.lowest) / row.step
            if abs(steps - round(steps)) > ROUNDING * steps:
                last = row.lowest + math.floor(steps) * row.step
                allowed = "a step that leads from the lowest value to the highest"
                remedy = f"end the range at {last:.6g} or at {last + row.step:.6g}, or give another step"
                raise validation_error(InputProblem("", shown(list(row)), allowed, remedy))
        return values

    @field_validator("targets", "limits")
    @classmethod
    def _each_figure_once(cls, values: tuple[Any, ...]) -> tuple[Any, ...]:
        names = [each if isinstance(each, str) else each[0] for each in values]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise validation_error(InputProblem("", f"{twice[0]} more than once", "each once", "delete one of them"))
        return values

    @field_validator("tolerances", "limits")
    @classmethod
    def _positive(cls, values: tuple[Tolerance | Limit, ...]) -> tuple[Tolerance | Limit, ...]:
        for row in values:
            most = MOST if isinstance(row, Tolerance) else math.inf
            if not 0.0 < row[1] <= most:
                allowed = f"a number above 0{'' if math.isinf(most) else f' up to {most}'}"
                raise validation_error(InputProblem("", shown(list(row)), allowed, "mend that row"))
        return values


def expanded(listed_rows: tuple[Vary, ...] | tuple[Tolerance, ...]) -> list[str]:
    """Keys of the scene that some rows stand for, of both gears where they share one."""
    return [name for row in listed_rows for name in keys_of_both(row.key)]


def keys_of_both(name: str) -> tuple[str, ...]:
    """Keys of the scene that a key of [design] stands for."""
    section, _, last = name.partition(".")
    return (f"pinion.{last}", f"wheel.{last}") if section == BOTH else (name,)
