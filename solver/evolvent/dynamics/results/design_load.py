"""Design load of a tooth relief: that under which the peak-to-peak transmission error is least (Harris, 1958)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import partial

import numpy as np
from scipy.optimize import minimize_scalar

from evolvent.dynamics.excitation.force_surface import SAME_LOAD, MeshExcitation
from evolvent.dynamics.results.curves import LOADED, CoarseExcitation, pitch_curves
from evolvent.dynamics.results.line_facts import line_facts
from evolvent.gears.problem.iso_stiffness import stiffnesses
from evolvent.results.tables.table import Record
from evolvent_meshes.gears.pair import GearPair

LOADS = 400
"""Loads among which the least peak-to-peak value is sought before it is refined."""


@dataclass(frozen=True)
class ExcitationFacts:
    """Scene, mesh and torques of an excitation, and its design load: excitation.json."""

    title: str
    """Title of the scene."""
    mesh_level: str
    """Mesh level of the scene."""
    positions: int
    """Number of positions of a pitch."""
    torques_Nm: tuple[float, ...]
    """Torques under which the excitation was solved, ascending."""
    design_torque_Nm: float | None
    """Torque under which the peak-to-peak transmission error is least, on the mesh force over deflection between the
    torques that were solved; null where that is the lightest or the heaviest of them, or where there are fewer than
    three."""
    design_peak_to_peak_um: float | None
    """Peak-to-peak transmission error under the design torque."""
    design_peak_to_peak_um_error: float | None
    """Estimated error of the peak-to-peak transmission error under the design torque: that of the nearest torque, and
    what interpolation between torques adds, by how well the solved ones beside it follow from all others; null without
    error bars."""
    design_from_Nm: float | None
    """Lightest torque around the design torque whose peak-to-peak value is larger by no more than the error: which
    torque from here to design_to_Nm is the design load is not known. Null without error bars."""
    design_to_Nm: float | None
    """Heaviest torque around the design torque whose peak-to-peak value is larger by no more than the error; null
    without error bars."""
    mean_tangent_stiffness_N_per_mm_um: float
    """Tangent mesh stiffness per mm of face width under the heaviest torque, mean over the pitch."""
    mean_secant_stiffness_N_per_mm_um: float
    """Secant mesh stiffness per mm of face width under the heaviest torque, mean over the pitch: to be compared with
    iso_mesh_stiffness_N_per_mm_um, which is a secant of teeth on solid discs; this one has the torsion of both bodies
    down to their bores, too."""
    iso_single_stiffness_N_per_mm_um: float | None
    """Single stiffness c' of ISO 6336-1:2006, clause 9, Method B, under the heaviest torque; null for profile shifts
    that the standard's formula does not cover."""
    iso_mesh_stiffness_N_per_mm_um: float | None
    """Mesh stiffness c_γα of ISO 6336-1:2006, clause 9, Method B, under the heaviest torque; null likewise."""
    face_load_factor: float | None
    """Face load factor K_Hβ (ISO 6336-1:2006, 7.2.2) under the heaviest torque in torques_Nm: on the layers of the mesh
    in the mean over the pitch, without shafts and housing but for pair.misalignment_um; null in the plane, and where
    the contact is resolved (`evolvent run` has it)."""
    face_load_factor_error: float | None
    """Estimated error of the face load factor; null without error bars."""
    largest_pressure_MPa: float | None
    """Largest of Hertz' p_0 at the positions under the heaviest torque in torques_Nm, without friction, away from edges
    of tips and from starts of linear reliefs, with the radii of curvature of the modified flanks; null where the
    contact is resolved."""
    largest_pressure_MPa_error: float | None
    """Estimated error of the largest pressure; null without error bars."""
    warnings: tuple[str, ...]
    """Sentences that a reader of the excitation has to know, as the command prints them."""


EXCITATION_FACTS = Record("excitation.json", ExcitationFacts)


