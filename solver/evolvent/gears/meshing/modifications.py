"""Estimates of the effects of relief, crowning and misalignment, before a pair is solved.

The share of the contact lines that bears, on springs of a tooth pair's stiffness; and whether the thin layers of the
mesh below a flank are deep enough for the material that is taken off.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.flank import contact_lines, separation
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.sector.section import SectorResolution

LEAST_SHARE = 0.5
"""Fraction of the contact lines under load below which a warning is due: modifications are meant for more, or the load
is far below the nominal one."""
MOST_RELIEF = 10.0
"""Tip relief, over the deflection of a tooth pair that carries the whole load, from which on a warning is due."""
LEAST_RELIEF = 0.5
"""Tip relief, over the largest deflection of the teeth, below which a warning is due. The edge comes clear of the mate
at about 1; less helps, too."""
FOLDING = 0.5
"""Modifications, over the depth of the thin layers, above which the mesh may fold. The papers' pairs at a tenth to ten
times their loads can have 0.5 to 0.95 of it, least near thin tips and on helical gears."""
POSITIONS, POINTS = 12, 64
"""Numbers of positions over an angular pitch and of points along a contact line."""


class TooMuchRelief(InputError):
    """Relief and crowning take most of the thin layers away that lie below a flank: its mesh may fold."""


@dataclass(frozen=True)
class Bearing:
    """Load-bearing length of contact lines on springs, over a pitch."""

    share: float
    """Length under load, over the length of all contact lines."""
    deflection: float
    """Largest deflection of a spring [mm]."""


def bearing(pair: GearPair, force: float, stiffness: float) -> Bearing:
    """Load-bearing length of contact lines on springs of this stiffness [N/mm²], under the normal force [N]."""
    rotations = np.arange(POSITIONS) * 2.0 * math.pi / pair.pinion.z / POSITIONS
    each = [_pressed(*_gaps(pair, float(rotation)), force / stiffness) for rotation in rotations]
    borne, whole, deepest = (np.array(values) for values in zip(*each, strict=True))
    return Bearing(float(borne.sum() / whole.sum()), float(deepest.max()))


def _gaps(pair: GearPair, rotation: float) -> tuple[Floats, Floats]:
    """Gaps (n,) and lengths (n,) [mm] of pieces of all contact lines, by ascending gap."""
    gaps, lengths = [], []
    for line in contact_lines(pair, rotation):
        ξ, z = (values[1::2] for values in line.points(2 * POINTS + 1))
        gaps.append(separation(pair, ξ, z))
        lengths.append(np.full(POINTS, np.ptp(line.z) / math.cos(pair.pinion.base_helix_angle) / POINTS))
    order = np.argsort(np.concatenate(gaps))
    return np.concatenate(gaps)[order], np.concatenate(lengths)[order]


def _pressed(gaps: Floats, lengths: Floats, load: float) -> tuple[float, float, float]:
    """Length under load, total length and largest deflection [mm]; approach δ with Σ l (δ − g)₊ = load [mm²]."""
    borne = np.cumsum(lengths)
    approach = (load + np.cumsum(lengths * gaps)) / borne  # with the first pieces alone
    last = int(np.argmax(np.append(gaps[1:], np.inf) >= approach))
    return float(borne[last]), float(borne[-1]), float(approach[last] - gaps[0])


def modification_warnings(problem: GearProblem) -> Iterator[str]:
    """Sentences on modifications with which much of the flanks would never touch."""
    given = _given(problem.pair)
    if not given:
        return
    estimate = problem.hertz_estimate
    single = estimate.tooth_deflection(*problem.materials)  # one pair with the whole load over the whole face
    force, width = estimate.normal_force, estimate.pair.face_width
    stiffness = force / (single * width)
    whole = bearing(estimate.pair, force, stiffness)
    alone = {key: bearing(_only(estimate.pair, key), force, stiffness).share for key in given}
    reliefs = [key for key in given if key.endswith(("tip_relief_um", "root_relief_um"))]
    idle = [key for key in reliefs if given[key] > MOST_RELIEF * single]
    named = [key for key in given if alone[key] < LEAST_SHARE or key in idle]
    if not named and whole.share < LEAST_SHARE:
        named = list(given)
    if named:
        figures = " and ".join(f"{key} = {1e3 * given[key]:g}" for key in named)
        yield (
            f"{figures} (µm): the flanks bear on about {100.0 * whole.share:.0f} % of the length of their contact "
            f"lines, where teeth deflect by up to {1e3 * whole.deflection:.3g} µm; a pair that carries the whole load "
            f"over the whole face deflects by {1e3 * single:.3g} µm. Check the figures, their unit and the torque."
        )


def tip_edge_warnings(problem: GearProblem) -> Iterator[str]:
    """A sentence on gears whose tips too little relieves: the next tooth meets the deflected ones with its tip's
    edge."""
    estimate = problem.hertz_estimate
    force = estimate.normal_force
    stiffness = force / (estimate.tooth_deflection(*problem.materials) * estimate.pair.face_width)
    deflection = 1e3 * bearing(estimate.pair, force, stiffness).deflection
    reliefs = {member: round(_tip_relief(problem, member), 3) + 0.0 for member in Member}
    plain = {member: relief for member, relief in reliefs.items() if relief < LEAST_RELIEF * deflection}
    if not plain:
        return
    if any(plain.values()):
        words = "Too little tip relief, " + " and ".join(f"{um:g} µm on the {each.label}" for each, um in plain.items())
    else:
        words = "No tip relief" if len(plain) == len(Member) else f"No tip relief on the {next(iter(plain)).label}"
    yield f"{words}: tip edges may bear, as teeth deflect by about {deflection:.2g} µm; see tip_relief_um."


def _tip_relief(problem: GearProblem, member: Member) -> float:
    """Material [µm] that keeps a gear's tip off its mate, missing from its own flank and from the mate's where they
    meet."""
    own, mate = (problem.pair.gears[each].modifications for each in (member, member.mate))
    designed = own.tip_relief_um + own.profile_crowning_um + mate.root_relief_um + mate.profile_crowning_um
    charted = _charted_ends(problem, member)[1] + _charted_ends(problem, member.mate)[0]
    return designed + 1e3 * charted


def _charted_ends(problem: GearProblem, member: Member) -> tuple[float, float]:
    """Depths [mm] of a gear's chart at the start of the active flank and at the tip, both at mid-face and beyond the
    depth at mid-height; 0 without a chart."""
    gear, chart = problem.pair.gears[member], problem.flanks[member]
    if chart is None:
        return 0.0, 0.0
    ends = [gear.roll_length(d) for d in (problem.pair.active_start_diameters[member], gear.tip_form_diameter)]
    root, middle, tip = chart.at(gear, np.array([ends[0], sum(ends) / 2.0, ends[1]]), np.zeros(3))
    return float(root - middle), float(tip - middle)


def folding_warnings(
    problem: GearProblem, resolutions: tuple[SectorResolution, SectorResolution]
) -> Iterator[str]:
    """Sentences on modifications that may fold the mesh."""
    for member, resolution in zip(Member, resolutions):
        if reason := too_much_relief(problem, member, resolution):
            yield f"The mesh may fold, which `run` then refuses: {reason}."


def too_much_relief(problem: GearProblem, member: Member, resolution: SectorResolution) -> TooMuchRelief | None:
    """The error where modifications take most of the thin layers away that lie below the flank; else None."""
    gear, depth = problem.pair.gears[member], 1e3 * sum(resolution.layer_depths)
    half, roll = 0.5 * gear.face_width, np.array([gear.flank_depth.start, gear.flank_depth.tip])
    taken = 1e3 * float(gear.flank_depth.at(*np.meshgrid(roll, np.array([-half, half]))).max())  # largest in a corner
    if taken < FOLDING * depth:
        return None
    key = gear.modifications.largest
    return TooMuchRelief(
        f"{member.label}.{key}: found {getattr(gear.modifications, key):g} (modifications take {taken:.4g} µm off); "
        f"allowed: less than {FOLDING * depth:.3g} µm together: the wider the contact, the deeper the mesh is fine; "
        "remedy: lower it, raise the torque, or take a chart as flank_csv"
    )


def _given(pair: GearPair) -> Mapping[str, float]:
    """Key -> modification [mm], of those that are not 0."""
    found = {"pair.misalignment_um": pair.misalignment_um}
    for member, gear in zip(Member, pair.gears):
        found |= {f"{member.label}.{key}": amount for key, amount in gear.modifications.amounts.items()}
    return {key: 1e-3 * value for key, value in found.items() if value}


def _only(pair: GearPair, key: str) -> GearPair:
    """The pair with this modification alone."""

    def bare(member: Member) -> GearParameters:
        gear, own = pair.gears[member], pair.gears[member].modifications
        return replace(gear, modifications=own.only(key.removeprefix(f"{member.label}.")))

    pinion, wheel = (bare(member) for member in Member)
    tilt = pair.misalignment_um if key == "pair.misalignment_um" else 0.0
    return replace(pair, pinion=pinion, wheel=wheel, misalignment_um=tilt)
