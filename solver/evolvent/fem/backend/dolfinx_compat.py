"""Interface to dolfinx, versions 0.5.2 (Debian 12) to 0.9.0 (Debian 13) and later; only this room depends on them.

Versions are distinguished by the names of functions and arguments, not by numbers. Each body is meshed and assembled on
one process (MPI.COMM_SELF). dolfinx renumbers nodes and cells; the functions here take and give the caller's numbers.
"""

from __future__ import annotations

import inspect
import logging
import platform
from collections.abc import Callable
from importlib import import_module, metadata
from importlib.util import find_spec
from typing import Any

import numpy as np
import scipy.sparse as sp
import ufl
from mpi4py import MPI
from numpy.typing import NDArray

from evolvent.fem.backend.foreign_settings import importing
from evolvent.fem.backend.form_compiler import compiling, form_directory, logging_kept
from evolvent.fem.backend.petsc import PETSc  # before dolfinx, which would start it
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import CELL_DIMENSION, MeshData, MeshError
from evolvent_meshes.mesh.reference_cells import node_count
from evolvent_meshes.mesh.soundness import check_cells

with logging_kept(), importing():  # FFCx adds a handler to the root logger and captures warnings
    import dolfinx
    import dolfinx.fem.petsc
    from dolfinx import cpp, fem

Mesh = Any  # dolfinx and UFL carry no usable type hints in 0.5.2
Space = Any
Form = Any

JIT_SECONDS = 1  # [s] FFCx waits so long for the compilation of another process; the lock of `compiling` leaves none


def create_mesh(points: Floats, cells: Ints, shape: str, order: int) -> Mesh:
    """The dolfinx mesh of one body, on this process alone.

    points: (n, 3) [mm]; in 2D only x and y are used.
    cells: (n_c, k) node indices of complete Lagrange cells in the order of gmsh (tri3/6, quad4/9, tet4/10, hex8/27).
    shape: "triangle", "quadrilateral", "tetrahedron" or "hexahedron".
    order: 1 or 2.
    Raises MeshError for input that is inconsistent, see `evolvent_meshes.mesh.soundness.check_cells`.
    """
    check_cells(points, cells, shape, order, "mesh")
    dimension = CELL_DIMENSION[shape]
    permuted = np.ascontiguousarray(cells[:, gmsh_permutation(shape, node_count(shape, order))], dtype=np.int64)
    coordinates = np.ascontiguousarray(points[:, :dimension], dtype=np.float64)
    domain = _coordinate_domain(shape, order, dimension)
    # the argument of the coordinate element has two names and two positions
    name = _first_parameter(dolfinx.mesh.create_mesh, "domain", "e")
    mesh = dolfinx.mesh.create_mesh(MPI.COMM_SELF, cells=permuted, x=coordinates, **{name: domain})
    mesh.topology.create_connectivity(dimension - 1, dimension)
    return mesh


def gmsh_permutation(shape: str, count: int) -> Ints:
    """Permutation (count,): cells[:, perm] have the node order of basix where cells of `count` nodes have gmsh's."""
    return np.asarray(cpp.io.perm_gmsh(getattr(cpp.mesh.CellType, shape), count), dtype=np.int64)


def vector_space(mesh: Mesh, order: int) -> Space:
    """Space of continuous Lagrange displacements, one vector of the mesh's dimension at each node."""
    dimension = mesh.geometry.dim
    with compiling(dolfinx.__version__):
        if hasattr(fem, "functionspace"):
            return fem.functionspace(mesh, ("Lagrange", order, (dimension,)), **_compiler_options(fem.functionspace))
        element = ufl.VectorElement("Lagrange", mesh.ufl_cell(), order)
        return fem.FunctionSpace(mesh, element, **_compiler_options(fem.FunctionSpace.__init__))


def displacement_space(mesh: MeshData) -> tuple[Mesh, Space, Ints]:
    """Mesh of dolfinx and space of the displacements of a body with N nodes, and where each of the degrees of freedom
    d·node + component is among those of the space, (N·d,)."""
    made = create_mesh(mesh.points, mesh.cells, mesh.shape, mesh.order)
    space, d = vector_space(made, mesh.order), mesh.dimension
    return made, space, (d * node_dofs(space, made, len(mesh.points))[:, None] + np.arange(d)).ravel()


def input_nodes(mesh: Mesh) -> Ints:
    """Node number of the caller (n_g,) for each geometry node of dolfinx (row of mesh.geometry.x)."""
    return np.asarray(mesh.geometry.input_global_indices, dtype=np.int64)


def input_cells(mesh: Mesh) -> Ints:
    """Cell number of the caller (n_c,) for each cell of dolfinx."""
    return np.asarray(mesh.topology.original_cell_index, dtype=np.int64)


def cell_nodes(mesh: Mesh) -> Ints:
    """Node numbers of the caller (n_c, k) for the cells of dolfinx, in the node order of basix."""
    return input_nodes(mesh)[geometry_dofmap(mesh)]


