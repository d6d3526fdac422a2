"""Contact surfaces: shape and hat functions, weights, normals, and how they are taken from a mesh."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.lagrange import tabulate
from evolvent.fem.reference_facets import reference_cell
from evolvent.fem.surface import Surface, surface_of
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import box, rectangle
from tests.support.meshes.surface_shapes import curve, lattice

CELLS = [(s, o) for s in ("interval", "quadrilateral", "triangle") for o in (1, 2)]
FACES = [c for c in CELLS if c[0] != "interval"]


def flat(u: Floats, v: Floats) -> Floats:
    """(u, v) -> the rectangle 3 × 2 mm at z = 0."""
    return np.stack([3.0 * u, 2.0 * v, 0.0 * u], axis=1)


@pytest.mark.parametrize(("shape", "order"), CELLS)
def test_surface_is_evaluated_by_its_shape_functions(shape: str, order: int) -> None:
    """A surface's monomial evaluation of a random facet equals ΣN_k x_k and its derivatives by basix."""
    rng = np.random.default_rng(2)
    k, dt = reference_cell(shape, order).nodes.shape
    x, xi = rng.normal(size=(k, dt + 1)), rng.normal(size=(20, dt))
    surface = Surface(x, x, np.arange(k)[None], shape, order, np.arange(k))
    value, slopes = surface.evaluate(x, np.array([0]), xi[None])
    N, dN = tabulate(shape, order, xi)
    assert np.allclose(value[0], N @ x, atol=1e-12)
    assert np.allclose(np.stack([s[0] for s in slopes], axis=1), dN @ x, atol=1e-12)


@pytest.mark.parametrize(("shape", "order"), FACES)
def test_mass_integrates_quadratics_against_hats(shape: str, order: int) -> None:
    """On a flat 3 × 2 rectangle Σ_jk M_jk q(x_k) = ∫q for q in the facets' space; row sums are m_j > 0.

    q = 1 + x + y (order 1): 6 + 9 + 6 = 21; with x² + xy added (order 2): + 18 + 9 = 48.
    """
    s = lattice(4, 3, shape, order, flat)
    x, y = s.points[:, 0], s.points[:, 1]
    q, exact = (1 + x + y, 21.0) if order == 1 else (1 + x + y + x * x + x * y, 48.0)
    assert (s.mass() @ q).sum() == pytest.approx(exact, rel=1e-13)
    assert np.allclose(np.asarray(s.mass().sum(axis=1)).ravel(), s.weights(), rtol=1e-13)
    assert s.weights().min() > 0
    assert s.areas().sum() == pytest.approx(6.0, rel=1e-14)


def test_weights_of_second_order_quadrilaterals_are_those_of_the_node_grid() -> None:
    """On 4 × 3 quad9 facets over 3 × 2: interior nodes own h_x h_y = (3/8)(2/6), edge nodes half, corners a quarter."""
    s = lattice(4, 3, "quadrilateral", 2, flat)
    sides = np.isin(s.points[:, 0], [0.0, 3.0]).astype(int) + np.isin(s.points[:, 1], [0.0, 2.0])
    assert np.allclose(s.weights(), 0.125 * 0.5**sides, rtol=1e-13)


@pytest.mark.parametrize(("shape", "order"), FACES)
def test_sphere_area_and_normals_converge(shape: str, order: int) -> None:
    """A patch of the unit sphere, longitude and latitude within ±0.4: area 0.8·2 sin 0.4, normal = position.

    Doubling the facets divides the error of the area by 4 (order 1) or 16 (order 2), that of the nodal normals inside
    by 16 on quad9, where the slopes of neighbours err oppositely, and by about 4 on all others.
    """
    def place(u: Floats, v: Floats) -> Floats:
        λ, φ = 0.8 * u - 0.4, 0.8 * v - 0.4
        return np.stack([np.cos(φ) * np.cos(λ), np.cos(φ) * np.sin(λ), np.sin(φ)], axis=1)

    area, normal = [], []
    for n in (4, 8):
        s = lattice(n, n, shape, order, place)
        inside = np.abs(np.arcsin(s.points[:, 2])) < 0.22
        inside &= np.abs(np.arctan2(s.points[:, 1], s.points[:, 0])) < 0.22
        area.append(abs(s.weights().sum() - 1.6 * np.sin(0.4)))
        normal.append(np.abs(s.normals - s.points)[inside].max())
    assert area[0] / area[1] > (3.7 if order == 1 else 14)
    assert normal[0] / normal[1] > (14 if (shape, order) == ("quadrilateral", 2) else 3.3)


def test_circle_length_and_normals() -> None:
    """Second-order facets on a quarter of a circle of radius 2, run clockwise: length π to O(h⁴), normals radial."""
    errors = []
    for n in (4, 8):
        s = curve(n, 2, lambda u: 2 * np.stack([np.sin(u * np.pi / 2), np.cos(u * np.pi / 2)], axis=1))
        errors.append(abs(s.weights().sum() - np.pi))
        assert np.abs(s.normals + s.points / 2)[1:-1].max() < 2e-2  # outwards for clockwise is towards the centre
    assert errors[0] / errors[1] > 14


