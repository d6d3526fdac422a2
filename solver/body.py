"""A body: mesh, material, supports, loads, rigid coupling; and its stiffness, assembled by dolfinx.

A rigidly coupled body is described in the frame of its coupling: the coupled nodes are at rest there, and the small
rigid motion δ of that frame is an unknown with a load, or is prescribed. A rigid motion carries no stress, so the
stiffness knows nothing of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import cast

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import ufl

from meshes.data import Floats, Ints, MeshData
from solver import compat
from solver.material import STEEL, Material
from solver.memory import keep_freed_memory
from solver.traction import rigid_modes

DIRECTIONS = {2: ("x", "y", "rz"), 3: ("x", "y", "z", "rx", "ry", "rz")}


@dataclass(frozen=True)
class Fixed:
    """No displacement of a facet group in these directions (letters of "xyz")."""

    group: str
    directions: str = "xyz"


@dataclass(frozen=True)
class Traction:
    """A constant traction [MPa] on a facet group, in the body's frame."""

    group: str
    vector: tuple[float, ...]


@dataclass(frozen=True)
class Freedom:
    """One rigid motion of a coupled group: loaded (force [N] or moment [N·mm]; per mm of thickness in 2D) or
    prescribed (displacement [mm] or angle [rad], small).

    direction: "x", "y", "z", or "rx", "ry", "rz" about the coupling's centre.
    """

    direction: str
    load: float | None = None
    displacement: float | None = None

    def __post_init__(self) -> None:
        if (self.load is None) == (self.displacement is None):
            raise ValueError(f"freedom {self.direction!r}: wanted either a load or a displacement; give exactly one")


@dataclass(frozen=True)
class Rigid:
    """A facet group that moves as a rigid body; motions that are not named are held."""

    group: str
    freedoms: tuple[Freedom, ...] = ()
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Body:
    """A deformable body. Raises ValueError for a group that the mesh does not have."""

    mesh: MeshData
    material: Material = STEEL
    supports: tuple[Fixed, ...] = ()
    loads: tuple[Traction, ...] = ()
    rigid: Rigid | None = None
    name: str = "body"

    def __post_init__(self) -> None:
        wanted = [s.group for s in self.supports] + [t.group for t in self.loads]
        wanted += [self.rigid.group] if self.rigid else []
        for group in wanted:
            if group not in self.mesh.facets:
                known = ", ".join(sorted(self.mesh.facets))
                raise ValueError(f"{self.name}: wanted the facet group {group!r}, found {known}; name one of these")


@dataclass(frozen=True)
class RigidMotions:
    """The rigid motions of a body that contact sees.

    shapes: (N, d, r) unit motions at the mesh nodes; load: (r,) their load [N, N·mm], NaN where the motion is
    prescribed; value: (r,) the prescribed motion [mm, rad], NaN where it is loaded.
    """

    shapes: Floats
    load: Floats
    value: Floats

    @property
    def free(self) -> Ints:
        """Indices of the unknown motions."""
        return np.flatnonzero(np.isnan(self.value))


@dataclass(frozen=True)
class Assembled:
    """Stiffness and load of a body on all its degrees of freedom (node-major: d·node + component).

    stiffness: (N·d, N·d) without supports; held: (N·d,) bool; load: (N·d,) external nodal forces [N].
    """

    body: Body
    stiffness: sp.csr_matrix
    held: np.ndarray
    load: Floats
    motions: RigidMotions = field(repr=False)

    @cached_property
    def free(self) -> Ints:
        """Indices of the degrees of freedom that are not held."""
        return np.flatnonzero(~self.held)

    @property
    def d(self) -> int:
        """Space dimension."""
        return self.body.mesh.dimension


def assemble(body: Body) -> Assembled:
    """Stiffness by dolfinx, loads, supports and rigid motions of a body.

    A body that its supports let float is held at as many degrees of freedom as it has rigid motions left, and these
    motions become unknowns without load: the reactions of such pins vanish in equilibrium.
    """
    keep_freed_memory()  # here, because whatever is large follows from a stiffness
    d = body.mesh.dimension
    points = body.mesh.points[:, :d]
    stiffness, load = _stiffness_and_load(body)
    held = np.zeros(points.shape, dtype=bool)
    for support in body.supports:
        nodes = np.unique(body.mesh.facets[support.group])
        for letter in support.directions[:d] if support.directions == "xyz" else support.directions:
            held[nodes, "xyz".index(letter)] = True
    if body.rigid:
        motions = _coupled_motions(body, body.rigid, held)
        held[np.unique(body.mesh.facets[body.rigid.group])] = True
    else:
        motions = _floating_motions(points, held)
    resultant = np.einsum("ndr,nd->r", motions.shapes, load.reshape(points.shape))
    return Assembled(
        body, stiffness, held.ravel(), load, RigidMotions(motions.shapes, motions.load + resultant, motions.value)
    )


