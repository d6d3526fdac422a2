"""Limits of the speeds, inertias and compliances of a vibration, and values that are doubtful."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from evolvent.gears.problem.gear_inertia import equivalent_mass, solid_moment, teeth_moment
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, method_b
from evolvent.gears.problem.load_limits import rounded_down, rounded_up
from evolvent.scene.inertias import KG_M2, moments_of_inertia
from evolvent.scene.schema.dynamics import DynamicsSection, TransientSection
from evolvent.scene.schema.errors import InputProblem, shown
from evolvent.scene.schema.loading import LoadSection
from evolvent_meshes.gears.pair import GearPair

FASTEST_RIM, FAST_RIM = 400.0, 200.0
"""Peripheral speeds of a tip circle [m/s] above which a scene is refused, and is doubtful. At 400 m/s rotation alone
puts 1 GPa at the bore of a steel disc, (3 + ν)/4 ϱ v²; the fastest gears that are built have about 200 m/s."""
SLOWEST = 0.01
"""Lowest speed of a vibration over the natural one: below it a mesh period has a hundred natural ones and more, in
which vibration dies away, and the time that it takes to compute goes with their number."""
HEAVIEST, HEAVY = 1e5, 100.0
"""Moment of inertia over that of a solid disc of the tip diameter above which a scene is refused, and is doubtful: a
value in kg·mm² is 1e6 times one in kg·m²; a flywheel above it turns as uniformly as one of this."""
LIGHTEST = 0.01
"""Moment of inertia over that of the teeth alone below which a scene is refused; below 1 it is doubtful."""
SOFT = 0.05
"""Stiffness in series with the mesh over that of the mesh by ISO 6336-1, below which the stiffness in series is
doubtful."""


def sense_of_transient(load: LoadSection) -> InputProblem | None:
    """Input problem of a wheel that drives, which `evolvent transient` does not compute; None where the pinion does."""
    if load.driving == "pinion":
        return None
    allowed = '"pinion" for evolvent transient, whose positions follow each other as they do where the pinion drives'
    remedy = (
        "`evolvent run` has the contact where the wheel drives, with dynamics.operating_rpm at a speed, and `evolvent "
        "dynamics` the vibration"
    )
    return InputProblem("load.driving", shown(load.driving), allowed, remedy)


@dataclass(frozen=True)
class PlannedVibration:
    """Quantities of a scene on which limits of its vibration depend."""

    pair: GearPair
    """Geometry of the gear pair."""
    force: float
    """Static force along the line of action in the transverse section [N]."""
    moduli: tuple[float, float]
    """Young's moduli of both gears [MPa]."""
    dynamics: DynamicsSection | None
    """Section [dynamics] of the scene, None where it has none."""
    transient: TransientSection | None
    """Section [transient] of the scene, None where it has none."""

    @property
    def fastest(self) -> float:
        """Speed of the pinion [r/min] at which a tip circle moves at `FASTEST_RIM`."""
        pinion, wheel = self.pair.gears
        widest = max(pinion.tip_diameter, wheel.tip_diameter / self.pair.ratio)
        return 60e3 * FASTEST_RIM / (math.pi * widest)

    @cached_property
    def mesh_stiffness(self) -> float:
        """Mesh stiffness: c_γα of ISO 6336-1 times the face width [N/mm]."""
        iso = method_b(self.pair, 1.0, self.force, Accuracy(), self.moduli)
        return 1e3 * iso.mesh_stiffness * self.pair.face_width

    @cached_property
    def natural_speed(self) -> float:
        """Speed of the pinion [r/min] at which the mesh frequency is the natural frequency, by `mesh_stiffness` and the
        stiffness in series."""
        section = self.dynamics or DynamicsSection()
        mass, flexible = equivalent_mass(self.pair, moments_of_inertia(self.pair, section)), 1.0 / self.mesh_stiffness
        if section.series_stiffness_N_per_um is not None:
            flexible += 1e-3 / section.series_stiffness_N_per_um
        return 30.0 / (math.pi * self.pair.pinion.z * math.sqrt(mass * flexible))

    @property
    def speeds(self) -> dict[str, tuple[float, ...]]:
        """Key -> its speeds [r/min], of those that the scene has."""
        found: dict[str, tuple[float, ...]] = {}
        if (section := self.dynamics) is not None:
            operating = () if section.operating_rpm is None else (section.operating_rpm,)
            found |= {"dynamics.speed_rpm": section.speed_rpm or (), "dynamics.histories_rpm": section.histories_rpm}
            found |= {"dynamics.operating_rpm": operating}
        if self.transient is not None:
            found |= {"transient.speeds_rpm": self.transient.speeds_rpm}
        return {key: speeds for key, speeds in found.items() if speeds}

    @property
    def inertias(self) -> Iterator[tuple[str, float, float, float]]:
        """Key and value [kg·m²] of each that the scene gives, the teeth's own and a solid disc's."""
        section = self.dynamics or DynamicsSection()
        given = section.pinion_inertia_kg_m2, section.wheel_inertia_kg_m2
        for name, gear, value in zip(("pinion", "wheel"), self.pair.gears, given):
            if value is not None:
                teeth, disc = (moment(gear, section.density) / KG_M2 for moment in (teeth_moment, solid_moment))
                yield f"dynamics.{name}_inertia_kg_m2", value, teeth, disc


