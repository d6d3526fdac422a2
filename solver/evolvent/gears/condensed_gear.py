"""A gear condensed onto its loaded flanks, once for all positions: one sector, closed to the ring of all sectors."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from evolvent.contact.nitsche.flux_recovery import (
    SAFETY,
    NitscheTraction,
    nitsche_stabiliser,
    node_functionals,
    recovered_traction,
    trace_functionals,
)
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.cache.cache import NOT_KEPT, Cache
from evolvent.fem.condensation.schur_complement import SectorSystem
from evolvent.fem.material import Material
from evolvent.fem.parallel.cores import Threads
from evolvent.fem.surface import Surface, surface_of
from evolvent.gears.full_gear import whole_mesh, whole_system
from evolvent.gears.meshing.flank_levels import FlankLevel
from evolvent.gears.meshing.root_meshes import root_nodes
from evolvent.gears.ring.chain_settings import ChainSettings
from evolvent.gears.ring.ring_compliance import ChainedCompliance, Compliance
from evolvent.gears.two_level.flank_cells import FlankCells
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.mesh_digest import mesh_digest
from evolvent_meshes.rotation import turn

COUPLING_TOLERANCE = 1e-10
"""Relative error of the coupling between teeth, which is compressed."""


@dataclass(frozen=True)
class GearBody:
    """One gear, condensed onto the loaded flanks of its teeth; its bore is held in the gear's frame."""

    gear: GearParameters
    """Geometry of the gear."""
    mesh: MeshData
    """Sector of tooth 0 in the gear's frame."""
    material: Material
    """Material of the gear."""
    flank: Surface
    """Loaded flank of tooth 0 in the gear's frame, n nodes."""
    stabiliser: Floats | None
    """Stabiliser γ and γ_t (n, 2) of Nitsche's method [MPa/mm], on the gear that carries the pressure; else None."""
    chain: Compliance
    """Compliance of the flanks of all teeth in contact, tooth s turned by +2πs/z."""
    member: Member
    """Pinion or wheel; tooth pair i has tooth member.sign·i."""
    assemble_seconds: float
    """Wall time of the assembly [s]."""
    condense_seconds: float
    """Wall time of the condensation [s]."""
    worn: Floats | None = None
    """Worn depth (n,) of the flank that mesh and compliance do not include [mm]."""
    levels: tuple[FlankLevel, ...] = ()
    """Levels by which the flank is finer than the mesh, which then has no flank modifications either; none: its nodes
    are the mesh's."""

    bare: MeshData | None = None
    """Mesh that was condensed: the cells of `mesh` on a flank without modifications; None: `mesh` was."""

    @property
    def condensed_mesh(self) -> MeshData:
        """Mesh that the compliance is of."""
        return self.mesh if self.bare is None else self.bare

    @property
    def coarse(self) -> GearBody:
        """The gear with the flank of its coarse sector, without the pressure side of Nitsche's method; itself where its
        flank has no levels."""
        if not isinstance(self.chain, TwoLevelRing):
            return self
        return replace(self, flank=self.chain.flank, stabiliser=None, chain=self.chain.coarse, levels=())

    @property
    def traction(self) -> NitscheTraction | None:
        """Recovered traction of Nitsche's method, of a gear that carries the pressure and whose flank is the mesh's;
        None of one without pressure. Recovered at each call: only modes and deformation fields need it."""
        if self.stabiliser is None:
            return None
        flank = surface_of(self.condensed_mesh, "flank")
        assert len(flank.points) == len(self.stabiliser)  # finer flanks have no traction on the mesh
        return recovered_traction(self.stabiliser, self.condensed_mesh, self.material, flank)

    def lost(self, facets: Ints, xi: Floats) -> Floats:
        """Worn depth (q,) [mm] at xi (q, d−1) of the flank's facets (q,)."""
        return np.zeros(len(facets)) if self.worn is None else self.flank.hat_matrix(facets, xi) @ self.worn

    @property
    def d(self) -> int:
        """Space dimension."""
        return self.mesh.dimension

    @property
    def z(self) -> Floats:
        """Heights (n,) of the flank's nodes [mm]."""
        return self.flank.points[:, 2] if self.d == 3 else np.zeros(len(self.flank.points))

    @property
    def roll_length(self) -> Floats:
        """Transverse involute curvature radius √(r² − r_b²) (n,) at the flank's nodes [mm]."""
        r = np.hypot(self.flank.points[:, 0], self.flank.points[:, 1])
        return np.sqrt(np.maximum(r**2 - self.gear.base_radius**2, 0.0))

    @cached_property
    def cells(self) -> FlankCells:
        """Facets of the flank by row and layer, of a gear whose flank has levels."""
        assert isinstance(self.chain, TwoLevelRing)
        return FlankCells.of(self.chain.levels[-1].correction.lattice, self.flank, self.gear.base_radius)

    @cached_property
    def tip_zone(self) -> Bools:
        """Flank nodes (n,) bool on the tip edge."""
        r = np.hypot(self.flank.points[:, 0], self.flank.points[:, 1])
        return r > r.max() - 1e-6 * self.gear.normal_module

    def rows(self, tooth: int, nodes: Ints) -> Ints:
        """Rows (len, 2) of the chain for flank nodes of tooth pair i."""
        return np.column_stack([np.full(len(nodes), self.member.sign * tooth), nodes])