def test_moved_surface_has_turned_points_and_normals() -> None:
    """A turn by 30° about z and a shift: points and normals follow, weights stay."""
    s = lattice(3, 3, "triangle", 2, lambda u, v: np.stack([u, v, 0.2 * u * v], axis=1))
    c, k = np.cos(np.pi / 6), 0.5
    turn = np.array([[c, -k, 0], [k, c, 0], [0, 0, 1]])
    t = s.moved(turn, [1.0, 2.0, 3.0])
    again = Surface.from_arrays(t.points, t.facets, t.shape, t.order)
    assert np.allclose(t.points, s.points @ turn.T + [1, 2, 3], atol=1e-14)
    assert np.allclose(t.normals, again.normals, atol=1e-14)
    assert np.allclose(t.weights(), s.weights(), rtol=1e-13)


# Taking a surface from a mesh: gmsh's hex27 and quad9 built here from the corners, as gmsh's manual numbers them.

HEX_EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
HEX_FACES = [(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)]
HEX_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)


def brick() -> MeshData:
    """One hex27 cell, the unit cube; all its faces in the group "skin", every other one listed inside out."""
    means = [HEX_CORNERS[list(c)].mean(axis=0) for c in (*HEX_EDGES, *HEX_FACES, range(8))]
    points = np.vstack([HEX_CORNERS, means])
    faces = []
    for i, f in enumerate(HEX_FACES):
        corners = f if i % 2 else f[::-1]
        middle = np.array([0.5 * (points[corners[k]] + points[corners[(k + 1) % 4]]) for k in range(4)])
        middle = np.vstack([middle, points[list(corners)].mean(axis=0)])
        nodes = [int(np.argmin(np.linalg.norm(points - m, axis=1))) for m in middle]
        faces.append([*corners, *nodes])
    groups = {"skin": np.array(faces), "top": np.array(faces[5:]), "none": np.empty((0, 9), dtype=np.int64)}
    return MeshData(points, "hexahedron", 2, np.arange(27)[None], groups, {"all": np.array([0])})


def test_surface_of_a_brick_points_outwards() -> None:
    """Unit cube: area 6, every facet's normal at its centre along its outward axis, whichever way gmsh listed it."""
    s = surface_of(brick(), "skin")
    assert s.areas() == pytest.approx(np.ones(6), rel=1e-13)
    centre = np.full((6, 1, 2), 0.5)
    where, vector = s.positions(np.arange(6), centre)[:, 0], s.area_vectors(np.arange(6), centre)[:, 0]
    assert np.allclose(vector, 2 * (where - 0.5), atol=1e-14)
    top = surface_of(brick(), "top")
    assert np.allclose(top.normals, [0, 0, 1], atol=1e-14)
    assert np.allclose(brick().points[top.nodes], top.points)


def test_surface_of_plane_quadratic_triangles() -> None:
    """A 2D tri6 cell with corners (0,0), (2,0), (0,1): the hypotenuse, listed either way, looks along (1, 2)/√5."""
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0]], float)
    points = np.vstack([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))])
    for line in ([1, 2, 4], [2, 1, 4]):
        mesh = MeshData(points, "triangle", 2, np.arange(6)[None], {"side": np.array([line])}, {})
        s = surface_of(mesh, "side")
        assert np.allclose(s.normals, np.array([1, 2]) / np.sqrt(5), atol=1e-14)
        assert s.weights().sum() == pytest.approx(np.sqrt(5))


def test_surface_of_unusable_groups_is_refused() -> None:
    """Unknown and empty groups and facets between two cells are refused, with the names that exist."""
    with pytest.raises(ValueError, match=r"groups none, skin, top, found 'flank'"):
        surface_of(brick(), "flank")
    with pytest.raises(ValueError, match="'none', found it empty"):
        surface_of(brick(), "none")
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    mesh = MeshData(points, "triangle", 1, np.array([[0, 1, 2], [0, 2, 3]]), {"cut": np.array([[0, 2]])}, {})
    with pytest.raises(ValueError, match=r"one cell behind each.* found 2 behind"):
        surface_of(mesh, "cut")
    with pytest.raises(ValueError, match="not finite"):
        Surface.from_arrays([[0.0, 0.0], [np.nan, 1.0]], [[0, 1]], "interval", 1)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", ["quadrilateral", "hexahedron", "tetrahedron"])
def test_field_with_the_volume_of_its_hats(shape: str, order: int) -> None:
    """A random field: ∫N·(changed) = ∫ψ·(field) over the whole surface to rounding; in order 1 nothing changes, and a
    constant never does."""
    plane = shape == "quadrilateral"
    mesh = rectangle(2.0, 1.0, 5, 3, order) if plane else box((2.0, 1.0, 1.0), (4, 3, 2), order, shape)
    top = surface_of(mesh, "top")
    field = np.random.default_rng(1).uniform(0.0, 1.0, len(top.points))
    changed = top.with_volume_of_hats(field)
    assert float(np.ones(len(field)) @ (top.mass() @ changed)) == pytest.approx(float(top.weights() @ field), rel=1e-12)
    assert (order == 1) == bool((changed == field).all())
    np.testing.assert_allclose(top.with_volume_of_hats(np.ones(len(field))), 1.0, rtol=1e-13)
