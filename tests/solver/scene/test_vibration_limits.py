"""Speeds, inertias and compliances with which a vibration is refused, or doubtful."""

from __future__ import annotations

import math
import re

import pytest

from evolvent.check.scene_warnings import scene_warnings
from evolvent.gears.problem.gear_inertia import polar_moment, solid_moment, teeth_moment
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, method_b
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.errors import SceneError
from evolvent.scene.vibration_limits import doubtful, impossible
from tests.support.checkout import ROOT

LIMIT = re.compile(r"(from|up to|to) ([\d.e+-]+) (?:r/min|N/µm|kg·m²)")


def he(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022_dynamics.toml", settings)


@pytest.mark.parametrize(
    ("setting", "word"),
    [
        ("dynamics.speed_rpm=[1000,{}]", "1e6"), ("dynamics.histories_rpm=[{}]", "1e6"),
        ("dynamics.operating_rpm={}", "1e6"), ("transient.speeds_rpm=[{}]", "1e6"),
        ("dynamics.speed_rpm=[{},5000]", "1"), ("dynamics.operating_rpm={}", "0.5"),
        ("dynamics.pinion_inertia_kg_m2={}", "1e-12"), ("dynamics.wheel_inertia_kg_m2={}", "1e9"),
        ("dynamics.series_stiffness_N_per_um={}", "0.001"),
    ],
)
def test_senseless_values_are_refused_and_their_limit_is_taken(setting: str, word: str) -> None:
    """He's pair: each is refused when the scene is read, by its key and with a limit; the limit itself is taken. Once
    they passed without a word, or the call stood for minutes."""
    key = setting.split("=")[0]
    with pytest.raises(SceneError, match=rf"{re.escape(key)}: found .*allowed: (up to|from) \S+ ") as error:
        he(setting.format(word))
    limits = [value for _, value in LIMIT.findall(str(error.value))]
    limit = limits[-1] if float(word) > float(limits[-1]) else limits[0]
    assert impossible(he(setting.format(limit)).planned_vibration()) is None


def test_limits_follow_from_the_gears() -> None:
    """400 m/s at the tip circle of 156 mm: 48,971 r/min; a hundredth of ISO's natural speed, 45.7 r/min, or less by the
    root of the stiffness with a compliance in series as soft as the mesh."""
    planned = he().planned_vibration()
    assert planned.fastest == pytest.approx(400e3 * 60.0 / (math.pi * 156.0), rel=1e-12)
    mass = 0.5 * 7.65 / planned.pair.pinion.base_radius**2
    iso = method_b(planned.pair, mass, planned.force, Accuracy(), planned.moduli)
    assert planned.natural_speed == pytest.approx(iso.resonance_speed, rel=1e-9)
    softer = he(f"dynamics.series_stiffness_N_per_um={1e-3 * planned.mesh_stiffness}").planned_vibration()
    assert softer.natural_speed == pytest.approx(planned.natural_speed / math.sqrt(2.0), rel=1e-9)


def test_moments_of_inertia_of_teeth_and_of_a_disc() -> None:
    """Teeth are what a body has beyond a disc of the root diameter; a solid disc of the tip diameter has more than the
    body with its bore: exact, π/32 ϱ b d⁴."""
    gear = he().gear_pair().pinion
    body, teeth, disc = (moment(gear, 7.85e-9) for moment in (polar_moment, teeth_moment, solid_moment))

    def solid(diameter: float) -> float:
        return 7.85e-9 * gear.face_width * math.pi * diameter**4 / 32.0

    assert body - teeth == pytest.approx(solid(gear.root_diameter) - solid(gear.bore_diameter), rel=1e-9)
    assert 0.0 < teeth < solid(gear.tip_diameter) - solid(gear.root_diameter)
    assert disc == pytest.approx(solid(gear.tip_diameter), rel=1e-12)


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("dynamics.pinion_inertia_kg_m2=1e-3", "less than the teeth alone"),
        ("dynamics.wheel_inertia_kg_m2=7.65", "that of a solid disc"),
        ("dynamics.series_stiffness_N_per_um=10", "hardly on their mesh"),
        ("transient.speeds_rpm=[40000]", "327 m/s"),
    ],
)
def test_doubtful_values_are_named(setting: str, words: str) -> None:
    """Taken, with a sentence that names the key; `check` has it among its warnings. He's own are not doubtful."""
    given = he(setting)
    (said,) = doubtful(given.planned_vibration())
    assert said.startswith(setting.split("=")[0]) and words in said
    assert f"{said}." in scene_warnings(given)
    assert doubtful(he().planned_vibration()) == []
