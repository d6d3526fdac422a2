"""Interface to dolfinx: every cell shape and order, against exact volumes, energies and forces."""

from __future__ import annotations

import itertools
import multiprocessing
import signal
from multiprocessing.context import SpawnContext
from multiprocessing.queues import Queue
from pathlib import Path

import gmsh
import numpy as np
import pytest
import ufl

from evolvent.fem.backend import dolfinx_compat, form_compiler
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import CELL_DIMENSION

SHAPES = [(shape, order) for shape in CELL_DIMENSION for order in (1, 2)]
SIZE = (2.0, 3.0, 5.0)
ELEMENT_TYPE = {
    ("triangle", 1): 2, ("triangle", 2): 9, ("quadrilateral", 1): 3, ("quadrilateral", 2): 10,
    ("tetrahedron", 1): 4, ("tetrahedron", 2): 11, ("hexahedron", 1): 5, ("hexahedron", 2): 12,
}
FACET_TYPE = {
    ("triangle", 1): 1, ("triangle", 2): 8, ("quadrilateral", 1): 1, ("quadrilateral", 2): 8,
    ("tetrahedron", 1): 2, ("tetrahedron", 2): 9, ("hexahedron", 1): 3, ("hexahedron", 2): 10,
}
Block = tuple[str, int, Floats, Ints, Ints]
"""shape, order, points, cells, facets at x = 0."""


@pytest.fixture(scope="module", params=SHAPES, ids=[f"{shape}{order}" for shape, order in SHAPES])
def block(request: pytest.FixtureRequest) -> Block:
    """A box with one corner at the origin, meshed by gmsh: (shape, order, points, cells, facets at x = 0)."""
    shape, order = request.param
    gmsh.initialize(interruptible=False)
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # as Python has it: other tests write to closed pipes
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        _model(CELL_DIMENSION[shape], recombine=shape in ("quadrilateral", "hexahedron"))
        gmsh.model.mesh.generate(CELL_DIMENSION[shape])
        gmsh.model.mesh.setOrder(order)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        number = np.zeros(int(tags.max()) + 1, dtype=np.int64)
        number[tags.astype(np.int64)] = np.arange(len(tags))
        cells = _connectivity(ELEMENT_TYPE[shape, order], number)
        boundary = _connectivity(FACET_TYPE[shape, order], number)
    finally:
        gmsh.finalize()
    points = coordinates.reshape(-1, 3)
    at_zero = np.all(np.abs(points[boundary, 0]) < 1e-12, axis=1)
    return shape, order, points, cells, boundary[at_zero]


def _model(dimension: int, recombine: bool) -> None:
    base = gmsh.model.occ.addRectangle(0, 0, 0, SIZE[0], SIZE[1])
    if dimension == 3:
        layers = [2] if recombine else []
        gmsh.model.occ.extrude([(2, base)], 0, 0, SIZE[2], numElements=layers, recombine=recombine)
    gmsh.model.occ.synchronize()
    if recombine:
        gmsh.model.mesh.setTransfiniteSurface(base)
        gmsh.model.mesh.setRecombine(2, base)
        for _, curve in gmsh.model.getBoundary([(2, base)], oriented=False):
            gmsh.model.mesh.setTransfiniteCurve(curve, 4)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1.2)


def _connectivity(element_type: int, number: Ints) -> Ints:
    _, nodes = gmsh.model.mesh.getElementsByType(element_type)
    per_element = gmsh.model.mesh.getElementProperties(element_type)[3]
    return number[nodes.astype(np.int64)].reshape(-1, per_element)


def _measure(dimension: int) -> float:
    return float(np.prod(SIZE[:dimension]))


def test_volume_of_a_box_and_the_mapping_of_its_cells(block: Block) -> None:
    """The cells of a 2 x 3 (x 5) mm box add up to 6 mm² (30 mm³), and dolfinx's cells are the caller's, renumbered."""
    shape, order, points, cells, _ = block
    mesh = dolfinx_compat.create_mesh(points, cells, shape, order)
    dimension = CELL_DIMENSION[shape]
    assert mesh.geometry.dim == dimension and mesh.topology.dim == dimension
    volume = dolfinx_compat.assemble_number(1.0 * ufl.dx(domain=mesh, metadata={"quadrature_degree": 4}))
    assert volume == pytest.approx(_measure(dimension), rel=1e-12)
    renumbered = cells[dolfinx_compat.input_cells(mesh)]
    assert np.array_equal(np.sort(renumbered, axis=1), np.sort(dolfinx_compat.cell_nodes(mesh), axis=1))
    assert np.allclose(points[dolfinx_compat.input_nodes(mesh)], mesh.geometry.x, atol=1e-14)