def excitation_facts(
    title: str, level: str, excitation: MeshExcitation, companion: CoarseExcitation, pair: GearPair,
    moduli: tuple[float, float] | None = None, warnings: Sequence[str] = (),
) -> ExcitationFacts:
    """Facts of an excitation. moduli: of both gears [MPa], None where they are not known. warnings: sentences on all of
    it."""
    torques = tuple(1e-3 * float(torque) for torque in excitation.loaded.torques)
    count = len(excitation.unloaded_error)
    torque, size, error, lightest, heaviest = _design(excitation, companion)
    per_width = 1e-3 / pair.face_width
    heaviest_force = float(excitation.loaded.forces[-1])
    single, mesh = (moduli and stiffnesses(pair, heaviest_force, moduli)) or (None, None)
    return ExcitationFacts(
        title=title, mesh_level=level, positions=count, torques_Nm=torques, design_torque_Nm=torque,
        design_peak_to_peak_um=size, design_peak_to_peak_um_error=error, design_from_Nm=lightest, design_to_Nm=heaviest,
        mean_tangent_stiffness_N_per_mm_um=per_width * float(np.mean(excitation.loaded.stiffness[:, -1])),
        mean_secant_stiffness_N_per_mm_um=per_width * float(np.mean(excitation.secant[:, -1])),
        iso_single_stiffness_N_per_mm_um=single, iso_mesh_stiffness_N_per_mm_um=mesh,
        **_of_line_contact(excitation, companion), warnings=tuple(warnings),
    )


def _of_line_contact(excitation: MeshExcitation, companion: CoarseExcitation) -> dict[str, float | None]:
    """Face load factor and largest pressure under the heaviest torque, with their errors."""
    facts = line_facts(excitation, companion)
    heaviest = {field.name: float(getattr(facts, field.name)[-1]) for field in fields(facts)}
    return {name: None if math.isnan(value) else value for name, value in heaviest.items()}


def _design(
    excitation: MeshExcitation, companion: CoarseExcitation
) -> tuple[float | None, float | None, float | None, float | None, float | None]:
    """Design torque [N·m], peak-to-peak value and its error [µm], and the range of torques [N·m] in which the design
    load lies."""
    forces = excitation.loaded.forces
    if len(forces) < 3:
        return None, None, None, None, None
    size, loads = partial(_peak_to_peak, excitation), np.linspace(forces[0], forces[-1], LOADS)
    sizes = np.array([size(float(force)) for force in loads])
    i = int(np.argmin(sizes))
    if i in (0, len(loads) - 1):
        return None, None, None, None, None
    best = float(minimize_scalar(size, bounds=(loads[i - 1], loads[i + 1]), method="bounded").x)
    to_torque, least = 1e-3 * excitation.loaded.base_radius, size(best)
    curves = list(pitch_curves(excitation, companion))[int(np.argmin(np.abs(forces - best)))]
    error = curves[LOADED].peak_to_peak_error
    if not np.isfinite(error):
        return to_torque * best, least, None, None, None
    error += _interpolation_error(excitation, best)
    alike = sizes <= least + error
    first = i - int(np.argmin(alike[i::-1])) + 1 if not alike[: i + 1].all() else 0
    last = i + int(np.argmin(alike[i:])) - 1 if not alike[i:].all() else len(loads) - 1
    return to_torque * best, least, float(error), to_torque * float(loads[first]), to_torque * float(loads[last])


def _peak_to_peak(excitation: MeshExcitation, force: float) -> float:
    """Peak-to-peak transmission error [µm] under a mesh force [N]."""
    return 1e3 * float(np.ptp(excitation.under(force)[0] + excitation.unloaded_error))


def _interpolation_error(excitation: MeshExcitation, force: float) -> float:
    """Error of the peak-to-peak transmission error [µm] at a force [N] between two solved ones: the larger difference
    between what was solved at these and what the other forces make of it, where they have one on either side, over the
    square of how much wider the gap is then. Cubics do better in smooth curves; where tooth pairs come into contact
    between two forces they do not. Zero where the force was solved."""
    forces = excitation.loaded.forces
    above = int(np.searchsorted(forces, force))
    if np.isclose(forces, force, rtol=SAME_LOAD).any():
        return 0.0
    gap, found = forces[above] - forces[above - 1], []
    for j in (above - 1, above):
        if 0 < j < len(forces) - 1:
            others = replace(excitation, loaded=excitation.loaded.without(j))
            off = abs(_peak_to_peak(others, float(forces[j])) - _peak_to_peak(excitation, float(forces[j])))
            found.append(off * (gap / (forces[j + 1] - forces[j - 1])) ** 2)
    return float(max(found))
