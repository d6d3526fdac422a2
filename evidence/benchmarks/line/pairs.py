"""Gear pairs for the comparison of line contact and resolved contact."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evidence.benchmarks.gears.whole_runs import FIRST, SLENDER
from evidence.checkout import ROOT
from evidence.scenes import HELICAL, PLAIN, SPUR
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import SceneError, load_scene, scene_from_text

IN_PLANE = 20
"""Positions of pairs in the plane, some of which are at kinks of linear reliefs."""


@dataclass(frozen=True)
class Case:
    """A gear pair under some torques."""

    name: str
    """Name in the table."""
    problem: GearProblem
    """Pair with its resolved mesh."""
    percents: tuple[float, ...]
    """Torques in percent of the problem's, ascending."""
    positions: int = 5
    """Positions of the pitch."""


def relieved(relief_um: float, form: str = "parabolic") -> tuple[str, ...]:
    """Settings of a scene for tip relief of both gears."""
    keys = f"tip_relief_um={relief_um}", f'tip_relief_form="{form}"'
    return tuple(f"{gear}.{key}" for gear in ("pinion", "wheel") for key in keys)


def faces(width: float) -> tuple[str, ...]:
    """Settings of a scene for the face width of both gears [mm]."""
    return tuple(f"{gear}.face_width_mm={width}" for gear in ("pinion", "wheel"))


def case(name: str, scene: Path, percents: tuple[float, ...], *settings: str) -> Case:
    """A pair of demos/ with some settings, frictionless."""
    problem = gear_problem(load_scene(scene, [*PLAIN, "contact.friction=0.0", *settings]))
    return Case(name, problem, percents, IN_PLANE if problem.is_plane else Case.positions)


FINE = "mesh.level=fine", 'exact.parts=["coarse-body"]'
"""Settings of pairs in the plane. On the coarse body of a run, whose columns meet thin layers of a fine flank, the
transmission error of He's pair is 0.5 to 1.3 % low."""
ALL = (
    case("He, plane", SPUR, (5.0, 30.0, 100.0), *relieved(20.0), *FINE),
    case("He, linear relief, plane", SPUR, (5.0, 30.0, 100.0), *relieved(20.0, "linear"), *FINE),
    case("He, short relief, plane", SPUR, (10.0, 50.0, 100.0), *relieved(40.0, "linear"),
         "pinion.tip_relief_start_diameter_mm=154.5", "wheel.tip_relief_start_diameter_mm=154.5", *FINE),
    case("He, lead crowning", SPUR, (60.0, 100.0), *relieved(20.0), "pinion.lead_crowning_um=5"),
    case("He, half the face, lead crowning", SPUR, (5.0,), *relieved(20.0), *faces(10.0),
         "pinion.lead_crowning_um=1.25", "mesh.level=quick"),  # the crown of the pair above; its whole face wants 14 GB
    case("He, misaligned 20 µm", SPUR, (30.0, 100.0), *relieved(20.0), "pair.misalignment_um=20"),
    case("He, half the face, misaligned 20 µm", SPUR, (10.0, 30.0), *relieved(20.0), *faces(10.0),
         "pair.misalignment_um=20", "load.torque_Nm=85", "mesh.level=quick"),  # standard: over 23 GB with friction
    case("tutorial, 24/72", ROOT / FIRST, (15.0, 50.0, 90.0), *relieved(40.0)),
    case("tutorial, linear relief", ROOT / FIRST, (15.0, 50.0, 90.0), *relieved(40.0, "linear")),
    case("Yang, relieved", HELICAL, (5.0, 10.0, 30.0, 100.0), *relieved(60.0)),
    case("Yang, misaligned 20 µm", HELICAL, (10.0, 30.0, 100.0), *relieved(60.0), "pair.misalignment_um=20",
         "mesh.level=quick"),  # at standard it takes 19 GB
    case("Yang, half the face, misaligned 20 µm", HELICAL, (10.0, 30.0, 100.0), *relieved(60.0), *faces(8.45),
         "pair.misalignment_um=20", "load.torque_Nm=125"),
    case("23/81", ROOT / FIRST, (50.0, 100.0), *SLENDER, *relieved(20.0), "load.torque_Nm=100"),
)
"""Pairs by name; those in the plane come first, as they take least."""
SPUR_PAIRS, HELICAL_PAIRS = 5, 10
"""Numbers of random pairs."""
SHARE = 14.0
"""Mesh stiffness [N/(mm µm)] from which the deflection of a random pair is estimated."""


