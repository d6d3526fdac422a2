"""The pictures of a study: curves over one parameter, maps over two, parallel coordinates over more."""

from __future__ import annotations

from functools import partial

from evolvent.results.drawing.labels import ending
from evolvent.results.drawing.picture_files import Picture
from evolvent.run.study.figures.study_values import StudyValues, bare_name


def study_pictures(values: StudyValues) -> list[Picture]:
    """Pictures of those figures that some scene has; none where no scene is done."""
    shown = [name for name in values.figures if values.has(name)]
    if not shown:
        return []
    from evolvent.results.drawing.style import png_of  # matplotlib takes a second to import
    from evolvent.run.study.figures.curves import curves_figure
    from evolvent.run.study.figures.heat_map import map_figure
    from evolvent.run.study.figures.parallel_coordinates import parallel_figure

    if len(values.axes) == 1:
        units = dict.fromkeys(ending(bare_name(name)) for name in shown)
        alike = {unit: [name for name in shown if ending(bare_name(name)) == unit] for unit in units}
        return [
            Picture(f"curves{unit}.png", partial(png_of, curves_figure, values, names)) for unit, names in alike.items()
        ]
    if len(values.axes) == 2 and not values.is_sampled:
        return [Picture(f"map_{_file_name(name)}.png", partial(png_of, map_figure, values, name)) for name in shown]
    return [Picture("parallel_coordinates.png", partial(png_of, parallel_figure, values, shown))]


def _file_name(name: str) -> str:
    """Name of a figure as part of a file's name."""
    return name.replace(" (μ = ", "_friction_").removesuffix(")")
