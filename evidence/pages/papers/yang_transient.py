"""`python -m evidence.pages.papers.yang_transient --out DIR`: Yang's pair at both speeds, for docs/yang2022.md.

At 1500 and 3000 r/min and the paper's friction coefficients, as the paper drives the pair, the pinion at constant speed
and a torque on the wheel; the lowest and the highest coefficient with error bars; and from rest (yang_start.py). Runs
that an earlier call has ended are read again. `python -m evidence.pages` then writes the page.
"""

from __future__ import annotations

import json
from pathlib import Path
from shutil import copy
from typing import Any

import numpy as np

from evidence.checkout import DEMOS, DOCS
from evidence.pages.papers import yang_start
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evidence.pages.papers.kept_runs.runs import Runs, keep_figures, read
from evidence.processes import module_run
from evidence.tables import markdown
from evolvent.scene.scene import load_scene

KEPT = "yang2022/transient.csv"
COMMAND = "python -m evidence.pages.papers.yang_transient --out DIR"
SPEEDS, LOW, HIGH = (1500, 3000), 0.07, 0.3
FRICTIONS = LOW, 0.08, 0.11, 0.12, 0.15, 0.2, HIGH
"""The paper's."""
POSITIONS = 60
DRIVE = (
    "load.on=wheel", "load.torque_Nm=882.353", "transient.drive=constant_speed", f"sweep.positions={POSITIONS}",
)
"""The torque on the wheel that 250 N·m on the pinion balance."""
PICTURE, WITH_BARS = "yang2022/at_speed.png", "yang2022/with_error_bars.png"
SHOWN = "static_peak_to_peak_um", "peak_to_peak_um", "static_max_pressure_MPa", "max_pressure_MPa"
"""Of each case."""


def command(*settings: str, error_bars: bool = False) -> list[object]:
    """`evolvent transient` of the scene on level quick."""
    output = "output.animation=false", f"output.error_bars={str(error_bars).lower()}"
    set_to = [f"--set={each}" for each in (*DRIVE, *settings, *output)]
    return [*module_run("evolvent", "transient", DEMOS / "yang2022.toml", "--level", "quick", "--overwrite",
                        "--quiet", *set_to)]


def figures(runs: Runs) -> Named:
    """(name, value) of each figure. Raises RunFailed."""
    speeds = f"transient.speeds_rpm={list(SPEEDS)}"
    words = command(speeds, f"contact.friction={list(FRICTIONS)}")
    folder, _ = runs.ended("all_coefficients", "transient.json", *words)
    yield from _of_cases(_facts(folder))
    yield from _of_teeth(folder)
    words = command(speeds, f"contact.friction={[LOW, HIGH]}", error_bars=True)
    barred, _ = runs.ended("error_bars", "transient.json", *words)
    yield from _of_bars(barred)
    copy(barred / "pictures/transient.png", DOCS / WITH_BARS)
    copy(folder / "pictures/transient.png", DOCS / PICTURE)
    yield from yang_start.figures(runs, command)


def _of_cases(facts: list[dict[str, Any]]) -> Named:
    """What inertia changes at each speed."""
    for speed in SPEEDS:
        own = [fact for fact in facts if fact["speed_rpm"] == speed]
        yield f"{speed}_periods", max(fact["mesh_periods"] for fact in own)
        yield f"{speed}_change_percent", 100.0 * max(fact["last_change"] for fact in own)
        yield f"{speed}_modes", own[0]["modes"]
        yield f"{speed}_mesh_Hz", speed / 60.0 * load_scene(DEMOS / "yang2022.toml").gear_pair().pinion.z
        yield f"{speed}_force_percent", 100.0 * (max(fact["dynamic_factor"] for fact in own) - 1.0)
        swing = [fact["peak_to_peak_um"] / fact["static_peak_to_peak_um"] - 1.0 for fact in own]
        yield f"{speed}_swing_least_percent", 100.0 * min(swing)
        yield f"{speed}_swing_most_percent", 100.0 * max(swing)
        peaks = [fact["max_pressure_MPa"] / fact["static_max_pressure_MPa"] - 1.0 for fact in own]
        yield f"{speed}_largest_percent", 100.0 * max(peaks, key=abs)
        for fact in own:
            for name in SHOWN:
                yield f"{speed}_{fact['friction']:g}_{name}", fact[name]


