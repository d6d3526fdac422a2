"""Pairs of points of two flanks at a contact lattice, and the jump on it."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from evolvent.contact.nitsche.contact_operator import ContactOperator, contact_operator
from evolvent.contact.search.pairing import Pairing, SearchError, pair_surfaces
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.surface import Surface
from evolvent.gears.contact import lattice_pairing
from evolvent.gears.contact.contact_lattice import ContactLattice
from evolvent.gears.contact.lattice_pairing import jump_space, pair_at_lattice, with_wheel_edges
from evolvent_meshes.arrays import Bools
from evolvent_meshes.gears.member import Member
from tests.support.meshes.flanks_in_mesh import TEETH, line, placed

GAP, OVERLAP = 0.8, 2.0
"""Limits of the search [mm]."""


@cache
def paired(tooth: int, half_width: float = 0.8) -> tuple[ContactLattice, Pairing, Bools]:
    lattice = ContactLattice.of(line(tooth), half_width)
    assert lattice is not None
    return lattice, *pair_at_lattice(lattice, placed(tooth), GAP, OVERLAP)


@pytest.mark.parametrize("tooth", TEETH)
def test_partners_lie_on_the_normals(tooth: int) -> None:
    """Exact: x_2 = x_1 + gap n_1, x_1 at the height of its point, and x_2 on its facet or next to the flank's edge."""
    lattice, pairing, kept = paired(tooth)
    first, second = placed(tooth)
    x1, n = (first.evaluate(v, pairing.facet1, pairing.xi1[:, None])[0][:, 0] for v in (first.points, first.normals))
    n /= np.linalg.norm(n, axis=1)[:, None]
    x2 = second.positions(pairing.facet2, pairing.xi2[:, None])[:, 0]
    assert x2 == pytest.approx(x1 + pairing.gap[:, None] * n, abs=1e-8)
    assert x1[:, 2] == pytest.approx(lattice.point_z[kept], abs=1e-8)
    assert (np.abs(pairing.xi2 - 0.5) < 0.61).all()


def test_gap_on_the_line_is_that_of_the_facets() -> None:
    """Problem: flanks without modifications that touch along the line. Exact: no gap there but for what second-order
    facets leave of an involute; away from the line it grows with the square of the distance."""
    lattice, pairing, kept = paired(0)
    c = lattice.point_across[kept]
    on, away = np.abs(c) < 0.05, np.abs(c) > 0.6
    assert np.abs(pairing.gap[on]).max() < 1e-3
    ratio = pairing.gap[away] / c[away] ** 2
    assert np.quantile(ratio, 0.9) < 2.0 * np.quantile(ratio, 0.1)


def moved_to_its_tip(wheel: Surface, distance: float) -> Surface:
    """The wheel's flank displaced by a distance [mm] along its profile."""
    across = wheel.points - line(0).stand.centre(Member.WHEEL, 3)
    along = np.cross([0.0, 0.0, 1.0], wheel.normals)
    along *= np.sign(np.einsum("na,na->n", along, across))[:, None] / np.linalg.norm(along, axis=1)[:, None]
    return wheel.displaced(distance * along)


@pytest.mark.parametrize("moved", [1.0, -1.0])
def test_partners_many_cells_away_are_found(moved: float) -> None:
    """Problem: the wheel's flank displaced along its profile by 1 mm, eight rows. Exact: of the points about the line
    those that still face it, over four fifths, are on the normals of the pinion; none is lost."""
    lattice, (first, second) = paired(0)[0], placed(0)
    there = first, moved_to_its_tip(second, moved)
    pairing, kept = pair_at_lattice(lattice, there, GAP, OVERLAP)
    x1, n = (first.evaluate(v, pairing.facet1, pairing.xi1[:, None])[0][:, 0] for v in (first.points, first.normals))
    x2 = there[1].positions(pairing.facet2, pairing.xi2[:, None])[:, 0]
    assert np.cross(x2 - x1, n) == pytest.approx(0.0, abs=1e-8)
    assert pairing.lost == 0.0 and 0.8 < kept.mean() < 0.95


