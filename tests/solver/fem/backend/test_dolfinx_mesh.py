"""Meshes from dolfinx, and functions on them: every cell shape and order, against exact energies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import gmsh
import numpy as np
import pytest
import ufl
from dolfinx import mesh as dolfinx_mesh
from mpi4py import MPI

from evolvent import Body, Fixed, InputError, Material, mesh_from_dolfinx
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.backend.dolfinx_mesh import nodal_space
from evolvent.fem.body import assemble
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import CELL_DIMENSION, MeshData
from evolvent_meshes.shapes.blocks import box, rectangle
from tests.support.running.processes import RunScript

SIZE = (2.0, 3.0, 5.0)
TOP = 7
STEEL = Material(210e3, 0.3)
GRADIENT = np.array([[1.0, 0.3, -0.2], [0.5, -0.7, 0.4], [0.1, -0.6, 0.9]])
CURVATURE = np.array([[0.2, -0.1, 0.3], [0.4, 0.5, -0.6], [-0.3, 0.1, 0.2]])


def first_order(shape: str) -> Any:
    """A box of `SIZE` by dolfinx; its triangles and tetrahedra turn both ways."""
    d = CELL_DIMENSION[shape]
    make = dolfinx_mesh.create_rectangle if d == 2 else dolfinx_mesh.create_box
    kind = getattr(dolfinx_mesh.CellType, shape)
    return make(MPI.COMM_SELF, [np.zeros(d), np.array(SIZE[:d])], [3, 2, 2][:d], kind)


def second_order(shape: str) -> Any:
    """A box of `SIZE` whose nodes dolfinx has numbered anew; cells are those of `evolvent_meshes`, of order 2."""
    flat = shape in ("triangle", "quadrilateral")
    made = rectangle(*SIZE[:2], 3, 2, 2, shape) if flat else box(SIZE, (2, 2, 1), 2, shape)
    return dolfinx_compat.create_mesh(made.points, made.cells, shape, 2)


def tagged_top(mesh: Any, d: int, tag: int = TOP) -> Any:
    """Tags of the facets at the far end of the last axis."""
    facets = dolfinx_mesh.locate_entities_boundary(mesh, d - 1, lambda x: x[d - 1] > SIZE[d - 1] - 1e-9)
    return dolfinx_mesh.meshtags(mesh, d - 1, facets, np.full(len(facets), tag, dtype=np.int32))


def square() -> Any:
    return first_order("triangle")


def displacement(points: Floats, order: int, d: int) -> Floats:
    """u (N, d): u_i = G_ij x_j, of order 2 with C_ij x_j (x_j + x_(j+1)) besides."""
    x = points[:, :d]
    u = x @ GRADIENT[:d, :d].T
    return np.asarray(u + (x * (x + np.roll(x, -1, axis=1))) @ CURVATURE[:d, :d].T if order == 2 else u)


def exact_energy(order: int, d: int) -> float:
    """½ ∫ σ : ε over the box, by a Gauss rule that is exact for it; the strain is linear in x."""
    ξ, w = np.polynomial.legendre.leggauss(2)
    x = np.stack(np.meshgrid(*(size * (1 + ξ) / 2 for size in SIZE[:d]), indexing="ij"), axis=-1).reshape(-1, d)
    weights = np.prod(np.stack(np.meshgrid(*(size * w / 2 for size in SIZE[:d]), indexing="ij")), axis=0).ravel()
    gradient = np.broadcast_to(GRADIENT[:d, :d], (len(x), d, d)).copy()
    for j in range(d if order == 2 else 0):
        k = (j + 1) % d
        gradient[:, :, j] += CURVATURE[:d, j] * (2 * x[:, [j]] + x[:, [k]])
        gradient[:, :, k] += CURVATURE[:d, j] * x[:, [j]]
    ε = (gradient + gradient.transpose(0, 2, 1)) / 2
    λ, μ = STEEL.lame
    return float(weights @ (λ * np.trace(ε, axis1=1, axis2=2) ** 2 / 2 + μ * (ε**2).sum(axis=(1, 2))))


def energy_of(function: Any) -> float:
    """½ ∫ σ : ε of a function over its mesh, by UFL."""
    λ, μ = STEEL.lame
    ε = ufl.sym(ufl.grad(function))
    return dolfinx_compat.assemble_number((λ / 2 * ufl.tr(ε) ** 2 + μ * ufl.inner(ε, ε)) * ufl.dx(degree=4))


@pytest.mark.parametrize("shape", CELL_DIMENSION)
@pytest.mark.parametrize(("order", "make"), [(1, first_order), (2, second_order)])
def test_energy_of_a_displacement_is_exact(shape: str, order: int, make: Callable[[str], Any]) -> None:
    """u linear (order 1) or quadratic (order 2) on a box: ½ uᵀK u of the body, and ½ ∫ σ : ε of the function on the
    caller's mesh, are the integral in closed form.

    Of the cells a wrong node order, and of the function a wrong number of any node, changes both.
    """
    d, theirs = CELL_DIMENSION[shape], make(shape)
    mesh = mesh_from_dolfinx(theirs, tagged_top(theirs, d), {"top": TOP})
    assert (mesh.shape, mesh.order) == (shape, order)
    assert np.array_equal(mesh.points, theirs.geometry.x)
    u, wanted = displacement(mesh.points, order, d), exact_energy(order, d)
    stiffness = assemble(Body(mesh, STEEL, (Fixed("top"),))).stiffness
    assert u.ravel() @ (stiffness @ u.ravel()) / 2 == pytest.approx(wanted, rel=1e-11)
    function = nodal_space(mesh).function(u, "displacement")
    assert energy_of(function) == pytest.approx(wanted, rel=1e-11)
    assert function.function_space.mesh is theirs


@pytest.mark.parametrize("shape", CELL_DIMENSION)
@pytest.mark.parametrize(("order", "make"), [(1, first_order), (2, second_order)])
def test_facets_are_those_with_the_tag(shape: str, order: int, make: Callable[[str], Any]) -> None:
    """All facets of the top and no others, with all of their nodes; one tag may have two names."""
    d, theirs = CELL_DIMENSION[shape], make(shape)
    mesh = mesh_from_dolfinx(theirs, tagged_top(theirs, d), {"top": TOP, "lid": TOP})
    nodes = np.unique(mesh.facets["top"])
    assert np.array_equal(nodes, np.flatnonzero(mesh.points[:, d - 1] > SIZE[d - 1] - 1e-9))
    assert np.array_equal(mesh.facets["top"], mesh.facets["lid"])
    assert len(mesh.facets["top"]) == len(tagged_top(theirs, d).indices)


def test_a_mesh_of_gmsh_by_dolfinx() -> None:
    """A square of order 2 that `dolfinx.io.gmshio` has read, with the tags of its groups: 3 mm at the right."""
    gmshio = pytest.importorskip("dolfinx.io.gmshio")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addRectangle(0, 0, 0, *SIZE[:2])
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1], 1)
        gmsh.model.addPhysicalGroup(1, [2], 5)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        theirs, _, tags = gmshio.model_to_mesh(gmsh.model, MPI.COMM_SELF, 0, gdim=2)
    finally:
        gmsh.finalize()
    mesh = mesh_from_dolfinx(theirs, tags, {"right": 5})
    assert np.all(mesh.points[mesh.facets["right"], 0] == SIZE[0])
    lengths = np.ptp(mesh.points[mesh.facets["right"], 1], axis=1)
    assert lengths.sum() == pytest.approx(SIZE[1], rel=1e-12) and mesh.order == 2


def test_a_body_of_arrays_has_a_function_on_a_mesh_of_its_own() -> None:
    """Quadratic u on a rectangle of `evolvent_meshes`: the energy by UFL is exact."""
    mesh = rectangle(*SIZE[:2], 3, 2, order=2)
    function = nodal_space(mesh).function(displacement(mesh.points, 2, 2), "displacement")
    assert energy_of(function) == pytest.approx(exact_energy(2, 2), rel=1e-11)


def test_a_moved_copy_remembers_the_mesh() -> None:
    """`dataclasses.replace` with other points, as wear does: functions stay on the caller's mesh."""
    theirs = square()
    mesh = mesh_from_dolfinx(theirs, tagged_top(theirs, 2), {"top": TOP})
    moved = replace(mesh, points=mesh.points + 1.0)
    function = nodal_space(moved).function(displacement(mesh.points, 1, 2), "displacement")
    assert energy_of(function) == pytest.approx(exact_energy(1, 2), rel=1e-11)


