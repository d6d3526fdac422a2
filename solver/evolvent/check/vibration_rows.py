"""Rows of `evolvent check` on [dynamics]: inertia, backlash and its limit, and the numbers of speeds and motions."""

from __future__ import annotations

from evolvent.check.planned_cost import SWEEPS, shown_time, speeds_time
from evolvent.check.text_table import Row
from evolvent.dynamics.of_scene import drive_settings, refusals
from evolvent.dynamics.pair_model import lacking_room
from evolvent.gears.problem.gear_inertia import added_inertia, equivalent_mass, polar_moment
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, method_b
from evolvent.scene.backlash import unnamed_backlash
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent.scene.skips import wanted_output

NOBODYS = "none is given"
WITH_OTHERS = "with those on other excitations, for error bars"


def vibration_lines(scene: Scene, section: DynamicsSection) -> list[Row]:
    """Lines on the inertia, damping, backlash and speeds of a scene with [dynamics]."""
    problem, count = gear_problem(scene), scene.sweep.positions
    settings = drive_settings(problem.pair, section)
    mass = equivalent_mass(problem.pair, settings.inertias)
    added = [
        added_inertia(moment, polar_moment(gear, section.density))
        for moment, gear in zip(settings.inertias, problem.pair.gears)
    ]
    planned, bars = scene.planned_vibration(), wanted_output(scene).error_bars
    time = shown_time(speeds_time(planned.natural_speed, section, bars))
    iso = method_b(problem.pair, mass, planned.force, Accuracy(), planned.moduli)
    swept = ["by default", *(f"{speed:g}" for speed in section.speed_rpm or ())]
    named = unnamed_backlash(problem.pair, section.backlash_um) is None
    return [
        Row("moment of inertia", "I", "kg·m²", tuple(f"{1e-3 * each:.4g}" for each in settings.inertias)),
        Row("  at the bore, beyond the body's", "", "kg·m²", tuple(f"{1e-3 * each:.3g}" for each in added)),
        Row("equivalent mass along the line of action", "m_e", "kg", (f"{1e3 * mass:.4g}",)),
        Row("gear bodies", "", "", (section.bodies,)),
        Row("damping ratio", "ζ", "", (f"{settings.damping_ratio:g}",)),
        Row("backlash along the line of action", "j", "µm", (f"{1e3 * settings.backlash:.4g}" if named else NOBODYS,)),
        Row("  lacking for unloaded errors", "", "µm", (f"{1e3 * lacking_room(problem, count, settings):.3g}",)),
        Row("natural speed by c_γα of ISO 6336-1", "n_E1", "r/min", (f"{iso.resonance_speed:.4g}",)),
        Row("speeds", "n", "r/min", tuple(swept[1:] or swept[:1])),
        Row("positions × torques of the excitation", "", "", (f"{count} × {len(section.torque_percents)}",)),
        Row("speeds, up and down", "", "", (str(section.speeds),)),
        *([Row(f"  {WITH_OTHERS}", "", "", (str(SWEEPS * section.speeds),))] if bars else []),
        Row("processor time of the speeds, roughly", "", "", (time,)),
    ]


def vibration_warnings(scene: Scene) -> list[str]:
    """Reasons why `evolvent dynamics` would refuse a scene with [dynamics]; none where it would not."""
    return [f"`evolvent dynamics` would refuse this scene: {why}." for why in refusals(scene)]
