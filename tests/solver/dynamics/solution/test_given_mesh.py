"""Vibration on a given mesh, where it is known exactly."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from evolvent.dynamics import GivenMeshVibration, given_mesh_vibration
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from tests.support.recorded_tables import columns_of

MASS, STIFFNESS, LOAD, TEETH, RATIO = 0.77e-3, 258.6e3, 2412.0, 50, 0.03
STATIC = LOAD / STIFFNESS
PHASE = 2.0 * np.pi * np.arange(512) / 512  # the interpolation error of a spline through a cosine is 1e-10
NATURAL = 60.0 / TEETH * np.sqrt(STIFFNESS / MASS) / (2.0 * np.pi)
SPEEDS = NATURAL * np.array([0.2, 0.5, 0.98, 1.4])


def swept(error: Floats, **changed: Any) -> GivenMeshVibration:
    """A constant stiffness with this error."""
    given: dict[str, Any] = {"mass": MASS, "load": LOAD, "teeth": TEETH, "damping_ratio": RATIO}
    return given_mesh_vibration(np.full(len(error), STIFFNESS), error, SPEEDS, **(given | changed))


@pytest.mark.parametrize("harmonic", [1, 2])
def test_linear_oscillator_under_a_sinusoidal_error(harmonic: int) -> None:
    """e = A cos(h τ) on a constant stiffness, touching all the time. Exact: the amplitude of s is A |k + iωc| /
    |k − mω² + iωc| with ω of harmonic h, that of the mesh force mω² times it, to 1e-8 of the static ones; the other
    harmonics are 0; the natural speed."""
    amplitude, damping = 0.02 * STATIC, RATIO * 2.0 * np.sqrt(STIFFNESS * MASS)
    found = swept(amplitude * np.cos(harmonic * PHASE))
    assert found.natural_speed == pytest.approx(NATURAL, rel=1e-12)
    ω = harmonic * 2.0 * np.pi * TEETH * SPEEDS / 60.0
    exact = amplitude * np.abs((STIFFNESS + 1j * ω * damping) / (STIFFNESS - MASS * ω**2 + 1j * ω * damping))
    for way in ("up", "down"):
        np.testing.assert_allclose(1e-3 * found.curve(f"harmonic_{harmonic}_um", way), exact, atol=1e-8 * STATIC)
        force = found.curve(f"force_harmonic_{harmonic}_N", way)
        np.testing.assert_allclose(force, MASS * ω**2 * exact, atol=1e-8 * LOAD)
        assert found.curve(f"harmonic_{3 - harmonic}_um", way).max() < 1e-5 * STATIC
        assert not found.curve("separated_share", way).any()
    assert found.jumps_up == found.jumps_down == ()


def test_back_flanks_are_behind_the_backlash() -> None:
    """An error of 0.6 static deflections at 0.98 of the natural speed, damped by a fifth, parts the flanks. Right: the
    back flanks touch behind a small backlash, and never without one that is given."""
    error = 0.6 * STATIC * np.cos(PHASE[::16])
    free, caught = (swept(error, damping_ratio=0.2, backlash=backlash) for backlash in (None, 0.1 * STATIC))
    assert free.curve("separated_share").max() > 0.1
    assert not free.curve("back_contact_share").any() and caught.curve("back_contact_share").max() > 0.01


def test_a_given_mesh_is_saved_and_drawn(tmp_path: Path) -> None:
    """The saved column is the curve; the picture is a PNG image."""
    found = swept(0.02 * STATIC * np.cos(PHASE))
    table = columns_of(found.save(tmp_path / "own.csv"))
    np.testing.assert_allclose(table["harmonic_1_um"][:4], found.curve("harmonic_1_um"), rtol=1e-8)
    with Image.open(found.plot(tmp_path / "own.png")) as image:
        assert image.format == "PNG" and image.width > 1000


@pytest.mark.parametrize(("wrong", "words"), [
    ({"stiffness": [1e5, 1e5]}, "stiffness: wanted finite numbers of shape"),
    ({"stiffness": [1e5, 0.0, 1e5, 1e5]}, "stiffness: wanted numbers above 0"),
    ({"error": [0.0, 0.0, 0.0]}, "error: wanted finite numbers of shape"),
    ({"mass": 0.0}, "mass: wanted a number above 0, in t"),
    ({"load": -1.0}, "load: wanted a number above 0, in N"),
    ({"teeth": 50.5}, "teeth: wanted a whole number"),
    ({"damping_ratio": 0.0}, "damping_ratio: wanted a number from 0.001 to 1"),
    ({"damping_in_separation": 1}, "damping_in_separation: wanted a bool"),
    ({"backlash": -1.0}, "backlash: wanted a number from 0 on"),
    ({"speeds": [3000.0]}, "speeds: wanted two or more"),
])
def test_a_mesh_that_cannot_be_is_refused(wrong: dict[str, Any], words: str) -> None:
    """InputError names argument, value and remedy."""
    right: dict[str, Any] = {
        "stiffness": np.full(4, STIFFNESS), "error": np.zeros(4), "speeds": SPEEDS, "mass": MASS, "load": LOAD,
        "teeth": TEETH, "damping_ratio": RATIO,
    }
    with pytest.raises(InputError, match=words):
        given_mesh_vibration(**(right | wrong))
