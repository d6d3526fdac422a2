"""What `evolvent check` tells of the section [design]: variants, torques and positions; what it would refuse."""

from __future__ import annotations

import pytest

from evolvent.check.check_report import overview
from evolvent.check.design_rows import design_refusals, design_rows
from evolvent.check.scene_warnings import scene_warnings
from evolvent.scene.scene import Scene
from tests.support.gear_cases import spur_scene

VARY = 'design.vary=[["both.tip_relief_um",0.0,40.0,2.0],["pinion.lead_crowning_um",0.0,8.0,2.0]]'


def told(*settings: str) -> dict[str, str]:
    """Name of a row -> its value."""
    scene = spur_scene(VARY, "sweep.positions=30", *settings)
    assert scene.design is not None
    return {row.name.strip(): row.values[0] for row in design_rows(scene, scene.design)}


def test_all_variants_where_they_are_no_more_than_the_samples() -> None:
    """21 reliefs and 5 crownings are 105 variants; with the scene as it stands 106 · 30 positions · 4 torques."""
    found = told()
    assert (found["combinations of what varies"], found["searched by"]) == ("105", "computing all of them")
    assert found["variants computed, beside the scene"] == "105"
    assert found["loads"] == "25 %, 50 %, 75 %, 100 %" and found["positions × torques × variants"] == "12,720"
    assert "again with friction, for the loss" not in found and "limits" not in found
    assert "variants within tolerances, of each best one" not in found


@pytest.mark.parametrize(("search", "words"), [("sobol", "an even sample (Sobol)"), ("optimum", "differential evol")])
def test_a_part_of_them(search: str, words: str) -> None:
    """About as many as the samples, under the torques of the scene's list; with a loss each once more."""
    loss = 'design.targets=["loss_percent"]'
    found = told("design.samples=50", f"design.search={search}", "load.percents=[100,20]", loss)
    assert found["searched by"].startswith(words) and found["variants computed, beside the scene"] == "about 50"
    assert found["loads"] == "20 %, 100 %" and found["positions × torques × variants"] == "3,060"
    assert found["again with friction, for the loss"] == "3,060" and found["targets"] == "loss_percent"


def test_tolerances_and_what_is_resolved() -> None:
    """Two deviations: the variant, 4 corners, 4 extremes by themselves, 32 in between."""
    found = told('design.tolerances=[["both.tip_relief_um",2.0]]', "design.verified=3", "mesh.level=quick")
    assert found["variants within tolerances, of each best one"] == "41"
    assert found["best ones with the contact resolved"] == "3 at level quick"
    assert told("mesh={level='line'}")["best ones with the contact resolved"] == "none at level line"


def test_tables_of_the_report() -> None:
    """Bounds, steps and number of values of what varies; tolerances where there are some; none without [design]."""
    lines = overview(spur_scene(VARY, 'design.tolerances=[["pair.misalignment_um",5.0]]')).splitlines()
    rows = [line.split() for line in lines]
    assert ["both.tip_relief_um", "µm", "0", "40", "2", "21"] in rows
    assert ["pinion.lead_crowning_um", "µm", "0", "8", "2", "5"] in rows
    assert ["pair.misalignment_um", "µm", "5"] in rows
    assert not any(line.startswith(("Design", "What varies")) for line in overview(spur_scene()).splitlines())


def refused(scene: Scene) -> list[str]:
    assert scene.design is not None
    return [str(each) for each in design_refusals(scene, scene.design)]


def test_a_loss_without_one_friction_coefficient_would_be_refused() -> None:
    """No coefficient but 0, and a list of them; a warning of `check` says so."""
    loss = VARY, 'design.limits=[["loss_percent",0.7]]'
    for friction in ("0", "[0.05,0.1]"):
        scene = spur_scene(*loss, f"contact.friction={friction}")
        (problem,) = refused(scene)
        assert problem.startswith("contact.friction: found ") and "0.05 is usual" in problem
        assert any(each.startswith("`evolvent design` would refuse") for each in scene_warnings(scene))
    assert not refused(spur_scene(*loss, "contact.friction=0.05"))
    assert not refused(spur_scene(VARY, "contact.friction=0"))
