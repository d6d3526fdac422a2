"""How finely the sectors of a gear pair are meshed: element sizes from the Hertz width."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import trapezoid

from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.problem.hertz_estimate import HertzEstimate
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.axial_layers import fewest_layers
from evolvent_meshes.sector.root_band import FIRST_CELL_ASPECT
from evolvent_meshes.sector.section import SectorResolution

ELEMENTS_PER_WIDTH = {"quick": 1.7, "standard": 3.0, "fine": 6.0}
"""Elements across the Hertz width 2b_H. Fitted peak against Hertz at mid-face of the Yang pair, median and nine in ten:
quick 4 and 13 %, standard 0.3 and 2.6 %."""
LEVELS_PER_WIDTH = {"quick": 1.7, "standard": 3.75, "fine": 6.0}
"""Elements across the Hertz width 2b_H on flanks with levels. Yang's pair with 3, 3.75 and 4.5 elements: nine in ten
peaks are within 2.1, 1.4 and 1.2 % of Hertz, the peak-to-peak transmission error lies 1.2, 0.2 and 0 % below that with
4.5, a position takes 1, 1.4 and 1.8 times as long."""
STIFF_PINION, STIFF_ELEMENTS = 5.0, 3.0
"""Stiffness of the pinion, which carries the pressure, over that of the wheel, from which on the contact is at least so
many elements wide. Largest pressure of a spur pair 20/40 over that of a mesh twice as fine, at 1.7 elements: ratio 4.7
1.04, ratio 7 1.96, ratio 70 2.7; at 3: 1.01, 1.01, 1.03. With the softer gear as pinion: 1.03 at 1.5 elements."""
SHEAR_PER_ELEMENT = {"quick": (0.85, 0.85), "standard": (0.85, 1.05), "fine": (1.2, 1.4)}
"""Elements by which a layer of (pinion, wheel) may shear the pressure ridge, on average along the profile; near the
pinion tip it is 1.7 times that. The pinion, on whose nodes the jump is defined, decides: there 1.05 instead of 0.85 at
standard makes nine in ten peaks right within 4.5 % instead of 2.6 %, and at quick 1.25 within 28 % instead of 13 %."""
LEAST_LAYERS = {"quick": 8, "standard": 12, "fine": 20}
"""Least number of layers of a spur gear, whose contact line is the lead line: enough for crowning and the ends of the
face."""
LEAST_ROWS = 4
"""Least number of coarse rows of a tooth, each as high as three profile elements: fewer are too high for a thin tip."""
LAYER_DEPTHS = np.array([0.57, 0.86, 1.26])
"""Thin layers below the flank in half-widths b_H; measured as enough for 3 elements across 2b_H."""
DEEPEST = 0.35
"""Largest depth of the thin layers together, in modules: deeper, they don't fit into the root under a heavy load."""
THIN_TIP, LEAST_DEEP = 0.12, 0.5
"""Tip thickness [normal modules] below which the layers get thinner in proportion, and the least factor. With layers of
`DEEPEST` tips of 0.07 and 0.08 modules had scaled Jacobians below 0.1, with three fifths of them above."""
LEAST_NECK = 3
NECK = 0.8
"""Cells from the flank start to the middle of the fillet, and how many modules they cover at most: they grow from the
thin layers' depth, twofold at most."""
CORE_AND_RIM = {True: (6, 6), False: (4, 4)}
"""Coarse columns of a tooth and rows of the rim, by whether the problem is plane. Error of the transmission error of
He's spur pair at quick, standard and fine, against 12 and 16: 0.04, 0.05, 0.09 % with 6 and 6; 0.16, 0.19, 0.29 % with
4 and 4; 0.29, 0.40, 0.72 % with 2 and 4. In space the rows of the rim cost most: the cut faces are condensed
densely."""
LINE_ROWS = {True: 24, False: 12}
"""Rows of a flank's mesh for line contact, by whether the problem is plane. Transmission error of Yang's pair with a
relief of 60 µm: 0.10 % off with 12 rows, 0.12 % with 18."""
LINE_LAYER, LEAST_LINE_LAYERS = 0.45, 8
"""Largest height of a layer of such a mesh [normal modules], and least number of layers."""
LINE_LAND = 0.3
"""Distance from the start of its flank to that of the active profile [normal modules]: a half-width of the load."""
TORQUE_STEP = 1.3
"""Ratio of two torques next to each other for which meshes are made. Torques within a step share their meshes, and what
is condensed of them; elements across the contact are up to 7 % wider or narrower than for the torque itself."""
RELATIVE_WIDTH = 0.0329
"""Half-width b_H of a contact over the normal module on which a step lies: He's pair under 170 N·m, whose meshes many
figures of docs/ are of."""
FORE_LAND = 1.2
"""Distance from the start of the fine flank to the start of active profile, in half-widths of the contact, which has a
width."""


