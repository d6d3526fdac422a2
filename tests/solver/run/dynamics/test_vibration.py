"""`evolvent dynamics` on He's pair with few torques, positions and speeds."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest
from scipy.integrate import trapezoid

from evolvent.commands.app import main
from evolvent.dynamics.figures.waterfall import waterfall_figure
from evolvent.dynamics.of_scene import drive_settings
from evolvent.dynamics.pair_model import geometric_backlash
from evolvent.dynamics.results.response import DYNAMICS, RESPONSE
from evolvent.dynamics.results.spectrum import SPECTRUM
from evolvent.run.dynamics.summary_lines import summary_lines
from evolvent.run.kinds.dynamics import Dynamics
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.computing.redrawn import redrawn
from tests.support.gear_cases import QUIET

SETTINGS = (
    "output.pictures=true", "mesh.level=quick", "sweep.positions=10", "dynamics.torque_percents=[25,100,200]",
    "dynamics.speeds=60", "dynamics.speed_rpm=[1700,7000]", "dynamics.base_pitch_deviation_um=5",
    "dynamics.profile_deviation_um=4",
)

TIPS = "No tip relief: tip edges may bear, as teeth deflect by about 17 µm; see tip_relief_um."
"""Warning under the heaviest torque, twice the scene's."""


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022_dynamics.toml", [*QUIET, *SETTINGS, *settings])


def rows(path: Path) -> list[dict[str, str]]:
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With the force surface."""
    folder, one = tmp_path_factory.mktemp("dynamics"), scene()
    assert one.dynamics is not None
    tips, bodies, said = quietly(Dynamics.of(one), folder)
    assert tips == TIPS
    assert bodies.startswith("gear bodies: their own vibration of") and "(mesh harmonic 3)" in bodies
    assert said.startswith("dynamics.torque_percents: the largest mesh force is")
    return folder


@pytest.fixture
def again(out: Path, tmp_path: Path) -> Callable[..., list[str]]:
    """The call again with other keys of [dynamics], on the positions that `out` has solved, in the folder `again`; its
    warnings."""

    def computed(*settings: str) -> list[str]:
        folder = copytree(out, tmp_path / "again")
        given = Dynamics.of(scene("output.pictures=false", *settings))
        return quietly(given, folder, resume=True, prepare=lambda *_: pytest.fail("gears condensed again"))

    return computed


def test_warnings_are_kept(out: Path) -> None:
    """Warnings that the call has returned are in dynamics.json: once, they were in the terminal alone."""
    tips, bodies, said = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))["warnings"]
    assert tips == TIPS
    assert bodies.startswith("gear bodies: their own vibration of")
    assert said.startswith("dynamics.torque_percents: the largest mesh force is")


def test_pictures_name_the_gear_bodies(out: Path) -> None:
    """The waterfall, too, says which model of the bodies it is of."""
    known = DYNAMICS.read(out)
    for bodies in ("elastic", "rigid"):
        figure = waterfall_figure(replace(known, bodies=bodies), SPECTRUM.read(out))
        assert f"Of {bodies} gear bodies." in " ".join(text.get_text() for text in figure.texts)


def test_texts_name_what_figures_rest_on() -> None:
    """Keys of which the text once named another mass or stiffness, or left out that bores do not move sideways."""
    texts = DYNAMICS.described()
    assert "moving_stiffness_N_per_um / moving_mass_kg" in texts["natural_speed_rpm"]
    assert "equivalent_mass_kg" in texts["iso_resonance_speed_rpm"]
    assert "centres of the bores cannot move" in texts["body_frequency_Hz"]
    assert "force of the damper is in it" in RESPONSE.described()["dynamic_factor"]
    series = DynamicsSection.model_fields["series_stiffness_N_per_um"].description
    assert series is not None and "no bearing whose lateral mode matters" in series


def test_last_lines_have_the_figures(out: Path) -> None:
    """Once, the command ended with paths alone. Natural speed, largest factors with their speeds, jumps both ways, the
    bodies' frequency and the inertia beyond them, 3.4 % of 0.00765 kg·m², as dynamics.json and response.csv have them.
    """
    first, second = summary_lines(out)
    known = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))
    assert first.startswith(f"natural speed {known['natural_speed_rpm']:.0f} r/min; running up, largest mesh force")
    for way in ("up", "down"):
        top = max((r for r in rows(out / "response.csv") if r["way"] == way), key=lambda r: float(r["dynamic_factor"]))
        factor, speed = (float(top[name]) for name in ("dynamic_factor", "speed_rpm"))
        assert f"running {way}, largest mesh force over the static one {factor:.2f} at {speed:.0f} r/min" in first
        assert f"running {way} at {known[f'jumps_{way}_rpm'][0]:.0f}" in second
    assert f"left out, {known['body_frequency_Hz']:.0f} Hz with bores whose centres cannot move" in second
    assert known["pinion_added_inertia_kg_m2"] == known["wheel_added_inertia_kg_m2"] == pytest.approx(2.6e-4, rel=0.1)
    assert f"turns with the bores: {known['pinion_added_inertia_kg_m2']:.3g} and" in second


def test_speeds_near_the_bodies_vibration_are_marked(out: Path) -> None:
    """From 0.9 times the speed at which the third mesh harmonic has the bodies' frequency, and no slower one."""
    known = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))
    third = known["body_frequency_Hz"] * 60.0 / (3.0 * 50.0)
    for row in rows(out / "response.csv"):
        assert (row["near_body_vibration"] == "True") == (0.9 * third < float(row["speed_rpm"]) < 1.2 * third)
    assert 0.9 * third < 7000.0