def tags_of_cells() -> Any:
    cells = np.arange(4, dtype=np.int32)
    return dolfinx_mesh.meshtags(square(), 2, cells, cells)


def interval() -> Any:
    return dolfinx_mesh.create_unit_interval(MPI.COMM_SELF, 3)


def another() -> Any:
    return dolfinx_mesh.create_unit_square(MPI.COMM_SELF, 5, 4)


@pytest.mark.parametrize(
    ("mesh", "tags", "names", "message"),
    [
        (lambda: "square.msh", None, {}, r"wanted a Mesh, found 'square.msh'; give a dolfinx.mesh.Mesh"),
        (interval, None, {}, r"wanted cells of order 1 or 2 out of triangle, .*, found interval cells of 2 nodes"),
        (square, lambda: None, {}, r"facet_tags: wanted a dolfinx.mesh.MeshTags, found None"),
        (square, tags_of_cells, {}, r"wanted tags of facets, which have dimension 1 here, found .* of dimension 2"),
        (square, lambda: tagged_top(another(), 2), {}, r"wanted tags of this mesh, found those of another one"),
        (square, None, {"top": 3}, r"wanted one of the tags 7, found 'top': 3; name a tag that facets have"),
        (square, None, {"top": "7"}, r"wanted a dictionary of names and integer tags"),
        (square, None, {7: 7}, r"wanted a dictionary of names and integer tags"),
        (square, None, ["top"], r"wanted a dictionary of names and integer tags"),
    ],
)
def test_what_is_no_mesh_or_no_tags_is_refused(
    mesh: Callable[[], Any], tags: Callable[[], Any] | None, names: Any, message: str
) -> None:
    """Each names what was wanted and what was found."""
    made = mesh()
    given = tags() if tags else tagged_top(made, 2) if mesh is square else None
    with pytest.raises(InputError, match=message):
        mesh_from_dolfinx(made, given, names)


