"""What follows from a scene, to be compared with what follows from another one; another value of every key."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from evolvent.check.check_report import overview
from evolvent.dynamics.of_scene import drive_settings, operating_point
from evolvent.gears.problem.gear_inertia import equivalent_mass
from evolvent.gears.problem.iso_dynamic_factor import method_b
from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.ranking import Ranking
from evolvent.run.dynamics.speeds import map_list, sweep_list
from evolvent.run.dynamics.vibration import accuracy
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.load_cases import load_cases, with_list
from evolvent.scene.scene import Scene, scene_from_text
from evolvent.scene.skips import wanted_output
from evolvent.strength.fatigue.flank_fatigue import FatigueMaterial, flank_fatigue
from evolvent.strength.fatigue.flank_loads import FlankLoads
from evolvent.strength.results.tables import formula_rows
from evolvent.strength.solution.root_stress import NO_DEEP_TEETH
from evolvent.strength.standard.root_stress import RootLoad
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import Modifications

BARE = """title = "spur pair without options"
pair = {normal_module_mm = 3.0, centre_distance_mm = 90.1}
pinion = {teeth = 20, face_width_mm = 20.0}
wheel = {teeth = 40, face_width_mm = 20.0}
load.torque_Nm = 80.0
mesh.level = "quick"
sweep.positions = 6
[wear]
cycles = 1e6
pinion_mm2_per_N = 1e-10
[dynamics]
[transient]
speeds_rpm = [1500.0]
[strength]
[strength.gauges]
gear = ["pinion"]
side = ["loaded"]
angle_deg = [30.0]
height_mm = [0.0]
length_mm = [1.0]
[fatigue]
[design]
vary = [["both.tip_relief_um", 5.0, 25.0, 5.0]]
"""
"""A scene with every section, in which no key is given that need not be, but for a cheap mesh."""
OF_GEARS = {
    "teeth": None, "face_width_mm": "19.0", "profile_shift": "-0.05", "tooth_thickness_allowance_um": "-50.0",
    "tip_diameter_mm": None, "addendum_coefficient": "1.02", "tip_chamfer_um": "150.0", "tip_rounding_um": "150.0",
    "root_diameter_mm": None, "dedendum_coefficient": "1.3", "rack_tip_radius_mm": "0.9", "protuberance_um": "30.0",
    "hand": '"left"', "bore_diameter_mm": "20.0", "rim_thickness_mm": "8.0", "web_thickness_mm": "8.0",
    "web_offset_mm": "2.0", "hub_diameter_mm": None, "support_width_mm": "12.0", "support_offset_mm": "2.0",
    "tip_relief_um": "12.0", "tip_relief_start_diameter_mm": None, "tip_relief_form": '"parabolic"',
    "root_relief_um": "9.0", "root_relief_end_diameter_mm": None, "root_relief_form": '"parabolic"',
    "profile_crowning_um": "5.0", "profile_slope_um": "-6.0", "profile_control_diameter_mm": None,
    "lead_crowning_um": "5.0", "helix_slope_um": "7.0", "end_relief_um": "8.0", "end_relief_length_mm": "3.0",
    "end_relief_form": '"parabolic"', "twist_um": "6.0", "flank_csv": None,
}
OF_EACH = {
    "teeth": ("19", "39"),
    "tip_diameter_mm": ("65.5", "125.5"), "root_diameter_mm": ("52.0", "112.0"), "hub_diameter_mm": ("30.0", "70.0"),
    "tip_relief_start_diameter_mm": ("64.0", "124.0"), "root_relief_end_diameter_mm": ("58.5", "118.5"),
    "profile_control_diameter_mm": ("57.5", "117.5"), "flank_csv": ('"pinion.csv"', '"wheel.csv"'),
}
"""Of pinion and wheel, where they cannot have the same."""
OTHERS = {
    "title": '"another"', "pair.normal_module_mm": "2.95", "pair.normal_pressure_angle_deg": "22.0",
    "pair.helix_angle_deg": "2.0", "pair.centre_distance_mm": "90.2", "pair.misalignment_um": "10.0",
    "material.E_GPa": "200.0", "material.nu": "0.29", "material.pinion.E_GPa": "200.0", "material.pinion.nu": "0.29",
    "material.wheel.E_GPa": "200.0", "material.wheel.nu": "0.29", "mesh.level": '"fine"',
    "mesh.elements_per_contact_width": "2.5", "mesh.shape": '"tetrahedron"', "mesh.order": "1",
    "contact.friction": "0.1", "load.torque_Nm": "90.0", "load.on": '"wheel"', "load.driving": '"wheel"',
    "load.mesh_torques_Nm": "[40.0, 160.0]",
    "load.percents": "[50.0, 100.0]", "load_case.name": '"b"', "load_case.torque_Nm": "60.0",
    "load_case.speed_rpm": "1500.0", "load_case.share_of_life": "1.0", "load_case.misalignment_um": "5.0",
    "sweep.positions": "8", "wear.cycles": "2e6", "wear.pinion_mm2_per_N": "2e-10", "wear.wheel_mm2_per_N": "1e-10",
    "wear.report_at_cycles": "[1e5]", "wear.tolerance": "0.1", "wear.blocks": '"explicit"',
    "wear.first_block_cycles": "2e4", "wear.refresh_um": "3.0", "dynamics.speed_rpm": "[500.0, 9000.0]",
    "dynamics.speeds": "200", "dynamics.mesh": '"tangent"', "dynamics.torque_percents": "[50.0, 100.0, 200.0]",
    "dynamics.damping_ratio": "0.07", "dynamics.damping_in_separation": "true", "dynamics.ground_damping_ratio": "0.01",
    "dynamics.backlash_um": "40.0", "dynamics.density_kg_m3": "7200.0", "dynamics.pinion_inertia_kg_m2": "1e-3",
    "dynamics.wheel_inertia_kg_m2": "1e-2", "dynamics.series_stiffness_N_per_um": "500.0",
    "dynamics.operating_rpm": "3000.0", "dynamics.approach": '"run_down"', "dynamics.histories_rpm": "[2000.0]",
    "dynamics.bodies": '"rigid"', "dynamics.map_percents": "[50.0, 150.0]", "dynamics.map_speeds": "50",
    "dynamics.base_pitch_deviation_um": "5.0", "dynamics.profile_deviation_um": "5.0", "dynamics.tolerance_class": "7",
    "dynamics.flank_surface": '"cast_iron"', "dynamics.contact_endurance_MPa": "1400.0",
    "transient.speeds_rpm": "[2000.0]", "transient.drive": '"constant_speed"', "transient.start": '"rest"',
    "transient.mesh_periods": "30", "transient.steady_change": "0.01", "transient.mode_damping_ratio": "0.02",
    "transient.modes_per_harmonic": "3", "transient.spectral_radius": "0.5", "transient.tolerance": "0.01",
    "transient.most_parts": "32", "strength.editions": "[2019]", "strength.tolerance_class": "3",
    "strength.root_refinement": "3", "strength.gauges.gear": '["wheel"]', "strength.gauges.side": '["back"]',
    "strength.gauges.angle_deg": "[40.0]", "strength.gauges.height_mm": "[3.0]", "strength.gauges.length_mm": "[0.5]",
    "fatigue.depths": "[0.0, 0.02, 0.05, 0.1, 0.5, 1.0]", "fatigue.yield_stress_MPa": "800.0",
    "fatigue.tension_factor": "0.5", "fatigue.compression_factor": "0.2", "fatigue.normal_factor": "0.5",
    "fatigue.exponents": "[9.0]", "output.pictures": "false", "output.animation": "false", "output.fields": "false",
    "output.deformation": "true", "output.error_bars": "false",
    "design.vary": '[["pinion.tip_relief_um", 5.0, 25.0, 5.0]]', "design.targets": '["face_load_factor"]',
    "design.limits": '[["face_load_factor", 1.5]]', "design.search": '"sobol"', "design.samples": "3",
    "design.tolerances": '[["wheel.tip_relief_um", 2.0]]', "design.verified": "2",
    "exact.parts": '["plane"]',
}
CHARTS = {"pinion.csv": "diameter_mm,depth_um\n50,3\n70,5\n", "wheel.csv": "diameter_mm,depth_um\n110,3\n130,5\n"}
"""Name -> text of a chart of either gear."""


def other_value(key: str) -> str:
    """An allowed value of a dotted key, in TOML, that is neither its default nor that of `BARE`."""
    section, _, name = key.rpartition(".")
    if section not in ("pinion", "wheel"):
        return OTHERS[key]
    if name in OF_EACH:
        return OF_EACH[name][section == "wheel"]
    value = OF_GEARS[name]
    assert value is not None
    return value


def setting(key: str, value: str) -> str:
    """Override of a dotted key by a value in TOML: of a load case, in a list of one that is not valid without its name
    and torque."""
    section, _, name = key.rpartition(".")
    if section != "load_case":
        return f"{key}={value}"
    keys = {"name": '"a"', "torque_Nm": "40.0", name: value}
    return f"load_case=[{{{', '.join(f'{each} = {given}' for each, given in keys.items())}}}]"


def _gears(scene: Scene) -> object:
    """What is computed, with the depth of modifications in place of their data."""
    problem = gear_problem(scene)
    pinion, wheel = (_unmodified(gear) for gear in problem.pair.gears)
    charts = [None if chart is None else chart.text() for chart in problem.flanks]
    plain = replace(problem, pair=replace(problem.pair, pinion=pinion, wheel=wheel), flanks=(None, None))
    return repr(plain), charts, [_depths(gear) for gear in problem.pair.gears]


def _unmodified(gear: GearParameters) -> GearParameters:
    """Without modifications; of a spur gear without a hand, which does not turn anything."""
    return replace(gear, modifications=Modifications(), hand=gear.hand if gear.helix_angle else 1)


def _depths(gear: GearParameters) -> object:
    lengths = np.array([gear.roll_length(d) for d in np.linspace(gear.root_form_diameter, gear.tip_diameter, 20)])
    heights = gear.face_width * np.linspace(-0.5, 0.5, 21)
    return gear.flank_depth.at(lengths[:, None], heights[None, :]).tolist()


def _vibration(scene: Scene) -> object:
    """The model of the section [dynamics], its speeds, and K_v of ISO 6336-1 over them."""
    problem, section = gear_problem(scene), scene.dynamics
    assert section is not None
    settings = drive_settings(problem.pair, section)
    mass = equivalent_mass(problem.pair, settings.inertias)
    iso = method_b(problem.pair, mass, problem.torque / problem.pair.pinion.base_radius, accuracy(section))
    factors = [iso.factor(speed) for speed in np.linspace(1000.0, 20000.0, 9)]
    over_torque = map_list(5000.0, section).tolist() if section.map_percents else None
    return (
        settings, sweep_list(5000.0, section).tolist(), section.histories_rpm, section.map_percents, over_torque,
        sorted(section.torque_percents), factors, operating_point(scene), section.bodies,
    )


def _roots(scene: Scene) -> object:
    """Root stress by the standard, and what else the section [strength] asks for."""
    problem, section = gear_problem(scene), scene.strength
    assert section is not None
    loads = [RootLoad(problem.pair, member, problem.pinion_torque) for member in Member]
    grade = section.tolerance_class or NO_DEEP_TEETH
    rows = [[repr(row) for row in formula_rows(load, section.editions, grade)] for load in loads]
    return rows, section.root_refinement, section.gauges


def _fatigue(scene: Scene) -> object:
    """Criteria below one loaded point of the pinion's flank."""
    section, one = scene.fatigue, np.ones(1)
    assert section is not None
    loads = FlankLoads(np.zeros((1, 3), dtype=np.int64), 0.0 * one, 0.0 * one, 1000.0 * one, 0.1 * one, 0.3 * one)
    material = scene.materials()[0]
    found = flank_fatigue(loads, 0.3, section.depths[:8:3], FatigueMaterial(
        material.poissons_ratio, material.lame[1], section.yield_stress_MPa, section.tension_factor,
        section.compression_factor, section.normal_factor,
    ))
    return section.depths, section.exponents, {each.name: value.tolist() for each, value in found.values.items()}


