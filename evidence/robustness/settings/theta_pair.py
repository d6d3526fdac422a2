"""A gear pair with any θ: He's two whole gears as bodies of the public API, in plane strain.

The sweep of gear pairs uses θ = 1 alone, whose stiffness is symmetric and can be condensed. Here each gear is one mesh
of all its teeth, held or turned at the bore, and the contact looks at the whole flanks of three teeth; no part of the
path between the mesh and the contact law is shared with the sweep.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from evidence.scenes import spur_pair
from evolvent import Contact, ContactResult, Nitsche, Placement, Problem, Solution, Step, sweep
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.gears.condensed_gear import matching_cuts
from evolvent.gears.contact.tooth_contact import GAP
from evolvent.gears.full_gear import whole_mesh
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.pressure.contact_slices import fitted_peak
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData

TEETH = (-1, 0, 1)
"""Tooth pairs that may touch within a pitch about the pitch point."""


@dataclass(frozen=True)
class PairFigures:
    """The pair at one pinion rotation.

    peak:       fitted p0 [MPa].
    torque:     that holds the wheel, per mm of face width [N].
    error:      transmission error [mm].
    iterations: of Newton's method.
    """

    peak: float
    torque: float
    error: float
    iterations: int


@dataclass(frozen=True)
class ThetaPair:
    """He's pair at a mesh level, with its Nitsche parameters."""

    level: str
    nitsche: Nitsche
    friction: float = 0.1

    def figures(self, rotations: Floats) -> list[PairFigures]:
        """At pinion rotations [rad], one after the other. Raises NotConverged, NotPositiveDefinite."""
        stands = [PairRotation(self._scene.gear_pair(), float(rotation)) for rotation in rotations]
        solutions = sweep(self.problem(), [Step(placements=_placements(stand)) for stand in stands])
        return [_figures(stand, solution) for stand, solution in zip(stands, solutions, strict=True)]

    def problem(self) -> Problem:
        """The pinion turns at its bore under the torque of the scene, the wheel is held."""
        scene = self._scene
        (pinion, wheel), (driver, driven) = (_whole_gear(scene, gear) for gear in Member), scene.materials()
        torque = 1e3 * scene.load.torque_Nm / scene.gear_pair().face_width
        bodies = (
            Body(pinion, driver, rigid=Rigid("bore", (Freedom("rz", load=torque),)), name="pinion"),
            Body(wheel, driven, supports=(Fixed("bore"),), name="wheel"),
        )
        reach = GAP * scene.gear_pair().pinion.normal_module
        return Problem(bodies, (Contact((0, "flank"), (1, "flank"), self.friction, reach),), self.nitsche)

    @cached_property
    def _scene(self) -> Scene:
        return spur_pair(f"mesh.level={self.level}")


def _whole_gear(scene: Scene, gear: Member) -> MeshData:
    """All teeth; "flank" holds those of `TEETH` only: what cannot touch costs nothing."""
    sector, count = gear_mesh(gear_problem(scene), gear), scene.gear_pair().gears[gear].z
    mesh = whole_mesh(sector, matching_cuts(sector, 2.0 * np.pi / count), count)
    flanks = mesh.facets["flank"].reshape(count, -1, mesh.facets["flank"].shape[1])
    chosen = np.concatenate([flanks[(gear.sign * tooth) % count] for tooth in TEETH])
    return replace(mesh, facets={**mesh.facets, "flank": chosen})


def _placements(stand: PairRotation) -> tuple[Placement, ...]:
    return tuple(Placement(stand.rotation(gear, 2), stand.centre(gear, 2)) for gear in Member)


def _figures(stand: PairRotation, solution: Solution) -> PairFigures:
    contact = solution.contacts[0]
    arm = contact.points - stand.centre(Member.WHEEL, 2)
    force = contact.weights[:, None] * contact.traction
    moment = float(np.sum(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]))
    pitch = stand.pair.pinion.transverse_base_pitch
    error = stand.pair.pinion.base_radius * float(solution.motions[0][_turn(solution)])
    return PairFigures(_peak(contact, pitch), -moment, error, solution.iterations)


def _turn(solution: Solution) -> int:
    """Which of the pinion's rigid motions is its rotation."""
    rigid = solution.condensed[0].assembled.body.rigid
    assert rigid is not None
    return [freedom.direction for freedom in rigid.freedoms].index("rz")


def _peak(contact: ContactResult, base_pitch: float) -> float:
    """Largest p0 [MPa] of the half-ellipses with the moments of the pressures; teeth touch a base pitch [mm] apart."""
    on = contact.pressure > 0.0
    x, p, w, n = contact.points[on], contact.pressure[on], contact.weights[on], contact.normals[on]
    normal = (p * w) @ n / (p @ w)
    along = x @ normal
    tooth = np.round((along - along[np.argmax(p)]) / base_pitch)
    return max(_fitted(x[tooth == i], p[tooth == i], w[tooth == i], normal) for i in np.unique(tooth))


def _fitted(x: Floats, p: Floats, w: Floats, normal: Floats) -> float:
    return fitted_peak(x @ np.array([-normal[1], normal[0]]), p, w, float(p @ w))[0]