def _facts(folder: Path) -> list[dict[str, Any]]:
    """Of each case."""
    found: list[dict[str, Any]] = json.loads((folder / "transient.json").read_text(encoding="utf-8"))
    return found


def _of_bars(folder: Path) -> Named:
    """Error bars of the lowest and the highest coefficient, and of a tooth's pressures the median and the largest away
    from the tip-edge zones."""
    for fact in _facts(folder):
        for name in SHOWN:
            yield f"{fact['speed_rpm']:.0f}_{fact['friction']:g}_{name}_error", fact[f"{name}_error"]
    rows = read(folder / "transient_teeth.csv")
    for speed in SPEEDS:
        own = [row for row in rows if float(row["speed_rpm"]) == speed]
        bars = np.array([float(row["max_pressure_MPa_error"]) / float(row["max_pressure_MPa"]) for row in own])
        yield f"{speed}_tooth_bar_median_percent", 100.0 * float(np.nanmedian(bars))
        yield f"{speed}_tooth_bar_most_percent", 100.0 * float(np.nanmax(bars))


def _of_teeth(folder: Path) -> Named:
    """Pressure of a tooth over its engagement: what inertia changes, and what friction does at each speed."""
    rows = read(folder / "transient_teeth.csv")
    for speed in SPEEDS:
        curves = {}
        for friction in FRICTIONS:
            own = [row for row in rows if (float(row["speed_rpm"]), float(row["friction"])) == (speed, friction)]
            columns = ("tooth_angle_deg", "max_pressure_MPa", "static_max_pressure_MPa")
            curves[friction] = np.array([[float(row[name]) for name in columns] for row in own])
        moved = np.concatenate([curve[:, 1] / curve[:, 2] - 1.0 for curve in curves.values()])
        yield f"{speed}_pressure_percent", 100.0 * float(np.nanmax(np.abs(moved)))
        for name, column in (("moving", 1), ("static", 2)):
            low, high = (_known(curves[friction], column) for friction in (LOW, HIGH))
            both = np.intersect1d(low[0], high[0])
            change = np.interp(both, *high) / np.interp(both, *low) - 1.0
            yield f"{speed}_{name}_before_percent", 100.0 * float(np.median(change[both < -10.0]))
            yield f"{speed}_{name}_after_percent", 100.0 * float(np.median(change[both > 10.0]))


def _known(curve: np.ndarray[Any, np.dtype[np.float64]], column: int) -> tuple[Any, Any]:
    """Angles and pressures where these are known."""
    known = np.isfinite(curve[:, column])
    return np.round(curve[known, 0], 6), curve[known, column]


def table(docs: Path) -> str:
    """Both speeds, level quick."""
    f = kept.kept(docs / KEPT, COMMAND)
    rows = [
        (
            f"{speed}", f"{f[f'{speed}_mesh_Hz'] * POSITIONS / f['natural_Hz']:.0f}",
            f"{f['natural_Hz'] / f[f'{speed}_mesh_Hz']:.2f}", f"{f[f'{speed}_periods']:.0f}",
            f"{f[f'{speed}_force_percent']:+.2f} %",
            f"{f[f'{speed}_swing_least_percent']:+.1f} to {f[f'{speed}_swing_most_percent']:+.1f} %",
            f"{f[f'{speed}_largest_percent']:+.2f} %", f"{f[f'{speed}_pressure_percent']:.1f} %",
            f"{f[f'{speed}_moving_before_percent']:+.1f} / {f[f'{speed}_moving_after_percent']:+.1f} %",
        )
        for speed in SPEEDS
    ]
    head = (
        "speed [r/min]", "time steps in a period of the pair's own vibration",
        "its frequency over the mesh frequency", "mesh periods until steady", "largest mesh force over the load",
        "peak-to-peak transmission error over statics", "largest pressure over statics",
        "pressure of a tooth: largest difference from statics",
        "friction, μ 0.07 to 0.30: pressure of a tooth at −25° to −10° / 10° to 30°",
    )
    return markdown(head, rows)