def test_linear_displacement_is_a_patch(block: Block) -> None:
    """u = A x with stress 2µ sym A + λ tr A I (µ = λ = 1): K u is zero at inner nodes, and uᵀK u = σ : ε · volume.

    u is written through node_dofs, so a wrong node map or a wrong permutation of mid nodes fails it.
    """
    shape, order, points, cells, _ = block
    dimension = CELL_DIMENSION[shape]
    mesh = dolfinx_compat.create_mesh(points, cells, shape, order)
    space = dolfinx_compat.vector_space(mesh, order)
    blocks = dolfinx_compat.node_dofs(space, mesh, len(points))
    stiffness = dolfinx_compat.assemble_csr(_elasticity(space))
    gradient = np.array([[1.0, 0.3, -0.2], [0.5, -0.7, 0.4], [0.1, -0.6, 0.9]])[:dimension, :dimension]
    used = np.unique(cells)
    assert np.array_equal(np.sort(blocks[used]), np.arange(len(used)))
    u = np.zeros((len(used), dimension))
    u[blocks[used]] = points[used, :dimension] @ gradient.T
    force = (stiffness @ u.ravel()).reshape(-1, dimension)
    strain = (gradient + gradient.T) / 2
    energy = (2 * np.sum(strain**2) + np.trace(strain) ** 2) * _measure(dimension)
    assert u.ravel() @ force.ravel() == pytest.approx(energy, rel=1e-11)
    size = np.array(SIZE[:dimension])
    inner = np.all((points[used, :dimension] > 1e-9) & (points[used, :dimension] < size - 1e-9), axis=1)
    assert np.abs(force[blocks[used[inner]]]).max(initial=0.0) < 1e-12 * np.abs(stiffness.data).max()


def _elasticity(space: dolfinx_compat.Space) -> dolfinx_compat.Form:
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    strain_u, strain_v = ufl.sym(ufl.grad(u)), ufl.sym(ufl.grad(v))
    stress = 2 * strain_u + ufl.tr(strain_u) * ufl.Identity(len(u))
    return ufl.inner(stress, strain_v) * ufl.dx(metadata={"quadrature_degree": 4})


def test_traction_on_a_named_facet_group(block: Block) -> None:
    """Unit traction along +x on the side x = 0: the nodal forces sum to its length 3 mm (area 15 mm²), about y = 1.5.

    The facets come in the caller's node numbers.
    """
    shape, order, points, cells, facets = block
    dimension = CELL_DIMENSION[shape]
    mesh = dolfinx_compat.create_mesh(points, cells, shape, order)
    space = dolfinx_compat.vector_space(mesh, order)
    tags = dolfinx_compat.facet_tags(mesh, [facets])
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=tags, metadata={"quadrature_degree": 4})
    force = dolfinx_compat.assemble_array(ufl.TestFunction(space)[0] * ds(1)).reshape(-1, dimension)
    area = _measure(dimension) / SIZE[0]
    assert force.sum(axis=0) == pytest.approx([area] + [0.0] * (dimension - 1), abs=1e-11)
    nodal = force[dolfinx_compat.node_dofs(space, mesh)[np.unique(facets)]]
    assert nodal[:, 0].sum() == pytest.approx(area, rel=1e-12)
    moment = points[np.unique(facets), 1] @ nodal[:, 0]
    assert moment == pytest.approx(area * SIZE[1] / 2, rel=1e-11)


def test_first_order_space_on_a_second_order_mesh(block: Block) -> None:
    """Corner nodes have blocks, mid nodes have none; as many blocks as corners."""
    shape, order, points, cells, _ = block
    mesh = dolfinx_compat.create_mesh(points, cells, shape, order)
    blocks = dolfinx_compat.node_dofs(dolfinx_compat.vector_space(mesh, 1), mesh, len(points))
    corners = np.unique(cells[:, : {"triangle": 3, "quadrilateral": 4, "tetrahedron": 4, "hexahedron": 8}[shape]])
    assert np.array_equal(np.flatnonzero(blocks >= 0), corners)
    assert np.array_equal(np.sort(blocks[corners]), np.arange(len(corners)))


