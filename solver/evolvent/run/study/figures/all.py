"""The pictures of a study: curves over one parameter, maps over two, parallel coordinates over more."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from evolvent.results.drawing.labels import ending
from evolvent.results.drawing.picture_files import Picture
from evolvent.run.study.figures.study_values import StudyValues


def study_pictures(values: StudyValues) -> list[Picture]:
    """Pictures of those figures that some scene has; none where no scene is done."""
    drawn = [name for name in values.figures if values.has(name)]
    if not drawn:
        return []
    if len(values.axes) == 1:
        units = dict.fromkeys(ending(_bare(name)) for name in drawn)
        return [_curves(values, unit, [name for name in drawn if ending(_bare(name)) == unit]) for unit in units]
    if len(values.axes) == 2 and not values.is_sampled:
        return [_map(values, name) for name in drawn]
    return [Picture("parallel_coordinates.png", partial(_parallel, values, drawn))]


def _bare(name: str) -> str:
    """Name of a figure without the friction coefficient in brackets."""
    return name.partition(" (")[0]


def _curves(values: StudyValues, unit: str, names: Sequence[str]) -> Picture:
    def drawn() -> bytes:
        from evolvent.run.study.figures.curves import curves_picture  # matplotlib takes a second to import

        return curves_picture(values, names)

    return Picture(f"curves{unit}.png", drawn)


def _map(values: StudyValues, name: str) -> Picture:
    def drawn() -> bytes:
        from evolvent.run.study.figures.heat_map import map_picture

        return map_picture(values, name)

    return Picture(f"map_{name.replace(' (μ = ', '_friction_').removesuffix(')')}.png", drawn)


def _parallel(values: StudyValues, names: Sequence[str]) -> bytes:
    from evolvent.run.study.figures.parallel_coordinates import parallel_picture

    return parallel_picture(values, names)


