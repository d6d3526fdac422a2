"""What `evolvent check` tells of the section [transient]: motions, time steps, speeds at which these are long."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from evolvent.check.check_report import overview
from evolvent.check.planned_cost import too_many_modes
from evolvent.check.scene_warnings import scene_warnings
from evolvent.check.transient_rows import natural_frequency, planned_steps, transient_lines
from evolvent.run.kinds.transient import Transient
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.errors import SceneError
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import spur_scene

NATURAL = 4566.0 / 60.0 * 50.0
"""[Hz] of He's pair, by ISO's natural speed (test_vibration_rows.py)."""
UNRESOLVED = "the pair's own vibration of 3805 Hz"


def pair(*settings: str) -> Scene:
    """He's, with three speeds."""
    return load_scene(ROOT / "demos/he2022_dynamics.toml", ["transient.speeds_rpm=[1500,2200,4000]", *settings])


def told(scene: Scene, companion: bool = True) -> dict[str, str]:
    """Name of a line -> its value."""
    assert scene.transient is not None
    return {name.strip(): values[0] for name, _, _, values in transient_lines(scene, scene.transient, companion)}


def test_motions_and_steps_are_counted() -> None:
    """3 speeds × 2 coefficients are 6 motions, 18 with those for error bars; 40 positions are as many steps, at least
    where a tolerance divides them."""
    found = told(pair("contact.friction=[0,0.1]"))
    assert (found["speeds × friction coefficients"], found["motions"]) == ("3 × 2", "6")
    assert found["with those of coarser gears, for error bars"] == "18"
    assert found["time steps in a mesh period"] == "40"
    assert "with those of coarser gears, for error bars" not in told(pair(), companion=False)
    divided = told(pair("transient.tolerance=0.01", "transient.most_parts=32"))
    assert divided["time steps in a mesh period, at least"] == "40"
    assert divided["each of which is divided by, at most"] == "32"


def test_steps_of_each_speed() -> None:
    """Exact: f_z = n z/60, 1250 Hz at 1500 r/min; a fortieth of 1/f_z a step, 20 µs; 1/(f_n h) = 13.14 steps in a
    period of ISO's natural frequency."""
    scene = pair()
    assert scene.transient is not None
    slow, *_ = planned_steps(scene, scene.transient)
    assert (slow.speed.rpm, slow.speed.mesh_frequency, slow.length) == pytest.approx((1500.0, 1250.0, 20e-6))
    assert slow.a_period == pytest.approx(1.0 / (NATURAL * 20e-6), rel=1e-3)


def test_the_gear_without_the_torque_at_constant_speed() -> None:
    """Equal gears: the mass that swings is I/r_b², not I/(2 r_b²), and the frequency 1/√2 of that of free ones."""
    free, held = pair(), pair("transient.drive=constant_speed")
    assert free.transient is not None and held.transient is not None
    assert natural_frequency(free, free.transient) == pytest.approx(NATURAL, rel=1e-3)
    expected = natural_frequency(free, free.transient) / math.sqrt(2.0)
    assert natural_frequency(held, held.transient) == pytest.approx(expected, rel=1e-9)


def test_speeds_that_are_not_resolved_are_warned_of() -> None:
    """13.14 steps a period at 40 positions are 19.7 at 60: then 61 resolve 1500 r/min, and faster speeds are fine; with
    a tolerance steps are divided, and nothing is said."""
    assert not any(UNRESOLVED in each for each in scene_warnings(pair("sweep.positions=61")))
    (said,) = (each for each in scene_warnings(pair("sweep.positions=60")) if UNRESOLVED in each)
    assert said.startswith("1500 r/min: ") and "has 19.7 time steps a period; wanted 20" in said
    assert "sweep.positions = 61 " in said and "ISO 6336-1" in said
    divided = pair("sweep.positions=60", "transient.tolerance=0.01")
    assert not any(UNRESOLVED in each for each in scene_warnings(divided))


def test_tables_are_printed_with_their_sections_alone() -> None:
    """A scene without [transient] and [fatigue] has no such tables; with [fatigue] the criteria stand in one line,
    that of Fatemi and Socie with a yield stress alone."""
    plain, text = overview(spur_scene()), overview(pair("fatigue.depths=[0,0.02,0.05,0.1,0.5,3]"))
    assert "\nTransient contact" in text and "\nTime steps at each speed" in text
    (line,) = (line for line in text.splitlines() if "Dang Van" in line)
    assert line.startswith("  6 depths down to 3 half-widths of the contact: contact pressure, ")
    assert "Fatemi-Socie" not in line
    assert "Fatemi-Socie" in overview(pair("fatigue.yield_stress_MPa=1500"))
    assert "Transient" not in plain and "Contact fatigue" not in plain


def test_modes_and_time_steps_are_counted() -> None:
    """Three modes of each harmonic of 50 teeth are 150 of each gear; the default, up to a quarter of the frequency of
    time steps, at least 50. Three motions of 200 mesh periods in 40 steps, and for error bars the same and four times
    as many on coarser gears: 6 · 24,000."""
    few = told(pair("transient.modes_per_harmonic=3"))
    assert few["natural modes of pinion and wheel, about"] == "150 and 150"
    assert told(pair())["natural modes of pinion and wheel, about"] == "50 and 50"
    (steps,) = (value for name, value in few.items() if name.startswith("time steps in all, at most"))
    assert steps == "144,000"
    (steps,) = (value for name, value in told(pair(), False).items() if name.startswith("time steps in all, at most"))
    assert steps == "24,000"


def test_a_wheel_that_drives_is_told() -> None:
    """That `evolvent transient` would refuse the scene; nothing of it where the pinion drives."""
    assert any("load.driving" in each for each in scene_warnings(pair("load.driving=wheel")))
    assert not any("load.driving" in each for each in scene_warnings(pair()))


def test_too_many_modes_are_refused(tmp_path: Path) -> None:
    """40,000 r/min in 400 positions resolve vibrations up to 3.3 MHz, of which He's gears have thousands: refused
    before anything is computed, unless the scene says how many."""
    many = pair("transient.speeds_rpm=[40000]", "sweep.positions=400")
    assert any("modes of a gear" in each for each in scene_warnings(many))
    with pytest.raises(SceneError, match=r"transient\.speeds_rpm: found .* modes of a gear.*modes_per_harmonic"):
        quietly(Transient.of(many), tmp_path / "out")
    assert many.transient is not None
    assert too_many_modes(many, many.transient.model_copy(update={"modes_per_harmonic": 2})) is None


@pytest.mark.parametrize(("start", "words"), [("statics", "would end without results"), ("rest", "would refuse")])
def test_a_backlash_that_nobody_names_is_said(start: str, words: str, tmp_path: Path) -> None:
    """Flanks that part need one: a start from rest without one is refused before anything is computed, statics are
    taken as long as flanks do not part, with a warning of `check`."""
    plain = load_scene(ROOT / "demos/he2022.toml", ["transient.speeds_rpm=[1500]", f'transient.start="{start}"'])
    (said,) = (each for each in scene_warnings(plain) if "backlash_um" in each)
    assert words in said and "pair.centre_distance_mm" in said
    if start == "rest":
        with pytest.raises(SceneError, match=r"dynamics\.backlash_um"):
            quietly(Transient.of(plain), tmp_path / "out")
    assert not any("backlash_um" in each for each in scene_warnings(pair()))
