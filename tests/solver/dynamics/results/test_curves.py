"""Error bars of curves over the pitch, on curves whose errors are known."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.results.curves import LINE_LEAST, LINE_OFF, LINE_VARIES, LOADED, TANGENT, PitchCurve
from evolvent_meshes.arrays import Floats


def wave(count: int, mean: float, amplitude: float) -> Floats:
    """mean + amplitude cos φ at equidistant phases."""
    return mean + amplitude * np.cos(2.0 * np.pi * np.arange(count) / count)


def test_errors_that_converge_are_held() -> None:
    """Values of a wave off by 1, and by 2^1.6 on elements of twice the size: the bar of every position is at least
    (2^1.6 − 1)/2 = 1.016, which holds the error, and that of the mean just so, 1e-12."""
    curve = PitchCurve(LOADED, wave(40, 11.0, 3.0), wave(40, 10.0 + 2.0**1.6, 3.0), 2)
    bar = 0.5 * (2.0**1.6 - 1.0)
    assert curve.bars.min() >= bar - 1e-12
    assert curve.bars.max() < 1.4 * bar
    assert curve.mesh_error(lambda values: float(values.mean())) == pytest.approx(bar, rel=1e-12)


@pytest.mark.parametrize(("elements", "factor"), [(0.25, 2.0), (0.7, np.log2(1.0 / 0.7)), (0.8, 0.5), (3.0, 0.5)])
def test_contacts_narrower_than_an_element_have_wider_bars(elements: float, factor: float) -> None:
    """A deflection that goes with the logarithm of the element's size until that is the contact's width: on elements of
    twice the size it is less by 0.01 ln 2; the bar of the mean is log2(element over width) times that, the true error,
    and half of it at least, 1e-9."""
    size = 1.0 / elements
    fine, coarse = (np.full(40, 10.0 - 0.01 * np.log(each)) for each in (size, 2.0 * size))
    bar = PitchCurve(LOADED, fine, coarse, 2, elements).mesh_error(lambda values: float(values.mean()))
    assert bar == pytest.approx(factor * 0.01 * np.log(2.0), rel=1e-9)
    assert bar >= 10.0 - float(fine.mean()) - 1e-12


def test_line_contact_is_off_by_more_than_its_meshes() -> None:
    """Curves that agree on both meshes: in line contact a part of each value, of the mean and of the peak-to-peak value
    is left, exactly; where the contact is resolved nothing is."""
    same = wave(40, 10.0, 3.0)
    line, resolved = (PitchCurve(LOADED, same, same, 2, in_line_contact=each) for each in (True, False))
    assert line.bars == pytest.approx(LINE_OFF[LOADED] * same)
    assert resolved.bars == pytest.approx(0.0, abs=1e-12)
    assert line.mean_error - resolved.mean_error == pytest.approx(LINE_OFF[LOADED] * 10.0)
    assert line.peak_to_peak_error - resolved.peak_to_peak_error == pytest.approx(LINE_VARIES[LOADED] * 6.0)
    flat = wave(40, 10.0, 0.1)
    line, resolved = (PitchCurve(LOADED, flat, flat, 2, in_line_contact=each) for each in (True, False))
    assert line.peak_to_peak_error - resolved.peak_to_peak_error == pytest.approx(LINE_LEAST[LOADED] * 10.0)


def test_harmonics_do_not_depend_on_the_mean() -> None:
    """Curves that differ by a constant: no error of the mesh in harmonics and peak-to-peak value, one in the mean."""
    curve = PitchCurve(LOADED, wave(40, 10.0, 3.0), wave(40, 11.0, 3.0), 2)
    assert curve.varying_error(lambda values: float(np.ptp(values))) == pytest.approx(0.0, abs=1e-12)
    assert curve.mean_error > 0.4


def test_an_amplitude_has_the_difference_of_the_meshes() -> None:
    """Amplitudes 3 and 3.6, first-order convergence: 0.6 of the first harmonic, and of the higher ones, which are zero
    on both meshes, only what kinks between the positions may add; without a companion all are unknown."""
    fine, coarse = wave(40, 10.0, 3.0), wave(40, 10.0, 3.6)
    curve = PitchCurve(LOADED, fine, coarse, 2)
    spacing = PitchCurve(LOADED, fine, fine, 2).amplitude_errors
    assert curve.amplitude_errors - spacing == pytest.approx([0.6, 0.0, 0.0, 0.0, 0.0], abs=1e-12)
    assert np.isnan(PitchCurve(LOADED, fine, None, 2).amplitude_errors).all()


@pytest.mark.parametrize("shift", np.linspace(0.0, 0.95, 20))
def test_bars_hold_a_stiffness_of_two_levels(shift: float) -> None:
    """300 and 400 N/µm, two tooth pairs in contact for 0.6 of the pitch, at 20 positions wherever the pitch begins:
    mean 360, and 2 · 100 sin(0.6 π r)/(π r) of the harmonics (their integral), each within its bar."""
    phase = (np.arange(20) + shift) / 20.0
    values = np.where(phase % 1.0 < 0.6, 400.0, 300.0)
    curve = PitchCurve(TANGENT, values, values, 2)
    r = np.arange(1, 6)
    exact = np.abs(200.0 * np.sin(0.6 * np.pi * r) / (np.pi * r))
    assert abs(values.mean() - 360.0) <= curve.mean_error
    assert (np.abs(curve.harmonics[0] - exact) <= curve.amplitude_errors).all()
