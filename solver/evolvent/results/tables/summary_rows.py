"""Every key of summary.json and column of positions.csv and teeth.csv, with its meaning.

The descriptions of docs/outputs.md and docs/summary.schema.json are made from the docstrings below the fields. Units
stand in the names.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from evolvent.results.archive.error_bar_data import FigureErrors
from evolvent.results.archive.run_cost import Timings
from evolvent.results.mesh_facts import MeshFacts
from evolvent.results.shaft_forces import ShaftForces
from evolvent.scene.skips import Skipped

SCHEMA_VERSION = 3
"""Version of the form of summary.json: raised where a key is removed, renamed or changes its meaning, not for new
keys."""


@dataclass(frozen=True)
class RunFacts:
    """Facts of a run beside its results."""

    versions: Mapping[str, str]
    """Program or library on which the results depend -> its version."""
    ranks: int
    """Number of MPI processes."""
    dofs: int
    """Degrees of freedom of one sector of both gears."""
    flank_dofs: int
    """Degrees of freedom of both loaded flanks on the finest of their own levels, see docs/two_level.md; 0 where they
    have none, and their nodes are those of the sectors."""
    cells: int
    """Number of cells of one sector of both gears."""
    mesh: MeshFacts
    """Quality of the meshes."""
    skipped: Sequence[Skipped]
    """Simplifications that the scene permitted, see docs/scene.md."""
    timings_s: Timings
    """Wall time of each stage of the run, summed over all parts of a resumed run."""
    peak_memory_MB: float
    """Largest resident memory, summed over the ranks; for a resumed run that of its largest part."""


@dataclass(frozen=True)
class ToothRow:
    """One tooth pair at a position."""

    tooth: int
    """Index of the tooth pair: 0 passes the pitch point at pinion angle 0, 1 is one pitch ahead of it, −1 one
    behind."""
    force_N: float
    """Normal force on the pair."""
    max_pressure_MPa: float
    """Largest contact pressure between the tip-edge zones, fitted in each slice and, on a helical line, averaged with
    the neighbouring slices (1:2:1), in line contact Hertz' for the load per length; null where no slice lies between
    these zones, and where the contact of a spur pair covers the start of a linear tip or root relief."""
    contact_length_mm: float
    """Length of the contact line under load."""
    edge_pressure_MPa: float
    """Largest pressure on a tip edge, 0 where no edge bears; null in line contact where one does. The pressure there is
    singular: its value depends on the mesh."""
    kink_pressure_MPa: float
    """Largest contact pressure, fitted in each slice, where the contact of a spur pair covers the start of a linear tip
    or root relief; 0 where it covers none, null in line contact where it does. Over that kink of the flank it depends
    on how sharp the kink is."""


@dataclass(frozen=True)
class PositionRow:
    """One position at one friction coefficient."""

    pinion_angle_deg: float
    """Rotation of the pinion; at 0 the flanks of tooth pair 0 touch at the pitch point at mid-face."""
    friction: float
    """Coulomb friction coefficient μ."""
    torque_pinion_Nm: float
    """Torque on the pinion's shaft."""
    torque_gear_Nm: float
    """Torque on the wheel's shaft."""
    transmission_error_um: float
    """Transmission error r_b1 φ_1 − r_b2 φ_2: lag of the wheel behind the pinion along the line of action."""
    mesh_stiffness_N_per_mm_um: float
    """Tangent stiffness at this load without friction: derivative of the force by the deflection along the line of
    action, over the face width."""
    secant_stiffness_N_per_mm_um: float
    """Secant stiffness: force over face width and deflection, that is what the torque adds to the unloaded transmission
    error, as in excitation.csv. Modifications, charts and wear of the flanks do not count as deflection."""
    max_pressure_MPa: float
    """Largest contact pressure of all teeth between the tip-edge zones and away from the starts of linear reliefs; null
    where there is none."""
    kink_pressure_MPa: float
    """Largest contact pressure of all teeth over the start of a linear tip or root relief of a spur pair; 0 where the
    contact covers none, null in line contact where it does."""
    tip_edge: bool
    """Whether a tooth bears on a tip edge, where the pressure is singular."""
    loss_percent: float
    """Friction power over input power, with the sliding velocities of rigid gears; it may fall a few hundredths of a
    per cent below 0 where a contact lies across the pitch line."""
    newton_iterations: int
    """Number of Newton iterations at this position."""
    balance_error: float
    """The larger of two ratios: force residual over load, and power stored or released by the teeth over input power. A
    run ends with status 3 if it exceeds 0.1."""
    seconds: float
    """Wall time of the position."""
    teeth: tuple[ToothRow, ...]
    """The tooth pairs in contact; in positions.csv their number, `teeth_in_contact`."""


