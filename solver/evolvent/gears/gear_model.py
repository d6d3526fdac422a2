"""What all positions of a gear pair share, and how it comes from a scene: meshes, condensed gears, window.

With several ranks each gear is condensed on one.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from mpi4py import MPI

from evolvent.fem.parallel.cores import Cores
from evolvent.fem.parallel.ranks import shared, together
from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.scene.flank_deviations import FlankChart
from evolvent.scene.meshing.sector_meshes import gear_mesh
from evolvent.scene.scene import GEARS, Scene
from evolvent.scene.skips import contact_teeth, is_plane, skips, switched_off
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.mesh.mesh_data import MeshData

WINDOW = 1.6  # half-width of the contact window in largest Hertz half-widths, plus one element


@dataclass(frozen=True)
class GearLoad:
    """The load: torque [N·mm; per mm of width in 2D] held on gear `on`; the other one is driven."""

    torque: float
    on: Member = Member.PINION


@dataclass(frozen=True)
class GearModel:
    """All that positions share.

    teeth: tooth pairs that may touch within the pitch. half_width: of the window to start with [mm of arc],
    infinite where the whole flanks are searched. friction_terms: also keep them where μ = 0. deflected: flanks touch as
    they have deflected.
    """

    pair: GearPair
    bodies: tuple[GearBody, GearBody]
    teeth: tuple[int, ...]
    load: GearLoad
    half_width: float
    friction_terms: bool = False
    deflected: bool = False

    def has_friction_terms(self, friction: float) -> bool:
        """Whether tangential components and a memory are kept at this μ."""
        return friction > 0.0 or self.friction_terms


@dataclass(frozen=True)
class Preparation:
    """A gear model and what it took: wall seconds of meshing and of condensing; its parts are summed over gears."""

    model: GearModel
    mesh_seconds: float
    seconds: float

    @property
    def assemble_seconds(self) -> float:
        return sum(body.assemble_seconds for body in self.model.bodies)

    @property
    def condense_seconds(self) -> float:
        return sum(body.condense_seconds for body in self.model.bodies)


def prepare_model(
    scene: Scene,
    comm: MPI.Comm,
    mesh: Callable[[Scene, Member], MeshData] | None = None,
    meshed: Callable[[], None] = lambda: None,
) -> Preparation:
    """Meshes and condenses both gears of a scene. mesh: makes a gear's sector, by default `gear_mesh`. meshed: called
    when both are meshed.

    Raises MeshError, NotPositiveDefinite, OutOfMemory.
    """
    begin = time.perf_counter()
    # eliminating the pinion, which carries Nitsche's constant term, takes most memory: first, while that is free
    own = [member for member in Member if member % comm.size == comm.rank]
    meshes = together(comm, lambda: {member: (mesh or gear_mesh)(scene, member) for member in own})
    after_meshing, cores = time.perf_counter(), Cores(comm)
    meshed()
    teeth, pair = contact_teeth(scene), scene.gear_pair()

    def condensed(member: Member) -> GearBody:
        gear, material, whole = pair.gears[member], scene.materials()[member], not skips(scene, "one-sector")
        return condensed_gear(
            gear, meshes[member], material, teeth, member, member == Member.PINION, whole=whole, threads=cores.used
        )

    built = together(comm, lambda: {member: condensed(member) for member in own}, cores.lent)
    bodies = [shared(comm, built.pop(member, None), member % comm.size) for member in Member]
    pinion, wheel = (_charted(body, scene.flank_chart(name)) for body, name in zip(bodies, GEARS))
    load = GearLoad(_torque(scene), Member.named(scene.load.on))
    model = GearModel(
        pair, (pinion, wheel), tuple(teeth), load, window_half_width(scene),
        friction_terms="friction-terms" in switched_off(scene), deflected="deflected-flanks" in switched_off(scene),
    )  # fmt: skip
    return Preparation(model, after_meshing - begin, time.perf_counter() - after_meshing)


def _charted(body: GearBody, chart: FlankChart | None) -> GearBody:
    """The gear with its flank as charted."""
    return body if chart is None else replace(body, worn=chart.at(body.gear, body.roll_length, body.z))


def _torque(scene: Scene) -> float:
    """N·mm; per mm of face width where the scene is plane."""
    return 1e3 * scene.load.torque_Nm / (scene.gear_pair().face_width if is_plane(scene) else 1.0)


def window_half_width(scene: Scene) -> float:
    """Half-width [mm of profile arc] of the window about a contact line: the same everywhere, for what deflection
    brings into contact beyond the path of contact lies outside a window as narrow as Hertz's contact is there.
    Infinite where the scene does without a window."""
    if not skips(scene, "window"):
        return float(np.inf)
    estimate = scene.hertz_estimate()
    ξ = np.linspace(*estimate.pair.path_of_contact, 50)
    return WINDOW * float(np.max(estimate.half_width(ξ)))
