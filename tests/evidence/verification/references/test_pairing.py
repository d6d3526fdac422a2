"""The pairing against its reference implementation in plain loops, and against itself after a rigid motion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evidence.verification.references.pairing import pair_surfaces_slowly
from evolvent.contact.search.pairing import Pairing, pair_surfaces
from evolvent.fem.reference_facets import hats
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats
from tests.support.meshes.surface_shapes import cap, curve, facing, lattice

Kind = tuple[str, int]
"""Shape and order of facets."""
QUAD1, QUAD2, TRI1, TRI2 = ("quadrilateral", 1), ("quadrilateral", 2), ("triangle", 1), ("triangle", 2)


def by_pair(first: Surface, second: Surface, p: Pairing, values: Floats) -> Floats:
    """Sums over the points of each pair of facets."""
    n = len(second.facets)
    sums: NDArray[Any] = np.bincount(p.facet1 * n + p.facet2, values, minlength=len(first.facets) * n)
    return sums  # floats: numpy's hints give integers, whatever the weights


@pytest.mark.parametrize(("first", "second"), [(QUAD2, QUAD2), (TRI2, QUAD1)])
def test_pairing_is_invariant_under_a_common_rigid_motion(first: Kind, second: Kind) -> None:
    """Both caps turned and shifted together: gaps, partners' shape functions and weights as sums, to 1e-12."""
    a, b = lattice(5, 4, *first, cap(5, 0.3, 0, 0.3)), facing(lattice(4, 5, *second, cap(5.01, 0.3, 0.4, 0.2)))
    turn = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    p = pair_surfaces(a, b, 0.5, 0.5)
    q = pair_surfaces(a.moved(turn, [3.0, -2.0, 1.0]), b.moved(turn, [3.0, -2.0, 1.0]), 0.5, 0.5)
    for value in (lambda p: p.weight, lambda p: p.weight * p.gap, lambda p: p.weight * p.xi2[:, 0] * p.xi1[:, 1]):
        totals = [by_pair(a, b, r, value(r)) for r in (p, q)]
        assert np.abs(totals[0] - totals[1]).max() < 1e-12


@pytest.mark.parametrize(("first", "second"), [(QUAD2, QUAD2), (TRI2, QUAD1), (QUAD1, TRI2)])
def test_pairing_agrees_with_the_reference_in_3d(first: Kind, second: Kind) -> None:
    """Same integrals of gap and partners as the reference, pair of facets by pair.

    To 1e-9: the triangles may differ, and the rule of degree 8 is not exact on curved facets.
    """
    a, b = lattice(2, 2, *first, cap(5, 0.35, 0, 0.1)), facing(lattice(3, 1, *second, cap(5.01, 0.3, 0.4, 0.2)))
    fast, slow = pair_surfaces(a, b, 0.5, 0.5, degree=8), pair_surfaces_slowly(a, b, 0.5, 0.5, degree=8)
    assert_same_integrals(a, b, fast, slow)


def test_pairing_agrees_with_the_reference_in_2d() -> None:
    """As above for a circle against a wavy line that it overlaps in part."""
    a = curve(6, 2, lambda u: np.stack([np.sin(1.5 - 3 * u), np.cos(1.5 - 3 * u)], axis=1))
    b = curve(5, 2, lambda u: np.stack([1.4 * (u - 0.5), 0.9 + 0.05 * np.sin(9 * u)], axis=1))
    assert_same_integrals(a, b, pair_surfaces(a, b, 0.2, 0.2), pair_surfaces_slowly(a, b, 0.2, 0.2))


def assert_same_integrals(a: Surface, b: Surface, fast: Pairing, slow: Pairing) -> None:
    assert len(slow.gap) > 20
    for value in (lambda p: 1.0, lambda p: p.gap, lambda p: p.xi2[:, 0] * p.xi1[:, -1],
                  lambda p: hats(a.shape, a.order, p.xi1)[:, 0] * p.xi2[:, -1]):
        totals = [by_pair(a, b, p, p.weight * value(p)) for p in (fast, slow)]
        assert np.abs(totals[0] - totals[1]).max() < 1e-9
