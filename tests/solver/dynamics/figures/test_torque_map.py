"""What the picture of the map shows, of rows that are made up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from matplotlib.collections import LineCollection, PolyCollection

from evolvent.dynamics.figures.torque_map import MapGrid, torque_map_figure
from evolvent.dynamics.results.torque_map import MapRow

TORQUES, SPEEDS = (10.0, 20.0, 40.0), (1000.0, 2000.0, 3000.0, 4000.0)


def made(factors: Sequence[float] = (), apart: Sequence[float] = ()) -> list[MapRow]:
    """Factors and shares running down, one after the other over all cells; running up 1.5 and none."""
    found = []
    for i, torque in enumerate(TORQUES):
        for way in ("up", "down"):
            for j, speed in enumerate(SPEEDS):
                cell = i * len(SPEEDS) + j
                factor = factors[cell] if factors and way == "down" else 1.5
                share = apart[cell] if apart and way == "down" else 0.0
                force = torque * factor
                common = torque, 100.0 * torque, speed, way, 1, 1.0, 1.0
                found.append(MapRow(*common, force, factor, share, 0.0, "elastic"))
    return found


def test_grid_has_the_rows_where_they_belong() -> None:
    """Running down the factors 1 to 12 by torque and speed, up 1.5 everywhere."""
    grid = MapGrid.of(made(factors=range(1, 13)))
    assert (grid.torques.tolist(), grid.speeds.tolist()) == (list(TORQUES), list(SPEEDS))
    assert grid.natural_speeds.tolist() == [1000.0, 2000.0, 4000.0]
    assert (grid.factor[0] == 1.5).all()
    assert (grid.factor[1] == np.arange(1, 13).reshape(3, 4)).all()


def test_region_of_parting_is_outlined() -> None:
    """One cell, of 20 N·m at 2000 r/min running down: four sides around it, halfway to the cells beside; none running
    up."""
    up, down = torque_map_figure(made(apart=[0.1 * (cell == 5) for cell in range(12)])).axes[:2]
    lines = [each for each in down.collections if isinstance(each, LineCollection)]
    for each in lines:
        points = np.concatenate(each.get_segments())
        assert len(each.get_segments()) == 4
        assert {tuple(point) for point in points} == {(x, y) for x in (1500.0, 2500.0) for y in (15.0, 30.0)}
    assert len(lines) == 2
    assert not any(each.get_segments() for each in up.collections if isinstance(each, LineCollection))


def test_differences_of_both_ways_are_hatched() -> None:
    """Two cells of twelve by 3 %, others by 1 %: two are hatched, and the foot says what that means."""
    figure = torque_map_figure(made(factors=[1.545 if cell in (3, 4) else 1.515 for cell in range(12)]))
    (hatched,) = [each for each in figure.axes[1].collections if isinstance(each, PolyCollection)]
    assert len(hatched.get_paths()) == 2
    for drawn, wanted in ((figure, "Hatched: "), (torque_map_figure(made()), "the same within 2 %")):
        assert any(wanted in text.get_text() for text in drawn.texts)


def test_largest_factors_stand_above() -> None:
    """Both ways, with speed and torque; without separation that is said."""
    factors = [2.25 if cell == 6 else 1.5 for cell in range(12)]
    texts = [text.get_text() for text in torque_map_figure(made(factors=factors)).texts]
    (said,) = [text for text in texts if text.startswith("Largest")]
    assert "1.5 running up (1000 r/min, 10 N·m), 2.25 running down (3000 r/min, 20 N·m)" in said
    assert said.endswith("flanks never part.")
    assert any(text.startswith("Of elastic gear bodies.\n") for text in texts)


def test_one_torque_alone_is_drawn() -> None:
    """Where the others had no steady states: a line of cells around it."""
    up = torque_map_figure(made()[:8]).axes[0]
    assert up.get_ylim() == pytest.approx((9.0, 11.0))