def _design(scene: Scene) -> object:
    """Variants that a search begins with, how they are judged, and those within the tolerances."""
    section = scene.design
    assert section is not None
    space = DesignSpace(scene, section)
    figures = np.array([[[1.0, 1.6, 900.0, 0.5, 0.4, 0.0]], [[2.0, 1.2, 950.0, 0.5, 0.8, 0.0]]])
    ranking = Ranking(section, figures)
    everything = section.search, section.samples, section.verified
    return (
        everything, space.keys, space.variants(space.lattice()).tolist(), space.deviating(space.as_it_stands).tolist(),
        ranking.best(1).tolist(), ranking.is_allowed.tolist(),
    )


def _output(scene: Scene) -> object:
    return wanted_output(scene)


def _torques(scene: Scene) -> object:
    """Loads of a list."""
    return load_cases(with_list(scene))


CONSEQUENCES: tuple[Callable[[Scene], object], ...] = (
    _gears, _output, _torques, _design, _fatigue, _vibration, overview, _roots,
)
"""What follows from a scene, the cheap ones first."""


@cache
def bare_scene(*settings: str) -> Scene:
    """`BARE` with some overrides."""
    return scene_from_text(BARE, settings)


@cache
def _of_bare(consequence: Callable[[Scene], object], *settings: str) -> object:
    return consequence(bare_scene(*settings))


def follows_the_same(scene: Scene, *settings: str) -> bool:
    """Whether everything that follows from a scene follows from `bare_scene(*settings)`, too."""
    return all(_of_bare(each, *settings) == each(scene) for each in CONSEQUENCES)