def node_dofs(space: Space, mesh: Mesh, n_nodes: int | None = None) -> Ints:
    """Block (n_nodes,) of `space` at each node of the caller, -1 where there is none.

    The degrees of freedom of a node are dimension * block + component. Nodes of no cell have no block, nor have the
    mid-side nodes of a second-order mesh in a first-order space.

    n_nodes: number of the caller's nodes (default: up to the last one used).
    Raises ValueError if the space has blocks where the mesh has no node.
    """
    blocks = _rows(space.dofmap.list, _n_cells(mesh))
    nodes = cell_nodes(mesh)
    if blocks.shape[1] > nodes.shape[1]:
        raise ValueError(f"space: wanted at most the mesh's {nodes.shape[1]} nodes a cell, found {blocks.shape[1]}")
    count = int(nodes.max()) + 1 if n_nodes is None else n_nodes
    result = np.full(count, -1, dtype=np.int64)
    # basix numbers vertices, then edges, then the interior: the nodes of a lower order come first
    result[nodes[:, : blocks.shape[1]]] = blocks
    return result


def facet_indices(mesh: Mesh, facets: Ints) -> NDArray[np.int32]:
    """Facet numbers of dolfinx (n_f,).

    facets: (n_f, k) node numbers of the caller in the order of gmsh, corners first.
    Raises MeshError if one of them is not a facet of any cell.
    """
    corners = _facet_corners(mesh)
    wanted = np.sort(facets[:, : corners.shape[1]], axis=1)
    both, inverse = np.unique(np.vstack([corners, wanted]), axis=0, return_inverse=True)
    inverse = inverse.reshape(-1)  # NumPy 2.0 gave it a second axis
    of_row = np.full(len(both), -1, dtype=np.int32)
    of_row[inverse[: len(corners)]] = np.arange(len(corners), dtype=np.int32)
    indices = of_row[inverse[len(corners) :]]
    if np.any(indices < 0):
        missing = facets[np.argmax(indices < 0)]
        raise MeshError(
            f"facets: wanted facets of the mesh's cells, found nodes {missing.tolist()} of no facet; mesh the "
            "boundary together with the volume"
        )
    return indices


def facet_tags(mesh: Mesh, groups: list[Ints]) -> Any:
    """Mesh tags for ufl.Measure("ds", subdomain_data=...): the facets of groups[i] have the tag i + 1.

    groups: facets (n_f, k) each, as for `facet_indices`; a facet of two groups has the tag of the later one.
    Raises MeshError if one of them is not a facet of any cell.
    """
    tags = np.zeros(len(_facet_corners(mesh)), dtype=np.int32)
    for tag, group in enumerate(groups, start=1):
        tags[facet_indices(mesh, group)] = tag
    tagged = np.flatnonzero(tags).astype(np.int32)
    return dolfinx.mesh.meshtags(mesh, mesh.topology.dim - 1, tagged, tags[tagged])


def compile_form(form: Form) -> Form:
    """A UFL form compiled by FFCx; processes may compile the same form at once, or be killed while they do.

    Raises CompileError and CacheError where it cannot be compiled or stored.
    """
    with compiling(dolfinx.__version__):
        return fem.form(form, **_compiler_options(fem.form))


def assemble_csr(form: Form) -> sp.csr_matrix:
    """Matrix (n_dofs, n_dofs) of a bilinear UFL form without boundary conditions. Raises as `compile_form`."""
    compiled = compile_form(form)
    # adding the entries of a cell takes half as long by blocks of a node's components as by single rows
    matrix = dolfinx.fem.petsc.create_matrix(compiled, "baij")
    dolfinx.fem.petsc.assemble_matrix(matrix, compiled)
    matrix.assemble()
    indptr, indices, data = matrix.getValuesCSR()
    result = sp.csr_matrix((data, indices, indptr), shape=matrix.getSize())
    matrix.destroy()
    return result


def assemble_array(form: Form) -> Floats:
    """Vector (n_dofs,) of a linear UFL form. Raises as `compile_form`."""
    vector = fem.assemble_vector(compile_form(form))
    return np.array(vector.array, dtype=np.float64)


def assemble_number(form: Form) -> float:
    """Value of a UFL functional. Raises as `compile_form`."""
    return float(fem.assemble_scalar(compile_form(form)))


def constant(mesh: Mesh, value: float | tuple[float, ...]) -> Any:
    """A number or vector in a form, which may change without another compilation."""
    return fem.Constant(mesh, np.asarray(value, dtype=PETSc.ScalarType))


def silence_logs() -> None:
    """Let dolfinx, FFCx and UFL log errors only, not their compilations."""
    dolfinx.log.set_log_level(dolfinx.log.LogLevel.ERROR)
    for name in ("FFCx", "ffcx", "UFL", "UFL_LEGACY", "dolfinx"):
        logging.getLogger(name).setLevel(logging.ERROR)


