"""Targets, limits, edges and front of made-up figures."""

from __future__ import annotations

import numpy as np

from evolvent.run.design.ranking import Ranking
from evolvent.scene.schema.design import FIGURES, DesignSection, Vary
from evolvent_meshes.arrays import Floats

ERROR, FACTOR, PRESSURE, LOSS, HARMONIC = FIGURES
VARY = (Vary("both.tip_relief_um", 0.0, 10.0, 1.0),)


def section(**given: object) -> DesignSection:
    return DesignSection.model_validate({"vary": [list(row) for row in VARY], **given})


def figures(*rows: tuple[float, float, float, float]) -> Floats:
    """Figures under one torque, without a loss; the first harmonic is half of the peak-to-peak value."""
    given = np.array(rows)
    loss, harmonic = np.full((len(rows), 1), np.nan), 0.5 * given[:, :1]
    return np.hstack([given[:, :3], loss, harmonic, given[:, 3:]])[:, None]


def test_the_largest_value_of_all_torques_counts() -> None:
    """1 and 3 µm under two torques are worse than 2 and 2."""
    light, heavy, middle = (figures((error, 1.0, 900.0, 0.0))[0] for error in (1.0, 3.0, 2.0))
    found = np.array([np.concatenate([light, heavy]), np.concatenate([middle, middle])])
    ranking = Ranking(section(), found)
    assert ranking.largest(ERROR).tolist() == [3.0, 2.0] and ranking.best(1).tolist() == [1]


def test_limits_leave_out() -> None:
    """The smallest error has a factor of 1.5, the next one 1.3 of 1.4 allowed."""
    ranking = Ranking(
        section(limits=[[FACTOR, 1.4]]), figures((1.0, 1.5, 900.0, 0.0), (2.0, 1.3, 900.0, 0.0), (3.0, 1.1, 900.0, 0.0))
    )
    assert ranking.is_allowed.tolist() == [False, True, True] and ranking.best(9).tolist() == [1, 2]
    costs = ranking.cost(ERROR)
    assert costs[0] > 1e6 and costs[1:].tolist() == [2.0, 3.0]


def test_costs_lead_back_to_what_is_allowed() -> None:
    """The more a limit is exceeded, the more load on edges, the higher the cost; worst is a variant without figures."""
    nothing, without_factor = (np.nan, np.nan, np.nan, np.nan), (0.1, np.nan, 900.0, 0.0)
    ranking = Ranking(section(limits=[[FACTOR, 1.4]]), figures(
        (9.0, 1.0, 900.0, 0.0), (1.0, 1.5, 900.0, 0.0), (1.0, 9.0, 900.0, 0.0), (1.0, 1.0, 900.0, 0.02),
        (1.0, 1.0, 900.0, 0.5), nothing,
    ))
    costs = ranking.cost(ERROR)
    assert np.isfinite(costs).all() and (np.diff(costs) > 0.0).all()
    unknown = Ranking(section(limits=[[FACTOR, 1.4]]), figures(without_factor))
    assert unknown.cost(ERROR)[0] == costs[-1] and not unknown.is_allowed[0]


def test_edges_compete_where_their_contact_is_resolved() -> None:
    """5 % of the load on edges: no line contact; a candidate where the transmission error alone is asked for and the
    contact will be resolved; with 30 % never, though that variant is named where its estimate is smaller."""
    rows = figures((1.0, 1.0, 900.0, 0.3), (2.0, 1.0, 900.0, 0.05), (3.0, 1.0, 900.0, 0.0))
    assert Ranking(section(), rows).checked == [2]
    assert Ranking(section(), rows, True).checked == [1, 2]
    assert Ranking(section(targets=[FACTOR]), rows, True).checked == [2]
    assert Ranking(section(limits=[[PRESSURE, 1e3]]), rows, True).checked == [2]
    assert Ranking(section(), rows, True).left_out(2.0).tolist() == [0]


def test_front_of_two_targets() -> None:
    """(1, 3), (2, 2), (3, 1) are not beaten; (3, 3) is, by (2, 2); of two alike neither beats the other."""
    rows = [(1.0, 3.0), (2.0, 2.0), (3.0, 1.0), (3.0, 3.0), (2.0, 2.0)]
    ranking = Ranking(section(targets=[ERROR, FACTOR]), figures(*((a, b, 900.0, 0.0) for a, b in rows)))
    assert ranking.front.tolist() == [True, True, True, False, True]
    assert ranking.best(2).tolist() == [0, 2]


def test_equal_figures_leave_the_transmission_error_to_decide() -> None:
    """Pressures that differ by 1e-10 are the same: the variant with 5 µm is best, and alone on the front."""
    rows = figures((6.0, 1.0, 1176.9699673, 0.0), (5.0, 1.0, 1176.9699674, 0.0))
    assert Ranking(section(targets=[PRESSURE]), rows).best(1).tolist() == [1]
    assert Ranking(section(targets=[PRESSURE, ERROR]), rows).front.tolist() == [False, True]


def test_loss_as_target_and_as_limit() -> None:
    """The loss is smallest of the second variant, whose transmission error is larger; of those up to 0.7 % the first
    one has the smallest error. A variant without a loss is not allowed."""
    rows = figures((1.0, 1.0, 900.0, 0.0), (2.0, 1.0, 900.0, 0.0), (0.5, 1.0, 900.0, 0.0), (0.1, 1.0, 900.0, 0.0))
    rows[:, 0, 3] = 0.7, 0.6, 0.8, np.nan
    assert Ranking(section(targets=[LOSS]), rows).best(9).tolist() == [1, 0, 2]
    limited = Ranking(section(limits=[[LOSS, 0.7]]), rows)
    assert limited.is_allowed.tolist() == [True, True, False, False] and limited.best(1).tolist() == [0]


def test_first_harmonic_as_limit() -> None:
    """Half of 1 µm is allowed, half of 3 µm is not; with edges that bear 5 % it does not compete by estimates."""
    rows = figures((1.0, 1.0, 900.0, 0.0), (3.0, 1.0, 900.0, 0.0), (0.5, 1.0, 900.0, 0.05))
    ranking = Ranking(section(limits=[[HARMONIC, 1.0]]), rows, True)
    assert ranking.is_allowed.tolist() == [True, False, False]


def test_variants_within_the_error_bar_of_the_best_one() -> None:
    """2.0, 2.05 and 3 µm ± 0.1: one other cannot be told from the best."""
    rows = figures((2.0, 1.0, 900.0, 0.0), (2.05, 1.0, 900.0, 0.0), (3.0, 1.0, 900.0, 0.0))
    assert Ranking(section(), rows).like(0, 0.1).tolist() == [1]
