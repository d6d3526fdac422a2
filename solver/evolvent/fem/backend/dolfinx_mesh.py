"""Meshes of dolfinx as bodies, and displacements of bodies as functions of dolfinx."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from evolvent.fem.backend.dolfinx_compat import (
    Mesh,
    Space,
    create_mesh,
    dolfinx,
    facet_indices,
    fem,
    geometry_dofmap,
    gmsh_permutation,
    input_nodes,
    node_dofs,
    vector_space,
)
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.input_checks import Words, instance, is_index, refuse
from evolvent_meshes.mesh.mesh_data import CELL_DIMENSION, MeshData
from evolvent_meshes.mesh.quality import least_determinants
from evolvent_meshes.mesh.reference_cells import facet_nodes, mirrored_nodes, node_count

FacetTags = Any  # dolfinx.mesh.MeshTags, which has another name in each version
Function = Any  # dolfinx.fem.Function

WHAT = "mesh_from_dolfinx"


@dataclass(frozen=True)
class DolfinxMesh(MeshData):
    """A mesh that was made with dolfinx.

    origin: the mesh of the caller; node i of this mesh is row i of origin.geometry.x.
    """

    origin: Mesh = field(repr=False)


@dataclass(frozen=True)
class NodalSpace:
    """Vector Lagrange space with the order of a mesh: one vector at each of its N nodes.

    space: of dolfinx.
    blocks: (N,) block of degrees of freedom of the space at each node.
    """

    space: Space
    blocks: Ints

    def function(self, values: Floats, name: str) -> Function:
        """The function with these values (N, d) at the nodes.

        name: of the function, in files and plots.
        """
        function = fem.Function(self.space, name=name)
        function.x.array.reshape(values.shape)[self.blocks] = values
        return function


def nodal_space(mesh: MeshData) -> NodalSpace:
    """The space on the caller's mesh if `mesh` was made by `mesh_from_dolfinx`, else on a dolfinx mesh of its own.

    Every node must belong to a cell. Raises CompileError and CacheError.
    """
    if isinstance(mesh, DolfinxMesh):
        space = vector_space(mesh.origin, mesh.order)
        return NodalSpace(space, node_dofs(space, mesh.origin)[input_nodes(mesh.origin)])
    made = create_mesh(mesh.points, mesh.cells, mesh.shape, mesh.order)
    space = vector_space(made, mesh.order)
    return NodalSpace(space, node_dofs(space, made, len(mesh.points)))


def mesh_from_dolfinx(mesh: Mesh, facet_tags: FacetTags, names: Mapping[str, int]) -> MeshData:
    """The mesh of a body, from a mesh of dolfinx with tagged facets; lengths are in mm.

    mesh: a dolfinx.mesh.Mesh of triangles, quadrilaterals, tetrahedra or hexahedra, order 1 or 2, on one process. Under
        mpirun every rank may have a mesh of its own on MPI.COMM_SELF.
    facet_tags: dolfinx.mesh.MeshTags of its facets.
    names: name of a facet group -> tag of its facets.

    Nodes have the numbers of the rows of mesh.geometry.x; facets without a name are in no group. Cells that are
    numbered clockwise, or left-handed in 3D, are turned over. `Solution.function` returns functions on `mesh`.
    Raises InputError.

    >>> import dolfinx, numpy
    >>> from mpi4py import MPI
    >>> square = dolfinx.mesh.create_unit_square(MPI.COMM_SELF, 2, 2)
    >>> top = dolfinx.mesh.locate_entities_boundary(square, 1, lambda x: x[1] > 1.0 - 1e-9)
    >>> tags = dolfinx.mesh.meshtags(square, 1, top, numpy.full(len(top), 3, dtype=numpy.int32))
    >>> mesh = mesh_from_dolfinx(square, tags, {"top": 3})
    >>> mesh.shape, len(mesh.cells), len(mesh.facets["top"])
    ('triangle', 8, 2)
    """
    instance(f"{WHAT}, mesh", mesh, dolfinx.mesh.Mesh, "give a dolfinx.mesh.Mesh; read_msh(path) reads gmsh files")
    if mesh.comm.size > 1:
        refuse(
            f"{WHAT}, mesh", "a mesh on one process", Words(f"one that is distributed over {mesh.comm.size} ranks"),
            "make it on MPI.COMM_SELF instead of MPI.COMM_WORLD; each rank may have a mesh of its own",
        )
    shape, order = _cell_kind(mesh)
    _check_tags(mesh, facet_tags)
    cells = geometry_dofmap(mesh)
    cells = np.ascontiguousarray(cells[:, np.argsort(gmsh_permutation(shape, cells.shape[1]))])
    points = np.array(mesh.geometry.x, dtype=np.float64)
    plain = _turned_over(MeshData(points, shape, order, cells, {}, {"body": np.arange(len(cells))}))
    facets = _facet_groups(mesh, plain, facet_tags, names)
    return DolfinxMesh(plain.points, shape, order, plain.cells, facets, plain.volumes, mesh)


def _cell_kind(mesh: Mesh) -> tuple[str, int]:
    """Shape and order of the cells. Raises InputError where a body cannot have them."""
    shape, nodes = mesh.topology.cell_name(), geometry_dofmap(mesh).shape[1]
    orders = {node_count(shape, order): order for order in (1, 2)} if shape in CELL_DIMENSION else {}
    if nodes not in orders:
        kinds = ", ".join(CELL_DIMENSION)
        found = Words(f"{shape} cells of {nodes} nodes")
        refuse(f"{WHAT}, mesh", f"cells of order 1 or 2 out of {kinds}", found, "mesh the body with these")
    if mesh.geometry.dim != CELL_DIMENSION[shape]:
        found = Words(f"{shape} cells in {mesh.geometry.dim}D")
        refuse(f"{WHAT}, mesh", "plane cells in 2D, solid ones in 3D", found, "give as many coordinates (gdim=2)")
    return shape, orders[nodes]


def _check_tags(mesh: Mesh, facet_tags: FacetTags) -> None:
    """Raises InputError for anything but tags of the mesh's facets."""
    what, d = f"{WHAT}, facet_tags", mesh.topology.dim - 1
    if not all(hasattr(facet_tags, name) for name in ("dim", "indices", "values")):
        refuse(what, "a dolfinx.mesh.MeshTags", facet_tags, "dolfinx.mesh.meshtags makes one")
    if facet_tags.dim != d:
        found = Words(f"tags of entities of dimension {facet_tags.dim}")
        refuse(what, f"tags of facets, which have dimension {d} here", found, f"write meshtags(mesh, {d}, ...)")
    # tags have their mesh until dolfinx 0.5, its topology since
    tagged = facet_tags.topology if hasattr(facet_tags, "topology") else facet_tags.mesh.topology
    theirs, ours = (topology.connectivity(d + 1, 0).array for topology in (tagged, mesh.topology))
    if not np.array_equal(theirs, ours):
        refuse(what, "tags of this mesh", Words("those of another one"), "tag the facets of the mesh that is given")


