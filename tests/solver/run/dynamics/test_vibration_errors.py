"""Error bars of the vibration: of a linear mesh in closed form, and of He's pair with few positions and speeds."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from evolvent.commands.app import main
from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.oscillator.steady_state import NoSteadyState
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive
from evolvent.dynamics.results.curves import NO_COMPANION, CoarseExcitation
from evolvent.dynamics.results.response_errors import VibrationErrors
from evolvent.run.dynamics import vibration_errors as module
from evolvent.run.dynamics.speeds import sweep_at
from evolvent.run.dynamics.vibration_errors import errors_over_speed, vibration_of
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.arrays import Floats
from tests.support.checkout import ROOT
from tests.support.gear_cases import spur_scene

LOAD, STIFFNESS, STIFFER, RATIO = 1000.0, 3e5, 1.02, 0.1
PROBLEM = gear_problem(spur_scene())
SETTINGS = DriveSettings((7.65, 7.65), RATIO, 0.05, mesh="tangent")
SPEEDS = np.linspace(1500.0, 6000.0, 12)
POSITIONS = 8


def excitation(error: Floats, stiffness: float = STIFFNESS) -> MeshExcitation:
    """A constant stiffness [N/mm] on flanks with an unloaded error (n,) [mm]."""
    count, forces = len(error), np.array([LOAD, 2.0 * LOAD])
    angles, whole = 2.0 * np.pi / 50.0 * np.arange(count) / count, np.full((count, 2), stiffness)
    return MeshExcitation(error, LoadedMesh(angles, forces, 1.0, error[:, None] + forces / whole, whole))


def wave(count: int, order: int, amplitude: float = 2e-4) -> Floats:
    """A mesh harmonic at equidistant positions [mm]."""
    return amplitude * np.cos(2.0 * np.pi * order * np.arange(count) / count + 0.7)


def errors(fine: MeshExcitation, companion: CoarseExcitation) -> tuple[Drive, VibrationErrors]:
    pair = drive(PROBLEM.pair, fine, LOAD, SETTINGS)
    own = vibration_of(pair, sweep_at(pair, SPEEDS))
    return pair, errors_over_speed(own, fine, companion, PROBLEM, SETTINGS, SPEEDS)


def amplitudes(error: Floats, stiffness: float, mass: float) -> Floats:
    """√ΣA_r² of three harmonics of s (n,) at the speeds, of m s̈ + c (ṡ − ė) + k (s − e) = F_0, e the periodic spline
    through values."""
    phases, fine = np.linspace(0.0, 1.0, len(error) + 1), np.arange(1024) / 1024
    spline = CubicSpline(phases, np.append(error, error[0]), bc_type="periodic")(fine)
    lines = 2.0 * np.abs(np.fft.rfft(spline))[1:4] / len(fine)
    rates = 2.0 * np.pi * np.arange(1, 4)[:, None] * SPEEDS * 50.0 / 60.0
    damper = 2j * RATIO * np.sqrt(stiffness * mass) * rates
    gain = np.abs((stiffness + damper) / (stiffness - mass * rates**2 + damper))
    return np.asarray(np.linalg.norm(lines[:, None] * gain, axis=0))


def test_a_companion_that_is_stiffer() -> None:
    """By 2 %: half of that in the mean stiffness, a quarter in the natural speed, and at each speed the difference of
    the closed forms in the amplitude, to 1e-6 of the amplitude. Thirteen positions have no part of spacing: said."""
    error = wave(13, 1)
    fine, coarse = excitation(error), excitation(error, STIFFER * STIFFNESS)
    pair, found = errors(fine, CoarseExcitation(coarse))
    assert found.mean_stiffness == pytest.approx(0.01 * STIFFNESS, rel=1e-9)
    assert found.natural_speed == pytest.approx(0.005 * pair.natural_speed, rel=1e-9)
    one, other = (amplitudes(error, stiffness, pair.model.mass) for stiffness in (STIFFNESS, STIFFER * STIFFNESS))
    for way in ("up", "down"):
        assert found.amplitude[way] == pytest.approx(np.abs(one - other), abs=1e-6 * one.max())
        assert (found.dynamic_factor[way] > 0.0).all()
    (said,) = found.said
    assert said.startswith("response.csv: the error bars are those of the mesh alone") and said.endswith("found 13")


def test_positions_that_miss_a_harmonic() -> None:
    """The third of eight positions is seen as the first by four: the mean difference of both halves to all, by the
    closed form, to 1e-6; the companion is the mesh itself and adds nothing."""
    error = wave(POSITIONS, 3) + wave(POSITIONS, 1)
    fine = excitation(error)
    pair, found = errors(fine, CoarseExcitation(fine))
    whole, *half = (amplitudes(each, STIFFNESS, pair.model.mass) for each in (error, error[::2], error[1::2]))
    wanted = np.mean([np.abs(each - whole) for each in half], axis=0)
    assert wanted.max() > 0.1 * whole.max()
    for way in ("up", "down"):
        assert found.amplitude[way] == pytest.approx(wanted, abs=1e-6 * whole.max())
    assert found.said == ()


def test_a_sweep_that_fails_leaves_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """No steady state on the stiffer companion: no bars, and a sentence why; the natural speed has its own."""

    def failing(pair: Drive, speeds: Floats, computed: Callable[[], None]) -> SpeedSweep:
        if pair.mean_stiffness > 1.01 * STIFFNESS:
            raise NoSteadyState("branch: wanted a next one, found none")
        return sweep_at(pair, speeds, computed)

    monkeypatch.setattr(module, "sweep_at", failing)
    error = wave(POSITIONS, 1)
    _, found = errors(excitation(error), CoarseExcitation(excitation(error, STIFFER * STIFFNESS)))
    assert np.isnan([*found.amplitude["up"], *found.dynamic_factor["down"]]).all()
    assert found.natural_speed > 0.0
    assert found.said == (
        "response.csv: no error bars, as the vibration on elements of twice the size was not found: branch: wanted a "
        "next one, found none",
    )


def test_without_a_companion_nothing_is_swept(monkeypatch: pytest.MonkeyPatch) -> None:
    """All is unknown, and nothing is said."""
    fine = excitation(wave(POSITIONS, 1))
    pair = drive(PROBLEM.pair, fine, LOAD, SETTINGS)
    own = vibration_of(pair, sweep_at(pair, SPEEDS))
    monkeypatch.delattr(module, "sweep_at")
    found = errors_over_speed(own, fine, NO_COMPANION, PROBLEM, SETTINGS, SPEEDS)
    assert np.isnan([*found.amplitude["up"], *found.dynamic_factor["down"], found.natural_speed]).all()
    assert found.said == ()


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """He's pair with error bars."""
    folder = tmp_path_factory.mktemp("dynamics") / "out"
    settings = (
        "sweep.positions=12", "dynamics.torque_percents=[50,100,200]", "dynamics.speeds=12",
        "dynamics.speed_rpm=[2600,7000]",
    )
    words = [word for setting in settings for word in ("--set", setting)]
    scene = str(ROOT / "demos/he2022_dynamics.toml")
    assert main(["dynamics", scene, "--level", "quick", "--out", str(folder), "--quiet", *words]) == 0
    return folder