def impossible(planned: PlannedVibration) -> InputProblem | None:
    """First problem for which a vibration cannot be computed, None where there is none."""
    return next((each for part in (_inertias, _series, _speeds) for each in part(planned)), None)


def doubtful(planned: PlannedVibration) -> list[str]:
    """A sentence on each value that is unlikely to be intended."""
    found = []
    for name, value, teeth, disc in planned.inertias:
        if value < teeth:
            found.append(f"{name}: found {value:.4g} kg·m², less than the teeth alone have, {teeth:.3g} kg·m²")
        if value > HEAVY * disc:
            found.append(
                f"{name}: found {value:.4g} kg·m², {value / disc:.3g} times that of a solid disc, {disc:.3g} kg·m²; is "
                "it in kg·m²?"
            )
    series = None if planned.dynamics is None else planned.dynamics.series_stiffness_N_per_um
    if series is not None and 1e3 * series < SOFT * planned.mesh_stiffness:
        found.append(
            f"dynamics.series_stiffness_N_per_um: found {series:.4g} N/µm beside a mesh of "
            f"{1e-3 * planned.mesh_stiffness:.3g} N/µm by ISO 6336-1: the gears vibrate on it, hardly on their mesh"
        )
    for name, speeds in planned.speeds.items():
        rim = FASTEST_RIM * max(speeds) / planned.fastest
        if rim > FAST_RIM:
            found.append(
                f"{name}: a tip circle moves at {rim:.0f} m/s; that rotation widens rims is not in the computation"
            )
    return found


def _inertias(planned: PlannedVibration) -> Iterator[InputProblem]:
    for name, value, teeth, disc in planned.inertias:
        if not LIGHTEST * teeth <= value <= HEAVIEST * disc:
            allowed = (
                f"from {rounded_up(LIGHTEST * teeth)} to {rounded_down(HEAVIEST * disc)} kg·m² for this gear: its "
                f"teeth alone have {teeth:.2g}, a solid disc {disc:.2g}"
            )
            yield InputProblem(name, shown(value), allowed, "mind the unit: 1 kg·m² is 1e6 kg·mm²; or delete the key")


def _series(planned: PlannedVibration) -> Iterator[InputProblem]:
    given = None if planned.dynamics is None else planned.dynamics.series_stiffness_N_per_um
    module = planned.pair.pinion.normal_module
    if given is not None and (way := 1e-3 * planned.force / given) > module:
        allowed = f"from {rounded_up(1e-3 * planned.force / module)} N/µm on: less than a module under the torque"
        found = f"{shown(given)} ({way:.3g} mm under the torque)"
        yield InputProblem("dynamics.series_stiffness_N_per_um", found, allowed, "check that it is in N/µm")


def _speeds(planned: PlannedVibration) -> Iterator[InputProblem]:
    for name, speeds in planned.speeds.items():
        if max(speeds) > planned.fastest:
            allowed = (
                f"up to {rounded_down(planned.fastest)} r/min for these gears, {FASTEST_RIM:g} m/s at a tip circle, "
                "where rotation alone bursts a steel disc"
            )
            yield InputProblem(name, shown(speeds), allowed, "check that speeds are in r/min and diameters in mm")
        if name.startswith("dynamics.") and min(speeds) < (least := SLOWEST * planned.natural_speed):
            allowed = (
                f"from {rounded_up(least)} r/min on for these gears, a hundredth of the natural speed by ISO 6336-1: "
                "below, vibration dies away within a mesh period, and the load is as good as static"
            )
            yield InputProblem(name, shown(speeds), allowed, "begin there; `evolvent run` has the static load")
