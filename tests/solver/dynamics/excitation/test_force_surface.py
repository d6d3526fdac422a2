"""A mesh under loads between those that were solved, against a force in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent_meshes.arrays import Floats

ANGLES = 2.0 * np.pi / 50.0 * np.arange(6) / 6
FIRST, SECOND = 2e5 * (1.0 + 0.2 * np.cos(50.0 * ANGLES)), 3e6 * (1.0 + 0.3 * np.sin(50.0 * ANGLES))
FORCES = np.array([200.0, 1000.0, 2400.0, 4800.0])


def depth(force: float) -> Floats:
    """x (n,) of F = a x + b x²."""
    return np.asarray((np.sqrt(FIRST**2 + 4.0 * SECOND * force) - FIRST) / (2.0 * SECOND))


def stiffening() -> MeshExcitation:
    """F = a x + b x² with a and b over the pitch, solved at FORCES."""
    unloaded = 1e-3 * np.sin(50.0 * ANGLES)
    depths = np.column_stack([depth(float(force)) for force in FORCES])
    stiffness = FIRST[:, None] + 2.0 * SECOND[:, None] * depths
    return MeshExcitation(unloaded, LoadedMesh(ANGLES, FORCES, 1.0, unloaded[:, None] + depths, stiffness))


@pytest.mark.parametrize("load", [50.0, 600.0, 1000.0, 1700.0, 4799.0])
def test_between_solved_loads(load: float) -> None:
    """F = a x + b x². Exact: x by the quadratic formula and k = √(a² + 4 b F), which the cubic interpolants have in
    them; the tangent and secant stiffness of the mesh are k and F/x. 1e-9."""
    mesh = stiffening()
    x, stiffness = mesh.under(load)
    exact = np.sqrt(FIRST**2 + 4.0 * SECOND * load)
    assert x == pytest.approx(depth(load), rel=1e-9)
    assert stiffness == pytest.approx(exact, rel=1e-9)
    assert mesh.stiffness_side(load).force[:, 0, 1, 0] == pytest.approx(exact, rel=1e-9)
    assert mesh.stiffness_side(load, secant=True).force[:, 0, 1, 0] == pytest.approx(load / depth(load), rel=1e-9)


def test_solved_loads_are_as_solved() -> None:
    """Deflection and stiffness under each solved load: the same bits; a load that differs by rounding is that one."""
    mesh = stiffening()
    for j, force in enumerate(FORCES):
        for load in (float(force), float(force) * (1.0 + 1e-15)):
            x, stiffness = mesh.under(load)
            assert (x == mesh.depths[:, j]).all() and (stiffness == mesh.loaded.stiffness[:, j]).all()


def test_series_adds_its_compliance_between_solved_loads() -> None:
    """A spring k_s behind a mesh of constant stiffness k. Exact: x = F/k + F/k_s, 1/(1/k + 1/k_s)."""
    k, series, load = np.tile(3e5 + 1e3 * np.arange(6)[:, None], len(FORCES)), 5e5, 700.0
    mesh = MeshExcitation(np.zeros(6), LoadedMesh(ANGLES, FORCES, 1.0, FORCES / k, k)).in_series(series)
    x, stiffness = mesh.under(load)
    assert x == pytest.approx(load / k[:, 0] + load / series, rel=1e-9)
    assert stiffness == pytest.approx(1.0 / (1.0 / k[:, 0] + 1.0 / series), rel=1e-9)


@pytest.mark.parametrize("load", [-1.0, 0.0, 4801.0])
def test_loads_off_the_surface_are_refused(load: float) -> None:
    """Not above 0, and beyond the heaviest: that and the load are named."""
    with pytest.raises(ValueError, match=f"heaviest, 4800 N, found {load:.6g}"):
        stiffening().under(load)
