"""The pressure of a round contact: integrated, fitted, and found by Evolvent."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.benchmarks.comparison.evolvent_program import solved
from evidence.benchmarks.comparison.pressure import Pressure, Reference
from evidence.benchmarks.comparison.round_contacts import cylinder, line_contact, sphere
from evidence.benchmarks.comparison.task import Answer, Task

LINE = line_contact()


@pytest.mark.parametrize(("task", "d"), [(cylinder(4, 2, "triangle"), 2), (sphere(2, 2, "hexahedron"), 3)])
def test_nodal_pressure_is_integrated_as_the_field_that_it_is(task: Task, d: int) -> None:
    """A parabola p = 300 − 100 (r/R)² at the nodes of the flat body, which order 2 represents: over the contact
    surface, |x| ≤ R or a quarter disc, ∫p = 2R (300 − 100/3) or π R²/4 (300 − 50); off itself by nothing."""
    mesh = task.bodies[1]
    nodes = np.unique(mesh.facets[task.contact[1]])
    radius = np.hypot(*mesh.points[nodes, : d - 1].T) if d == 3 else np.abs(mesh.points[nodes, 0])
    R = radius.max()
    found = Pressure.of(task, Answer(1, 300.0 - 100.0 * (radius / R) ** 2, nodes))
    exact = 2 * R * (300 - 100 / 3) if d == 2 else np.pi * R**2 / 4 * (300 - 50)
    assert found.force == pytest.approx(exact, rel=2e-3)
    assert found.value == pytest.approx(300.0 - 100.0 * (found.radius / R) ** 2, rel=2e-3)


def test_the_reference_is_found_again_from_its_own_points() -> None:
    """A smooth pressure √(1 − s)(c0 + c1 s) at points and with weights of a fine rule: the fit gives a, c0 and c1."""
    exact = Reference(0.51, (300.0, -20.0))
    radius = (np.arange(20000) + 0.5) * 0.6 / 20000
    for d in (2, 3):
        weights = np.full(len(radius), 2 * 0.6 / 20000) if d == 2 else np.pi / 2 * radius * 0.6 / 20000
        found = Reference.fitted(Pressure(radius, exact(radius), weights), 0.5, d)
        assert found.half_width == pytest.approx(0.51, rel=1e-4)
        assert found.coefficients == pytest.approx((300.0, -20.0), rel=2e-3)


def test_evolvent_solves_the_line_contact_of_the_benchmark() -> None:
    """Hertz: the peak of an ellipse with the force F of the solution is √(F E*/π R); a/R = 0.01, cells of a/4."""
    task = cylinder(4, 2, "quadrilateral")
    found = Pressure.of(task, solved(task))
    peak = LINE.peak * np.sqrt(found.force / (np.pi / 2 * LINE.peak * LINE.half_width))
    assert found.peak(LINE.half_width) == pytest.approx(peak, rel=0.005)
