"""Yang's pair from rest: the pinion at 1500 r/min at once, the wheel at rest under its torque.

The paper computes 0.0015 s "dynamic, implicit" with a speed on the pinion and a load on the wheel, and says nothing of
how the motion begins. Here with the wheel's inertia on the mean stiffness of the mesh, m ẍ + k x = F_0 from x = 0 and
ẋ = v.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from evidence.checkout import DEMOS
from evidence.pages.papers.kept_runs.kept import Named
from evolvent.scene.pair_dynamics import drive_settings
from evolvent.scene.scene import load_scene
from evolvent.scene.schema.dynamics import DynamicsSection

DURATION = 0.0015
"""[s], the paper's."""


def figures(fact: Mapping[str, Any]) -> Named:
    """(name, value) of each figure. fact: of transient.json, with the wheel loaded."""
    pair = load_scene(DEMOS / "yang2022.toml").gear_pair()
    mass = drive_settings(pair, DynamicsSection()).inertias[1] / pair.wheel.base_radius**2
    speed = 2.0 * np.pi * fact["speed_rpm"] / 60.0 * pair.pinion.base_radius  # along the line of action, of both gears
    natural = 2.0 * np.pi * fact["natural_frequency_Hz"]
    blow = mass * natural * speed / fact["load_N"]  # force that stops the wheel without its load, over the load
    yield "natural_Hz", fact["natural_frequency_Hz"]
    yield "rest_force_ratio", 1.0 + float(np.hypot(1.0, blow))
    yield "rest_time_us", 1e6 * (0.5 * np.pi + float(np.arctan(1.0 / blow))) / natural
    yield "rest_ramp_percent", 100.0 * mass * speed / DURATION / fact["load_N"]


def sentence(kept: Mapping[str, float]) -> str:
    """What the figures say."""
    return (
        "If the pair starts from rest (the paper does not say how its 0.0015 s begin; say the pinion has 1500 r/min at "
        "once and the wheel is at rest under its torque), the wheel's inertia on the mean stiffness of the mesh has "
        f"the mesh force rise to **{kept['rest_force_ratio']:.1f} times the load** within {kept['rest_time_us']:.0f} "
        "µs, and the flanks part when it has swung back. The paper's curves have nothing of the kind. If the speed "
        "rises evenly over the 0.0015 s instead, the wheel's acceleration adds "
        f"{kept['rest_ramp_percent']:.0f} % to the load in the mean, and up to twice that where it sets in at once. "
        "With `transient.start = \"rest\"` contact itself can be followed through the blow, given a backlash: the "
        "drawn gears have none."
    )
