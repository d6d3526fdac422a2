"""From a scene to the plain data of gears: each skip that is switched off is one option, decided here alone."""

from __future__ import annotations

from dataclasses import asdict, fields
from typing import get_args

import pytest

from evolvent.gears.problem.gear_problem import GearOptions
from evolvent.scene.gear_problem import gear_options, gear_problem, shares_gears
from evolvent.scene.schema.output import SkipName
from evolvent.scene.skips import OF_OUTPUT
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, spur_scene
from tests.support.scene_texts import WEAR

OPTIONS: dict[SkipName, str] = {
    "plane": "in_space",
    "friction-terms": "friction_terms",
    "one-pitch": "whole_engagement",
    "one-sector": "whole_gears",
    "far-teeth": "all_teeth",
    "window": "whole_flanks",
    "deflected-flanks": "deflected_flanks",
    "coarse-body": "fine_body",
}
"""A skip, and the option that computes what it leaves out."""


def test_by_default_nothing_is_computed_in_full() -> None:
    """A scene without exact.parts has the default options, and gears that all coefficients share."""
    assert gear_options(helical_scene()) == GearOptions()
    assert not any(asdict(GearOptions()).values())
    assert shares_gears(helical_scene())


@pytest.mark.parametrize("name", OPTIONS)
def test_a_skip_switched_off_is_one_option(name: SkipName) -> None:
    """Problem: one name in exact.parts. Exact: its option alone is set."""
    options = asdict(gear_options(helical_scene(f'exact.parts=["{name}"]')))
    assert [key for key, value in options.items() if value] == [OPTIONS[name]]


def test_every_skip_has_an_option() -> None:
    """The options, `two_levels`, `shares_gears` and the output's are all skips that there are, and every option has its
    skip."""
    assert {*OPTIONS, *OF_OUTPUT, "two-level", "reuse"} == set(get_args(SkipName))
    assert set(OPTIONS.values()) == {field.name for field in fields(GearOptions)}
    assert not shares_gears(helical_scene('exact.parts=["reuse"]'))
    assert shares_gears(helical_scene('exact.parts=["reuse"]', "contact.friction=0.1"))  # a single coefficient


def test_levels_are_left_to_the_size_of_the_mesh() -> None:
    """Unless they are switched off, or flanks wear."""
    wearing = helical_scene("contact.friction=0.1", *WEAR)
    scenes = helical_scene(), helical_scene('exact.parts=["two-level"]'), wearing
    assert [gear_problem(scene).mesh.two_level for scene in scenes] == [None, False, False]


def test_problem_has_the_values_of_the_scene() -> None:
    """Torque [N·mm] and its gear, materials, mesh, and no charts where none are given."""
    scene = spur_scene("load.on='wheel'", "material.wheel.E_GPa=70", "mesh.level='fine'", "mesh.order=1")
    problem = gear_problem(scene)
    assert (problem.torque, problem.torque_on) == (170e3, Member.WHEEL)
    assert [material.youngs_modulus for material in problem.materials] == [210e3, 70e3]
    assert (problem.mesh.level, problem.mesh.order, problem.mesh.shape) == ("fine", 1, "hexahedron")
    assert problem.pair == scene.gear_pair() and problem.flanks == (None, None)
    assert problem.pinion_torque == 170e3 and problem.is_plane