def elements_per_contact_width(problem: GearProblem, levels: bool = False) -> float:
    """Elements across 2b_H: as given, or the mesh level's; more on a pinion much stiffer than its wheel.

    levels: whether the flanks have levels of their own.
    """
    given = problem.mesh.elements_per_contact_width
    if given is not None:
        return given
    usual = LEVELS_PER_WIDTH if levels else ELEMENTS_PER_WIDTH
    return max(usual[problem.mesh.level], STIFF_ELEMENTS if has_stiff_pinion(problem) else 0.0)


def has_stiff_pinion(problem: GearProblem) -> bool:
    """Whether the pinion, which carries the pressure, is much stiffer than its wheel."""
    pinion, wheel = problem.materials
    return pinion.plane_modulus > STIFF_PINION * wheel.plane_modulus


def sector_resolutions(problem: GearProblem) -> tuple[SectorResolution, SectorResolution]:
    """Resolutions of (pinion's, wheel's) sector; see `sector_resolution`."""
    return sector_resolution(problem, Member.PINION), sector_resolution(problem, Member.WHEEL)


def sector_resolution(problem: GearProblem, member: Member) -> SectorResolution:
    """The resolution of the pinion's or the wheel's sector.

    Along the profile the elements are h = 2b_H/n long with the local half-width b_H: ∫ds/h of them, with ds = ρ/r_b dρ
    the arc of the involute. A layer of length L shears the contact line by s = L tan β_b ρ/r_b along the profile; s/h
    is held at what the level allows, on average over the path of contact.
    """
    if problem.is_line:
        line = _line_resolution(problem, member)
        return _fine_everywhere(line) if problem.options.fine_body else line
    gear, level, needs = problem.pair.gears[member], problem.mesh.level, flank_needs(problem, member)
    depths = needs.depths * min(1.0, float(deepest_layers(gear).sum() / needs.depths.sum()))
    rows = 3 * max(LEAST_ROWS, math.ceil(needs.rows / 3))
    layers = max(LEAST_LAYERS[level], math.ceil(needs.shear / SHEAR_PER_ELEMENT[level][member]))
    below = _below_flank(problem, depths, gear.normal_module)
    resolution = replace(
        below, profile_elements=rows, face_elements=layers, flank_start_diameter=needs.start, size_at=needs.width
    )
    return _fine_everywhere(resolution) if problem.options.fine_body else resolution


def _line_resolution(problem: GearProblem, member: Member) -> SectorResolution:
    """The resolution of a sector for line contact, which does not depend on the torque."""
    gear, active = problem.pair.gears[member], problem.pair.active_start_diameters[member]
    depths = deepest_layers(gear)
    layers = math.ceil(gear.face_width / (LINE_LAYER * gear.normal_module))
    return replace(
        _below_flank(problem, depths, gear.normal_module),
        profile_elements=LINE_ROWS[problem.is_plane],
        face_elements=max(LEAST_LINE_LAYERS, layers, 2 * fewest_layers(gear)),  # a companion has half of them
        end_size_ratio=1.0,
        flank_start_diameter=_start_before(gear, active, LINE_LAND * gear.normal_module),
        size_at=ContactWidth(mesh_estimate(problem), member),
        graded_middles=True,
    )


def deepest_layers(gear: GearParameters) -> Floats:
    """Thickness (3,) of the thin layers below a flank that the tooth has room for at its root and its tip [mm]."""
    tip = gear.normal_thickness(gear.tip_diameter) / (THIN_TIP * gear.normal_module)
    whole = LAYER_DEPTHS * DEEPEST * gear.normal_module / float(LAYER_DEPTHS.sum())
    return np.asarray(whole * min(1.0, max(LEAST_DEEP, tip)))


def _below_flank(problem: GearProblem, depths: Floats, module: float) -> SectorResolution:
    """The resolution of a sector below its flank. depths: (3,) of the thin layers [mm]; module: m_n [mm]."""
    more, (core, rim) = _neck_elements(float(depths.sum()) / module) - LEAST_NECK, CORE_AND_RIM[problem.is_plane]
    return SectorResolution(
        layer_depths=(depths[0], depths[1], depths[2]),
        neck_elements=LEAST_NECK + more,
        fillet_elements=SectorResolution.fillet_elements + more,
        back_elements=SectorResolution.back_elements + more,
        core_elements=core,
        rim_elements=rim,
    )


