"""Fatigue criteria on histories with a known answer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from evolvent.strength.fatigue.criteria import (
    dang_van,
    fatemi_socie,
    largest_shear,
    orthogonal_shear_range,
    plane_amplitudes,
    von_mises,
)
from evolvent.strength.fatigue.half_plane import HertzTractions, plane_strain
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError

PHASES = np.linspace(0.0, 2.0 * np.pi, 721)


def tension(mean: float, amplitude: float) -> Floats:
    """Uniaxial stress along x."""
    stress = np.zeros((len(PHASES), 3, 3))
    stress[:, 0, 0] = mean + amplitude * np.sin(PHASES)
    return stress


def torsion(amplitude: float, normal: float = 0.0) -> Floats:
    """Shear τ_xz that alternates, with a constant normal stress along z."""
    stress = np.zeros((len(PHASES), 3, 3))
    stress[:, 0, 2] = stress[:, 2, 0] = amplitude * np.sin(PHASES)
    stress[:, 2, 2] = normal
    return stress


def test_dang_van_of_uniaxial_stress() -> None:
    """σ_m + σ_a sin t: the deviator's path is a straight line, shear about its middle is σ_a/2, hydrostatic stress
    (σ_m + σ_a)/3 at the same time: σ_a/2 + a (σ_m + σ_a)/3."""
    assert dang_van(tension(100.0, 300.0), 0.4, 0.4) == pytest.approx(150.0 + 0.4 * 400.0 / 3.0, rel=1e-6)


def test_dang_van_of_alternating_torsion() -> None:
    """τ_a, whatever a."""
    assert dang_van(torsion(200.0), 0.7, 0.7) == pytest.approx(200.0, rel=1e-6)


def test_dang_van_holds_both_fatigue_limits() -> None:
    """With a = 3 τ_w/σ_w − 1.5 fully reversed torsion with τ_w and fully reversed tension with σ_w have τ_w both. The
    latter has σ_w/2 of shear at σ_w/3 of hydrostatic stress: a locus that is constant at σ_w/2 below that allows
    τ_w/(σ_w/2) = 1 + 2a/3 less."""
    σw, τw = 600.0, 360.0
    a = 3.0 * τw / σw - 1.5
    assert dang_van(torsion(τw), a, 0.0) == pytest.approx(τw, rel=1e-6)
    assert dang_van(tension(0.0, σw), a, 0.0) == pytest.approx(τw, rel=1e-6)
    amplitude = dang_van(tension(0.0, σw), 0.0, 0.0)
    assert amplitude == pytest.approx(0.5 * σw, rel=1e-6)
    assert τw / amplitude == pytest.approx(1.0 + 2.0 * a / 3.0, rel=1e-6)


def test_dang_van_out_of_phase() -> None:
    """σ_x and τ_xz 90° apart, τ_a = σ_a/√3: the deviator goes round a circle, its centre is 0; largest of shear
    √(σ²/4 + τ²) plus a σ/3 over the cycle."""
    stress = tension(0.0, 300.0)
    stress[:, 0, 2] = stress[:, 2, 0] = 300.0 / np.sqrt(3.0) * np.cos(PHASES)
    t = np.linspace(0.0, 2.0 * np.pi, 100_001)
    wanted = np.sqrt((150.0 * np.sin(t)) ** 2 + (300.0 / np.sqrt(3.0) * np.cos(t)) ** 2) + 0.3 * 100.0 * np.sin(t)
    assert dang_van(stress, 0.3, 0.3) == pytest.approx(float(wanted.max()), rel=2e-6)


def test_fatemi_socie_of_torsion_with_a_normal_stress() -> None:
    """Δγ/2 = τ_a/G, on planes normal to z with the constant tension σ: (1 + kσ/σ_y) τ_a/G; under compression the plane
    normal to x, without normal stress, is as bad: τ_a/G."""
    G, σy, k = 80e3, 700.0, 0.6
    assert fatemi_socie(torsion(200.0), G, σy, k) == pytest.approx(200.0 / G * (1.0 + k * _normal(200.0, σy, k) / σy))
    small = fatemi_socie(torsion(1e-3, 350.0), G, σy, k)  # so small that shear adds no normal stress
    assert small == pytest.approx(1e-3 / G * (1.0 + k * 350.0 / σy), rel=1e-5)


def _normal(amplitude: float, σy: float, k: float) -> float:
    """Largest normal stress on the worst plane of alternating torsion, turned by θ from that of the shear: it maximises
    cos 2θ (1 + k τ sin 2θ/σ_y), and its own value is such that the product is the maximum."""
    θ = np.linspace(0.0, np.pi / 4.0, 1_000_001)
    product = np.cos(2.0 * θ) * (1.0 + k * amplitude * np.sin(2.0 * θ) / σy)
    return float((product.max() - 1.0) * σy / k)


def test_dang_van_under_compression() -> None:
    """σ_m = −600, σ_a = 300: hydrostatic stress is compression throughout, −100 at its largest. With a factor of 0 it
    does not count, σ_a/2; with that of tension it lowers the criterion."""
    history = tension(-600.0, 300.0)
    assert dang_van(history, 0.4, 0.0) == pytest.approx(150.0, rel=1e-6)
    assert dang_van(history, 0.4, 0.4) == pytest.approx(150.0 - 0.4 * 100.0, rel=1e-6)


def test_fatemi_socie_where_the_worst_plane_is_tilted() -> None:
    """σ_x and σ_z alternate together, σ_y stays 0: shear is largest on planes at 45° between the y axis and any normal
    in the x-z plane, σ_a/2, with the tension σ_a/2 on them. It maximises sin 2θ (1 + k σ_a cos² θ/σ_y) over their
    tilt, which planes through the y axis, free of shear, do not see."""
    stress = np.zeros((len(PHASES), 3, 3))
    stress[:, 0, 0] = stress[:, 2, 2] = 300.0 * np.sin(PHASES)
    G, σy, k = 80e3, 700.0, 0.6
    θ = np.linspace(0.0, np.pi / 2.0, 1_000_001)
    exact = (150.0 / G * np.sin(2.0 * θ) * (1.0 + k * 300.0 * np.cos(θ) ** 2 / σy)).max()
    assert fatemi_socie(stress, G, σy, k) == pytest.approx(float(exact), rel=1e-6)


def test_amplitude_is_half_of_the_longest_chord() -> None:
    """Shear on the plane normal to z that goes round an ellipse with half-axes of 50 and 30, turned by 20°: 50, in
    whatever direction between those that are tried, to 1e-3."""
    stress = np.zeros((len(PHASES), 3, 3))
    along, across = 50.0 * np.cos(PHASES), 30.0 * np.sin(PHASES)
    c, s = np.cos(np.radians(20.0)), np.sin(np.radians(20.0))
    stress[:, 0, 2] = stress[:, 2, 0] = c * along - s * across
    stress[:, 1, 2] = stress[:, 2, 1] = s * along + c * across
    shear, normal = plane_amplitudes(stress, np.array([[0.0, 0.0, 1.0]]))
    assert shear == pytest.approx([50.0], rel=1e-3)
    assert normal == pytest.approx([0.0], abs=1e-9)


def test_orthogonal_shear_below_a_line_contact() -> None:
    """Range 0.5 p0 at 0.5 b, whatever the friction (Johnson, 4.2): to 1e-3."""
    b, x = 1.0, np.linspace(-6.0, 6.0, 1201)
    for μ in (0.0, 0.1):
        history = plane_strain(HertzTractions(b, 1000.0, μ).stress(x, np.full_like(x, 0.5)), 0.3)
        assert orthogonal_shear_range(history) == pytest.approx(500.0, rel=2e-2 if μ else 1e-3)


def test_what_friction_changes_below_a_line_contact() -> None:
    """μ = 0.132 against 0.107: the largest von Mises stress and shear below the surface change by less than 1.2 %, the
    largest von Mises stress at the surface by 3 to 6 %, its tension by 23.4 %."""
    x = np.linspace(-1.5, 1.5, 301)
    deep, surface, tension = [], [], []
    for μ in (0.107, 0.132):
        loads = HertzTractions(1.0, 1000.0, μ)
        grid = [plane_strain(loads.stress(x, np.full_like(x, z)), 0.3) for z in np.linspace(0.5, 1.0, 11)]
        deep.append([max(criterion(each).max() for each in grid) for criterion in (von_mises, largest_shear)])
        at_surface = plane_strain(loads.stress(x, np.zeros_like(x)), 0.3)
        surface.append(float(von_mises(at_surface).max()))
        tension.append(float(at_surface[:, 0, 0].max()))
    assert all(1.0 < ratio < 1.012 for ratio in np.array(deep[1]) / deep[0])
    assert 1.03 < surface[1] / surface[0] < 1.06
    assert tension[1] / tension[0] == pytest.approx(0.132 / 0.107, rel=2e-3)


@pytest.mark.parametrize("criterion", [
    von_mises, largest_shear, orthogonal_shear_range, lambda stress: dang_van(stress, 0.4, 0.4),
    lambda stress: fatemi_socie(stress, 8e4, 1600.0, 1.0),
])
@pytest.mark.parametrize(("stress", "words"), [
    (np.eye(3), r"found shape \(3, 3\)"), (np.zeros((3, 3, 5)), r"found shape \(3, 3, 5\)"),
    (np.zeros((0, 3, 3)), r"found shape \(0, 3, 3\)"), (np.full((2, 3, 3), np.nan), "found NaN"),
    (np.arange(9.0).reshape(1, 3, 3), "not symmetric"), (None, "stress: wanted"), ("stress", "found 'stress'"),
])
def test_a_history_that_cannot_be_is_refused(criterion: Callable[[Any], object], stress: object, words: str) -> None:
    """InputError says what of it is wrong, for each criterion."""
    with pytest.raises(InputError, match=words):
        criterion(stress)


@pytest.mark.parametrize("factors", [(None, 0.4), (-0.1, 0.4), (0.4, np.nan)])
def test_factors_that_cannot_be_are_refused(factors: tuple[Any, Any]) -> None:
    """InputError names the factor."""
    with pytest.raises(InputError, match="_factor: wanted a number from 0 on"):
        dang_van(torsion(100.0), *factors)