def test_resonance_is_where_stiffness_and_inertia_put_it(out: Path) -> None:
    """The natural speed is √(k/m) 60/(2π z), k and m those in motion, as bodies are elastic by default, and beyond that
    of m_e at the bores; at 60 speeds the mesh force is largest within a fifth of it running up; above it the pair is
    isolated: K_v falls towards 1."""
    known = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))
    assert known["equivalent_mass_kg"] == pytest.approx(0.7701, rel=1e-4) and known["bodies"] == "elastic"
    natural, rigid = (
        np.sqrt(1e6 * known[k] / known[m]) * 60.0 / (2.0 * np.pi * 50)
        for k, m in (("moving_stiffness_N_per_um", "moving_mass_kg"), ("mean_stiffness_N_per_um", "equivalent_mass_kg"))
    )
    assert known["natural_speed_rpm"] == pytest.approx(natural, rel=1e-9)
    assert known["rigid_natural_speed_rpm"] == pytest.approx(rigid, rel=1e-9) and 1.03 < natural / rigid < 1.08
    lines = rows(out / "response.csv")
    assert [line["way"] for line in lines] == ["up"] * 60 + ["down"] * 60
    up = lines[:60]
    factor = np.array([float(line["dynamic_factor"]) for line in up])
    assert float(up[int(np.argmax(factor))]["speed_rpm"]) == pytest.approx(natural, rel=0.2)
    assert 1.0 < factor[-1] < 1.2
    assert {line["repeats"] for line in lines} == {"1"}


def test_rigid_bodies_have_all_inertia_at_the_bores(again: Callable[..., list[str]], tmp_path: Path) -> None:
    """`dynamics.bodies = "rigid"`, once the default: the natural speed is √(k/m_e) 60/(2π z), the transmission error s
    itself, and a sentence says what that leaves out."""
    said = again('dynamics.bodies="rigid"', 'dynamics.mesh="tangent"', "dynamics.speeds=2")
    assert said[1].startswith('dynamics.bodies = "rigid": all inertia is at the bores')
    known = json.loads((tmp_path / "again/dynamics.json").read_text(encoding="utf-8"))
    natural = np.sqrt(1e6 * known["mean_stiffness_N_per_um"] / known["equivalent_mass_kg"]) * 60.0 / (2.0 * np.pi * 50)
    assert known["natural_speed_rpm"] == known["rigid_natural_speed_rpm"] == pytest.approx(natural, rel=1e-9)
    assert known["moving_mass_kg"] == known["equivalent_mass_kg"] and known["body_frequency_Hz"] is None
    assert known["bodies"] == "rigid"


