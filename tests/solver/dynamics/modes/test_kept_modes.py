"""Natural modes that are kept between calls."""

from __future__ import annotations

from dataclasses import replace
from typing import NoReturn

import numpy as np
import pytest

from evolvent.dynamics.modes import gear_modes as module
from evolvent.dynamics.modes.gear_modes import ModeChoice, gear_modes
from evolvent.fem.cache.cache import Cache
from tests.support.gear_cases import model_of, spur_scene

FEW = ModeChoice(0.0, 1)


def test_modes_of_a_relieved_gear_are_those_that_are_kept(
    kept: Cache, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Problem: one mode a harmonic of both gears of He's pair in the plane, then of the same pair with reliefs. Exact:
    the same numbers, computed once; other modes, and those of a lighter material, are computed."""
    plain = model_of(spur_scene("mesh.level=quick"))
    relieved = model_of(spur_scene("mesh.level=quick", "pinion.tip_relief_um=20", "wheel.tip_relief_um=20"))
    pinion = plain.bodies[0]
    light = replace(pinion, material=replace(pinion.material, density=0.5 * pinion.material.density))
    first = [gear_modes(body, FEW) for body in plain.bodies]

    def refused(*_: object) -> NoReturn:
        raise AssertionError("computed")

    monkeypatch.setattr(module, "_on_mesh", refused)
    for body, own in zip(relieved.bodies, first):
        found = gear_modes(body, FEW)
        assert np.array_equal(found.modes.frequencies, own.modes.frequencies)
        assert np.array_equal(found.modes.shapes, own.modes.shapes) and np.array_equal(found.spun, own.spun)
        assert found.moment_of_inertia == own.moment_of_inertia
        with pytest.raises(AssertionError, match="computed"):
            gear_modes(body, ModeChoice(0.0, 2))
    with pytest.raises(AssertionError, match="computed"):
        gear_modes(light, FEW)
