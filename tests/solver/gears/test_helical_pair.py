"""A small, coarse helical pair: balance, torque ratio, and the load's shift under misalignment."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears.gear_model import GearModel
from evolvent.gears.solution.certificates import balance_error
from evolvent.run.kept_pitch import pitch_of
from tests.support.gear_cases import helical_scene, model_of, swept


@pytest.fixture(scope="module")
def helical() -> GearModel:
    return model_of(helical_scene("mesh.order=2"))


def test_helical_pair_is_balanced_and_periodic(helical: GearModel) -> None:
    """A coarse helical pair: balanced (force 1e-9, energy 0.5 %), T_2/T_1 = z_2/z_1 without friction within 0.5 %, less
    with it, and positions one pitch apart agree."""
    model, degrees = helical, np.degrees(pitch_of(helical_scene()).angles)
    step = float(np.diff(degrees).mean())
    smooth, rough = swept(model, np.append(degrees, [degrees[-1] + step]), [0.0, 0.3])
    for curve in (smooth, rough):
        assert curve.of("residual").max() < 1e-9
        assert max(balance_error(result) for result in curve.results) < 5e-3
        assert all(np.isfinite(result.contact.traction).all() for result in curve.results)
    assert np.abs(smooth.torque_ratio - 1.0).max() < 5e-3
    assert np.all(rough.torque_ratio < 0.995)
    errors = smooth.of("transmission_error")
    assert errors[2] == pytest.approx(errors[0], rel=1e-9)
    everywhere = sum(smooth.forces(tooth) for tooth in model.teeth)
    lever = model.pair.pinion.base_radius * np.cos(model.pair.pinion.base_helix_angle)
    np.testing.assert_allclose(everywhere * lever, model.load.torque, rtol=5e-3)


def test_misaligned_axis_shifts_the_load(helical: GearModel) -> None:
    """A wheel that leans away from the pinion's flank at +z bears more at −z, one that leans the other way more at +z;
    for a small lean the shift of the load's centre is linear. T_2/T_1 = z_2/z_1 stays."""

    def centre(misalignment_um: float) -> float:
        model = replace(helical, pair=replace(helical.pair, misalignment_um=misalignment_um))
        curve = swept(model, np.array([4.0]), [0.0])[0]
        assert curve.torque_ratio[0] == pytest.approx(1.0, abs=5e-3)
        c = curve.results[0].contact
        return float(np.average(c.z, weights=c.pressure * c.weights))

    aligned, away, towards = (centre(lean) for lean in (0.0, 2.0, -2.0))
    assert away < aligned - 0.02
    assert towards > aligned + 0.02
    assert away + towards == pytest.approx(2.0 * aligned, abs=0.2 * (towards - away))
