"""Error bars of the vibration, from motions that are made up and stiffnesses whose errors are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.oscillator.response import Response, Spectrum
from evolvent.dynamics.pair_model import DriveSettings, drive
from evolvent.dynamics.results.curves import NO_COMPANION, SECANT, CoarseExcitation
from evolvent.dynamics.results.response_errors import (
    OtherVibration,
    Vibration,
    halves,
    mean_stiffness_error,
    same_jumps,
    vibration_errors,
)
from evolvent.scene.gear_problem import gear_problem
from tests.support.gear_cases import spur_scene

LOAD = 1000.0
NOTHING = np.zeros(5)


def excitation(stiffness: float, positions: int = 12) -> MeshExcitation:
    """A constant stiffness [N/mm] under two loads, without unloaded error."""
    forces = np.array([LOAD, 2.0 * LOAD])
    angles, whole = 2.0 * np.pi / 50.0 * np.arange(positions) / positions, np.full((positions, 2), stiffness)
    return MeshExcitation(np.zeros(positions), LoadedMesh(angles, forces, 1.0, forces / whole, whole))


def vibration(amplitudes: list[float], factors: list[float], up: tuple[float, ...] = ()) -> Vibration:
    """Motions of one harmonic [mm] at some speeds, the same up and down; down there is no jump."""
    pair = drive(
        gear_problem(spur_scene()).pair, excitation(3e5), LOAD, DriveSettings((7.65, 7.65), 0.1, 0.05, mesh="tangent")
    )
    found = [
        Response(np.array([size, 0, 0, 0, 0]), NOTHING, NOTHING, LOAD * factor, 0.0, 0.0, 0.0, Spectrum(*[NOTHING] * 3))
        for size, factor in zip(amplitudes, factors)
    ]
    return Vibration(pair, {"up": found, "down": found}, {"up": up, "down": ()})


OWN = vibration([0.010, 0.020], [1.5, 2.0], (1400.0, 4100.0))
COARSE = OtherVibration("on other meshes", "Refine", 2.0, vibration([0.011, 0.018], [1.5, 2.25], (1410.0, 4080.0)))
HALF = OtherVibration("on half of it", "Add more", 0.5, vibration([0.014, 0.020], [1.0, 2.0], (4090.0, 2500.0)))


def test_parts_of_an_error_add_up() -> None:
    """2 · 1 µm + 0.5 · 4 µm and 2 · 2 µm; 0.5 · 0.5 and 2 · 0.25; of the jump at 4100 r/min 2 · 20 + 0.5 · 10."""
    found = vibration_errors(OWN, [COARSE, HALF], 3e3)
    for way in ("up", "down"):
        assert found.amplitude[way] == pytest.approx([0.004, 0.004], rel=1e-12)
        assert found.dynamic_factor[way] == pytest.approx([0.25, 0.5], rel=1e-12)
    assert found.jumps["up"][1] == pytest.approx(45.0)
    assert found.jumps["down"] == ()
    assert found.natural_speed == pytest.approx(0.005 * OWN.drive.natural_speed, rel=1e-12)


def test_a_jump_that_is_lost_is_said() -> None:
    """That at 1400 r/min is on one of the two alone, as is one at 2500: no error, and a sentence with the remedy."""
    found = vibration_errors(OWN, [COARSE, HALF], 3e3)
    assert np.isnan(found.jumps["up"][0])
    assert found.said == (
        "dynamics.json: running up, the jump at 1400 r/min is not found on half of it; running up, the jump at 2500 "
        "r/min is found on half of it alone: whether the pair jumps there is not sure. Add more",
    )


def test_what_was_not_computed_is_not_known() -> None:
    """Without others, or where one of them failed: NaN everywhere but in the stiffness, whose error is given."""
    lost = replace(HALF, vibration=None, failure="no steady state")
    for others, said in (([], 0), ([COARSE, lost], 1)):
        found = vibration_errors(OWN, others, 3e3)
        assert np.isnan([*found.amplitude["up"], *found.dynamic_factor["down"], *found.jumps["up"]]).all()
        assert len(found.amplitude["up"]) == len(found.dynamic_factor["down"]) == len(found.jumps["up"]) == 2
        assert found.mean_stiffness == 3e3
        assert len(found.said) == said
    assert found.said[0] == "response.csv: no error bars, as the vibration on half of it was not found: no steady state"


def test_jumps_are_those_nearest_to_each_other() -> None:
    """Each is one other at most, and none that is more than a tenth away."""
    assert same_jumps([2000.0, 2050.0], [2060.0]) == pytest.approx([np.nan, 2060.0], nan_ok=True)
    assert same_jumps([4100.0, 2000.0], [2150.0, 4000.0, 1000.0]) == pytest.approx([4000.0, 2150.0])
    assert np.isnan(same_jumps([1000.0], [1101.0])).all()
    assert np.isnan(same_jumps([1000.0], [])).all() and len(same_jumps([], [1000.0])) == 0


def test_halves_are_every_other_position() -> None:
    """From the first on and from the second on, with their angles; none of an odd number, nor of four."""
    whole = excitation(3e5)
    first, second = halves(whole)
    assert np.stack([first.loaded.angles, second.loaded.angles], axis=1).ravel() == pytest.approx(whole.loaded.angles)
    assert first.loaded.errors.shape == second.loaded.stiffness.shape == (6, 2)
    assert halves(excitation(3e5, 13)) == halves(excitation(3e5, 4)) == ()


def test_error_of_a_stiffness() -> None:
    """Constant ones of 300 and 306 N/µm: half the difference, 3 N/µm, and nothing between the positions; behind
    600 N/µm in series 200 and 202.65 N/µm, half of that difference; without a companion it is unknown. Secants of a
    straight line are its tangents."""
    fine, coarse = excitation(3e5), CoarseExcitation(excitation(3.06e5))
    assert mean_stiffness_error(fine, coarse, LOAD, np.inf) == pytest.approx(3e3, rel=1e-9)
    behind = 0.5 * (1.0 / (1.0 / 3.06e5 + 1.0 / 6e5) - 2e5)
    assert mean_stiffness_error(fine, coarse, LOAD, 6e5) == pytest.approx(behind, rel=1e-9)
    assert mean_stiffness_error(fine, coarse, LOAD, 6e5, SECANT) == pytest.approx(behind, rel=1e-9)
    assert np.isnan(mean_stiffness_error(fine, NO_COMPANION, LOAD, np.inf))