@dataclass(frozen=True)
class FrictionRow:
    """Values of one pitch at one friction coefficient."""

    friction: float
    """Coulomb friction coefficient μ."""
    max_pressure_MPa: float
    """Largest contact pressure over the whole engagement of a tooth, between the tip-edge zones: peak p0 of the
    half-ellipse with a slice's line load and second moment, in line contact Hertz' for the load. On a spur pair it is
    that away from the starts of linear tip and root reliefs, whose contact does not cover the kink that the flank has
    there."""
    max_pressure_angle_deg: float
    """Pinion rotation of the tooth at its largest contact pressure; 0 is the pitch point at mid-face."""
    max_pressure_at_zone_end: bool
    """Whether it lies at the limit of a tip-edge zone, so that its value depends on the place of that limit, and so on
    the mesh. Then it has no error bar."""
    kink_pressure_MPa: float
    """Largest contact pressure of a spur pair while the contact passes the start of a linear tip or root relief, p0 as
    above: Hertz' pressure for the load there times a factor of the kink's angle, in closed form, for an ideal kink of
    flanks that are not worn. A manufactured kink is rounder. null where no such relief begins between the tip-edge
    zones, and for helical pairs, whose contact line crosses the kink at every position."""
    kink_pressure_angle_deg: float
    """Pinion rotation of the tooth at which the nominal contact passes that start of a relief; null as above."""
    mean_pressure_MPa: float
    """Mean over the engagement of the peak pressure p0 across the contact, averaged along the line between the tip-edge
    zones. On a spur pair it is that away from the starts of linear tip and root reliefs, as the largest pressure is:
    rotations at which the contact covers such a start are left out."""
    transmission_error_peak_to_peak_um: float
    """Largest less smallest transmission error of the pitch."""
    mesh_stiffness_N_per_mm_um: float
    """Tangent stiffness, mean over the pitch. Not comparable with c_γα of ISO 6336-1 without care: it is the tangent,
    and includes torsion of both gear bodies down to the rigid bore."""
    secant_stiffness_N_per_mm_um: float
    """Secant stiffness, mean over the pitch: force over what the torque adds to the unloaded transmission error."""
    loss_percent: float
    """Friction work over input work of the pitch."""
    face_load_factor: float
    """K_Hβ of ISO 6336-1:2006, 7.2.2: largest normal force per unit of face width over its mean. The force is that of
    all tooth pairs in a layer of the mesh along the face, mean over the mesh cycle; at an end of the face it is lower
    than the limit there. Of shafts and bearings only `pair.misalignment_um` is in it. 1 in plane strain. Why Method C
    of the standard finds less of a misaligned pair: docs/evidence.md."""
    crossing_deg: float
    """Pinion rotation of the tooth at which its curve of maximum pressure crosses that of the smallest friction
    coefficient; null where it does not cross, or where the contact is less than two elements wide."""
    balance_error: float
    """Input less output less friction work of the pitch, over the input work. A run ends with status 3 if it exceeds
    0.01."""
    forces_on_pinion: ShaftForces
    """Loads of the mesh on the pinion and its shaft."""
    forces_on_wheel: ShaftForces
    """Loads of the mesh on the wheel and its shaft."""
    estimated_error: FigureErrors | None
    """Error bars of the values with the same names: sum of the parts of the mesh and of the spacing of positions; null
    where there are none."""
    spacing_error: FigureErrors
    """The part of the error bars due to the spacing of positions (`sweep.positions`); known without error bars too."""


@dataclass(frozen=True)
class ErrorBars:
    """Method of the error bars, or the reason why there are none."""

    method: str
    """Method by which the error bars were estimated; empty where there are none."""
    missing: str | None
    """Reason why there are no error bars; null where there are some."""


@dataclass(frozen=True)
class Summary(RunFacts):
    """The content of summary.json."""

    schema_version: int
    """Version of this file's form, docs/summary.schema.json: raised where a key is removed or changes its meaning."""
    scene: Mapping[str, object]
    """The scene with all its defaults, docs/scene.md."""
    warnings: tuple[str, ...]
    """Limits on the accuracy of the values, a sentence each."""
    estimated_error: ErrorBars
    """Method of the error bars."""
    frictions: tuple[FrictionRow, ...]
    """Values of the pitch, one entry a friction coefficient."""
    positions: tuple[PositionRow, ...]
    """Values at the positions, one entry a position and friction coefficient."""
