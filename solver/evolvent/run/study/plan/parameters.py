"""The parameters of a study: its axes, and the values of each of its scenes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from scipy.stats import qmc

from evolvent.run.study.plan.study_file import LatinHypercubeSection, StudyFile
from evolvent.scene.scene import Scene
from evolvent.scene.schema.errors import keys_of

SampleRow = tuple[Any, ...]


@dataclass(frozen=True)
class Axis:
    """Axis of a study: keys that take their values together."""

    keys: tuple[str, ...]
    """Dotted keys of the scene."""
    rows: tuple[SampleRow, ...]
    """Values of the keys, one row a point of the axis."""


def axes(study: StudyFile) -> list[Axis]:
    """Axes of a study: one for each key of [grid], one for all keys of [list] and one for those of [latin_hypercube].
    """
    found = [Axis((name,), tuple((value,) for value in values)) for name, values in study.grid.items()]
    if study.list:
        found.append(Axis(tuple(study.list), tuple(zip(*study.list.values()))))
    if study.latin_hypercube is not None:
        found.append(_sampled(study.latin_hypercube))
    return found


def combinations(axes: Sequence[Axis]) -> Iterator[Mapping[str, Any]]:
    """Key -> value, for each scene: all combinations of the points of the axes, the last axis varying fastest."""
    for rows in product(*(axis.rows for axis in axes)):
        yield {name: value for axis, row in zip(axes, rows) for name, value in zip(axis.keys, row)}


def _sampled(section: LatinHypercubeSection) -> Axis:
    """Samples of a Latin hypercube: each of as many equal intervals of a parameter holds one (McKay et al. 1979)."""
    lowest, highest = zip(*section.ranges.values())
    sampler = qmc.LatinHypercube(d=len(section.ranges), seed=section.seed)
    samples = qmc.scale(sampler.random(section.samples), lowest, highest)
    whole = [keys_of(Scene)[name].annotation is int for name in section.ranges]
    rows = (tuple(round(v) if w else float(v) for v, w in zip(row, whole)) for row in samples)
    return Axis(tuple(section.ranges), tuple(rows))
