"""Oscillator of a gear pair: inertia, damping and load on the mesh force that was computed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeGuard, get_args

import numpy as np

from evolvent.dynamics.excitation.force_surface import MeshExcitation, mirrored_law, paper_law
from evolvent.dynamics.one_degree import OneDegree, one_degree
from evolvent.dynamics.oscillator.mesh_law import Jammed, MeshLaw, MeshSide, backwards, linear_side, with_chords
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent.dynamics.small_system import GearShapes, pair_system
from evolvent.gears.problem.gear_inertia import added_inertia, equivalent_mass
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent.scene.schema.dynamics import DAMPING, DAMPING_WANTED, USUAL_DAMPING
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import instance, is_number, number, one_of, refuse, vector

MeshModel = Literal["force_surface", "tangent", "secant"]
RIGID = 'dynamics.bodies = "rigid"'
"""Setting of rigid bodies, for remedies in messages."""
MESHED = 0.95
"""Inertia over that of a meshed body, from which on it may be all of it: coarse meshes have up to 2 % more."""
NANOMETRE = 1e-6
"""Accuracy of unloaded errors [mm]; no backlash is asked for less."""
OVERLAP = 0.01
"""Overlap of both sides of the teeth, over the static deflection, up to which it counts as inaccuracy of their
errors."""


class TooSoftBodies(ResultError):
    """Gear bodies whose static shapes are more compliant than the whole mesh."""

    def __init__(self, what: str) -> None:
        super().__init__(f"{what}; take rigid bodies ({RIGID}), or evolvent transient")


@dataclass(frozen=True)
class DriveSettings:
    """Settings of a pair's vibration beside its mesh."""

    inertias: tuple[float, float]
    """Moments of inertia of pinion and wheel [t·mm²]."""
    damping_ratio: float
    """Damping ratio of the mesh, over the critical damping at the mean stiffness, see `Drive`: a series compliance
    lowers the damping."""
    backlash: float
    """Backlash along the line of action, from flank to flank [mm]. Where straight lines between both sides' errors
    leave room and splines through them do not, the overlap of the splines is added."""
    damping_in_separation: bool = False
    """Whether the damping of the mesh acts on separated flanks, too."""
    ground_damping_ratio: float = 0.0
    """Damping ratio of the shafts against the ground, over the critical damping at the mean stiffness."""
    series_stiffness: float = math.inf
    """Stiffness of what gives way in line with the mesh, along the line of action, without inertia [N/mm]."""
    mesh: MeshModel = "force_surface"
    """Model of the mesh force."""
    bodies: tuple[GearShapes, GearShapes] | None = None
    """Static shapes of the bodies of pinion and wheel, on their whole width; None: the bodies are rigid, with all
    inertia at the bores."""
    driving: Member = Member.PINION
    """Gear that drives; where it is the wheel, the pair passes the positions of the mesh in the opposite order."""

    def __post_init__(self) -> None:
        """Raises InputError for settings that no pair has."""
        unit = "1 kg·m² is 1000 t·mm²"
        for inertia in vector("inertias", self.inertias, (2,), "two numbers above 0, in t·mm²", unit):
            number("inertias", inertia, "two numbers above 0, in t·mm²", unit, lambda J: J > 0.0)
        check_damping(self.damping_ratio, self.damping_in_separation)
        number("backlash", self.backlash, "a number from 0 on, in mm", "50 µm are 0.05", lambda j: j >= 0.0)
        wanted = "a number from 0 to 1"
        number("ground_damping_ratio", self.ground_damping_ratio, wanted, "0 for none", lambda D: 0.0 <= D <= 1.0)
        series = self.series_stiffness
        if series != math.inf and not (is_number(series) and series > 0.0):
            refuse("series_stiffness", "a number above 0, in N/mm", series, "leave it out for none")
        one_of("mesh", self.mesh, get_args(MeshModel))
        one_of("driving", self.driving, tuple(Member))
        if self.bodies is not None:
            self._check_bodies(self.bodies)

    def _check_bodies(self, bodies: object) -> None:
        """Raises InputError unless these are static shapes of two gears, whose inertia is at least that of the bodies
        but for the accuracy of their meshes: without it, motions have a negative kinetic energy."""
        if not _are_shapes(bodies):
            remedy = "leave it out for rigid bodies; with_elastic_bodies(settings, problem, density) adds them"
            refuse("bodies", "None or the shapes of both gears", bodies, remedy)
        for member, inertia, shapes in zip(Member, self.inertias, bodies):
            if inertia < MESHED * (own := float(shapes.mass[0, 0])):
                wanted = f"of the {member.label} at least that of its elastic body, {own:.4g} t·mm²"
                refuse("inertias", wanted, inertia, "take the body's own, or leave out bodies for rigid ones")

    @property
    def bodies_named(self) -> Literal["elastic", "rigid"]:
        """As `dynamics.bodies` of a scene."""
        return "rigid" if self.bodies is None else "elastic"

    @property
    def added_inertias(self) -> tuple[float, float] | None:
        """Moments of inertia [t·mm²] beyond those of both bodies, at the bores; 0 where they are equal but for
        rounding. None for rigid bodies."""
        if self.bodies is None:
            return None
        pinion, wheel = (
            added_inertia(moment, float(gear.mass[0, 0])) for moment, gear in zip(self.inertias, self.bodies)
        )
        return pinion, wheel