def frictions_table(docs: Path) -> str:
    """Transmission error and largest pressure at each friction coefficient, in statics and at both speeds; with error
    bars where they were computed."""
    f = kept.kept(docs / KEPT, COMMAND)

    def shown(name: str, digits: int) -> str:
        bar = f" ± {f[f'{name}_error']:.{digits}f}" if f"{name}_error" in f else ""
        return f"{f[name]:.{digits}f}{bar}"

    first = SPEEDS[0]
    rows = [
        (
            f"{μ:.2f}", shown(f"{first}_{μ:g}_static_peak_to_peak_um", 3),
            *(shown(f"{speed}_{μ:g}_peak_to_peak_um", 3) for speed in SPEEDS),
            shown(f"{first}_{μ:g}_static_max_pressure_MPa", 0),
            *(shown(f"{speed}_{μ:g}_max_pressure_MPa", 0) for speed in SPEEDS),
        )
        for μ in FRICTIONS
    ]
    at = [f"at {speed} r/min" for speed in SPEEDS]
    statics = f"statics, torque held on the wheel, quick, {POSITIONS} positions"
    head = ("μ", f"transmission error, peak to peak [µm]: {statics}", *at, "largest pressure [MPa]: statics", *at)
    return markdown(head, rows)


def bars_said(docs: Path) -> str:
    """What the error bars are, and which changes of the transmission error they leave."""
    f = kept.kept(docs / KEPT, COMMAND)
    swing = {
        (speed, μ): [(f[name], f[f"{name}_error"]) for name in (f"{speed}_{μ:g}_{each}" for each in SHOWN[:2])]
        for speed in SPEEDS for μ in (LOW, HIGH)
    }
    faster = [f"{speed} r/min, μ = {μ:g}" for (speed, μ), (still, moving) in swing.items() if _apart(still, moving)]
    rougher = [
        f"{at} {speed} r/min" if at else "in statics"
        for speed, column, at in ((SPEEDS[0], 0, ""), *((speed, 1, "at") for speed in SPEEDS))
        if _apart(swing[speed, LOW][column], swing[speed, HIGH][column])
    ]
    median, most = (max(f[f"{speed}_tooth_bar_{name}_percent"] for speed in SPEEDS) for name in ("median", "most"))
    return (
        "The error bars hold mesh, modes, time steps and the spacing of positions; level quick has less than two "
        f"elements across the contact. Those of the pressure of a tooth are {median:.0f} % of it in the median, "
        f"{most:.0f} % at most. The peak-to-peak transmission error differs by more than both bars together between "
        f"statics and motion: {_listed(faster)}; between both coefficients: {_listed(rougher)}. All columns are of one "
        "mesh and one set of positions, so that differences should be better than that; by how much was not measured."
        "\n"
    )


def _apart(one: tuple[float, float], other: tuple[float, float]) -> bool:
    """Whether two values (value, error) differ by more than both errors together."""
    return abs(one[0] - other[0]) > one[1] + other[1]


def _listed(names: list[str]) -> str:
    return " and ".join(names) or "nowhere"


def start(docs: Path) -> str:
    """The start from rest."""
    return yang_start.sentence(kept.kept(docs / KEPT, COMMAND)) + "\n"


if __name__ == "__main__":
    keep_figures(__doc__, DOCS / KEPT, figures)
