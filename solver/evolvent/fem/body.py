"""An elastic body: mesh, material, supports and loads; its stiffness matrix and load vector, assembled by dolfinx.

The displacements of a body with a rigid coupling are relative to the coupled facet group, whose nodes are held. The
small rigid motion δ of that group is an unknown with a load, or is prescribed. A rigid motion causes no stress, so that
the stiffness does not depend on it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import cast

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import ufl
from scipy.sparse.csgraph import connected_components

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.backend.dolfinx_compat import Mesh
from evolvent.fem.boundary import AXES, DIRECTIONS, BodyForce, Fixed, Freedom, Rigid, Traction
from evolvent.fem.material import STEEL, Material
from evolvent.fem.parallel.memory import keep_freed_memory
from evolvent.fem.rigid_modes import rigid_modes
from evolvent.fem.surface import boundary_group, facet_group
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.errors import InputError
from evolvent_meshes.input_checks import members, refuse, text
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.soundness import check_mesh

__all__ = [
    "DIRECTIONS",
    "Assembled",
    "Body",
    "BodyForce",
    "Fixed",
    "Freedom",
    "Rigid",
    "RigidMotions",
    "Traction",
    "assemble",
    "prescribed_displacements",
]


@dataclass(frozen=True, eq=False)
class Body:
    """A deformable body. body["top"] is its facet group "top" as a side of a contact; a body equals itself only.

    mesh: from `read_msh`, from `evolvent_meshes.shapes`, or from arrays.
    material: isotropic, linear elastic.
    supports: facet groups that are held or displaced; rigid motions that they leave free are unknowns.
    loads: tractions and body forces, multiplied by the load factor of a step.
    rigid: a facet group that moves as a rigid body.
    name: used in messages and file names.
    Raises MeshError for an unusable mesh (`evolvent_meshes.mesh.soundness`), InputError for other inconsistent input.

    >>> from evolvent_meshes.shapes.blocks import rectangle
    >>> mesh = rectangle(40.0, 20.0, nx=4, ny=2)
    >>> block = Body(mesh, supports=(Fixed("bottom"),), loads=(Traction("top", (0.0, -1.0)),))
    >>> block.material.youngs_modulus, block.mesh.dimension
    (210000.0, 2)
    >>> Body(mesh, supports=(Fixed("floor"),), name="block")
    Traceback (most recent call last):
    ...
    evolvent_meshes.mesh.mesh_data.MeshError: block: wanted one of the facet groups bottom, left, right, top, found \