def check_damping(ratio: float, in_separation: bool) -> None:
    """Raises InputError for a damping of the mesh that a scene may not have either."""
    number("damping_ratio", ratio, DAMPING_WANTED, USUAL_DAMPING, lambda D: DAMPING[0] <= D <= DAMPING[1])
    instance("damping_in_separation", in_separation, bool, "give True or False")


def _are_shapes(bodies: object) -> TypeGuard[tuple[GearShapes, GearShapes]]:
    """Whether these are the static shapes of two gears."""
    return isinstance(bodies, tuple) and len(bodies) == 2 and all(isinstance(each, GearShapes) for each in bodies)


@dataclass(frozen=True, eq=False)
class Drive:
    """Vibration model of a gear pair."""

    model: TorsionalModel
    """Oscillator with one degree of freedom."""
    mean_stiffness: float
    """Mean stiffness of the mesh over the pitch under the load, with the series compliance [N/mm]: the secant one where
    the mesh has it, else the tangent one."""
    teeth: int
    """Number of teeth of the pinion."""
    settings: DriveSettings
    """Settings from which the model was made."""
    moving_stiffness: float
    """Mean stiffness in motion [N/mm]: the inertia of elastic bodies lies nearer to the mesh than the bores, which hold
    them in statics. `mean_stiffness` where bodies are rigid."""
    equivalent_mass: float
    """Equivalent mass m_e of rigid bodies [t]."""
    body_frequency: float
    """Lowest natural frequency [Hz] of the bodies on the mesh that one degree of freedom leaves out; infinite for rigid
    bodies."""

    @property
    def natural_speed(self) -> float:
        """Speed of the pinion at which the mesh frequency is the natural frequency at the mean stiffness in motion
        [r/min]."""
        return MeshSpeed.of_natural(self.moving_stiffness, self.model.mass, self.teeth).rpm

    def body_speed(self, harmonic: int) -> float:
        """Speed of the pinion at which this mesh harmonic has the frequency `body_frequency` [r/min]."""
        return MeshSpeed.of_frequency(self.body_frequency / harmonic, self.teeth).rpm

    @property
    def rigid_natural_speed(self) -> float:
        """Natural speed of the pinion with rigid bodies, all inertia at the bores [r/min]."""
        return MeshSpeed.of_natural(self.mean_stiffness, self.equivalent_mass, self.teeth).rpm


def drive(pair: GearPair, excitation: MeshExcitation, load: float, settings: DriveSettings) -> Drive:
    """Vibration model of a pair under a load F_0 [N]. The force surface serves every load up to its heaviest;
    stiffnesses under a load between two that were solved are those of `MeshExcitation.under`. Raises ValueError beyond
    the heaviest, Jammed, TooSoftBodies."""
    mesh = excitation if math.isinf(settings.series_stiffness) else excitation.in_series(settings.series_stiffness)
    mean = _mean(mesh, load, settings)
    body = _body(pair, mean, settings)
    if body.stiffer != 0.0:
        _check_left(mesh, body.stiffer)
        mesh = mesh.in_series(-1.0 / body.stiffer)
    moving = _mean(mesh, load, settings)
    critical = 2.0 * math.sqrt(moving * body.mass)
    law = _law(pair, mesh, load, settings)
    if settings.driving is Member.WHEEL:
        law = backwards(law)
    model = TorsionalModel(
        body.mass, load, law, settings.damping_ratio * critical,
        settings.damping_in_separation, settings.ground_damping_ratio * critical, body.stiffer * load, body.bore,
        teeth=pair.pinion.z,
    )
    rigid = equivalent_mass(pair, settings.inertias)
    return Drive(model, mean, pair.pinion.z, settings, moving, rigid, body.next_frequency / (2.0 * math.pi))