def test_a_run_writes_its_bars(out: Path) -> None:
    """Each line has its own, of both figures, at most as large as the largest figure; dynamics.json has that of the
    stiffness of harmonics.csv, that of the natural speed, by the stiffness in motion on elastic bodies over the static
    one, and one of each jump, null where it is not known."""
    with open(out / "response.csv", encoding="utf-8") as stream:
        lines = list(csv.DictReader(stream))
    for name in ("equivalent_amplitude_um", "dynamic_factor"):
        value, bar = (np.array([float(line[key]) for line in lines]) for key in (name, f"{name}_error"))
        assert (bar > 0.0).all() and bar.max() < value.max()
        assert np.median(bar / value) < 0.2
    known = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))
    with open(out / "harmonics.csv", encoding="utf-8") as stream:
        (mean,) = {
            float(line["mean_error"]) for line in csv.DictReader(stream)
            if line["quantity"] == "tangent_stiffness_N_per_um" and line["torque_Nm"] == "170"
        }
    assert known["mean_stiffness_N_per_um_error"] == pytest.approx(mean, rel=1e-7)
    share = known["mean_stiffness_N_per_um_error"] / known["mean_stiffness_N_per_um"]
    moving = known["moving_stiffness_N_per_um"] / known["mean_stiffness_N_per_um"]
    assert moving > 1.05
    natural = 0.5 * share * moving * known["natural_speed_rpm"]
    assert known["natural_speed_rpm_error"] == pytest.approx(natural, rel=1e-9)
    for way in ("up", "down"):
        assert len(known[f"jumps_{way}_rpm_error"]) == len(known[f"jumps_{way}_rpm"])
    assert (out / "pictures/vibration.png").stat().st_size > 20_000
