"""The points on the flanks that Yang et al. 2022 plot."""

from __future__ import annotations

import pytest

from evidence.pages.papers.yang_places import at_point, paper_points, paper_position
from tests.support.synthetic_run import synthetic_run


def test_points_lie_where_the_paper_says() -> None:
    """A, B, C on the line through the pitch circle: below, at, above it; D on the line near the root. All on the flank
    and under pressure."""
    run = synthetic_run("contact.friction=[0.0, 0.1, 0.2]")
    k = paper_position(run)
    a, b, c, d = paper_points(run, k)
    assert a.roll_distance < b.roll_distance == 0.0 < c.roll_distance
    assert d.roll_distance < a.roll_distance
    assert (a.tooth, b.tooth, c.tooth, d.tooth) == (0, 0, 0, -1)
    for point in (a, b, c, d):
        exact = run.pair.roll_distance(run.angles[k], point.tooth, point.z)
        assert float(exact) == pytest.approx(point.roll_distance, abs=1e-9)
        assert at_point(run.positions[k][0].cut, point) > 1000.0
