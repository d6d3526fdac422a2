"""Yang's pair from rest: the pinion at 1500 r/min at once, the wheel at rest under its torque.

The paper computes 0.0015 s "dynamic, implicit" with a speed on the pinion and a load on the wheel, and says nothing of
how the motion begins. Here the flanks just touch at t = 0 (`transient.start = "rest"`), without friction, and with a
backlash in which they can part; beside it the wheel's inertia on the mean stiffness of the mesh, m ẍ + k x = F_0 from
x = 0 and ẋ = v.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from shutil import copy

import numpy as np

from evidence.checkout import DEMOS, DOCS
from evidence.pages.papers.kept_runs.kept import Named
from evidence.pages.papers.kept_runs.runs import Runs, read
from evolvent.dynamics.of_scene import drive_settings
from evolvent.scene.scene import load_scene
from evolvent.scene.schema.dynamics import DynamicsSection

DURATION = 0.0015
"""[s], the paper's."""
SPEED = 1500
PICTURE = "yang2022/from_rest.png"
SETTINGS = (
    f"transient.speeds_rpm=[{SPEED}]", "contact.friction=0.0", 'transient.start="rest"',
    "transient.mesh_periods=2", "transient.tolerance=0.005", "dynamics.backlash_um=1000",
)


def figures(runs: Runs, command: Callable[..., list[object]]) -> Named:
    """(name, value) of each figure. command: of the scene with settings. Raises RunFailed."""
    folder, _ = runs.ended("rest", "transient.json", *command(*SETTINGS))
    (fact,) = json.loads((folder / "transient.json").read_text(encoding="utf-8"))
    yield "natural_Hz", fact["natural_frequency_Hz"]
    yield from _one_degree(fact)
    rows = [{name: float(value) for name, value in row.items()} for row in read(folder / "transient_start.csv")]
    force = np.array([row["mesh_force_N"] for row in rows])
    yield "rest_contact_ratio", fact["start_dynamic_factor"]
    yield "rest_contact_us", 1e6 * rows[int(np.argmax(force))]["time_s"]
    yield "rest_parted_us", 1e6 * next(row["time_s"] for row in rows if row["mesh_force_N"] == 0.0)
    yield "rest_apart_um", -min(row["transmission_error_um"] for row in rows)
    early = [row for row in rows if row["time_s"] <= DURATION]
    peaks = np.array([row["max_pressure_MPa"] / row["static_max_pressure_MPa"] for row in early])
    yield "rest_pressure_ratio", float(np.nanmax(peaks))
    yield "rest_apart_percent", 100.0 * float(np.mean([row["mesh_force_N"] == 0.0 for row in early]))
    copy(folder / "pictures/transient_start.png", DOCS / PICTURE)


def _one_degree(fact: Mapping[str, float]) -> Named:
    """Of the estimate. fact: of transient.json."""
    pair = load_scene(DEMOS / "yang2022.toml").gear_pair()
    mass = drive_settings(pair, DynamicsSection()).inertias[1] / pair.wheel.base_radius**2
    speed = 2.0 * np.pi * SPEED / 60.0 * pair.pinion.base_radius  # along the line of action, of both gears
    natural = 2.0 * np.pi * fact["natural_frequency_Hz"]
    blow = mass * natural * speed / fact["load_N"]  # force that stops the wheel without its load, over the load
    yield "rest_force_ratio", 1.0 + float(np.hypot(1.0, blow))
    yield "rest_time_us", 1e6 * (0.5 * np.pi + float(np.arctan(1.0 / blow))) / natural
    yield "rest_ramp_percent", 100.0 * mass * speed / DURATION / fact["load_N"]


def sentence(kept: Mapping[str, float]) -> str:
    """What the figures say."""
    return (
        "If the pair starts from rest (the paper does not say how its 0.0015 s begin; here the pinion has 1500 r/min "
        "at once and the wheel is at rest under its torque, without friction), the mesh force rises to "
        f"**{kept['rest_contact_ratio']:.1f} times the load** {kept['rest_contact_us']:.0f} µs after the flanks touch "
        f"({kept['rest_force_ratio']:.1f} times after {kept['rest_time_us']:.0f} µs by the wheel's inertia on the "
        f"mean stiffness alone), they part after {kept['rest_parted_us']:.0f} µs (positions are 39 µs apart), and by "
        f"up to {kept['rest_apart_um']:.0f} µm, given 1 mm of backlash: the drawn gears have none. In the first "
        f"0.0015 s they are apart {kept['rest_apart_percent']:.0f} % of the time, and the largest pressure is up to "
        f"{kept['rest_pressure_ratio']:.1f} times the static one. The paper's curves have nothing of the kind. If the "
        "speed rises evenly over the 0.0015 s instead, the wheel's acceleration adds "
        f"{kept['rest_ramp_percent']:.0f} % to the load in the mean, and up to twice that where it sets in at once."
    )
