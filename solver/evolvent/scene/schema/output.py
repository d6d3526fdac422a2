"""Sections [output] and [exact]: the files that a run writes, and simplifications that it must not make."""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from pydantic import BeforeValidator, field_validator

from evolvent.scene.schema.section import SceneSection, as_tuple, key


class OutputSection(SceneSection):
    """[output]: the results that are written beside the tables."""

    pictures: bool = key("draw the PNG pictures; the animation has a key of its own", "true or false", default=True)
    animation: bool = key("draw the animation", "true or false", default=True)
    fields: bool = key("write the fields for ParaView", "true or false", default=True)
    deformation: bool = key(
        "also write displacement and stress of the teeth in contact for ParaView, at the first friction coefficient; "
        "both gears are condensed once more",
        "true or false",
        default=False,
    )
    error_bars: bool = key(
        "solve a coarse companion too, for error bars of the engineering figures", "true or false", default=True
    )


SkipName = Literal["plane", "friction-terms", "one-pitch", "one-sector", "far-teeth", "window",
                   "deflected-flanks", "coarse-body", "two-level", "reuse", "error-bars", "fields",
                   "pictures"]
"""Simplifications that a run makes where its scene allows them: `evolvent.scene.skips`."""
SKIP_NAMES: tuple[SkipName, ...] = get_args(SkipName)


class ExactSection(SceneSection):
    """[exact]: parts that are computed without their simplification; for tests and benchmarks."""

    parts: Annotated[tuple[SkipName, ...], BeforeValidator(as_tuple)] = key(
        "parts that are computed without their simplification",
        f"a list of {', '.join(SKIP_NAMES)}",
        "give names of this list; `evolvent check` tells which ones apply to the scene",
        default=(),
    )

    @field_validator("parts")
    @classmethod
    def _each_once(cls, names: tuple[SkipName, ...]) -> tuple[SkipName, ...]:
        """Sorts the names, so that scenes with the same names are equal."""
        return tuple(name for name in SKIP_NAMES if name in names)