def _turned_over(mesh: MeshData) -> MeshData:
    """The mesh with mirrored numbering in cells whose Jacobian is negative, which dolfinx allows."""
    cells, wrong = mesh.cells.copy(), least_determinants(mesh) < 0.0
    cells[wrong] = cells[wrong][:, mirrored_nodes(mesh.shape, mesh.order)]
    return replace(mesh, cells=cells)


def _facet_groups(mesh: Mesh, plain: MeshData, facet_tags: FacetTags, names: Mapping[str, int]) -> dict[str, Ints]:
    """Name -> facets (n_f, k) with its tag, in the node order of gmsh. Raises InputError for a tag of no facet."""
    what = f"{WHAT}, names"
    if not isinstance(names, Mapping) or not all(isinstance(n, str) and is_index(tag) for n, tag in names.items()):
        refuse(what, "a dictionary of names and integer tags", names, 'write {"top": 3}')
    rows = plain.cells[:, facet_nodes(plain.shape, plain.order)]
    rows = rows.reshape(-1, rows.shape[2])
    number = facet_indices(mesh, input_nodes(mesh)[rows])  # each facet inside the body is in two rows
    row_of = np.empty(number.max() + 1, dtype=np.int64)
    row_of[number] = np.arange(len(rows))
    groups = {}
    for name, tag in names.items():
        tagged = facet_tags.indices[facet_tags.values == tag]
        if not len(tagged):
            known = ", ".join(map(str, np.unique(facet_tags.values).tolist())) or "(there are none)"
            refuse(what, f"one of the tags {known}", Words(f"{name!r}: {tag}"), "name a tag that facets have")
        groups[name] = rows[row_of[tagged]]
    return groups