def test_pairs_jump_at_the_folds(out: Path) -> None:
    """Running up, the jump is at the first speed above a fold; branch.csv marks as many as dynamics.json names."""
    folds = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))["folds_rpm"]
    assert sum(line["fold"] == "True" for line in rows(out / "branch.csv")) == len(folds) > 0
    speeds = np.linspace(1700.0, 7000.0, 60)
    jumps = [float(line["speed_rpm"]) for line in rows(out / "response.csv")[:60] if line["jumped"] == "True"]
    assert jumps
    assert all(any(0.0 <= jump - fold <= speeds[1] - speeds[0] for fold in folds) for jump in jumps)
    for name in ("vibration.png", "waterfall.png"):
        assert (out / "pictures" / name).stat().st_size > 20_000
    assert (out / "excitation.csv").exists()
    assert not (out / "histories.csv").exists()


def test_jumps_are_named_by_their_way(out: Path) -> None:
    """As many speeds as response.csv marks jumps, each within the step before the mark, in the order of the way; they
    are folds of this pair."""
    known = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))
    step = 5300.0 / 59.0
    for way, sign in (("up", 1.0), ("down", -1.0)):
        lines = [line for line in rows(out / "response.csv") if line["way"] == way and line["jumped"] == "True"]
        marked = [float(line["speed_rpm"]) for line in lines][:: int(sign)]
        jumps = known[f"jumps_{way}_rpm"]
        assert len(jumps) == len(marked) > 0
        assert all(0.0 <= sign * (mark - jump) <= step for mark, jump in zip(marked, jumps))
        assert set(jumps) <= set(known["folds_rpm"])


def test_dynamic_factor_of_the_standard_stands_beside(out: Path) -> None:
    """dynamic_factor_iso is K_v of Method B worked by hand: with f_pb = 5 µm and f_fα = 4 µm, 7.5 % of them run in,
    B_p = c' 4.625/w, B_f = c' 3.7/w and B_k = 1; the same up and down. The line load w is F cos α/b."""
    known, lines = json.loads((out / "dynamics.json").read_text(encoding="utf-8")), rows(out / "response.csv")
    line_load = known["static_force_N"] * np.cos(np.radians(20.0)) / 20.0
    B_p, B_f = (known["iso_single_stiffness_N_per_mm_um"] * um / line_load for um in (4.625, 3.7))
    for line, other in zip(lines[:60], lines[60:]):
        N, factor = float(line["speed_rpm"]) / known["iso_resonance_speed_rpm"], float(line["dynamic_factor_iso"])
        if N <= 1.15:
            deviating = 0.32 * B_p + 0.34 * B_f
            exact = 1.0 + N * (deviating + 0.23) if N <= 0.85 else 1.0 + deviating + 0.90
            assert factor == pytest.approx(exact, rel=1e-8)
        assert other["dynamic_factor_iso"] == line["dynamic_factor_iso"]
    assert known["iso_relief_term"] == 1.0


def test_spectrum_has_the_harmonics(out: Path) -> None:
    """The lines of whole orders are the harmonics of response.csv, at order times speed times teeth."""
    lines, spectrum = rows(out / "response.csv"), rows(out / "spectrum.csv")
    assert len(spectrum) == 120 * 8
    for i in range(120):
        for order in range(1, 6):
            line = spectrum[8 * i + order - 1]
            assert (line["speed_rpm"], line["way"]) == (lines[i]["speed_rpm"], lines[i]["way"])
            assert line["force_N"] == lines[i][f"force_harmonic_{order}_N"]
            assert line["transmission_error_um"] == lines[i][f"harmonic_{order}_um"]
            frequency = order * float(line["speed_rpm"]) * 50.0 / 60.0
            assert float(line["frequency_Hz"]) == pytest.approx(frequency, rel=1e-7)


