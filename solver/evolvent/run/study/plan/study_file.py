"""The study file: a base scene, parameters, what to compute of each scene and which figures to gather.

Everything that is wrong with it is reported in one `SceneError` before anything is computed or written.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, ValidationError, field_validator, model_validator

from evolvent.run.kinds.all import KINDS
from evolvent.scene.scene import Scene, SceneError, future_warning
from evolvent.scene.scene_text import STUDY_FILE, flat_keys, require_kind, require_shallow, scene_text, toml_values
from evolvent.scene.schema.errors import InputProblem, key_problem, problems_of, shown, validation_error
from evolvent.scene.schema.old_names import Warn, new_names
from evolvent.scene.schema.section import SceneSection, key, listed

COMPUTATIONS = ("check", *(kind.name for kind in KINDS if kind.in_studies))
"""Computations that a study can make of each scene."""
MOST_SCENES = 1_000_000
"""Largest number of scenes of a study."""
PARTS = "grid", "list", "latin_hypercube.ranges"
"""Sections of a study file that hold parameters."""
EXAMPLE = "write for example load.torque_Nm = [100.0, 200.0]"
NAMED = 5
"""Largest number of wrong values that a message names."""


def flat(values: Any) -> Any:
    """Nested tables as one with dotted keys, see `flat_keys`; other values as they are."""
    return flat_keys(values) if isinstance(values, dict) else values


def _tuples(values: Any) -> Any:
    """Values by dotted keys, with tuples in place of lists; other values as they are."""
    return {name: listed(value) for name, value in flat_keys(values).items()} if isinstance(values, dict) else values


SceneKeys = Annotated[dict[str, Any], BeforeValidator(flat)]
ValueLists = Annotated[dict[str, tuple[Any, ...]], BeforeValidator(_tuples)]
Ranges = Annotated[dict[str, tuple[float, float]], BeforeValidator(_tuples)]
Texts = Annotated[tuple[str, ...], BeforeValidator(listed)]


class LatinHypercubeSection(SceneSection):
    """[latin_hypercube]: samples that fill the space of some parameters evenly."""

    kind: ClassVar[str] = "study"
    page: ClassVar[str] = "docs/studies.md"
    samples: int = key("number of samples", "a whole number from 1 to 1000000", ge=1, le=MOST_SCENES)
    seed: int = key("seed of the random numbers: the same one gives the same samples", "a whole number from 0 on",
                    default=0, ge=0)
    ranges: Ranges = key(
        "keys of the scene with the lowest and the highest value of each",
        "keys of the scene, each with two different numbers, the lower one first",
        "write for example load.torque_Nm = [100.0, 300.0]",
    )

    @field_validator("ranges")
    @classmethod
    def _ascending(cls, ranges: Ranges) -> Ranges:
        for name, (low, high) in ranges.items():
            if not low < high:
                allowed, remedy = "two different numbers, the lower one first", f"write {name} = [lowest, highest]"
                raise validation_error(InputProblem(name, shown([low, high]), allowed, remedy))
        return ranges


class FigureSection(SceneSection):
    """[[figure]]: a figure from a table that each scene leaves."""

    kind: ClassVar[str] = "study"
    page: ClassVar[str] = "docs/studies.md"
    name: str = key(
        "name of the figure and of its column, with its unit at the end",
        "letters, digits and underscores, as in pinion_worst_rotation_deg",
        pattern=r"^[A-Za-z]\w{0,79}$",
    )
    file: str = key(
        "file in the folder of a scene that has it",
        "the name of a CSV or JSON file in it, or in a folder below it, docs/outputs.md",
        pattern=r"^([\w-][\w.-]*/)*[\w-][\w.-]*\.(csv|json)$",
    )
    column: str = key("column of the CSV file, or key of the JSON file, dotted where it lies deeper",
                      "a text, docs/outputs.md", min_length=1)
    rows: str = key("key of the list of a JSON file whose entries are its rows", "a text, docs/outputs.md", default="")
    where: Annotated[dict[str, str | int | float], BeforeValidator(flat)] = key(
        "columns with the value that the row must have", "columns, each with a text or a number", default={},
    )
    statistic: Literal["only", "max", "min", "mean", "peak_to_peak", "last"] = key(
        "what is taken of several rows", '"only", where there is just one, or "max", "min", "mean", "peak_to_peak", '
        '"last"', default="only",
    )


class StudyFile(SceneSection):
    """A valid study, complete with its defaults."""

    kind: ClassVar[str] = "study"
    page: ClassVar[str] = "docs/studies.md"
    title: str = key("a name for table and pictures", "a text of up to 200 characters", default="study",
                     max_length=200)
    scene: str = key("the base scene: a path relative to the folder of the study file", "the name of a scene file",
                     min_length=1, max_length=1000)
    compute: str = key(
        "what is computed of each scene, as the command of this name does; wear: as `run` of a scene with [wear]",
        ", ".join(f'"{name}"' for name in COMPUTATIONS), default="run", pattern=f"^({'|'.join(COMPUTATIONS)})$",
    )
    figures: Texts | None = key(
        "figures that the table gathers, by name; those of the computation by default", "a list of names of figures",
        "give names of figures in a list; a figure of your own is a section [[figure]]", default=None, min_length=1,
    )
    leave_out: Texts = key("keys of the base scene that are left out", "a list of keys of the scene", default=())
    share_gears: bool = key(
        "condense the gears of scenes that differ in torque, friction or misalignment only once, on meshes that serve "
        "all their torques", "true or false", default=True,
    )
    set: SceneKeys = key("keys that all scenes share, in place of the base scene's", "keys of the scene with a value",
                         default={})
    grid: ValueLists = key(
        "keys with a list of values each: all combinations", "keys of the scene, each with a list", EXAMPLE, default={}
    )
    list: ValueLists = key(
        "keys with lists of values that go side by side: the first of each, the second, ...",
        "keys of the scene, each with a list, all equally long", EXAMPLE, default={},
    )
    latin_hypercube: LatinHypercubeSection | None = None
    figure: Annotated[tuple[FigureSection, ...], BeforeValidator(listed)] = Field(
        default=(), description="figures from tables of the scenes' folders"
    )

    @model_validator(mode="after")
    def _keys_are_scene_keys(self) -> Self:
        keys: list[tuple[str, str, Any]] = [("leave_out", name, True) for name in self.leave_out]
        keys += [("set", name, value) for name, value in self.set.items()]
        keys += [(part, name, values) for part, given in self.parts().items() for name, values in given.items()]
        for part, name, value in keys:
            if problem := key_problem(name, value, Scene):
                raise validation_error(InputProblem(f"{part}.{problem.key}", problem.found, problem.allowed,
                                                    problem.remedy))
        return self

    @model_validator(mode="after")
    def _each_key_once(self) -> Self:
        places: dict[str, str] = {}
        for part, names in {"set": self.set, **self.parts()}.items():
            for name in names:
                if name in places:
                    found = f"a key that [{places[name]}] has, too"
                    remedy = "delete one of the two"
                    raise validation_error(InputProblem(f"{part}.{name}", found, "each key once", remedy))
                places[name] = part
        return self

    @model_validator(mode="after")
    def _lists_have_values(self) -> Self:
        for part, lists in (("grid", self.grid), ("list", self.list)):
            for name, values in lists.items():
                texts = [repr(value) for value in values]
                twice = sorted({text for text in texts if texts.count(text) > 1}) if len(texts) < MOST_SCENES else []
                if not values:
                    problem = InputProblem(f"{part}.{name}", "an empty list", "at least one value", "give some values")
                    raise validation_error(problem)
                if part == "grid" and twice:
                    found = f"{', '.join(twice[:NAMED])} more than once"
                    remedy = "delete the repeated ones, they would give the same scenes"
                    raise validation_error(InputProblem(f"grid.{name}", found, "different values", remedy))
        lengths = {name: len(values) for name, values in self.list.items()}
        if len(set(lengths.values())) > 1:
            found = ", ".join(f"{name} with {count}" for name, count in lengths.items())
            remedy = "give as many values for each of them; [grid] takes all combinations instead"
            raise validation_error(InputProblem("list", found, "lists that are equally long", remedy))
        return self

    @model_validator(mode="after")
    def _number_of_scenes(self) -> Self:
        if not any(self.parts().values()):
            remedy = 'write [grid] with, for example, "load.torque_Nm" = [100.0, 200.0]'
            allowed = "at least one of [grid], [list] and [latin_hypercube]"
            raise validation_error(InputProblem("grid", "no parameter", allowed, remedy))
        if (count := self.count) > MOST_SCENES:
            found = f"{count:,} scenes" if count < 1e12 else f"{count:.1e} scenes"
            remedy = "give fewer values, or samples of a [latin_hypercube] in place of all combinations"
            raise validation_error(InputProblem("grid", found, f"up to {MOST_SCENES:,} scenes", remedy))
        return self

    def parts(self) -> dict[str, Mapping[str, tuple[Any, ...]]]:
        """Name of a section with parameters -> its keys with their values, or with their range."""
        ranges: Mapping[str, tuple[Any, ...]] = {} if self.latin_hypercube is None else self.latin_hypercube.ranges
        return dict(zip(PARTS, (self.grid, self.list, ranges)))

    @property
    def count(self) -> int:
        """Number of scenes."""
        count = 1
        for values in self.grid.values():
            count *= len(values)
        count *= len(next(iter(self.list.values()), (None,)))
        return count * (self.latin_hypercube.samples if self.latin_hypercube is not None else 1)


def load_study(path: Path, warn: Warn = future_warning) -> StudyFile:
    """Reads and validates a study file. warn: is given a sentence on each old name of a scene's key. Raises SceneError.
    """
    try:
        values = toml_values(scene_text(path, STUDY_FILE), STUDY_FILE)
        require_shallow(values)
        require_kind(values, STUDY_FILE)
        _rename(values, warn)
        return StudyFile.model_validate(values)
    except ValidationError as error:
        raise SceneError(problems_of(error, StudyFile), str(path)) from error
    except SceneError as error:
        raise SceneError(error.problems, str(path)) from error.__cause__


def _rename(values: dict[str, Any], warn: Warn) -> None:
    """Gives the scene's keys in a study file, not yet validated, their present names. Raises SceneError."""
    for part in ("leave_out", "set", *PARTS):
        *sections, name = part.split(".")
        holder = values.get(sections[0]) if sections else values
        given = holder.get(name) if isinstance(holder, dict) else None
        if isinstance(holder, dict) and isinstance(given, dict):
            holder[name] = new_names(flat(given), warn)
        elif isinstance(holder, dict) and isinstance(given, list) and all(isinstance(each, str) for each in given):
            holder[name] = list(new_names(dict.fromkeys(given), warn))
