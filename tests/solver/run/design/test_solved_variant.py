"""A variant under all torques: meshes of its loss, and figures that are not known."""

from __future__ import annotations

import math

import pytest

from evolvent.gears.meshing.levelled_meshes import flank_cells
from evolvent.results.archive.run_cost import Timings
from evolvent.run.design.solved_variant import NOT_SOLVED, SolvedLoss, SolvedVariant, under_each
from evolvent.run.dynamics.scene_torques import listed_torques
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, spur_scene


@pytest.mark.parametrize("percents", [(5.0, 100.0), (50.0, 200.0), (150.0, 200.0)])
def test_loss_is_solved_on_the_meshes_of_the_excitation(percents: tuple[float, ...]) -> None:
    """Under torques below, around and above the scene's own: so many rows and layers as the excitation has, whatever
    the torque, and as many torques."""
    for scene in (spur_scene(), helical_scene()):
        loads = listed_torques(scene, percents)
        problems = [gear_problem(each) for each in under_each(loads)]
        assert [each.torque for each in problems] == pytest.approx(loads.torques)
        for member in Member:
            assert {flank_cells(each, member) for each in (*problems, loads.problem)} == {
                flank_cells(loads.problem, member)
            }


def test_figures_that_are_not_known() -> None:
    """Nothing was solved: NaN throughout. A loss under the lighter of two torques stands in its place."""
    assert all(math.isnan(value) for pairs in NOT_SOLVED.figures(2).values() for pair in pairs for value in pair)
    unknown = math.nan, math.nan
    loss = SolvedLoss([(0.6, 0.01), unknown], Timings(), ("a warning",), ("a reason",))
    variant = SolvedVariant(loss=loss, reason="another")
    assert variant.figures(2)["loss"][0] == (0.6, 0.01) and math.isnan(variant.figures(2)["loss"][1][0])
    assert math.isnan(variant.figures(2)["error"][0][0]) and len(variant.figures(2)["error"]) == 2
    assert variant.warnings == ("a warning",) and variant.reasons == ("another", "a reason")