def mesh_estimate(problem: GearProblem) -> HertzEstimate:
    """Hertz contact under the torque of a problem, rounded so that (b_H/m_n)² at the pitch point, which grows with the
    torque, is a power of `TORQUE_STEP` times that of `RELATIVE_WIDTH`."""
    estimate = problem.hertz_estimate
    width = float(estimate.half_width(0.0)) / problem.pair.pinion.normal_module / RELATIVE_WIDTH
    steps = math.log(width**2) / math.log(TORQUE_STEP)
    return replace(estimate, pinion_torque=TORQUE_STEP ** (round(steps) - steps) * estimate.pinion_torque)


def flank_needs(problem: GearProblem, member: Member, levels: bool = False) -> FlankNeeds:
    """Requirements of the contact on the flank mesh of the pinion or the wheel, with levels of its own or without:
    element sizes for the lightest torque that the mesh serves, a flank that begins where the heaviest one needs it."""
    estimate, gear = mesh_estimate(problem.lightest), problem.pair.gears[member]
    count = elements_per_contact_width(problem, levels)
    width = ContactWidth(estimate, member)
    start = _flank_start(gear, ContactWidth(mesh_estimate(problem.heaviest), member))
    roll = np.linspace(gear.roll_length(start), gear.roll_length(gear.tip_form_diameter), 401)
    density = roll / gear.base_radius * count / width.at_roll_length(roll)
    shear = float(np.mean(density)) * math.tan(gear.base_helix_angle) * gear.face_width
    depths = LAYER_DEPTHS * float(estimate.half_width(0.0)) * min(1.0, math.sqrt(3 / count))
    edge = 0.0 if gear.tip_edge is None else gear.tip_edge.length * count / float(width.at_roll_length(roll[-1]))
    return FlankNeeds(float(trapezoid(density, roll)) + edge, shear, depths, start, width)


@dataclass(frozen=True)
class FlankNeeds:
    """Requirements of a contact on the mesh of its flank."""

    rows: float
    """Number of elements along the profile."""
    shear: float
    """Number of elements by which the contact line is sheared over the whole face, on average along the profile."""
    depths: Floats
    """Thickness (3,) of the thin layers below the flank [mm]."""
    start: float
    """Diameter where the fine flank starts [mm]."""
    width: ContactWidth
    """Hertz width along the profile."""


def _fine_everywhere(resolution: SectorResolution) -> SectorResolution:
    """The back flank meshed as the loaded one, three times as many elements elsewhere."""
    return replace(
        resolution,
        fine_back=True,
        core_elements=3 * resolution.core_elements,
        rim_elements=3 * resolution.rim_elements,
        web_elements=3 * resolution.web_elements,
        hub_elements=3 * resolution.hub_elements,
        fillet_elements=3 * resolution.fillet_elements,
        back_elements=3 * resolution.back_elements,
        neck_elements=3 * resolution.neck_elements,
    )


def _neck_elements(depth: float) -> int:
    """Cells n that cover the neck, each at most twice as long as the one above. depth: of the thin layers [modules]."""
    return max(LEAST_NECK, math.ceil(math.log2(1.0 + NECK / (FIRST_CELL_ASPECT * depth))))


class ContactWidth:
    """Hertz width 2b_H [mm] along one gear's profile; beyond the path of contact that of its nearest end."""

    def __init__(self, estimate: HertzEstimate, member: Member) -> None:
        self.estimate, self.member, self.gear = estimate, member, estimate.pair.gears[member]
        self.pitch_point = estimate.pair.pitch_point_roll_lengths[member]

    def __call__(self, radius: Floats) -> Floats:
        """Hertz width 2b_H [mm] at radii [mm], any shape."""
        return self.at_roll_length(np.sqrt(np.maximum(np.asarray(radius) ** 2 - self.gear.base_radius**2, 0.0)))

    def at_roll_length(self, roll: Floats) -> Floats:
        """Hertz width 2b_H [mm] at transverse curvature radii ρ [mm], any shape."""
        xi = np.clip(self.member.sign * (roll - self.pitch_point), *self.estimate.pair.path_of_contact)
        return 2 * self.estimate.half_width(xi)


def _flank_start(gear: GearParameters, width: ContactWidth) -> float:
    """Diameter where the fine flank starts [mm]: below the active profile, not below the involute."""
    active = width.estimate.pair.active_start_diameters[width.member]
    half_width = float(width.at_roll_length(np.array(gear.roll_length(active)))) / 2
    return _start_before(gear, active, FORE_LAND * half_width)


def _start_before(gear: GearParameters, active: float, land: float) -> float:
    """Diameter where the fine flank starts [mm], an arc `land` [mm] below a diameter, but on the involute."""
    square = gear.roll_length(active)**2 - 2 * gear.base_radius * land  # arc s = ρ²/2r_b
    return max(gear.root_form_diameter, 2 * math.hypot(gear.base_radius, math.sqrt(max(0.0, square))))