'floor'; name one of these
    """

    mesh: MeshData
    material: Material = STEEL
    supports: tuple[Fixed, ...] = ()
    loads: tuple[Traction | BodyForce, ...] = ()
    rigid: Rigid | None = None
    name: str = "body"

    def __post_init__(self) -> None:
        text("body", self.name, "give the body a name, or leave it out")
        check_mesh(self.mesh, self.name)
        if not isinstance(self.material, Material):
            refuse(self.name, "a Material", self.material, "write Material(210e3, 0.3)")
        supports = members(f"{self.name}, supports", self.supports, (Fixed,), '(Fixed("bottom"),)')
        loads = members(f"{self.name}, loads", self.loads, (Traction, BodyForce), '(Traction("top", (0.0, -1.0)),)')
        object.__setattr__(self, "supports", supports)
        object.__setattr__(self, "loads", loads)
        if self.rigid is not None and not isinstance(self.rigid, Rigid):
            refuse(f"{self.name}, rigid", "a Rigid", self.rigid, 'write Rigid("top"), or leave it out')
        self._check_groups()
        self._check_dimension()
        prescribed_displacements(self)

    def __getitem__(self, group: str) -> tuple[Body, str]:
        """The side of a contact on this facet group. Raises MeshError for a group that cannot be in contact."""
        text(f"{self.name}, side", group, 'name a facet group, as in body["top"]')
        boundary_group(self.mesh, group, self.name)
        return self, group

    def _check_groups(self) -> None:
        for support in self.supports:
            facet_group(self.mesh, support.group, self.name)
        for load in self.loads:
            if isinstance(load, Traction):
                boundary_group(self.mesh, load.group, f"{self.name}, traction")
        if self.rigid:
            facet_group(self.mesh, self.rigid.group, self.name)

    def _check_dimension(self) -> None:
        d = self.mesh.dimension
        for support in self.supports:
            if support.directions != AXES and not set(support.directions) <= set(AXES[:d]):
                wanted = f'directions out of "{AXES[:d]}", as the body is {d}D'
                refuse(f"{self.name}, support of {support.group!r}", wanted, support.directions, "leave out the others")
        for load in self.loads:
            if len(load.vector) != d:
                of = f"traction on {load.group!r}" if isinstance(load, Traction) else "body force"
                refuse(f"{self.name}, {of}", f"{d} components, as the body is {d}D", load.vector, "give as many")
        for freedom in self.rigid.freedoms if self.rigid else ():
            if freedom.direction not in DIRECTIONS[d]:
                known = ", ".join(DIRECTIONS[d])
                refuse(
                    f"{self.name}, rigid coupling", f"a rigid motion of {known}, as the body is {d}D",
                    freedom.direction, "name one of these",
                )
        if self.rigid and len(self.rigid.centre) < d:
            refuse(f"{self.name}, rigid coupling", f"a centre of {d} coordinates", self.rigid.centre, "write (x, y, z)")


def prescribed_displacements(body: Body) -> tuple[Bools, Floats]:
    """Whether the supports prescribe a displacement, (N, d), and its value (N, d) [mm], zero elsewhere.

    Raises InputError where two supports, or a support and the rigid coupling, prescribe different ones.
    """
    d = body.mesh.dimension
    held, value = np.zeros((len(body.mesh.points), d), dtype=bool), np.zeros((len(body.mesh.points), d))
    rigid = np.unique(body.mesh.facets[body.rigid.group]) if body.rigid else np.empty(0, dtype=np.int64)
    for support in body.supports:
        nodes = np.unique(body.mesh.facets[support.group])
        for axis in (AXES.index(letter) for letter in support.directions if letter in AXES[:d]):
            given, already = support.displacement, held[nodes, axis]
            clash = already & (value[nodes, axis] != given)
            if clash.any() or (given and np.isin(nodes, rigid).any()):
                other = f"{value[nodes, axis][clash][0]:g} mm of another support" if clash.any() else "a rigid coupling"
                raise InputError(
                    f"{body.name}, support of {support.group!r}: wanted one displacement along {AXES[axis]} a node, "
                    f"found {given:g} mm and {other} at shared nodes; separate the groups, or prescribe the same"
                )
            held[nodes, axis], value[nodes, axis] = True, given
    return held, value


@dataclass(frozen=True)
class RigidMotions:
    """Rigid motions of a body, superposed to its displacements.

    shapes: (N, d, r) displacements of the mesh nodes by unit motions.
    load: (r,) load of each motion [N, N·mm], NaN where it is prescribed.
    value: (r,) prescribed motion [mm, rad], NaN where it is an unknown.
    """

    shapes: Floats
    load: Floats
    value: Floats

    @property
    def free(self) -> Ints:
        """Indices of the motions that are unknowns."""
        return np.flatnonzero(np.isnan(self.value))


@dataclass(frozen=True)
class Assembled:
    """Stiffness matrix and load vector of a body on all of its degrees of freedom d·node + component.

    body: what was assembled.
    stiffness: (N·d, N·d) without supports [N/mm].
    held: (N·d,) where a displacement is prescribed.
    load: (N·d,) external nodal forces [N].
    prescribed: (N·d,) prescribed displacements, zero elsewhere [mm].
    motions: rigid motions superposed to the displacements.
    """

    body: Body
    stiffness: sp.csr_matrix
    held: Bools
    load: Floats
    prescribed: Floats
    motions: RigidMotions = field(repr=False)

    @cached_property
    def free(self) -> Ints:
        """Indices of the degrees of freedom that are not held."""
        return np.flatnonzero(~self.held)

    @property
    def d(self) -> int:
        """Dimension of space, 2 or 3."""
        return self.body.mesh.dimension


def assemble(body: Body) -> Assembled:
    """Stiffness matrix, load vector, supports and rigid motions of a body.

    Rigid motions that the supports leave free become unknowns, and as many degrees of freedom are pinned; in
    equilibrium the reactions at these pins vanish.

    Raises InputError where a support holds a freedom of the rigid coupling, MeshError where a piece of the mesh is not
    held, CompileError and CacheError where dolfinx cannot compile the forms.
    """
    keep_freed_memory()  # before the first large array
    d = body.mesh.dimension
    points = body.mesh.points[:, :d]
    stiffness, load = _stiffness_and_load(body)
    held, value = prescribed_displacements(body)
    if body.rigid:
        motions = _coupled_motions(body, body.rigid, held)
        held[np.unique(body.mesh.facets[body.rigid.group])] = True
        _refuse_loose_pieces(body, held)
    else:
        _refuse_loose_pieces(body, held)
        motions = _floating_motions(points, held)
    resultant = np.einsum("ndr,nd->r", motions.shapes, load.reshape(points.shape))
    loaded = RigidMotions(motions.shapes, motions.load + resultant, motions.value)
    return Assembled(body, stiffness, held.ravel(), load, value.ravel(), loaded)


def _stiffness_and_load(body: Body) -> tuple[sp.csr_matrix, Floats]:
    (mesh, space, order), d = dolfinx_compat.displacement_space(body.mesh), body.mesh.dimension
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    λ, μ = (dolfinx_compat.constant(mesh, float(value)) for value in body.material.lame)
    dx = ufl.Measure("dx", domain=mesh, metadata={"quadrature_degree": 2 * body.mesh.order})
    ε = ufl.sym(ufl.grad(u))
    form = ufl.inner(λ * ufl.tr(ε) * ufl.Identity(d) + 2 * μ * ε, ufl.sym(ufl.grad(v))) * dx
    stiffness = cast(sp.csr_matrix, dolfinx_compat.assemble_csr(form)[order][:, order].tocsr())
    stiffness.eliminate_zeros()  # sums of matrices drop them too, and patterns are compared
    return stiffness, _load(body, mesh, v)[order] if body.loads else np.zeros(len(order))


def _load(body: Body, mesh: Mesh, v: object) -> Floats:
    terms = []
    for load in body.loads:
        f, degree = dolfinx_compat.constant(mesh, load.vector), {"quadrature_degree": 2 * body.mesh.order + 2}
        if isinstance(load, Traction):
            tags = dolfinx_compat.facet_tags(mesh, [body.mesh.facets[load.group]])
            terms.append(ufl.inner(f, v) * ufl.Measure("ds", domain=mesh, subdomain_data=tags, metadata=degree)(1))
        else:
            terms.append(ufl.inner(f, v) * ufl.Measure("dx", domain=mesh, metadata=degree))
    return np.sum([dolfinx_compat.assemble_array(term) for term in terms], axis=0)


def _coupled_motions(body: Body, rigid: Rigid, held: Bools) -> RigidMotions:
    d = body.mesh.dimension
    shapes = rigid_modes(body.mesh.points[:, :d] - np.asarray(rigid.centre)[:d])
    chosen = shapes[:, :, [DIRECTIONS[d].index(f.direction) for f in rigid.freedoms]]
    if held.any() and np.abs(chosen[held]).max(initial=0.0) > 1e-12 * np.abs(shapes).max():
        names = ", ".join(f.direction for f in rigid.freedoms)
        raise InputError(
            f"{body.name}: wanted supports that allow the freedoms {names} of the rigid coupling of {rigid.group!r}, "
            "which move the whole body, found one that holds it there; leave out one of the two, or move the face by "
            "Fixed(group, direction, displacement) instead"
        )
    nan = float("nan")
    return RigidMotions(
        chosen,
        np.array([nan if f.load is None else f.load for f in rigid.freedoms]),
        np.array([nan if f.displacement is None else f.displacement for f in rigid.freedoms]),
    )


def _refuse_loose_pieces(body: Body, held: Bools) -> None:
    """Raises MeshError where the mesh has several pieces, as with nodes that are not welded, and one is not held."""
    cells, points = body.mesh.cells, body.mesh.points[:, : body.mesh.dimension]
    links = np.ones(cells.size, dtype=np.int8), (np.repeat(cells[:, 0], cells.shape[1]), cells.ravel())
    count, number = connected_components(sp.csr_matrix(links, shape=(len(points),) * 2), directed=False)
    for piece in range(count) if count > 1 else ():
        nodes = np.flatnonzero(number == piece)
        modes = rigid_modes(points[nodes] - points[nodes].mean(axis=0))
        stopped = (modes / np.abs(modes).max(axis=(0, 1)))[held[nodes]]
        if not len(stopped) or np.linalg.matrix_rank(stopped, tol=1e-10) < modes.shape[2]:
            raise MeshError(
                f"{body.name}: wanted a mesh in one piece, or every piece held by supports, found {count} pieces, of "
                f"which that with point {nodes[0]} is not held; weld nodes that coincide (gmsh.model.mesh."
                "removeDuplicateNodes), or make each piece a body of its own"
            )


def _floating_motions(points: Floats, held: Bools) -> RigidMotions:
    """The rigid motions that the supports leave free; sets one degree of freedom for each in `held` (N, d)."""
    shapes = rigid_modes(points - points.mean(axis=0))
    n, d, r = shapes.shape
    scale = 1.0 / np.linalg.norm(shapes.reshape(n * d, r), axis=0)
    stopped = np.linalg.qr(shapes[held] * scale, mode="r")  # few rows with the same null space
    basis = np.eye(r) if not held.any() else la.null_space(stopped, rcond=1e-10)
    shapes = (shapes.reshape(n * d, r) * scale) @ basis * np.sqrt(n)
    if shapes.shape[1]:
        pins = la.qr(shapes.T, pivoting=True, mode="r")[1][: shapes.shape[1]]
        held.reshape(-1)[pins] = True
    count = shapes.shape[1]
    return RigidMotions(shapes.reshape(n, d, count), np.zeros(count), np.full(count, np.nan))