def _stiffness_and_load(body: Body) -> tuple[sp.csr_matrix, Floats]:
    mesh = compat.create_mesh(body.mesh.points, body.mesh.cells, body.mesh.shape, body.mesh.order)
    space = compat.vector_space(mesh, body.mesh.order)
    blocks = compat.node_dofs(space, mesh, len(body.mesh.points))
    if np.any(blocks < 0):
        raise ValueError(f"{body.name}: wanted every mesh node in a cell, found {np.sum(blocks < 0)} loose nodes")
    d = body.mesh.dimension
    order = (d * blocks[:, None] + np.arange(d)).ravel()
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    λ, μ = (compat.constant(mesh, float(value)) for value in body.material.lame)
    dx = ufl.Measure("dx", domain=mesh, metadata={"quadrature_degree": 2 * body.mesh.order})
    ε = ufl.sym(ufl.grad(u))
    form = ufl.inner(λ * ufl.tr(ε) * ufl.Identity(d) + 2 * μ * ε, ufl.sym(ufl.grad(v))) * dx
    stiffness = cast(sp.csr_matrix, compat.assemble_csr(form)[order][:, order].tocsr())
    stiffness.eliminate_zeros()  # sums drop them too, and who compares patterns must not be misled
    return stiffness, _load(body, mesh, v)[order] if body.loads else np.zeros(len(order))


def _load(body: Body, mesh: object, v: object) -> Floats:
    total: Floats | None = None
    degree = {"quadrature_degree": 2 * body.mesh.order + 2}
    for traction in body.loads:
        tags = compat.facet_tags(mesh, [body.mesh.facets[traction.group]])
        ds = ufl.Measure("ds", domain=mesh, subdomain_data=tags, metadata=degree)
        t = compat.constant(mesh, tuple(float(x) for x in traction.vector[: body.mesh.dimension]))
        part = compat.assemble_array(ufl.inner(t, v) * ds(1))
        total = part if total is None else total + part
    assert total is not None
    return total


def _coupled_motions(body: Body, rigid: Rigid, held: np.ndarray) -> RigidMotions:
    d = body.mesh.dimension
    shapes = rigid_modes(body.mesh.points[:, :d] - np.asarray(rigid.centre)[:d])
    names = DIRECTIONS[d]
    for freedom in rigid.freedoms:
        if freedom.direction not in names:
            raise ValueError(f"{body.name}: wanted a rigid motion of {', '.join(names)}, found {freedom.direction!r}")
    chosen = shapes[:, :, [names.index(f.direction) for f in rigid.freedoms]]
    if held.any() and np.abs(chosen[held]).max(initial=0.0) > 1e-12 * np.abs(shapes).max():
        raise ValueError(
            f"{body.name}: wanted supports that allow the rigid motions of {rigid.group!r}; free them there"
        )
    nan = float("nan")
    return RigidMotions(
        chosen,
        np.array([nan if f.load is None else f.load for f in rigid.freedoms]),
        np.array([nan if f.displacement is None else f.displacement for f in rigid.freedoms]),
    )


def _floating_motions(points: Floats, held: np.ndarray) -> RigidMotions:
    """What the supports leave free; pins one degree of freedom a motion in `held`."""
    shapes = rigid_modes(points - points.mean(axis=0))
    n, d, r = shapes.shape
    scale = 1.0 / np.linalg.norm(shapes.reshape(n * d, r), axis=0)
    basis = np.eye(r) if not held.any() else la.null_space(shapes[held] * scale, rcond=1e-10)
    shapes = (shapes.reshape(n * d, r) * scale) @ basis * np.sqrt(n)
    if shapes.shape[1]:
        pins = la.qr(shapes.T, pivoting=True, mode="r")[1][: shapes.shape[1]]
        held.reshape(-1)[pins] = True
    count = shapes.shape[1]
    return RigidMotions(shapes.reshape(n, d, count), np.zeros(count), np.full(count, np.nan))