def test_a_plane_mesh_in_space_is_refused() -> None:
    """Triangles with three coordinates a node are a shell."""
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]])
    if hasattr(ufl, "VectorElement"):
        domain = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell("triangle", geometric_dimension=3), 1))
    else:
        import basix.ufl

        domain = ufl.Mesh(basix.ufl.element("Lagrange", "triangle", 1, shape=(3,)))
    shell = dolfinx_mesh.create_mesh(MPI.COMM_SELF, np.array([[0, 1, 2]]), points, domain)
    with pytest.raises(InputError, match="wanted plane cells in 2D, solid ones in 3D, found triangle cells in 3D"):
        mesh_from_dolfinx(shell, None, {})


ON_TWO_RANKS = """
from mpi4py import MPI
import numpy as np
from dolfinx import mesh as dolfinx_mesh
from evolvent import InputError, mesh_from_dolfinx

def made(comm):
    square = dolfinx_mesh.create_unit_square(comm, 4, 4)
    top = dolfinx_mesh.locate_entities_boundary(square, 1, lambda x: x[1] > 1.0 - 1e-9)
    return square, dolfinx_mesh.meshtags(square, 1, top, np.full(len(top), 3, dtype=np.int32))

try:
    mesh_from_dolfinx(*made(MPI.COMM_WORLD), {"top": 3})
except InputError as error:
    refused = str(error)
own = mesh_from_dolfinx(*made(MPI.COMM_SELF), {"top": 3})
said = MPI.COMM_WORLD.gather((refused, len(own.facets["top"])))
if MPI.COMM_WORLD.rank == 0:
    print(said)
"""


@pytest.mark.mpi
def test_a_distributed_mesh_is_refused(run_script: RunScript) -> None:
    """On both of two ranks, with the remedy; a mesh of each rank's own on MPI.COMM_SELF is taken."""
    done = run_script("-c", ON_TWO_RANKS, ranks=2)
    assert done.returncode == 0, done.stderr
    refusal = (
        "mesh_from_dolfinx, mesh: wanted a mesh on one process, found one that is distributed over 2 ranks; make it on "
        "MPI.COMM_SELF instead of MPI.COMM_WORLD; each rank may have a mesh of its own"
    )
    assert done.stdout.strip() == str([(refusal, 4), (refusal, 4)])


def test_meshes_of_others_stay_plain() -> None:
    """A mesh of arrays has no field of dolfinx, and one from dolfinx is a MeshData."""
    assert "origin" not in MeshData.__dataclass_fields__
    theirs = square()
    assert isinstance(mesh_from_dolfinx(theirs, tagged_top(theirs, 2), {}), MeshData)


@pytest.mark.parametrize("shape", CELL_DIMENSION)
@pytest.mark.parametrize(("order", "make"), [(1, first_order), (2, second_order)])
def test_cells_that_are_numbered_the_other_way_round_are_turned_over(
    shape: str, order: int, make: Callable[[str], Any]
) -> None:
    """A box mirrored at x = 0, whose Jacobians are negative: a body is made of it, and u = Gx has the exact energy."""
    d, theirs = CELL_DIMENSION[shape], make(shape)
    tags = tagged_top(theirs, d)
    theirs.geometry.x[:, 0] *= -1.0
    mesh = mesh_from_dolfinx(theirs, tags, {"top": TOP})
    stiffness, u = assemble(Body(mesh, STEEL, (Fixed("top"),))).stiffness, displacement(mesh.points, 1, d)
    assert u.ravel() @ (stiffness @ u.ravel()) / 2 == pytest.approx(exact_energy(1, d), rel=1e-11)
