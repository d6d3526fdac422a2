"""How fine a pair is meshed: where the pinion, which carries the pressure, is much stiffer than its wheel."""

from __future__ import annotations

import pytest
from mpi4py import MPI

from evidence.solved_run import solved_run
from evolvent.check.scene_warnings import scene_warnings
from evolvent.gears.meshing.element_sizes import elements_per_contact_width
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import scene_from_text

SPUR = """
[pair]
normal_module_mm = 3.0
[pinion]
teeth = 20
face_width_mm = 20.0
[wheel]
teeth = 40
face_width_mm = 20.0
[load]
torque_Nm = 15.0
[mesh]
level = "quick"
[sweep]
positions = 12
"""


@pytest.mark.parametrize(
    ("moduli", "own", "elements"),
    [
        ((210.0, 210.0), None, 1.7),
        ((210.0, 45.0), None, 1.7),
        ((210.0, 30.0), None, 3.0),
        ((3.0, 210.0), None, 1.7),
        ((210.0, 3.0), 2.0, 2.0),
    ],
)
def test_stiff_pinion_has_three_elements_across_the_contact(
    moduli: tuple[float, float], own: float | None, elements: float
) -> None:
    """Level quick, 1.7 elements across: 3 where the pinion is more than five times as stiff as the wheel; what the
    scene says holds, with a warning."""
    sets = [f"material.{gear}.E_GPa={E}" for gear, E in zip(("pinion", "wheel"), moduli)]
    sets += [] if own is None else [f"mesh.elements_per_contact_width={own}"]
    scene = scene_from_text(SPUR, sets)
    assert elements_per_contact_width(gear_problem(scene)) == elements
    said = any("softer gear the pinion" in sentence for sentence in scene_warnings(scene))
    assert said == (own is not None)


def test_pressure_on_a_plastic_wheel_is_that_of_hertz() -> None:
    """Problem: a steel pinion on a wheel of 3 GPa, ν = 0.4, 15 N·m, without friction. Exact: Hertz where one pair
    carries the whole load, 66.0 MPa at the pitch point; within 8 %, with 1.7 elements 223 MPa were found."""
    scene = scene_from_text(SPUR, ["material.wheel.E_GPa=3", "material.wheel.nu=0.4", "contact.friction=0"])
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    assert friction_rows(run)[0].max_pressure_MPa == pytest.approx(66.0, rel=0.08)
