"""The verification shapes and the measure of cell quality."""

from itertools import product

import numpy as np
import pytest

from evolvent_meshes.mesh.mesh_data import FACET_SHAPE, MeshData, MeshError
from evolvent_meshes.mesh.quality import check_quality, scaled_jacobians
from evolvent_meshes.mesh.reference_cells import shape_gradients
from evolvent_meshes.mesh.structured_grid import boundary_facets, graded_ends
from evolvent_meshes.shapes.blocks import box, cylinder_2d, graded_box, graded_rectangle, rectangle, sphere_quarter

A = 6.2146  # half-width of the NAFEMS cylinder's contact, mm
FLAT = ("quadrilateral", "triangle")
SOLID = ("hexahedron", "tetrahedron")


def measure(mesh: MeshData) -> float:
    """Area or volume of a mesh by Gauss points on the curved cells, collapsed for simplices."""
    d = mesh.dimension
    line, weights = np.polynomial.legendre.leggauss(4)
    where = np.array(list(product(0.5 + 0.5 * line, repeat=d)))
    weight = np.prod(list(product(0.5 * weights, repeat=d)), axis=1)
    if mesh.shape in ("triangle", "tetrahedron"):  # collapsed coordinates
        x = where.copy()
        for k in range(1, d):
            where[:, k] = x[:, k] * (1 - where[:, :k].sum(axis=1))
            weight = weight * (1 - where[:, :k].sum(axis=1))
    gradients = shape_gradients(mesh.shape, mesh.order, where)
    jacobians = np.einsum("cni,pnj->cpij", mesh.points[mesh.cells, :d], gradients)
    return float((np.linalg.det(jacobians) * weight).sum())


def covers_boundary(mesh: MeshData) -> bool:
    """Whether the facet groups are together the whole boundary, each facet once."""
    corners = len({"interval": "ab", "triangle": "abc", "quadrilateral": "abcd"}[FACET_SHAPE[mesh.shape]])
    outside = np.sort(boundary_facets(mesh.shape, mesh.order, mesh.cells)[:, :corners], axis=1)
    named = np.sort(np.concatenate(list(mesh.facets.values()))[:, :corners], axis=1)
    return len(named) == len(outside) and {tuple(f) for f in named.tolist()} == {tuple(f) for f in outside.tolist()}


@pytest.mark.parametrize(("shape", "order"), product(FLAT + SOLID, (1, 2)))
def test_blocks_fill_their_size(shape: str, order: int) -> None:
    """Area or volume of every block by quadrature, and its groups are the boundary; conforming simplices included."""
    if shape in FLAT:
        meshes = [
            (rectangle(2, 3, 2, 3, order, shape, origin=(1, 1)), 6.0),
            (graded_rectangle(20, 10, A / 8, A / 2, order, shape), 200.0),
        ]
    else:
        meshes = [
            (box((1, 2, 3), (2, 3, 2), order, shape), 6.0),
            (graded_box(4, 3, 0.3, 0.6, order, shape), 48.0),
        ]
    for mesh, expected in meshes:
        assert measure(mesh) == pytest.approx(expected, rel=1e-12)
        assert covers_boundary(mesh)
        assert scaled_jacobians(mesh).min() > 0


def test_group_positions() -> None:
    """Every group of the uniform blocks lies on the side that its name says."""
    flat, solid = rectangle(2, 3, 2, 3, origin=(1, 1)), box((1, 2, 3), (2, 2, 2), origin=(5, 5, 5))
    sides = {"left": (0, 1), "right": (0, 3), "bottom": (1, 1), "top": (1, 4)}
    for name, (axis, value) in sides.items():
        assert (flat.points[flat.facets[name], axis] == value).all()
    sides = {"left": (0, 5), "right": (0, 6), "front": (1, 5), "back": (1, 7), "bottom": (2, 5), "top": (2, 8)}
    for name, (axis, value) in sides.items():
        assert (solid.points[solid.facets[name], axis] == value).all()


