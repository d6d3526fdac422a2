"""The text of `evolvent check`: derived gear data, Hertz estimates, what is skipped, and what the run will cost."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

from evolvent.check.cache_size import kept_megabytes
from evolvent.check.form_rows import gear_lines, pair_lines
from evolvent.check.planned_tables import planned_tables
from evolvent.check.problem_size import (
    counted,
    flank_dofs,
    gigabytes,
    memory_megabytes,
    room_problem,
    sector_sizes,
    strength_megabytes,
)
from evolvent.check.scene_warnings import scene_warnings
from evolvent.check.text_table import Row, table
from evolvent.fem.parallel.machine import machine_megabytes
from evolvent.gears.meshing.element_sizes import elements_per_contact_width
from evolvent.gears.meshing.levelled_meshes import flank_cells, is_two_level
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.problem.hertz_estimate import HertzEstimate
from evolvent.scene.gear_pair import working_angle_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.plain_text import fixed
from evolvent.scene.scene import GEARS, Scene
from evolvent.scene.schema.wear import WearSection
from evolvent.scene.skips import one_mesh_reason, skipped, switched_off
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import AMOUNTS
from evolvent_meshes.gears.pair import GearPair

HANDS = {1: "right", -1: "left"}


def overview(scene: Scene) -> str:
    """The text that `evolvent check` prints, with the symbols of ISO 21771:2007."""
    pair, estimate = scene.gear_pair(), scene.hertz_estimate()
    blocks = [
        scene.title,
        table("Gears", [*_gear_rows(pair), *gear_lines(pair), *_chart_rows(scene)], GEARS),
        table("Pair", [*_pair_rows(pair), *pair_lines(pair)]),
        table("Load and Hertz estimate (rigid sharing, no friction)", _load_rows(scene, estimate)),
        *([table("Wear (line contact, rigid sharing)", _wear_rows(scene.wear, estimate), GEARS)] if scene.wear else []),
        *planned_tables(scene),
        table("Mesh and cost (estimate)", _cost_rows(scene), GEARS) + _room_line(scene),
        _skip_lines(scene),
        *_warning_lines(scene),
    ]
    return "\n\n".join(blocks)


def _skip_lines(scene: Scene) -> str:
    """Lines on the parts of the run that are skipped, and on those that are computed in full."""
    left_out = skipped(scene)
    column = 2 + max((len(skip.name) for skip in left_out), default=0)
    lines = ["Skipped", *(f"  {skip.name:<{column}}{skip.sentence}" for skip in left_out)]
    off = switched_off(scene)
    long_way = [*([", ".join(off)] if off else []), *filter(None, [one_mesh_reason(scene)])]
    exact = ["Computed without simplification", *(f"  {line}" for line in long_way)] if long_way else []
    return "\n".join([*lines, *exact])


def _warning_lines(scene: Scene) -> list[str]:
    warnings = list(scene_warnings(scene))
    return ["\n".join(["Warnings", *(f"  {sentence}" for sentence in warnings)])] if warnings else []


def _both(name: str, symbol: str, unit: str, digits: int, values: Iterable[float]) -> Row:
    return Row(name, symbol, unit, tuple(fixed(value, digits) for value in values))


def _one(name: str, symbol: str, unit: str, digits: int, value: float) -> Row:
    return _both(name, symbol, unit, digits, (value,))


def _gear_rows(pair: GearPair) -> list[Row]:
    gears = pair.gears

    def each(name: str, symbol: str, unit: str, digits: int, attribute: str) -> Row:
        return _both(name, symbol, unit, digits, (getattr(gear, attribute) for gear in gears))

    tips = [gear.normal_thickness(gear.tip_diameter) for gear in gears]
    return [
        Row("teeth", "z", "", tuple(str(gear.z) for gear in gears)),
        Row("hand", "", "", tuple(_hand(gear) for gear in gears)),
        each("profile shift coefficient", "x", "", 4, "profile_shift"),
        each("reference diameter", "d", "mm", 3, "reference_diameter"),
        each("base radius", "r_b", "mm", 4, "base_radius"),
        each("tip diameter", "d_a", "mm", 3, "tip_diameter"),
        each("root diameter", "d_f", "mm", 3, "root_diameter"),
        _both("working pitch diameter", "d_w", "mm", 3, pair.working_pitch_diameters),
        _both("diameter at start of active profile", "d_Nf", "mm", 3, pair.active_start_diameters),
        each("root form diameter", "d_Ff", "mm", 3, "root_form_diameter"),
        _both("addendum of the basic rack", "h_aP*", "m_n", 2, pair.addendum_coefficients),
        each("dedendum of the basic rack", "h_fP*", "m_n", 2, "dedendum_coefficient"),
        each("root fillet radius of the basic rack", "ρ_fP", "mm", 3, "rack_tip_radius"),
        _both("normal tooth thickness at the tip", "s_an", "mm", 4, tips),
        _both("tip clearance to the mate's root", "c", "mm", 3, pair.tip_clearances),
        each("face width", "b", "mm", 3, "face_width"),
        each("bore diameter, held rigidly", "d_i", "mm", 3, "bore_diameter"),
        *_modification_rows(pair),
    ]


def _modification_rows(pair: GearPair) -> list[Row]:
    """Rows on tip relief and lead crowning, and on the other modifications that the flank of either gear has."""
    each = [gear.modifications for gear in pair.gears]
    shown = {"tip_relief_um", "lead_crowning_um"}.union(*(given.amounts for given in each))
    return [
        _both(*named, "µm", 1, (getattr(given, amount) for given in each))
        for amount, named in AMOUNTS.items() if amount in shown
    ]


def _chart_rows(scene: Scene) -> list[Row]:
    """Rows on flank charts, whose depths are added to the modifications; none where there is no chart."""
    charts = [scene.flank_chart(name) for name in GEARS]
    if not any(charts):
        return []
    files = [Path(getattr(scene, name).flank_csv or "none").name for name in GEARS]
    deepest = ["–" if chart is None else fixed(1e3 * float(chart.depth.max()), 1) for chart in charts]
    return [
        Row("chart of the flank", "", "", tuple(files)),
        Row("  missing at most, beside modifications", "", "µm", tuple(deepest)),
    ]


def _hand(gear: GearParameters) -> str:
    return HANDS[gear.hand] if gear.helix_angle else "spur"


def _pair_rows(pair: GearPair) -> list[Row]:
    pinion = pair.pinion
    return [
        _one("normal module", "m_n", "mm", 3, pinion.normal_module),
        _one("transverse module", "m_t", "mm", 4, pinion.transverse_module),
        _one("normal pressure angle", "α_n", "°", 4, pinion.normal_pressure_angle_deg),
        _one("transverse pressure angle", "α_t", "°", 4, math.degrees(pinion.transverse_pressure_angle)),
        _one("working transverse pressure angle", "α_wt", "°", 4, math.degrees(pair.working_pressure_angle)),
        _one("  without backlash, from x1 + x2", "α_wt", "°", 4, math.degrees(working_angle_of(*pair.gears))),
        _one("helix angle", "β", "°", 4, pinion.helix_angle_deg),
        _one("base helix angle", "β_b", "°", 4, math.degrees(pinion.base_helix_angle)),
        _one("centre distance", "a", "mm", 4, pair.centre_distance),
        _one("tip alteration coefficient", "k", "", 4, pair.tip_alteration_coefficient),
        _one("transverse base pitch", "p_bt", "mm", 4, pinion.transverse_base_pitch),
        _one("transverse contact ratio", "ε_α", "", 4, pair.transverse_contact_ratio),
        _one("overlap ratio", "ε_β", "", 4, pair.overlap_ratio),
        _one("total contact ratio", "ε_γ", "", 4, pair.total_contact_ratio),
        _one("normal backlash", "j_bn", "µm", 2, 1e3 * pair.normal_backlash),
        _one("total angle of transmission of the pinion", "", "°", 3, math.degrees(pair.engagement_angle)),
        _one("misalignment over the face width", "", "µm", 1, pair.misalignment_um),
    ]


def _load_rows(scene: Scene, estimate: HertzEstimate) -> list[Row]:
    start, end = estimate.pair.path_of_contact[:: Member.named(scene.load.driving).sign]
    shortest, mean, longest = estimate.line_lengths

    def pressure(name: str, xi: float, length: float | None = None) -> Row:
        return _one(f"p0 {name}", "", "MPa", 1, float(estimate.peak_pressure(xi, length)))

    return [
        _one(f"torque held on the {scene.load.on}", "T", "N·m", 3, scene.load.torque_Nm),
        *_driving_rows(scene),
        *_operating_rows(scene),
        Row("friction coefficients", "μ", "", (", ".join(f"{value:g}" for value in scene.contact.friction),)),
        _one("normal force on the flanks", "F_bn", "N", 1, estimate.normal_force),
        _one("contact line length, shortest", "", "mm", 2, shortest),
        _one("contact line length, mean", "", "mm", 2, mean),
        _one("contact line length, longest", "", "mm", 2, longest),
        _one("half-width at pitch point, mean length", "b_H", "mm", 4, float(estimate.half_width(0.0))),
        _one("  shortest length", "b_H", "mm", 4, float(estimate.half_width(0.0, shortest))),
        pressure("at the pitch point, mean length", 0.0),
        pressure("at the pitch point, shortest length", 0.0, shortest),
        pressure("at the start of engagement, mean length", start),
        pressure("at the end of engagement, mean length", end),
    ]


def _driving_rows(scene: Scene) -> list[Row]:
    """Rows on a wheel that drives: the flanks that bear, which are the same, and the sense of rotation; none where the
    pinion drives."""
    if scene.load.driving == "pinion":
        return []
    return [
        Row("driving gear", "", "", (f"{scene.load.driving}, the pinion turns clockwise seen from z > 0",)),
        Row("flanks that bear, on both gears", "", "", ("left ones seen from z > 0, as where the pinion drives",)),
    ]


def _operating_rows(scene: Scene) -> list[Row]:
    """Row on the speed under whose mesh force contact is computed; none where the load is a torque."""
    dynamics = scene.dynamics
    if dynamics is None or dynamics.operating_rpm is None:
        return []
    return [_one(f"  varied by vibration at, running {dynamics.direction}", "n", "r/min", 1, dynamics.operating_rpm)]


def _wear_rows(wear: WearSection, estimate: HertzEstimate) -> list[Row]:
    coefficients = wear.pinion_mm2_per_N, wear.wheel_mm2_per_N
    depths = [1e3 * wear.cycles * rate for rate in estimate.wear_per_cycle(*coefficients)]
    return [
        Row("wear coefficient over hardness", "K/H", "mm²/N", tuple(f"{value:.4g}" for value in coefficients)),
        Row("revolutions of the pinion", "", "", (f"{wear.cycles:.4g}",)),
        _both("depth at the ends of the path of contact", "h", "µm", 3, depths),
    ]


def _cost_rows(scene: Scene) -> list[Row]:
    problem = gear_problem(scene)
    rows, layers = zip(*(flank_cells(problem, member) for member in Member))
    is_levelled = is_two_level(problem)
    name = "positions, at least" if any(scene.contact.friction) else "positions"  # some are solved again with friction
    levels = [Row("degrees of freedom of a flank", "", "", tuple(map(counted, flank_dofs(scene))))]
    rooted = scene.strength is not None and not problem.is_line  # whose roots a line contact does not serve
    roots = [Row("with its finer roots, of `evolvent strength`", "", "", (gigabytes(strength_megabytes(scene)),))]
    return [
        Row("level", "", "", (scene.mesh.level,)),
        Row("cells", "", "", (f"{scene.mesh.shape}, order {scene.mesh.order}",)),
        *([] if problem.is_line else [_across(problem, is_levelled)]),
        Row("elements along the loaded flank", "", "", tuple(map(counted, rows))),
        Row("layers over the face width", "", "", ("plane",) * 2 if problem.is_plane else tuple(map(counted, layers))),
        Row("degrees of freedom of a sector", "", "", tuple(counted(size.dofs) for size in sector_sizes(scene))),
        *(levels if is_levelled else []),
        Row("largest memory of a run on one rank, estimated", "", "", (gigabytes(memory_megabytes(scene)),)),
        *(roots if rooted else []),
        Row("memory of this machine", "", "", (gigabytes(machine_megabytes()),)),
        Row("condensed gears in the cache, estimated", "", "", (gigabytes(kept_megabytes(problem)),)),
        Row("tooth pairs that can touch", "", "", (str(len(problem.touching_teeth)),)),
        Row(name, "", "", (str(problem.pitches * scene.sweep.positions),)),
        Row("friction coefficients at each", "", "", (str(len(scene.contact.friction)),)),
    ]


def _across(problem: GearProblem, levels: bool) -> Row:
    """Elements across the width of the contact. levels: whether the flanks have levels of their own."""
    return _one("elements across the contact width 2b_H", "", "", 1, elements_per_contact_width(problem, levels))


def _room_line(scene: Scene) -> str:
    """Message on a scene that needs more memory than the machine has; empty where it fits."""
    problem = room_problem(scene, memory_megabytes)
    return "" if problem is None else f"\n\nToo large for this machine\n  {problem}"
