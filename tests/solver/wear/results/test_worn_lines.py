"""Last words of a wear study, and the load in its titles."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, cast

from evolvent.dynamics.operation_figures import VibrationRow
from evolvent.run.output import last_lines
from evolvent.scene.scene import load_scene
from evolvent.wear.results.vibration_figure import vibration_over_cycles
from evolvent.wear.results.worn_lines import load_words

WEAR = ("wear.cycles=4e5", "wear.pinion_mm2_per_N=1e-10", "wear.wheel_mm2_per_N=0")


def test_a_wear_study_ends_with_the_worn_pair(tmp_path: Path) -> None:
    """Problem: a study of 400,000 cycles with a report halfway, whose pinion wears. Exact: the last lines have the
    load, the unworn pair, and of the last report largest depth, pressure and transmission error, by their names."""
    row = {"friction": 0.0, "max_pressure_MPa": 600.0, "estimated_error": None}
    (tmp_path / "summary.json").write_text(json.dumps({"frictions": [row]}))
    gear = {"deepest_um": 1.234, "at_diameter_mm": 147.0}
    worn = {"cycles": 4e5, "pinion": gear, "wheel": {"deepest_um": 0.0, "at_diameter_mm": 0.0},
            "max_pressure_MPa": 555.0, "transmission_error_peak_to_peak_um": 2.5}
    reports = [worn | {"cycles": 0.0, "max_pressure_MPa": 600.0}, worn | {"max_pressure_MPa": 570.0}, worn]
    (tmp_path / "wear.json").write_text(json.dumps({"reports": reports}))
    lines = last_lines(tmp_path, load_scene("demos/he2022.toml", WEAR)).splitlines()
    assert lines[:3] == [
        "under 170 N·m on the pinion:",
        "unworn, μ = 0: largest pressure 600 MPa",
        "after 0.4 million cycles: worn off at most 1.23 µm (pinion, d = 147.00 mm), largest pressure 555 MPa, "
        "transmission error 2.50 µm peak to peak; without error bars; wear.json has all reports",
    ]
    assert lines[3].startswith("done: figures in ") and "figures of wear in" in lines[3]


def test_titles_say_under_which_load_a_pair_wears() -> None:
    """Problem: a pair under the mesh force of its vibration, and under its torque. Exact: the load of the contact in
    words, and in the title of the vibration the static torque under which its curves are."""
    running = load_scene("demos/he2022_wear.toml")
    assert running.dynamics is not None and running.dynamics.operating_rpm is not None
    assert load_words(running) == f"under the mesh force of the vibration at {running.dynamics.operating_rpm:g} r/min"
    assert load_words(load_scene("demos/he2022.toml", WEAR)) == "under 170 N·m on the pinion"
    rows = [VibrationRow(**dict.fromkeys(VibrationRow.__dataclass_fields__, cast(Any, 1.0))) for _ in range(2)]
    title = vibration_over_cycles(rows, 3000.0, "170 N·m on the pinion").texts[0].get_text()
    assert title == "Vibration at 3000 r/min under 170 N·m on the pinion, as the pair wears"
