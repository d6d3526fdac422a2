"""Modified flanks under load: a spur pair in space, 8 mm wide, coarse, at one position without friction.

All flanks lie on the same condensed gears, so that the contact alone differs.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.two_level_gear import modified_flank
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import Modifications
from tests.support.gear_cases import helical_scene, model_of, swept

FACE, SLOPE, NOISE = 8.0, 5.0, 0.02
"""Face width [mm]; helix slope [µm]; how far the transmission error moves as the cells of both flanks shift [µm]."""


@cache
def plain() -> GearModel:
    return model_of(helical_scene("pair.helix_angle_deg=0", 'exact.parts=["plane"]'))


def modified(**of_gears: dict[str, Any]) -> GearModel:
    """The pair with modifications of the pinion, the wheel or both."""
    model = plain()
    for member in Member:
        if given := of_gears.get(member.label):
            gear = replace(model.pair.gears[member], modifications=Modifications(**given))
            bodies, body = list(model.bodies), model.bodies[member]
            bodies[member] = replace(body, gear=gear, flank=modified_flank(body.flank, gear))
            gears: dict[str, Any] = {member.label: gear}
            model = replace(model, bodies=(bodies[0], bodies[1]), pair=replace(model.pair, **gears))
    return model


def solved(model: GearModel) -> PositionResult:
    return swept(model, np.array([4.0]), [0.0])[0].results[0]


def error_um(result: PositionResult) -> float:
    return 1e3 * result.transmission_error


def forces(result: PositionResult) -> tuple[Floats, Floats]:
    """Heights [mm] and normal forces [N] of all contact points."""
    return result.contact.z, result.contact.pressure * result.contact.weights


def load_centre(result: PositionResult) -> float:
    z, force = forces(result)
    return float(np.average(z, weights=force))


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
@pytest.mark.parametrize("slope", [SLOPE, -SLOPE])
def test_helix_slope_is_a_misalignment(gear: str, slope: float) -> None:
    """Exact: a helix slope of either gear opens the flanks as pair.misalignment_um of the same amount does, and by half
    of it more everywhere, which the pinion turns further: the same load centre (1 %), the error that much larger."""
    tilted = solved(replace(plain(), pair=replace(plain().pair, misalignment_um=slope)))
    found = solved(modified(**{gear: {"helix_slope_um": slope}}))
    assert load_centre(found) == pytest.approx(load_centre(tilted), rel=0.01)
    assert load_centre(found) * slope < 0.0  # away from the end where material is missing
    assert error_um(found) - error_um(tilted) == pytest.approx(0.5 * SLOPE, abs=NOISE)


def test_opposite_helix_slopes_cancel() -> None:
    """Exact: with opposite slopes both flanks have the same direction again; the pinion turns further by one slope."""
    found = solved(modified(pinion={"helix_slope_um": SLOPE}, wheel={"helix_slope_um": -SLOPE}))
    assert load_centre(found) == pytest.approx(load_centre(solved(plain())), abs=1e-3)
    assert error_um(found) - error_um(solved(plain())) == pytest.approx(SLOPE, abs=NOISE)


def test_end_relief_takes_the_load_off_the_ends() -> None:
    """200 µm over 2 mm at both ends, far above the deflection of 24 µm: without it the ends carry the half of the load
    that is theirs, with it nothing; the middle, half as wide, carries it all and deflects more, by less than twice."""

    def share(result: PositionResult) -> float:
        z, force = forces(result)
        return float(force[np.abs(z) > 0.25 * FACE].sum() / force.sum())

    even = solved(plain())
    found = solved(modified(wheel={"end_relief_um": 200.0, "end_relief_length": 0.25 * FACE}))
    assert share(even) == pytest.approx(0.5, abs=0.05)
    assert share(found) == 0.0
    assert forces(found)[1].sum() == pytest.approx(forces(even)[1].sum(), rel=2e-3)
    assert 1.1 < error_um(found) / error_um(even) < 2.0