def random_cases() -> Iterator[Case]:
    """Random pairs with parabolic tip relief and lead crowning, spur ones first."""
    for helical, count in ((False, SPUR_PAIRS), (True, HELICAL_PAIRS)):
        found, seed = 0, 0
        while found < count:
            seed += 1
            try:
                problem = _random_problem(seed, helical)
            except SceneError:
                continue
            found += 1
            kind = "helical" if helical else "spur"
            pair = problem.pair
            yield Case(f"random {kind} {found}, {pair.pinion.z}/{pair.wheel.z}", problem, (50.0, 100.0), positions=4)


def _random_problem(seed: int, helical: bool) -> GearProblem:
    """The pair of a seed. Raises SceneError where the gears are impossible."""
    rng = np.random.default_rng((seed, helical))
    module = round(float(rng.uniform(1.0, 6.0)), 2)
    teeth, ratio = int(rng.integers(17, 36)), float(rng.uniform(1.0, 3.5))
    wheel, width = round(teeth * ratio), round(module * float(rng.uniform(3.0, 5.0)), 2)
    helix = round(float(rng.uniform(8.0, 25.0)), 1) if helical else 0.0
    radius = 0.5 * module * teeth / np.cos(np.radians(helix))
    load = float(rng.uniform(40.0, 120.0)) * module  # per mm of face
    relief, crowning = round(1.6 * load / SHARE, 2), round(float(rng.uniform(0.2, 0.6)) * load / SHARE, 2)
    space = helical or rng.random() < 0.4
    text = f"""
[pair]
normal_module_mm = {module}
normal_pressure_angle_deg = 20.0
helix_angle_deg = {helix}
[pinion]
teeth = {teeth}
face_width_mm = {width}
profile_shift = {round(float(rng.uniform(-0.1, 0.5)), 3)}
bore_diameter_mm = {round(0.9 * radius, 2)}
tip_relief_um = {relief}
tip_relief_form = "parabolic"
lead_crowning_um = {crowning if space else 0.0}
[wheel]
teeth = {wheel}
face_width_mm = {width}
bore_diameter_mm = {round(0.9 * radius * ratio, 2)}
tip_relief_um = {relief}
tip_relief_form = "parabolic"
[load]
torque_Nm = {round(1e-3 * load * width * radius, 2)}
"""
    return gear_problem(scene_from_text(text, [*PLAIN, *(() if space else FINE)]))


def unrelieved(seed: int, helical: bool = False) -> GearProblem:
    """A random pair without relief: spur in the plane, resolved at level standard, or helical, resolved at level quick.
    Raises SceneError where the gears are impossible."""
    rng = np.random.default_rng((seed, 8 if helical else 7))
    module = round(float(rng.uniform(1.0, 6.0)), 2)
    teeth, width = int(rng.integers(17, 40)), round((4.0 if helical else 8.0) * module, 2)
    wheel = round(teeth * float(rng.uniform(1.0, 3.5)))
    load = float(np.exp(rng.uniform(np.log(5.0), np.log(150.0)))) * module
    helix = round(float(rng.uniform(8.0, 25.0)), 1) if helical else 0.0
    diameter = module / np.cos(np.radians(helix))
    text = f"""
[pair]
normal_module_mm = {module}
normal_pressure_angle_deg = {rng.choice([17.5, 20.0, 25.0])}
helix_angle_deg = {helix}
[pinion]
teeth = {teeth}
face_width_mm = {width}
profile_shift = {round(float(rng.uniform(-0.1, 0.5)), 3)}
bore_diameter_mm = {round(0.45 * diameter * teeth, 2)}
[wheel]
teeth = {wheel}
face_width_mm = {width}
bore_diameter_mm = {round(0.45 * diameter * wheel, 2)}
[load]
torque_Nm = {round(0.5e-3 * load * width * diameter * teeth, 3)}
"""
    return gear_problem(scene_from_text(text, [*PLAIN, *(('mesh.level="quick"',) if helical else ())]))
