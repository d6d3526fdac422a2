"""What summary.json, positions.csv and teeth.csv hold: every key and column, and what it means."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from evolvent.results.archive.error_bar_data import FigureErrors
from evolvent.results.archive.run_cost import Timings
from evolvent.results.mesh_facts import MeshFacts
from evolvent.results.shaft_forces import ShaftForces
from evolvent.scene.skips import Skipped

SCHEMA_VERSION = 1
"""Of summary.json: one more where a key goes, is named anew or means something else; new keys leave it as it is."""


@dataclass(frozen=True)
class RunFacts:
    """What a run knows beside its results."""

    versions: Mapping[str, str]
    """What the results depend on: program or library, and its version."""
    ranks: int
    """MPI processes."""
    dofs: int
    """Degrees of freedom of one sector of both gears."""
    cells: int
    """Cells of these."""
    mesh: MeshFacts
    """What the meshes are worth."""
    skipped: Sequence[Skipped]
    """What the scene did not need, see docs/scene.md."""
    timings_s: Timings
    """Wall time of the run's parts, summed over all its parts where it was resumed."""
    peak_memory_MB: float
    """Largest resident memory, summed over the ranks; of a resumed run its largest part's."""


@dataclass(frozen=True)
class ToothRow:
    """One tooth pair at a position."""

    tooth: int
    """The tooth pair: 0 passes the pitch point at the pinion angle 0, 1 is one pitch ahead of it, −1 one behind."""
    force_N: float
    """Normal force on the pair."""
    max_pressure_MPa: float
    """Largest contact pressure between the tip-edge zones, fitted over each slice and, on a helical line, averaged with
    the slices beside it (1:2:1); null where no slice lies there."""
    contact_length_mm: float
    """Length of the contact line that bears."""
    edge_pressure_MPa: float
    """Largest pressure at a tip's edge, 0 where none bears: singular there, and a matter of the mesh."""


@dataclass(frozen=True)
class PositionRow:
    """One position at one friction coefficient."""

    pinion_angle_deg: float
    """Rotation of the pinion; 0: the flanks of tooth pair 0 touch at the pitch point at mid-face."""
    friction: float
    """Coulomb's coefficient μ."""
    torque_pinion_Nm: float
    """On the pinion's shaft."""
    torque_gear_Nm: float
    """On the wheel's shaft."""
    transmission_error_um: float
    """r_b1 φ_1 − r_b2 φ_2: by how much the wheel lags behind the pinion, along the path of contact."""
    mesh_stiffness_N_per_mm_um: float
    """Slope of the force over the deflection along the line of action, over the face width: the tangent at this load,
    without friction."""
    secant_stiffness_N_per_mm_um: float
    """Force over face width and transmission error, in which modifications of the flanks count as deflection; null
    where a flank has a chart."""
    max_pressure_MPa: float
    """The largest of the teeth's."""
    tip_edge: bool
    """Whether a tooth bears on a tip's edge, where the pressure is singular."""
    loss_percent: float
    """Friction power, of the input power, with the sliding of rigid gears; where a contact lies across the pitch line a
    few hundredths of a per cent below 0 may be found."""
    newton_iterations: int
    """Iterations of Newton's method at this position."""
    balance_error: float
    """Imbalance of the forces, or the power that the teeth store or give back over the input: the larger one. A run
    ends with status 3 above 0.1."""
    seconds: float
    """Wall time."""
    teeth: tuple[ToothRow, ...]
    """The tooth pairs that bear; in positions.csv their number, `teeth_in_contact`."""


@dataclass(frozen=True)
class FrictionRow:
    """A pitch at one friction coefficient."""

    friction: float
    """Coulomb's coefficient μ."""
    max_pressure_MPa: float
    """Largest contact pressure of a tooth's whole engagement between the tip-edge zones."""
    max_pressure_angle_deg: float
    """The tooth's rotation where it occurs; 0 is the pitch point at mid-face."""
    max_pressure_at_zone_end: bool
    """Whether it lies where a tip-edge zone begins, so that its size is a matter of where that is."""
    max_pressure_at_relief_start: bool
    """Whether it lies, or may lie between two positions, where a linear tip relief begins: over that kink of the flank
    its size is a matter of how sharp the kink is."""
    mean_pressure_MPa: float
    """Mean over the engagement of the mean pressure between the tip-edge zones."""
    transmission_error_peak_to_peak_um: float
    """Largest less smallest transmission error of the pitch."""
    mesh_stiffness_N_per_mm_um: float
    """Tangent, mean of the pitch. As c_γ of ISO 6336-1, but of the whole gears, rims, webs and their tilting under the
    axial force included, on rigid bores; ISO's is that of the teeth."""
    secant_stiffness_N_per_mm_um: float
    """Secant, mean of the pitch; null where a flank has a chart."""
    loss_percent: float
    """Friction work of the pitch, of the input."""
    crossing_deg: float
    """The tooth's rotation at which its curve of maximum pressure crosses that of the smallest coefficient; null where
    it does not, or where the contact is less than two elements wide."""
    balance_error: float
    """Input less output less friction work, over the input, of the pitch. A run ends with status 3 above 0.01."""
    forces_on_pinion: ShaftForces
    """What the mesh does to the pinion and its shaft."""
    forces_on_wheel: ShaftForces
    """The same of the wheel."""
    estimated_error: FigureErrors | None
    """Error bars of the figures of the same names, those of the mesh and of the spacing of positions added; null where
    there are none."""
    spacing_error: FigureErrors
    """The part of the error bars that comes from the spacing of positions (`sweep.positions`), also where there are no
    error bars."""


@dataclass(frozen=True)
class ErrorBars:
    """How error bars were estimated, or why there are none."""

    method: str
    """How they were estimated; empty where there are none."""
    missing: str | None
    """Why there are none; null where there are some."""


@dataclass(frozen=True)
class Summary(RunFacts):
    """summary.json."""

    schema_version: int
    """Of this file's form, docs/summary.schema.json: larger where a key is gone or means something else."""
    scene: Mapping[str, object]
    """The scene with all its defaults, docs/scene.md."""
    warnings: tuple[str, ...]
    """What makes figures doubtful, a sentence each."""
    estimated_error: ErrorBars
    """How error bars were estimated."""
    frictions: tuple[FrictionRow, ...]
    """The figures of the pitch, one entry a friction coefficient."""
    positions: tuple[PositionRow, ...]
    """One entry a position and friction coefficient."""
