"""The mesh under several torques against the pitch that is solved under each, and differences of loads."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from evolvent.dynamics.excitation.force_surface import MeshExcitation, NoForceSurface
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh, loaded_mesh
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep import position_search
from tests.support.gear_cases import model_of, spur_scene, swept

TORQUES = np.array([20e3, 85e3, 170e3, 255e3])
ANGLES = 2.0 * np.pi / 50.0 * np.arange(4) / 4


@cache
def model() -> GearModel:
    return model_of(spur_scene("mesh.level=quick"))


@cache
def mesh() -> LoadedMesh:
    return loaded_mesh(model(), TORQUES.tolist(), ANGLES)


def test_each_torque_is_that_of_a_sweep() -> None:
    """Transmission error and stiffness as a sweep under this torque has them: 1e-8."""
    (curves,) = swept(model(), np.degrees(ANGLES), [0.0])
    number = TORQUES.tolist().index(170e3)
    assert mesh().errors[:, number] == pytest.approx(curves.of("transmission_error"), rel=1e-8)
    stiffness = 20.0 * np.array([result.stiffness for result in curves.results])
    assert mesh().stiffness[:, number] == pytest.approx(stiffness, rel=1e-6)
    assert mesh().torques.tolist() == TORQUES.tolist()
    assert mesh().forces == pytest.approx(TORQUES / model().pair.pinion.base_radius)


def test_tangent_stiffness_is_that_of_two_loads() -> None:
    """dF/ds against the difference of loads 0.1 % above and below: 1e-4."""
    torques = (170e3 * np.array([0.999, 1.0, 1.001])).tolist()
    found = loaded_mesh(model(), torques, ANGLES)
    difference = (found.forces[2] - found.forces[0]) / (found.errors[:, 2] - found.errors[:, 0])
    assert found.stiffness[:, 1] == pytest.approx(difference, rel=1e-4)


def test_flanks_are_searched_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each torque's displacement is predicted from the lighter one's: after the first position, where nothing is known
    of the second differences, at most one of four torques wants a second search."""
    count, search = 0, position_search.facing_flanks

    def counted(*args: Any, **options: Any) -> GearContact:
        nonlocal count
        count += 1
        return search(*args, **options)

    monkeypatch.setattr(position_search, "facing_flanks", counted)
    loaded_mesh(model(), TORQUES.tolist(), ANGLES[:1])
    first = count
    loaded_mesh(model(), TORQUES.tolist(), ANGLES)
    assert count - 2 * first <= 5 * (len(ANGLES) - 1)


def test_force_surface_has_the_solved_forces_and_stiffnesses() -> None:
    """At each position under each torque: F and ∂F/∂x within 2e-3 and 2 % of what was solved, read between its
    knots."""
    excitation = MeshExcitation(np.zeros(len(ANGLES)), mesh())
    side = excitation.force_surface()
    for i, x in enumerate(excitation.depths):
        for j, depth in enumerate(x):
            b = int(np.searchsorted(side.depths, depth)) - 1
            c, d = side.force[i, b, :, 0], depth - side.depths[b]
            assert np.polyval(c[::-1], d) == pytest.approx(mesh().forces[j], rel=2e-3)
            slope = np.polyval((c[1:] * (1.0, 2.0, 3.0))[::-1], d)
            assert slope == pytest.approx(mesh().stiffness[i, j], rel=0.02)


def test_force_goes_on_with_the_stiffness_under_the_heaviest_torque() -> None:
    """∂F/∂x at the last depth is the tangent stiffness there at each position: exact."""
    side = MeshExcitation(np.zeros(len(ANGLES)), mesh()).force_surface()
    d = side.depths[-1] - side.depths[-2]
    slopes = (side.force[:, -1, 1:, 0] * (1.0, 2.0, 3.0)) @ d ** np.arange(3)
    assert slopes == pytest.approx(mesh().stiffness[:, -1], rel=1e-9)


def test_deflections_that_do_not_grow_are_refused() -> None:
    """An unloaded error above the loaded one: no force surface, the position and the load are named."""
    with pytest.raises(NoForceSurface, match="wanted more than under the load before"):
        MeshExcitation(np.full(len(ANGLES), 1.0), mesh())