def test_space_of_higher_order_than_the_mesh_is_refused() -> None:
    """Second order on straight triangles has blocks at no node of the caller: an error, not a wrong map."""
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    mesh = dolfinx_compat.create_mesh(points, np.array([[0, 1, 2]]), "triangle", 1)
    with pytest.raises(ValueError, match="wanted at most"):
        dolfinx_compat.node_dofs(dolfinx_compat.vector_space(mesh, 2), mesh)


def test_unknown_facet_is_refused(block: Block) -> None:
    """The nodes of one facet with one of them exchanged for a node on the far side form no facet."""
    shape, order, points, cells, facets = block
    mesh = dolfinx_compat.create_mesh(points, cells, shape, order)
    wrong = facets[:1].copy()
    wrong[0, 0] = np.argmax(points[:, 0])
    with pytest.raises(ValueError, match="of no facet"):
        dolfinx_compat.facet_indices(mesh, wrong)


def test_unused_nodes_have_no_block() -> None:
    """A node that no cell uses (gmsh leaves centres of arcs behind) gets block -1, the others stay right."""
    points = np.array([[9.0, 9.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    mesh = dolfinx_compat.create_mesh(points, np.array([[1, 2, 3]]), "triangle", 1)
    blocks = dolfinx_compat.node_dofs(dolfinx_compat.vector_space(mesh, 1), mesh, 4)
    assert blocks[0] == -1 and sorted(blocks[1:]) == [0, 1, 2]


@pytest.mark.parametrize(
    ("cells", "shape", "order", "message"),
    [
        (np.zeros((1, 6), dtype=np.int64), "prism", 1, "wanted cells of shape triangle"),
        (np.zeros((1, 20), dtype=np.int64), "hexahedron", 2, r"wanted integers \(n, 27\)"),
        (np.zeros((1, 10), dtype=np.int64), "triangle", 3, "wanted cells of order 1 or 2"),
    ],
)
def test_wrong_cells_are_refused(cells: Ints, shape: str, order: int, message: str) -> None:
    """Prisms, serendipity cells and third order each name what was wanted."""
    with pytest.raises(ValueError, match=message):
        dolfinx_compat.create_mesh(np.zeros((27, 3)), cells, shape, order)


def _compile_in_a_child(directory: Path, queue: Queue[float]) -> None:
    # the spawned child's own copies
    form_compiler.form_directory = dolfinx_compat.form_directory = lambda version: directory
    points = np.array(list(itertools.product((0.0, 1.0), repeat=2)))
    mesh = dolfinx_compat.create_mesh(np.c_[points, np.zeros(4)], np.array([[0, 2, 3, 1]]), "quadrilateral", 1)
    x = ufl.SpatialCoordinate(mesh)
    queue.put(dolfinx_compat.assemble_number(3 * x[0] * x[1] ** 3 * ufl.dx))


def test_forms_compile_after_a_kill_and_in_two_processes(tmp_path: Path) -> None:
    """∫ 3 x y³ over the unit square is 3/8 in two processes at once, though a killed run left half a form behind.

    FFCx alone would wait 10 s for the dead compiler and give up.
    """
    context = multiprocessing.get_context("spawn")
    queue = context.Queue()
    _run_children(context, tmp_path, queue)
    sources = list(tmp_path.glob("*.c"))
    assert sources
    for source in sources:
        source.with_suffix(".c.cached").unlink()
    _run_children(context, tmp_path, queue)


def _run_children(context: SpawnContext, directory: Path, queue: Queue[float]) -> None:
    children = [context.Process(target=_compile_in_a_child, args=(directory, queue)) for _ in range(2)]
    for child in children:
        child.start()
    values = [queue.get(timeout=60) for _ in children]
    for child in children:
        child.join(timeout=60)
    assert values == pytest.approx([3 / 8, 3 / 8], rel=1e-12)


def test_versions_name_what_is_installed() -> None:
    """The solver's libraries are named, each with a number."""
    versions = dolfinx_compat.versions()
    for name in ("python", "dolfinx", "petsc", "numpy", "scipy", "gmsh"):
        assert versions[name][:1].isdigit(), (name, versions[name])