def test_histories_are_those_of_the_sweep(again: Callable[..., list[str]], tmp_path: Path) -> None:
    """Speeds of histories join the sweep, one of its own counts once; each motion closes after its repeats, its largest
    force is at most that of response.csv, and within 2 % of it; its mean force is the static one (no damping against
    the ground), to 1e-3 by the trapezoidal rule."""
    given = "dynamics.histories_rpm=[1700,3900]", "dynamics.speeds=20", 'dynamics.mesh="secant"'
    again(*given, "output.pictures=true")
    folder = tmp_path / "again"
    response = {(line["speed_rpm"], line["way"]): line for line in rows(folder / "response.csv")}
    assert len(response) == 2 * 21
    lines = rows(folder / "histories.csv")
    static = json.loads((folder / "dynamics.json").read_text(encoding="utf-8"))["static_force_N"]
    for speed in ("1700", "3900"):
        for way in ("up", "down"):
            motion = [line for line in lines if (line["speed_rpm"], line["way"]) == (speed, way)]
            names = "phase", "force_N", "transmission_error_um"
            phase, force, s = (np.array([float(line[name]) for line in motion]) for name in names)
            assert (np.diff(phase) > 0.0).all() and phase[-1] == float(response[speed, way]["repeats"])
            assert s[-1] == pytest.approx(s[0], abs=1e-5)
            largest = float(response[speed, way]["largest_force_N"])
            assert 0.98 * largest <= force.max() <= largest * (1.0 + 1e-8)
            assert trapezoid(force, phase) / phase[-1] == pytest.approx(static, rel=1e-3)
    assert "histories.png" in redrawn(folder, tmp_path)


def test_settings_follow_from_the_gears() -> None:
    """Without inertia and backlash in the scene: those of steel bodies, and of the tooth thicknesses, which leave none
    at the reference centre distance; 0.1 mm more opens 2 · 0.1 mm · sin α along the line of action (ISO 21771), 1 %."""
    plain = load_scene(ROOT / "demos/he2022.toml", [*QUIET, "dynamics.speeds=2"])
    assert plain.dynamics is not None
    pair = plain.gear_pair()
    settings = drive_settings(pair, plain.dynamics)
    assert settings.inertias[0] == settings.inertias[1] == pytest.approx(7.4, rel=0.05)
    assert settings.backlash == pytest.approx(0.0, abs=1e-9)
    gear = GearParameters.from_rack(
        z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=70.0
    )
    assert geometric_backlash(GearPair(gear, gear, 150.1)) == pytest.approx(0.2 * np.sin(np.radians(20.0)), rel=0.01)


def test_little_backlash_is_warned_of(again: Callable[..., list[str]], tmp_path: Path) -> None:
    """That of the reference centre distance, none: the key and the static deflection are named."""
    found = again("dynamics.backlash_um=0", 'dynamics.mesh="secant"', "dynamics.speeds=2")
    (said,) = [each for each in found if "backlash" in each]
    known = json.loads((tmp_path / "again/dynamics.json").read_text(encoding="utf-8"))
    deflection = known["static_force_N"] / known["mean_stiffness_N_per_um"]
    assert said.startswith(f"dynamics.backlash_um: found 0 µm, less than the static deflection of {deflection:.3g} µm")


def test_no_factor_of_the_standard_without_deviations(out: Path, tmp_path: Path) -> None:
    """With f_pb alone: a column without a number, and a sentence that names the missing key."""
    words = [each for each in SETTINGS if "profile_deviation" not in each]
    few = 'dynamics.mesh="secant"', "dynamics.speeds=2"
    one = load_scene(ROOT / "demos/he2022_dynamics.toml", [*QUIET, *words, *few, "output.pictures=false"])
    folder = copytree(out, tmp_path / "again")
    found = quietly(Dynamics.of(one), folder, resume=True)
    (said,) = [each for each in found if each.startswith("dynamic_factor_iso: ")]
    assert said.endswith("give dynamics.profile_deviation_um")
    assert {line["dynamic_factor_iso"] for line in rows(folder / "response.csv")} == {"nan"}


def test_wear_does_not_keep_a_scene_from_its_vibration(tmp_path: Path) -> None:
    """A scene with [wear]: the vibration of the pair as it is."""
    words = [word for setting in (*QUIET, *SETTINGS) for word in ("--set", setting)]
    assert main(["dynamics", str(ROOT / "demos/he2022_wear.toml"), "--out", str(tmp_path), "--quiet", *words]) == 0
    assert rows(tmp_path / "response.csv")
