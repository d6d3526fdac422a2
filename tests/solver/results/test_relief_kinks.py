"""Pressure over the start of a linear tip relief: a cylinder with a kink on a half-space, and a lightly loaded pair."""

from __future__ import annotations

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.fem.material import contact_modulus
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.pressure.contact_slices import fitted_peak
from evolvent.results.error_bars.position_spacing import limited_on_kinks
from evolvent.results.relief_kinks import relief_kinks, wedge_factor
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import warnings_of
from evolvent.run.coarse_run import solved_run
from evolvent.run.pitch_run import pitch_of
from evolvent.scene.scene import scene_from_text
from evolvent_meshes.arrays import Floats
from tests.support.run_parts import GOOD

LIGHT = """
[pair]
normal_module_mm = 3.0
[pinion]
teeth = 20
face_width_mm = 20.0
tip_relief_um = 20.0
[wheel]
teeth = 40
face_width_mm = 20.0
tip_relief_um = 20.0
[mesh]
level = "quick"
[contact]
friction = [0.0]
[load]
torque_Nm = 20.0
"""
WORDS = "where a linear tip relief begins"


def light(*overrides: str) -> RunData:
    scene = scene_from_text(LIGHT, overrides)
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    return run


@pytest.fixture(scope="module")
def missed() -> RunData:
    """Forty positions, of which none shows the peak."""
    return light("sweep.positions=40")


def kinked(angle: float, place: float, n: int = 240) -> float:
    """Fitted peak over Hertz' of a cylinder, R = b = E* = 1, with a convex kink by the angle at x = `place`:
    strips of even pressure on an elastic half-plane (Johnson 5.30), those that would pull left out."""
    edges = np.linspace(-1.2 - angle, 1.2, n + 1)
    x, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * (edges[1] - edges[0])
    gap = 0.5 * x**2 + angle * np.maximum(x - place, 0.0)
    near, far = x[:, None] - x - half, x[:, None] - x + half
    deflection = -(far * np.log(far**2) - near * np.log(near**2)) / np.pi  # + constant; E* = 1
    pressed, load = np.arange(n), 0.25 * np.pi  # Hertz' for b = 1
    while True:
        own = deflection[np.ix_(pressed, pressed)]
        system = np.block(
            [[own, -np.ones((len(pressed), 1))], [np.full((1, len(pressed)), 2.0 * half), np.zeros((1, 1))]]
        )
        p = np.linalg.solve(system, np.append(-gap[pressed], load))[:-1]
        if (p >= 0.0).all():
            return fitted_peak(x[pressed], p, np.full(len(p), 2.0 * half), load)[0] / 0.5
        pressed = pressed[p >= 0.0]


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.3, 2.5])
def test_wedge_factor_is_the_largest_over_all_places_of_a_kink(angle: float) -> None:
    """Problem: a cylinder with a kink, wherever the kink is in the contact. Exact: the closed form is the largest of
    all places, that of the kink in the middle."""
    factors: Floats = np.array([kinked(angle, place) for place in np.linspace(-angle - 0.8, 0.8, 17)])
    assert factors.max() == pytest.approx(wedge_factor(2.0 * angle / np.pi), rel=0.02)
    if angle:
        middle = kinked(angle, -0.5 * angle)
        assert middle == pytest.approx(wedge_factor(2.0 * angle / np.pi), rel=0.02) and middle >= 0.99 * factors.max()


def test_peak_over_a_kink_between_positions_is_known_and_warned_of(missed: RunData) -> None:
    """Problem: a lightly loaded pair whose pressure rises over the start of the wheel's relief, in less than a step
    between two of 40 positions. Exact: the closed form, which the pressures of 160 positions come to within 2 % on a
    fine mesh (884 and 812 MPa over the two kinks; 20 s) and within a fifth on this one. The bar holds it, and it is
    said."""
    (row,) = friction_rows(missed)
    pinion, wheel = relief_kinks(missed, 0)
    assert (pinion.roll_distance, wheel.roll_distance) == pytest.approx((3.794, -4.042), abs=1e-3)
    assert (pinion.pressure, wheel.pressure) == pytest.approx((812.0, 884.0), rel=0.02)
    assert (
        row.max_pressure_MPa < 0.8 * wheel.pressure <= 0.8 * (row.max_pressure_MPa + row.spacing_error.max_pressure_MPa)
    )
    assert row.max_pressure_at_relief_start
    (said,) = [sentence for sentence in warnings_of(missed, GOOD) if WORDS in sentence]
    assert "ξ = −4.04 mm" in said and "0.22 mm apart" in said and "parabolic" in said


def test_extrapolation_on_a_kink_is_limited_to_its_pressure(missed: RunData) -> None:
    """Samples on the wheel's kink and far from any: what lines reach, 2000 MPa, is cut down to the pressure
    over the kink where the contact lies on it, and nowhere else."""
    places = np.array([-4.5, -4.3, -4.1, -3.9, 0.0, 0.2, 0.4])
    known = limited_on_kinks(places, np.full(4, 2e3), relief_kinks(missed, 0))
    assert known[:3] == pytest.approx(relief_kinks(missed, 0)[1].pressure) and known[3] == 2e3


def test_root_relief_begins_with_a_kink() -> None:
    """Problem: root relief of the pinion instead of the wheel's tip relief, both of 20 µm. Exact: its kink lies at the
    roll length where it ends; the flank turns there by 20 µm over the length of the relief times r_b/ρ."""
    run = light("wheel.tip_relief_um=0", "pinion.root_relief_um=20", "sweep.positions=8")
    (kink,) = [kink for kink in relief_kinks(run, 0) if kink.relief == "root relief"]
    pinion, (start, _) = run.pair.pinion, run.pair.path_of_contact
    end = pinion.roll_length(run.pair.active_start_diameters[0] + 1.5)
    first = run.pair.pitch_point_roll_lengths[0]
    assert kink.roll_distance == pytest.approx(end - first, abs=1e-9)
    angle = 20e-3 / (end - first - start) * pinion.base_radius / end
    modulus = contact_modulus(*run.scene.materials())
    assert kink.pressure == pytest.approx(kink.hertz * wedge_factor(angle * modulus / (np.pi * kink.hertz)), rel=1e-9)


def test_parabolic_relief_has_no_kink() -> None:
    """Exact: parabolic relief begins without a kink, at the tip and at the root."""
    parabolic = [f'{gear}.tip_relief_form="parabolic"' for gear in ("pinion", "wheel")]
    parabolic += ["pinion.root_relief_um=5", 'pinion.root_relief_form="parabolic"']
    smooth = light(*parabolic, "sweep.positions=8")
    assert relief_kinks(smooth, 0) == [] and not friction_rows(smooth)[0].max_pressure_at_relief_start
    assert not any(WORDS in sentence for sentence in warnings_of(smooth, GOOD))