def condensed_gear(
    gear: GearParameters,
    mesh: MeshData,
    material: Material,
    teeth: Sequence[int],
    member: Member,
    carries_pressure: bool,
    safety: float = SAFETY,
    whole: bool = False,
    threads: Threads = nullcontext,
    cache: Cache = NOT_KEPT,
) -> GearBody:
    """Assembles and condenses one sector of a gear held at its bore, and closes the ring of its z sectors.
    Displacements of `root_nodes` are condensed, too, where the mesh has them.

    teeth: tooth pairs that may touch. safety: factor on the stabilisation of Nitsche's method. whole: assemble and
    condense all sectors instead of one. threads: context in which the largest matrix products run. cache: keeps a
    sector that is closed to the ring.

    Raises NotPositiveDefinite, OutOfMemory.
    """
    begin = assembled = time.perf_counter()
    flank, pitch = surface_of(mesh, "flank"), 2.0 * np.pi / gear.z
    numbers = sorted(member.sign * tooth for tooth in teeth)
    own_safety = safety if carries_pressure else None
    γ = None if own_safety is None else nitsche_stabiliser(mesh, material, flank, own_safety)

    def closed_sector() -> ChainedCompliance:
        nonlocal assembled
        traction = None if γ is None else recovered_traction(γ, mesh, material, flank)
        system = _sector_system(sector_body(mesh, material, member), flank, traction, pitch)
        assembled = time.perf_counter()
        sector = system.condensed(threads)
        del system, traction  # gigabytes at the fine end
        return ChainedCompliance.of(sector, settings)

    if whole:
        ring = whole_mesh(mesh, matching_cuts(mesh, pitch), gear.z)
        named = range(numbers[0], numbers[-1] + 1)
        system = whole_system(ring, material, gear.z, named, own_safety)
        assembled = time.perf_counter()
        chain: Compliance = system.condensed(threads)
    else:
        settings = ChainSettings(pitch, len(numbers), numbers[0], mesh.dimension, COUPLING_TOLERANCE)
        inputs = "sector", mesh_digest(mesh), material.elasticity, settings, own_safety
        chain = cache.kept(f"sector, {in_words(gear)}", inputs, ChainedCompliance, closed_sector)
    end = time.perf_counter()
    return GearBody(gear, mesh, material, flank, γ, chain, member, assembled - begin, end - assembled)


def in_words(gear: GearParameters) -> str:
    """A gear in a few words, for lists of what is kept."""
    return f"z = {gear.z}, m_n = {gear.normal_module:g} mm, β = {gear.helix_angle_deg:g}°, b = {gear.face_width:g} mm"


def sector_body(mesh: MeshData, material: Material, member: Member) -> Body:
    """A sector of the pinion or the wheel, held at its bore."""
    return Body(mesh, material, supports=(Fixed("bore"),), name=member.label)


def _sector_system(
    body: Body, flank: Surface, traction: NitscheTraction | None, pitch: float
) -> SectorSystem:
    """Sector ready for elimination. It is separate from its caller so that the full matrices are freed when the
    elimination starts."""
    parts, nodes = sector_parts(body, flank, traction, pitch), root_nodes(body.mesh)
    observed = node_functionals(nodes, body.mesh.dimension, parts.stiffness.shape[0]) if len(nodes) else None
    return SectorSystem.of(
        parts.stiffness, parts.functionals, parts.low, parts.high, parts.graph, parts.free, observed=observed
    )


@dataclass(frozen=True)
class SectorParts:
    """Matrices of a sector with Nitsche's constant term, N degrees of freedom."""

    stiffness: sp.csr_matrix
    """Stiffness (N, N) [N/mm]."""
    functionals: sp.csr_matrix
    """Displacements (m, N) of the flank that enter the contact."""
    low: Ints
    """Free degrees of freedom of the low cut face."""
    high: Ints
    """Free degrees of freedom of the high cut face, in the order of those of the low one."""
    free: Ints
    """Numbers of all free degrees of freedom."""
    graph: sp.csr_matrix
    """Pattern (N, N) of the stiffness without Nitsche's term."""


def sector_parts(body: Body, flank: Surface, traction: NitscheTraction | None, pitch: float) -> SectorParts:
    """Assembles a sector. pitch: angle between its cut faces [rad]."""
    assembled = assemble(body)
    K, d = assembled.stiffness, assembled.d
    P = trace_functionals(flank, K.shape[0])
    graph = sp.csr_matrix((np.ones(K.nnz, dtype=np.int8), K.indices, K.indptr), shape=K.shape)
    if traction is not None:
        K, P = K - traction.constant_term(), P - traction.flux()
    cut = [(d * nodes[:, None] + np.arange(d)).ravel() for nodes in matching_cuts(body.mesh, pitch)]
    low, high = (dofs[~assembled.held[dofs]] for dofs in cut)
    return SectorParts(K, P, low, high, assembled.free, graph)


def matching_cuts(mesh: MeshData, pitch: float) -> tuple[Ints, Ints]:
    """Nodes (k,) of the low and of the high cut face in matching order: high = low turned by the pitch [rad].

    Raises ValueError where they do not match within 1e-7 mm.
    """
    low, high = (np.unique(mesh.facets[name]) for name in ("cut_low", "cut_high"))
    turned = mesh.points[low] @ turn(pitch, 3).T
    distance, partner = cKDTree(mesh.points[high]).query(turned)
    if len(low) != len(high) or distance.max() > 1e-7:
        raise ValueError(
            f"sector: wanted cut faces that match when turned by the pitch, found {distance.max():.1e} mm apart"
        )
    return low, high[partner]