def _mean(mesh: MeshExcitation, load: float, settings: DriveSettings) -> float:
    """Mean stiffness over the pitch under a load [N/mm]."""
    depth, tangent = mesh.under(load)
    return float(np.mean(load / depth if settings.mesh == "secant" else tangent))


def _body(pair: GearPair, stiffness: float, settings: DriveSettings) -> OneDegree:
    """One degree of freedom for both bodies on a mesh of this mean stiffness [N/mm]. Raises TooSoftBodies."""
    if settings.bodies is None:
        return OneDegree(equivalent_mass(pair, settings.inertias), 0.0, 0.0, math.inf)
    pinion, wheel = (gear.with_inertia(moment) for gear, moment in zip(settings.bodies, settings.inertias))
    try:
        return one_degree(pair_system(pinion, wheel), stiffness)
    except ValueError as error:
        raise TooSoftBodies(str(error)) from error


def _check_left(mesh: MeshExcitation, stiffer: float) -> None:
    """Raises TooSoftBodies where the compliance of the mesh, at some position under some torque, is not above the one
    by which the bodies are stiffer in motion [mm/N]."""
    least = 1.0 / float(mesh.loaded.stiffness.max())
    if least <= stiffer:
        raise TooSoftBodies(
            f"compliance of the mesh: wanted more at each position than what the bodies are stiffer by in motion, "
            f"{1e3 * stiffer:.4g} µm/N, found {1e3 * least:.4g} µm/N"
        )


def lacking_room(problem: GearProblem, positions: int, settings: DriveSettings) -> float:
    """Backlash [mm] that unloaded errors at so many positions of the pitch need beyond the given one, by geometry
    alone; 0 where both sides of the teeth have room. Where it is 0, `drive` raises no Jammed: neither on these flanks,
    whose errors it joins by the same splines, nor on worn ones, from which material is only taken away."""
    angles = np.array(uniform_pitch(problem.pair.pinion.z, positions).angles)
    error = unloaded_error(RigidFlanks(problem.pair, problem.flanks), angles, problem.torque_on)
    side, begin = linear_side(np.ones(len(error)), error), _begin(problem.pair, angles)
    overlap = max(_overlap(each, problem.pair, settings, begin) for each in (side, with_chords(side)))
    return overlap if overlap > NANOMETRE else 0.0


def geometric_backlash(pair: GearPair) -> float:
    """j_bt = (2π r_w1/z_1 − s_w1 − s_w2) cos α_wt [mm]: along the line of action in the transverse section, from the
    tooth thicknesses on the working pitch circles (ISO 21771:2007, 5.6); 0 where rounding leaves less.

    Raises InputError.
    """
    instance("pair", pair, GearPair, "write GearPair(pinion, wheel, centre_distance)")
    gap = np.pi * pair.working_pitch_diameters[0] / pair.pinion.z
    for gear, diameter in zip(pair.gears, pair.working_pitch_diameters):
        gap -= diameter * gear.half_angle(diameter)
    return max(float(gap * np.cos(pair.working_pressure_angle)), 0.0)


def _law(pair: GearPair, mesh: MeshExcitation, load: float, settings: DriveSettings) -> MeshLaw:
    """Mesh law of both sides of the teeth where the pinion drives. Raises Jammed where they overlap between straight
    lines, too; the overlap of splines alone is added to the backlash."""
    if settings.mesh != "force_surface":
        return paper_law(mesh.stiffness_side(load, settings.mesh == "secant"), settings.backlash)
    side, begin = mesh.force_surface(), _begin(pair, mesh.loaded.angles)
    overlap = _overlap(side, pair, settings, begin)
    allowed = OVERLAP * float(np.mean(mesh.under(load)[0]))
    if overlap > 0.0 and (certain := _overlap(with_chords(side), pair, settings, begin)) > allowed:
        raise Jammed(max(certain, overlap))
    return mirrored_law(side, pair, settings.backlash + overlap, begin)


def _begin(pair: GearPair, angles: Floats) -> float:
    """Phase of the first of some positions (n,) [rad]."""
    return float(angles[0]) * pair.pinion.z / (2.0 * np.pi)


def _overlap(side: MeshSide, pair: GearPair, settings: DriveSettings, begin: float) -> float:
    """Overlap of both sides of the teeth [mm]; 0 where they have room. begin: phase of the first position."""
    try:
        if settings.mesh == "force_surface":
            mirrored_law(side, pair, settings.backlash, begin)
        else:
            paper_law(side, settings.backlash)
    except Jammed as jammed:
        return jammed.overlap
    return 0.0
