"""Pairing: no area missed or covered twice, exact partners and gaps, on curved and non-matching facets."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent import SearchError
from evolvent.contact.search import segments
from evolvent.contact.search.pairing import Pairing, pair_surfaces
from evolvent.fem.lagrange import tabulate
from evolvent.fem.reference_facets import hats, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints
from tests.support.meshes.surface_shapes import Place, cap, curve, facing, lattice, rectangle, shaken

Kind = tuple[str, int]
"""Shape and order of facets."""
QUAD1, QUAD2, TRI1, TRI2 = ("quadrilateral", 1), ("quadrilateral", 2), ("triangle", 1), ("triangle", 2)
FACES = [(QUAD1, QUAD1), (QUAD2, QUAD2), (TRI1, TRI1), (TRI2, TRI2), (QUAD2, TRI1), (TRI2, QUAD2), (QUAD1, TRI2)]


def where(surface: Surface, facets: Ints, xi: Floats) -> Floats:
    return surface.positions(facets, xi[:, None])[:, 0]


def covered(surface: Surface, p: Pairing) -> Floats:
    """Share of each facet of surface 1 that has points, in its reference plane."""
    measure = np.linalg.norm(surface.area_vectors(p.facet1, p.xi1[:, None])[:, 0], axis=1)
    total = np.bincount(p.facet1, p.weight / measure, minlength=len(surface.facets))
    return total / reference_cell(surface.shape, surface.order).measure


def assert_consistent(first: Surface, second: Surface, p: Pairing) -> None:
    """x2(ξ2) = x1(ξ1) + gap n1 at every point, with n1 the normalised interpolated normal."""
    n = first.evaluate(first.normals, p.facet1, p.xi1[:, None])[0][:, 0]
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    miss = where(first, p.facet1, p.xi1) + p.gap[:, None] * n - where(second, p.facet2, p.xi2)
    assert np.abs(miss).max() < 1e-12
    assert p.lost == 0.0


@pytest.mark.parametrize(("first", "second"), FACES)
def test_area_and_moments_of_a_planar_overlap(first: Kind, second: Kind) -> None:
    """Surface 2, the rectangle [0.3, 1.7] × [0.2, 0.9] turned by 0.3 rad, lies wholly over surface 1 at gap 0.01.

    ∫1, ∫x, ∫xy, ∫x²y² over the overlap are those of the rectangle, to 1e-12, whatever the meshes.
    """
    low, high, turn = (0.3, 0.2), (1.7, 0.9), 0.3
    a = lattice(5, 4, *first, rectangle((-0.5, -0.5), (2.2, 1.9)))
    b = facing(lattice(4, 3, *second, rectangle(low, high, turn, 0.01)))
    p = pair_surfaces(a, b, 0.1, 0.1)
    x, y, _ = where(a, p.facet1, p.xi1).T
    s, w = np.polynomial.legendre.leggauss(4)
    u, v = (low[i] + (high[i] - low[i]) * (s + 1) / 2 for i in (0, 1))
    U, V = np.meshgrid(u, v, indexing="ij")
    W = np.outer(w, w) / 4 * (high[0] - low[0]) * (high[1] - low[1])
    X, Y = np.cos(turn) * U - np.sin(turn) * V, np.sin(turn) * U + np.cos(turn) * V
    for f in (lambda x, y: 1 + 0 * x, lambda x, y: x, lambda x, y: x * y, lambda x, y: x * x * y * y):
        assert p.weight @ f(x, y) == pytest.approx((W * f(X, Y)).sum(), abs=1e-12)
    assert np.abs(p.gap - 0.01).max() < 1e-14
    assert_consistent(a, b, p)


@pytest.mark.parametrize(("first", "second"), FACES)
def test_shape_functions_of_surface_2_are_integrated_exactly(first: Kind, second: Kind) -> None:
    """Parallel planes, surface 2 wholly covered: ∫N2_k∘π over surface 1 is ∫N2_k over surface 2, for every node k."""
    a = lattice(5, 4, *first, rectangle((-0.5, -0.5), (2.2, 1.9)))
    b = facing(lattice(4, 3, *second, rectangle((0.3, 0.2), (1.7, 0.9), 0.3, 0.01)))
    p = pair_surfaces(a, b, 0.1, 0.1)
    N2 = tabulate(*second, p.xi2)[0]
    found = np.bincount(b.facets[p.facet2].ravel(), (p.weight[:, None] * N2).ravel(), minlength=len(b.points))
    assert np.abs(found - np.asarray(b.mass().sum(axis=0)).ravel()).max() < 1e-12


@pytest.mark.parametrize(("first", "second"), FACES)
def test_hat_functions_of_a_covered_surface_are_integrated_exactly(first: Kind, second: Kind) -> None:
    """Surface 1 wholly covered by a larger, turned surface 2: ∫ψ_j over the segments is m_j, for every node j."""
    a = lattice(4, 3, *first, rectangle((0.3, 0.2), (1.7, 0.9), 0.3))
    b = facing(lattice(5, 4, *second, rectangle((-0.5, -0.5), (2.2, 1.9), 0.0, 0.01)))
    p = pair_surfaces(a, b, 0.1, 0.1)
    found = np.bincount(a.facets[p.facet1].ravel(), (p.weight[:, None] * hats(*first, p.xi1)).ravel())
    assert np.abs(found - a.weights()).max() < 1e-13


@pytest.mark.parametrize("order1", [1, 2])
@pytest.mark.parametrize("order2", [1, 2])
def test_overlap_of_two_lines_has_exact_moments(order1: int, order2: int) -> None:
    """2D: y = 0 over [0, 2] below y = 0.02 over [0.7, 3.1]: overlap 1.3, ∫x = 1.755, ∫x² = (8 − 0.343)/3."""
    a = curve(5, order1, lambda u: np.stack([2 * (1 - u), 0 * u], axis=1))
    b = curve(7, order2, lambda u: np.stack([0.7 + 2.4 * u, 0.02 + 0 * u], axis=1))
    p = pair_surfaces(a, b, 0.1, 0.1)
    x = where(a, p.facet1, p.xi1)[:, 0]
    assert p.weight.sum() == pytest.approx(1.3, abs=1e-14)
    assert p.weight @ x == pytest.approx(1.755, abs=1e-14)
    assert p.weight @ x**2 == pytest.approx((8 - 0.343) / 3, abs=1e-14)
    assert np.abs(p.gap - 0.02).max() < 1e-15
    assert_consistent(a, b, p)


def test_areas_of_distorted_planar_facets_are_exact() -> None:
    """Planes meshed with facets whose inner nodes are displaced at random, so that edges are curved: areas exact.

    Regular [0, 2] × [0, 1] under a displaced [0.5, 2.5] × [−0.5, 0.5]: 0.75; displaced [0, 2] × [0, 1] wholly under a
    displaced [−0.5, 2.5] × [−0.5, 1.5]: 2. (The edge of surface 2 over a displaced facet would be a chord.)
    """
    rng = np.random.default_rng(3)
    for first, second in FACES:
        a = lattice(5, 4, *first, rectangle((0, 0), (2, 1)))
        b = facing(shaken(lattice(6, 3, *second, rectangle((0.5, -0.5), (2.5, 0.5), 0.0, -0.03)), rng))
        p = pair_surfaces(a, b, 0.1, 0.1)
        assert p.weight.sum() == pytest.approx(0.75, abs=1e-13)
        assert np.abs(p.gap + 0.03).max() < 1e-14
        b = facing(shaken(lattice(6, 7, *second, rectangle((-0.5, -0.5), (2.5, 1.5), 0.0, -0.03)), rng))
        p = pair_surfaces(shaken(a, rng), b, 0.1, 0.1, degree=6)  # a distorted quad9 has an area element of degree 6
        assert p.weight.sum() == pytest.approx(2.0, abs=1e-13)


@pytest.mark.parametrize("kind", [QUAD1, QUAD2, TRI2])
def test_gap_between_offset_surfaces_is_exact(kind: Kind) -> None:
    """Surface 2 is surface 1 (a curved cylinder) with every node moved by 0.05 along its normal, turned over.

    Then x2(ξ) = x1(ξ) + 0.05 ΣN_k n_k: the gap at ξ is 0.05 |ΣN_k n_k|, the partner the same point of the same facet.
    """
    def cylinder(u: Floats, v: Floats) -> Floats:
        return np.stack([2 * np.sin(1.2 * u - 0.6), v, 2 * np.cos(1.2 * u - 0.6)], axis=1)

    a = lattice(6, 3, *kind, cylinder)
    b = facing(Surface.from_arrays(a.points + 0.05 * a.normals, a.facets, *kind))
    p = pair_surfaces(a, b, 0.1, 0.1)
    n = a.evaluate(a.normals, p.facet1, p.xi1[:, None])[0][:, 0]
    assert np.array_equal(p.facet1, p.facet2)
    assert np.abs(p.gap - 0.05 * np.linalg.norm(n, axis=1)).max() < 1e-13
    assert np.allclose(covered(a, p), 1.0, atol=1e-12)
    swapped = p.xi2[:, ::-1]
    assert np.abs(p.xi1 - swapped).max() < 1e-12


@pytest.mark.parametrize(("first", "second", "rate"), [(QUAD2, QUAD2, 6.0), (TRI2, QUAD2, 6.0), (QUAD1, TRI1, 3.0)])
def test_gap_between_spheres_converges(first: Kind, second: Kind, rate: float) -> None:
    """Concentric caps of radius 5 and 5.01, meshed differently: the gap is 0.01; its largest error falls as h³ (h²)."""
    error = []
    for n in (6, 12):
        a = lattice(n, n, *first, cap(5.0, 0.3, 0.0, 0.3))
        b = facing(lattice(n + 1, n + 1, *second, cap(5.01, 0.5, 0.4, 0.2)))
        p = pair_surfaces(a, b, 0.3, 0.3)
        assert_consistent(a, b, p)
        error.append(np.abs(p.gap - 0.01).max())
    assert error[0] / error[1] > rate


@pytest.mark.parametrize(("first", "second"), FACES)
def test_curved_surfaces_are_covered_once(first: Kind, second: Kind) -> None:
    """Caps with doubly curved, obliquely meeting facets of other sizes: every facet of 1 is covered exactly once."""
    for n1, n2 in ((3, 10), (9, 4), (7, 7)):
        a = lattice(n1, n1, *first, cap(5.0, 0.3, 0.0, 0.3))
        b = facing(lattice(n2, n2, *second, cap(5.01, 0.52, 0.7, 0.2)))
        p = pair_surfaces(a, b, 0.5, 0.5)
        assert np.abs(covered(a, p) - 1).max() < 1e-12
        assert_consistent(a, b, p)
        inside = reference_cell(*second).corners
        assert np.abs(p.xi2 - 0.5).max() < 0.6, inside


def test_long_narrow_facets_are_covered_once() -> None:
    """Helical flanks have facets twenty times as long as wide; crossed at 6° on a cylinder, all are covered once."""
    def flank(radius: float, turn: float, width: float) -> Place:
        def place(u: Floats, v: Floats) -> Floats:
            s, z = width * (u - 0.5), 1.3 * width * (v - 0.5)
            s, z = np.cos(turn) * s - np.sin(turn) * z, np.sin(turn) * s + np.cos(turn) * z
            return np.stack([radius * np.sin(s / radius), z, radius * np.cos(s / radius)], axis=1)
        return place

    a = lattice(40, 2, *QUAD2, flank(5.0, 0.0, 2.0))
    b = facing(lattice(44, 3, *QUAD2, flank(5.002, 0.1, 2.6)))
    p = pair_surfaces(a, b, 0.01, 0.01)
    assert np.abs(covered(a, p) - 1).max() < 1e-12
    assert np.abs(p.gap - 0.002).max() < 1e-6


def test_slightly_bent_edges_are_taken_as_their_chords(monkeypatch: pytest.MonkeyPatch) -> None:
    """Caps whose edges bend by up to half of STRAIGHT: chords cover every facet once, with fewer points. Exact: the
    integral of a cubic's interpolant on surface 2 with edges that are followed by two chords, to 1e-10: neighbours
    agree along their edge, and nearly in their slopes."""
    a = lattice(6, 6, *QUAD2, cap(5.0, 0.1, 0.0, 0.05))
    b = facing(lattice(9, 9, *QUAD2, cap(5.01, 0.17, 0.7, 0.05)))
    field = b.points[:, 0] ** 3 + b.points[:, 1]

    def integral() -> tuple[int, float]:
        p = pair_surfaces(a, b, 0.5, 0.5)
        assert np.abs(covered(a, p) - 1).max() < 1e-12
        assert_consistent(a, b, p)
        return len(p.weight), float(p.weight @ b.evaluate(field[:, None], p.facet2, p.xi2[:, None])[0][:, 0, 0])

    assert 0.1 * segments.STRAIGHT < segments._bend(b, np.arange(len(b.facets))) < 0.5 * segments.STRAIGHT
    count, found = integral()
    monkeypatch.setattr(segments, "STRAIGHT", 0.0)
    more, wanted = integral()
    assert count < 0.9 * more
    assert found == pytest.approx(wanted, abs=1e-10)


def test_points_of_chosen_facets_are_those_of_the_whole_search() -> None:
    """The points for chosen facets are those of the whole search; facets beyond the edge of surface 2 have none."""
    a = lattice(6, 6, *QUAD2, rectangle((0, 0), (6, 6)))
    b = facing(lattice(3, 3, *TRI2, rectangle((-1, -1), (3.25, 3.25), 0.0, 0.1)))
    p = pair_surfaces(a, b, 0.2, 0.2)
    assert p.weight.sum() == pytest.approx(3.25**2, abs=1e-12)
    some = np.array([7, 2, 14, 35])
    q = pair_surfaces(a, b, 0.2, 0.2, facets1=some)
    chosen = np.isin(p.facet1, some)
    assert np.array_equal(q.facet1, p.facet1[chosen])
    assert np.array_equal(q.weight, p.weight[chosen])
    assert np.array_equal(np.unique(q.facet1), [2, 7, 14])
    assert len(pair_surfaces(a, b, 0.2, 0.2, facets1=[]).gap) == 0


def test_only_gaps_in_range_are_kept() -> None:
    """A plane y = 0 and a slope y = 0.1 x over [0, 4], max_gap 0.1, max_overlap 0: the points have 0 <= gap <= 0.1."""
    a = curve(40, 2, lambda u: np.stack([6 * (0.5 - u), 0 * u], axis=1))
    b = curve(4, 1, lambda u: np.stack([8 * (u - 0.5), 0.8 * (u - 0.5)], axis=1))
    p = pair_surfaces(a, b, 0.1, 0.0)
    x = where(a, p.facet1, p.xi1)[:, 0]
    assert p.gap.min() >= 0.0
    assert p.gap.max() <= 0.1
    assert np.abs(p.gap - 0.1 * x).max() < 1e-14
    assert p.weight.sum() == pytest.approx(1.0, abs=0.16)  # cut point by point: right to one facet
    assert len(pair_surfaces(a, b.moved(np.eye(2), [0.0, 9.0]), 0.1, 0.1).gap) == 0
    assert len(pair_surfaces(a, Surface.from_arrays(b.points, b.facets[:, ::-1], "interval", 1), 1, 1).gap) == 0


def test_unusable_surfaces_and_limits_are_refused() -> None:
    """Mixed dimensions and negative limits are ValueErrors; two layers within reach and too coarse facets are
    SearchErrors."""
    a = lattice(3, 3, *QUAD2, rectangle((0, 0), (1, 1)))
    line = curve(3, 1, lambda u: np.stack([u, 0 * u], axis=1))
    with pytest.raises(ValueError, match="found 3D facing 2D"):
        pair_surfaces(a, line, 0.1, 0.1)
    with pytest.raises(ValueError, match="wanted a reach >= 0"):
        pair_surfaces(a, a, -0.1, 0.1)
    layers = [facing(lattice(2, 2, *QUAD1, rectangle((0, 0), (1, 1), 0.0, z))) for z in (0.1, 0.2)]
    n = len(layers[0].points)
    both = Surface.from_arrays(np.vstack([s.points for s in layers]),
                               np.vstack([layers[0].facets, layers[1].facets + n]), *QUAD1)
    assert pair_surfaces(a, both, 0.15, 0.15).weight.sum() == pytest.approx(1.0)
    with pytest.raises(SearchError, match="two partners"):
        pair_surfaces(a, both, 0.3, 0.3)


def test_area_without_partners_is_refused() -> None:
    """A hilly surface (radius 0.2, slopes of 60°) with three facets: area without partners raises SearchError."""
    def hills(turn: float, z: float) -> Place:
        def place(u: Floats, v: Floats) -> Floats:
            x, y, _ = rectangle((-1, -1), (1, 1), turn)(u, v).T
            return np.stack([x, y, 0.6 * np.sin(2 * x) * np.cos(3 * y) + z], axis=1)
        return place

    a, b = lattice(3, 3, *TRI2, hills(0.0, 0.0)), facing(lattice(16, 16, *TRI2, hills(0.5, 0.02)))
    with pytest.raises(SearchError, match="no partner found"):
        pair_surfaces(a, b, 0.3, 0.3)
