"""The smallest sphere around points, against spheres that are known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from evolvent.strength.fatigue.half_plane import HertzTractions, plane_strain
from evolvent.strength.fatigue.smallest_sphere import centre
from evolvent_meshes.arrays import Floats


@pytest.mark.parametrize("dimension", [1, 2, 3, 5])
def test_points_on_and_in_a_sphere(dimension: int) -> None:
    """200 points in a sphere and opposite pairs on it: its own centre, to 1e-9 of its radius."""
    rng = np.random.default_rng(dimension)
    directions = rng.normal(size=(200, dimension))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    middle = rng.normal(size=dimension)
    inner = 3.0 * rng.uniform(0.0, 0.99, (200, 1)) * directions
    points = middle + np.vstack([inner, 3.0 * directions[:4], -3.0 * directions[:4]])
    assert centre(points) == pytest.approx(middle, abs=3e-9)


def test_obtuse_and_acute_triangle() -> None:
    """Obtuse: middle of the longest side. Equilateral: its middle."""
    assert centre(np.array([[0.0, 0.0], [4.0, 0.0], [1.0, 0.5]])) == pytest.approx([2.0, 0.0], abs=1e-9)
    acute = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, np.sqrt(3.0)]])
    assert centre(acute) == pytest.approx([1.0, 1.0 / np.sqrt(3.0)], abs=1e-9)


def test_one_point_and_equal_points() -> None:
    """The point itself."""
    assert centre(np.ones((1, 3))) == pytest.approx(np.ones(3))
    assert centre(np.ones((9, 3))) == pytest.approx(np.ones(3))


@pytest.mark.parametrize("depth", [0.0, 0.1, 0.5, 0.8, 2.5])
def test_path_of_a_passage(depth: float) -> None:
    """Deviators below a sliding contact, 2000 of them: no centre has a smaller largest distance, by a search from ours
    (Nelder and Mead) on the three components that a plane problem has."""
    x = np.linspace(-10.0, 10.0, 2000)
    stress = plane_strain(HertzTractions(1.0, 1.0, 0.12).stress(x, np.full_like(x, depth)), 0.3)
    points = (stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)).reshape(-1, 9)
    found = centre(points)
    plane = np.array([[1, 0, 0, 0, 0, 0, 0, 0, -1], [1, 0, 0, 0, -2, 0, 0, 0, 1], [0, 0, 1, 0, 0, 0, 1, 0, 0]]) / 2.0

    def radius(shift: Floats) -> float:
        return float(np.linalg.norm(points - found - shift @ plane, axis=1).max())

    best = minimize(radius, np.zeros(3), method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12, "maxiter": 2000})
    assert radius(np.zeros(3)) <= best.fun + 1e-9