@pytest.mark.parametrize(("shape", "half"), product(FLAT, (True, False)))
def test_disc(shape: str, half: bool) -> None:
    """NAFEMS cylinder, radius 50: area of the circle, every arc node on it, elements of a/8 in contact."""
    mesh = cylinder_2d(50, A / 8, 1.5 * A, order=2, shape=shape, half=half, contact=2 * A)
    area = np.pi * 50**2 / (2 if half else 1)
    assert measure(mesh) == pytest.approx(area, rel=1e-5)
    arc = mesh.points[mesh.facets["arc"]]
    np.testing.assert_allclose(np.hypot(arc[..., 0], arc[..., 1] - 50), 50, rtol=1e-14)
    near = abs(arc[:, :2, 0]).max(axis=1) < 1.5 * A + 1e-9
    length = np.linalg.norm(arc[:, 1] - arc[:, 0], axis=1)
    assert length[near].max() <= A / 8
    assert near.sum() >= 24
    assert 1.5 * A < abs(arc[..., 0]).max() <= 2 * A
    if half:
        assert np.ptp(mesh.points[mesh.facets["top"], 0]) == pytest.approx(100)
        np.testing.assert_allclose(mesh.points[mesh.facets["top"], 1], 50, rtol=1e-14)


@pytest.mark.parametrize("shape", SOLID)
def test_sphere_quarter(shape: str) -> None:
    """Sphere of 8 mm: volume above z = R − √(R² − x² − y²) by a fine sum, nodes of the arc on the sphere."""
    mesh = sphere_quarter(8, 4, 6, 0.47 / 2, 0.7, order=2, shape=shape)
    arc = mesh.points[np.unique(mesh.facets["arc"])] - [0, 0, 8]
    np.testing.assert_allclose(np.linalg.norm(arc, axis=1), 8, rtol=1e-14)
    middle = (np.arange(800) + 0.5) / 200
    sag = 8 - np.sqrt(64 - middle[:, None] ** 2 - middle[None, :] ** 2)
    assert measure(mesh) == pytest.approx(16 * (6 - sag.mean()), rel=1e-5)
    assert covers_boundary(mesh)
    with pytest.raises(MeshError, match="smaller side"):
        sphere_quarter(8, 6, 6, 0.2, 0.7)


def test_graded_ends() -> None:
    """Cells of 1 up to 3, then at most 1.5 times the last, ending at 20 exactly."""
    sizes = np.diff(graded_ends(20, 1, 3, 1.5))
    np.testing.assert_allclose(sizes[:3], 1)
    assert (sizes[1:] / sizes[:-1]).max() <= 1.5 + 1e-12
    assert sizes.sum() == pytest.approx(20)
    with pytest.raises(MeshError, match="fine < length"):
        graded_ends(2, 1, 3)


def test_wrong_shape() -> None:
    """A tetrahedron is no shape of a rectangle."""
    with pytest.raises(MeshError, match="tetrahedron"):
        rectangle(1, 1, 1, 1, shape="tetrahedron")


def _one_cell(shape: str, points: list[list[float]]) -> MeshData:
    nodes = np.pad(np.array(points, dtype=float), ((0, 0), (0, 3 - len(points[0]))))
    return MeshData(nodes, shape, 1, np.arange(len(nodes))[None], {}, {"body": np.array([0])})


def test_scaled_jacobian_of_known_cells() -> None:
    """A 30° parallelogram has sin 30°, regular simplices 1, a cube's corner √2 / (1·√2·√2)."""
    rhomb = _one_cell("quadrilateral", [[0, 0], [3, 0], [3 + np.sqrt(3), 1], [np.sqrt(3), 1]])
    assert scaled_jacobians(rhomb) == pytest.approx(0.5)
    triangle = _one_cell("triangle", [[0, 0], [1, 0], [0.5, np.sqrt(3) / 2]])
    assert scaled_jacobians(triangle) == pytest.approx(1)
    regular = _one_cell("tetrahedron", [[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]])
    assert scaled_jacobians(regular) == pytest.approx(1)
    corner = _one_cell("tetrahedron", [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    assert scaled_jacobians(corner) == pytest.approx(1 / np.sqrt(2))


def test_quality_finds_an_inverted_cell() -> None:
    """One middle node of a second-order block pulled through its cell: the message names the cell's place."""
    mesh = rectangle(4, 4, 4, 4)
    check_quality(mesh, 0.99)
    points = mesh.points.copy()
    points[mesh.cells[9, 8]] += [0.6, 0, 0]
    broken = MeshData(points, mesh.shape, 2, mesh.cells, mesh.facets, mesh.volumes)
    assert np.flatnonzero(scaled_jacobians(broken) < 0.2).tolist() == [9]
    with pytest.raises(MeshError, match=r"cell 9 at \(2\.5667, 1\.5000"):
        check_quality(broken, 0.2)
