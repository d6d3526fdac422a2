"""The compliance of all bodies of a step: as a matrix, as products, and its normal components alone."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent import Body, Contact, Fixed, Problem, Step, StepSystem, Traction, condense_bodies
from evolvent.contact.newton.jump_compliance import DenseCompliance
from evolvent.contact.step.bodies_compliance import BodiesCompliance
from evolvent_meshes.shapes.blocks import rectangle


@pytest.mark.parametrize("k", [2, 3])
def test_products_and_normal_components_are_those_of_the_matrix(k: int) -> None:
    """Two bodies with random maps and compliances, against Σ E C Eᵀ written out: products and a matrix among some
    unknowns to rounding; normal components bit for bit those of the matrix, as results must not depend on friction
    elsewhere."""
    rng = np.random.default_rng(3)
    maps = [sp.random(4 * k, m, 0.5, "csr", random_state=m) for m in (7, 9)]
    parts = [c @ c.T for c in (rng.normal(size=(m, m)) for m in (7, 9))]
    A, force = BodiesCompliance(maps, parts, k), rng.normal(size=4 * k)
    wanted = sum(E.toarray() @ C @ E.toarray().T for E, C in zip(maps, parts))
    assert A.matrix == pytest.approx(wanted, rel=1e-12, abs=1e-13)
    assert A.times(force) == pytest.approx(wanted @ force, rel=1e-12, abs=1e-13)
    assert np.array_equal(A.normal().matrix, DenseCompliance(A.matrix, k).normal().matrix)
    some = np.array([1, 2, 5])
    assert A.active(some).times(force[some]) == pytest.approx(wanted[np.ix_(some, some)] @ force[some], rel=1e-5)


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_the_whole_matrix_is_made_for_friction_only(friction: float) -> None:
    """A pressed block, solved: with friction the compliance is a matrix; without, no matrix of it has been made."""
    upper = Body(rectangle(1.0, 1.0, 2, 2, origin=(0.0, 1.0)), supports=(Fixed("left", "x"),),
                 loads=(Traction("top", (0.0, -50.0)),))
    lower = Body(rectangle(1.0, 1.0, 3, 3), supports=(Fixed("bottom"),))
    problem = Problem((upper, lower), (Contact((0, "bottom"), (1, "top"), friction=friction),))
    system = StepSystem(problem, condense_bodies(problem), Step())
    solution, _ = system.solve(None)
    assert solution.contacts[0].force[1] == pytest.approx(-50.0, rel=1e-9)
    assert ("matrix" in vars(system.compliance)) == bool(friction)
