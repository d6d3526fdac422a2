"""A position of a line contact in the form of a resolved one: torques, nodal forces, transmission error."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.kinematics import PairRotation
from evolvent.gears.line.line_position import position_of
from evolvent.gears.line.line_result import LineResult
from evolvent.gears.solution.certificates import balance_error
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.rotation import turn
from tests.solver.gears.line.test_line_friction import helical, spur
from tests.solver.gears.line.test_line_gears import helical_model
from tests.support.gear_cases import model_of, spur_scene


def test_position_has_the_figures_of_the_line_contact() -> None:
    """Exact: transmission error, torques and their balance, tangent stiffness without friction; 1e-4 of the input is
    what parts of layers leave of the balance."""
    gears, force = helical(), 1500.0
    position = gears.position(0.05)
    smooth, found = LineResult.of(position, force), LineResult.of(position, force, 0.2, gears.free)
    result = position_of(gears, found, smooth, force)
    assert result.transmission_error == pytest.approx(found.transmission_error, rel=1e-12)
    assert result.torques[0] == pytest.approx(force * gears.pair.pinion.base_radius, rel=1e-12)
    assert result.torques[1] < result.torques[0] * gears.pair.ratio
    assert result.stiffness == smooth.equilibrium.stiffness
    assert balance_error(result) < 1e-4
    whole = sum(found.force(tooth) for tooth in found.teeth)
    assert result.load_share(0) == pytest.approx(found.force(0) / whole, rel=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("plane", [True, False])
def test_nodal_forces_have_the_torques(plane: bool, friction: float) -> None:
    """Exact: the moments of the nodal forces about the axes of pinion and wheel are the torques. Nodes lie on both
    sides of the line, and forces on them along their own normals: 0.5 %."""
    gears, force = (spur(), 120.0) if plane else (helical(), 1500.0)
    bodies = model_of(spur_scene("mesh.level=line")).bodies if plane else helical_model().bodies
    position = gears.position(0.02)
    result = position_of(gears, LineResult.of(position, force, friction), LineResult.of(position, force), force)
    for member in Member:
        moment = _moment(result, member, bodies[member].flank.points)
        assert moment == pytest.approx(-result.torques[member], rel=5e-3)


def _moment(result: PositionResult, member: Member, points: Floats) -> float:
    """Moment of the nodal forces on a gear about its axis, in its own frame."""
    rows, forces = (result.pinion_rows, result.pinion_forces) if member is Member.PINION else (
        result.wheel_rows, result.wheel_forces
    )
    pitch, moment = 2.0 * np.pi / result.stand.pair.gears[member].z, 0.0
    for (tooth, node), f in zip(rows, forces):
        x = turn(tooth * pitch, len(f)) @ points[node]
        moment += x[0] * f[1] - x[1] * f[0]
    return moment


def test_torque_turns_the_gear_that_holds_it() -> None:
    """Exact: the approach is a rotation of the gear whose torque is given."""
    gears, force = spur(), 120.0
    position = gears.position(0.02)
    found = LineResult.of(position, force)
    stand = position_of(gears, found, found, force).stand
    angle = found.transmission_error / gears.pair.pinion.base_radius
    turned = PairRotation(gears.pair, 0.02).turned(gears.free, angle)
    assert gears.free is Member.PINION and stand.beyond_nominal == pytest.approx(turned.beyond_nominal)