def test_points_without_partners_amid_the_wheel_are_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: partners of a hundredth of the points are not found, amid the wheel's flank or beyond its tip. Exact:
    the first are lost, which is an error; the second face no flank."""
    lattice, find = paired(0)[0], lattice_pairing._partners

    def failing(at: float) -> Callable[..., object]:
        def partners(*arguments: object) -> object:
            facets, xi, gap, found, partner = find(*arguments)  # type: ignore[arg-type]
            found[::100] = False
            last = len(line(0).flanks[Member.WHEEL].facets) - 1
            partner.row[::100], partner.at[::100] = last, [at, 0.5]
            return facets, xi, gap, found, partner

        return partners

    monkeypatch.setattr(lattice_pairing, "_partners", failing(0.5))
    with pytest.raises(SearchError, match="refine the mesh"):
        pair_at_lattice(lattice, placed(0), GAP, OVERLAP)
    monkeypatch.setattr(lattice_pairing, "_partners", failing(2.0))
    assert pair_at_lattice(lattice, placed(0), GAP, OVERLAP)[0].lost == 0.0


def test_edges_of_the_wheel_move_with_its_flank() -> None:
    """Problem: the wheel's flank displaced by 0.05 mm along its profile, towards its tip. Exact: its edges face places
    that lie 0.05 mm nearer to the pinion's root than without, within 1 mm of contact lines up to half a per cent,
    as flanks are curved and apart there. On flanks in place they are there where they are on conjugate ones up to 2 µm.
    """
    near, moved, z = 0, 0.05, np.linspace(-7.0, 7.0, 141)
    for tooth in TEETH:
        (first, second), nominal = placed(tooth), line(tooth)
        there = with_wheel_edges(nominal, (first, second))
        displaced = with_wheel_edges(nominal, (first, moved_to_its_tip(second, moved)))
        own, ξ = nominal.flanks[Member.PINION].arc, nominal.stand.roll_distance(tooth, z)
        start, end = nominal.stand.pair.path_of_contact
        for before, found, after in zip(*(each.edges_of_wheel(z) for each in (nominal, there, displaced))):
            beside = (before > own[0] + moved) & (before < own[-1] - moved)
            beside &= (np.abs(before - nominal.arc(z)) < 1.0) & (ξ > start) & (ξ < end)
            assert np.abs(found - before)[beside].max(initial=0.0) < 2e-3
            assert (after - found)[beside] == pytest.approx(-moved, rel=5e-3)
            near += np.count_nonzero(beside)
    assert near > 20


def test_area_is_that_of_the_search_over_segments() -> None:
    """Problem: the whole flanks of a tooth pair. Exact: the same area faces the wheel as by the search that cuts
    facets, up to half a per cent at the edges of curved facets."""
    _, pairing, _ = paired(0, np.inf)
    wanted = pair_surfaces(*placed(0), GAP, OVERLAP)
    assert pairing.weight.sum() == pytest.approx(wanted.weight.sum(), rel=5e-3)


@cache
def operator(tooth: int, half_width: float = 0.8) -> ContactOperator:
    lattice, pairing, kept = paired(tooth, half_width)
    first, second = placed(tooth)
    space = jump_space(lattice, first, kept)
    stabiliser = np.ones((len(first.points), 2))
    return contact_operator(pairing, first, second, stabiliser, tangent_frames(first.normals), jumps=space)


def within(tooth: int, half_width: float = 0.8) -> Bools:
    """Points (q,) bool by the line, 1 mm or more from the flanks' edges."""
    lattice, _, kept = paired(tooth, half_width)
    low, high = lattice.line.edges(lattice.point_z, lattice.line.arc(lattice.point_z))
    near = (np.abs(lattice.point_across) < 0.2) & (low < -1.0) & (high > 1.0)
    found: Bools = near[kept]
    assert found.any()
    return found


@pytest.mark.parametrize("tooth", [0, 1])
def test_jump_of_fields_that_the_lattice_has(tooth: int) -> None:
    """Problem: both flanks moved alike, and the pinion by its heights. Exact: no jump, and the heights of the nodes;
    all that is left is the weight of what lies beyond the flanks."""
    found, (first, second), lattice = operator(tooth), placed(tooth), paired(tooth)[0]
    moved = found.jump1 @ np.ones((len(first.points), 2)) - found.jump2 @ np.ones((len(second.points), 2))
    assert np.abs(moved).max() < 1e-8
    inside = np.unique(found.shape[within(tooth)].indices)
    heights = found.jump1 @ first.points[:, 2]
    assert heights[inside] == pytest.approx(lattice.z[inside], abs=1e-4)


@pytest.mark.parametrize("tooth", TEETH)
def test_both_gears_get_all_of_the_force(tooth: int) -> None:
    """Problem: random tractions. Exact: forces on lattice nodes, on the pinion's and on the wheel's all have one sum,
    that of traction times weight; gathered from those on the pinion's nodes it is the same again, up to the weight
    of what lies beyond the flanks."""
    found = operator(tooth)
    traction = np.random.default_rng(1).random((len(found.weights), 3))
    f, wanted = found.forces(traction), found.weights @ traction
    jumps = found.jump1, found.jump2
    for forces in (f, *(jump.transposed(f) for jump in jumps)):
        assert forces.sum(axis=0) == pytest.approx(wanted, rel=1e-9)
    c = paired(tooth)[0].point_across[paired(tooth)[2]]
    smooth = found.weights * np.maximum(0.0, 1.0 - (c / 0.6) ** 2) ** 2
    assert found.gathered((found.trace.T @ smooth)[:, None]).sum() == pytest.approx(smooth.sum(), rel=1e-4)


def test_flux_of_a_uniform_traction() -> None:
    """Problem: uniform pressure on all that the flanks share. Exact: F = −p n/γ at the flank nodes well within it, up
    to a hundredth by which normals that are interpolated on either mesh differ."""
    found = operator(0, np.inf)
    flux = found.flux(np.tile([2.0, 0.0, 0.0], (len(found.weights), 1)))
    inside = np.unique(found.trace[within(0, np.inf)].indices)
    normals = placed(0)[0].normals[found.nodes]
    assert flux[inside] == pytest.approx(-2.0 * normals[inside], abs=3e-2)