def versions() -> dict[str, str]:
    """Versions of the programs that a result depends on: name -> version, "" where unknown."""
    distributions = ("numpy", "scipy", "gmsh", "pyvista", "mpi4py")
    packages = {name: _distribution_version(name) for name in distributions}
    return {
        "evolvent": _distribution_version("evolvent"),
        "python": platform.python_version(),
        "dolfinx": dolfinx.__version__,
        "petsc": ".".join(str(number) for number in PETSc.Sys.getVersion()),
        "mpi": MPI.Get_library_version().split(",")[0].strip("\x00\n "),
        **packages,
    }


def _distribution_version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return ""


def _coordinate_domain(shape: str, order: int, dimension: int) -> Any:
    if hasattr(ufl, "VectorElement"):  # UFL until 2022, before basix.ufl
        cell = ufl.Cell(shape, geometric_dimension=dimension)
        scalar = ufl.FiniteElement("Lagrange", cell, order, variant="equispaced")
        return ufl.Mesh(ufl.VectorElement(scalar, dim=dimension))
    import basix.ufl

    element = basix.ufl.element(
        "Lagrange", shape, order, shape=(dimension,), lagrange_variant=basix.LagrangeVariant.equispaced
    )
    return ufl.Mesh(element)


def _first_parameter(function: Callable[..., Any], *names: str) -> str:
    """The one of these parameter names that the installed dolfinx uses. Raises RuntimeError where there is none."""
    known = inspect.signature(function).parameters
    for name in names:
        if name in known:
            return name
    raise RuntimeError(
        f"dolfinx {dolfinx.__version__}: {function.__name__} wanted with one of the arguments {', '.join(names)}, "
        f"found {', '.join(known)}; evolvent.fem.backend.dolfinx_compat has to be adapted to this version"
    )


def _rows(table: Any, n_cells: int) -> Ints:
    """A dofmap (n_cells, k): an array since dolfinx 0.7, an adjacency list before."""
    return np.asarray(getattr(table, "array", table), dtype=np.int64).reshape(n_cells, -1)


def _n_cells(mesh: Mesh) -> int:
    return int(mesh.topology.index_map(mesh.topology.dim).size_local)


def geometry_dofmap(mesh: Mesh) -> Ints:
    """Rows of mesh.geometry.x (n_c, k) that are the nodes of dolfinx's cells, in the node order of basix."""
    return _rows(mesh.geometry.dofmap, _n_cells(mesh))


def _facet_corners(mesh: Mesh) -> Ints:
    """Corner nodes of the caller (n_facets, corners) for all facets of dolfinx, each row sorted."""
    topology = mesh.topology
    topology.create_connectivity(topology.dim - 1, 0)
    cell_vertices = _rows(topology.connectivity(topology.dim, 0), _n_cells(mesh))
    node_of_vertex = np.zeros(topology.index_map(0).size_local, dtype=np.int64)
    node_of_vertex[cell_vertices] = cell_nodes(mesh)[:, : cell_vertices.shape[1]]
    n_facets = topology.index_map(topology.dim - 1).size_local
    return np.sort(node_of_vertex[_rows(topology.connectivity(topology.dim - 1, 0), n_facets)], axis=1)


def _compiler_options(function: Callable[..., Any]) -> dict[str, Any]:
    """Options of a function that compiles: the defaults of the libraries, with our cache folder and timeout.

    All are given: FFCx and dolfinx read others from files in the current folder and in ~/.config, which belong to other
    programs.
    """
    jit = _defaults("dolfinx.jit", "DOLFINX_DEFAULT_JIT_OPTIONS", "DOLFINX_DEFAULT_JIT_PARAMETERS")
    ours = {"cache_dir": form_directory(dolfinx.__version__), "timeout": JIT_SECONDS}
    ffcx = _defaults("ffcx", "options.FFCX_DEFAULT_OPTIONS", "parameters.FFCX_DEFAULT_PARAMETERS")
    return {
        _first_parameter(function, "jit_options", "jit_params"): jit | ours,
        _first_parameter(function, "form_compiler_options", "form_compiler_params"): ffcx,
    }


def _defaults(package: str, *names: str) -> dict[str, Any]:
    """Option -> default, from the table of the installed version: (value, help) or (type, value, help, ...).

    Raises RuntimeError where there is no such table.
    """
    for name in names:
        module, _, table = f"{package}.{name}".rpartition(".")
        if (spec := find_spec(module)) and hasattr(loaded := import_module(spec.name), table):
            return {key: entry[0 if len(entry) == 2 else 1] for key, entry in getattr(loaded, table).items()}
    raise RuntimeError(
        f"{package}: wanted one of {', '.join(names)}, found none; "
        "evolvent.fem.backend.dolfinx_compat has to be adapted to this version"
    )
