"""What a trusted contact solver promises and no other test holds it to; each test is seen to fail on a broken solver.

Held elsewhere: ranks and resuming on another number of them (run/test_scene_run.py, results/archive/test_archive.py), a
retried step and the tooth index (gears/test_gear_pair.py), a turned model (contact/solution/), action and reaction
(contact/newton/test_equilibrium.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from demos.two_blocks import Patch
from evidence.robustness.settings.matrix import Cylinder, patch_cell
from evidence.robustness.settings.sheets import Cell, attempt
from evolvent import Problem, SmallStrainExceeded, solve
from evolvent.contact.newton import contact_equations, equilibrium, snes
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.nitsche.contact_operator import ContactOperator
from evolvent.contact.nitsche.coulomb import LawValues, coulomb
from evolvent.contact.search.pairing import Pairing
from evolvent.contact.step import paired_surfaces
from evolvent.fem.surface import Surface
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep import pitch_sweep, position_search
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import shared_position
from evolvent.scene.scene import Scene, scene_from_text
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import QUIET, Curves, model_of, swept
from tests.support.running.patches import calling_first, with_result

ROTATIONS = np.array([1.0, 1.5, 2.0])
FRICTION = 0.2


def pair(scale: float = 1.0, z: tuple[int, int] = (20, 24), helix: float = 0.0, *settings: str) -> Scene:
    """A spur or helical pair of module 3 mm times `scale`, under a torque that makes the same stress."""
    bores = [1.8 * 3.0 * teeth / 3.0 * scale for teeth in z]
    elements = 0.5 if helix else 2.0
    text = f"""
    pair = {{ normal_module_mm = {3.0 * scale}, helix_angle_deg = {helix} }}
    pinion = {{ teeth = {z[0]}, face_width_mm = {8.0 * scale}, bore_diameter_mm = {bores[0]} }}
    wheel = {{ teeth = {z[1]}, face_width_mm = {8.0 * scale}, bore_diameter_mm = {bores[1]} }}
    mesh = {{ level = "quick", elements_per_contact_width = {elements} }}
    load = {{ torque_Nm = {6.0 * z[0] * scale**3} }}
    """
    return scene_from_text(text, [*QUIET, *settings])


@pytest.fixture(scope="module")
def spur() -> GearModel:
    return model_of(pair())


@pytest.fixture(scope="module")
def helical() -> GearModel:
    return model_of(pair(1.0, (20, 24), 20.0))


def fails(check: Callable[[], None]) -> bool:
    """Whether a check finds something wrong."""
    try:
        check()
    except (AssertionError, NotConverged):
        return True
    return False


def forces_cancel(model: GearModel) -> None:
    """The forces on both gears in the common frame, summed over the nodes: Σ F_1 + Σ F_2 = 0."""
    shared = shared_position(model, 0.02, (0.0, 0.0), (0.0,), None)
    geometry, force = shared.contact.geometry, shared.smooth.force
    ends = np.cumsum([len(t.operator.nodes) for t in geometry.teeth])[:-1]
    total = np.zeros((2, geometry.d))
    for gear in Member:
        turned = geometry.stand.rotation(gear, geometry.d)
        for own, nodal in zip(geometry.jump_maps(gear, 1), np.split(force, ends), strict=True):
            total[gear] += own.forces(nodal).sum(axis=0) @ turned.T
    assert np.linalg.norm(total[0]) > 0.5 * force.sum()
    assert np.linalg.norm(total.sum(axis=0)) < 1e-8 * force.sum()


@pytest.mark.parametrize("name", ["spur", "helical"])
def test_forces_on_curved_flanks_cancel(
    name: str, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exact: what the pinion presses on the wheel with, the wheel presses on the pinion with, tooth flanks or not. Seen
    to fail where the projection loses a thousandth of a constant."""
    model = request.getfixturevalue(name)
    forces_cancel(model)

    def leaking(contact: GearContact) -> GearContact:
        geometry = contact.geometry
        lossy = [replace(t.operator.jump2, mixed=0.999 * t.operator.jump2.mixed) for t in geometry.teeth]
        teeth = [replace(t, operator=replace(t.operator, jump2=Π)) for t, Π in zip(geometry.teeth, lossy)]
        return replace(contact, geometry=replace(geometry, teeth=tuple(teeth)))

    monkeypatch.setattr(position_search, "facing_flanks", with_result(position_search.facing_flanks, leaking))
    assert fails(lambda: forces_cancel(model))


def obeys_coulomb(result: PositionResult, friction: float) -> None:
    """|τ| ≤ μλ at every point; where it slides |τ| = μλ and friction takes power, and somewhere it slides."""
    t, rate = result.contact.traction, result.contact.rate
    size = np.linalg.norm(t[:, 1:], axis=1)
    assert np.all(t[:, 0] > 0.0) and np.all(size <= friction * t[:, 0] * (1.0 + 1e-9))
    slides = ~result.contact.sticks
    assert slides.any()
    np.testing.assert_allclose(size[slides], friction * t[slides, 0], rtol=1e-8)
    assert np.mean(np.einsum("qa,qa->q", t[slides, 1:], rate[slides, 1 : t.shape[1]]) > 0.0) > 0.9


@pytest.mark.parametrize("name", ["spur", "helical"])
def test_friction_law_at_every_point(
    name: str, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Coulomb's law on the flanks of both pairs, at μ = 0.2. Seen to fail where μ is silently zero, halved, or the
    friction cone is forgotten."""
    model = request.getfixturevalue(name)

    def check() -> None:
        for result in swept(model, ROTATIONS[:2], [FRICTION])[0].results:
            obeys_coulomb(result, FRICTION)

    check()

    def cone_forgotten(trial: Floats, friction: Floats | float) -> LawValues:
        return coulomb(trial, 1e3 if np.any(friction) else 0.0)

    for broken in (lambda t, μ: coulomb(t, 0.0 * μ), lambda t, μ: coulomb(t, 0.5 * μ), cone_forgotten):
        with monkeypatch.context() as patch:
            patch.setattr(equilibrium, "coulomb", broken)
            assert fails(check)


def dimensionless(curves: list[Curves], scale: float) -> list[Floats]:
    """Transmission error over the size, wheel torque over its cube, peak pressure, per friction coefficient."""
    return [
        np.array([curve.of("transmission_error") for curve in curves]) / scale,
        np.array([curve.of("torques")[:, 1] for curve in curves]) / scale**2,  # plane: torque per mm of width
        np.array([[r.contact.pressure.max() for r in curve.results] for curve in curves]),
    ]


@pytest.mark.parametrize("scale", [0.1, 10.0])
def test_size_of_gears(scale: float) -> None:
    """All lengths times `scale`, the same stresses: the same dimensionless results within 1e-8. Exact: elastic contact
    has no length of its own. Failed at 8e-5 while the search was repeated beyond a fixed 0.5 µm."""
    one, other = (dimensionless(swept(model_of(pair(s)), ROTATIONS, [0.0, FRICTION]), s) for s in (1.0, scale))
    for a, b in zip(one, other, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-8)


def test_size_of_gears_sees_a_fixed_length(monkeypatch: pytest.MonkeyPatch) -> None:
    """The check above fails where the search is repeated beyond 0.5 µm whatever the module, as it once was."""

    def fix_length(model: GearModel, *_: object, **__: object) -> None:
        monkeypatch.setattr(position_search, "RELOCATE", 5e-4 / model.pair.pinion.normal_module)

    monkeypatch.setattr(pitch_sweep, "shared_position", calling_first(position_search.shared_position, fix_length))
    assert fails(lambda: test_size_of_gears(10.0))


def in_units(problem: Problem, length: float) -> Problem:
    """The problem in units of length that are `length` mm: modulus in N per unit², load per unit of thickness."""
    bodies = []
    for body in problem.bodies:
        material = replace(body.material, youngs_modulus=body.material.youngs_modulus * length**2)
        mesh = replace(body.mesh, points=body.mesh.points / length)
        rigid = body.rigid and replace(
            body.rigid,
            freedoms=tuple(f if f.load is None else replace(f, load=f.load * length) for f in body.rigid.freedoms),
        )
        bodies.append(replace(body, mesh=mesh, material=material, rigid=rigid))
    contacts = tuple(replace(c, reach=c.reach and c.reach / length) for c in problem.contacts)
    return replace(problem, bodies=tuple(bodies), contacts=contacts)


@pytest.mark.parametrize("length", [1e-3, 25.4, 1e3])
def test_units(length: float) -> None:
    """Exact: a cylinder on a block with friction in µm, inch and m has the traction that it has in mm, within 1e-8.
    Where the modulus keeps its unit it has another one, or is refused as strained too far."""
    problem = Cylinder().problem()
    wanted = solve(problem).contacts[0]
    found = solve(in_units(problem, length)).contacts[0]
    np.testing.assert_allclose(found.traction / length**2, wanted.traction, atol=1e-8 * wanted.pressure.max())
    turned = in_units(problem, length)
    kept = [replace(body, material=old.material) for body, old in zip(turned.bodies, problem.bodies, strict=True)]
    try:
        other = solve(replace(turned, bodies=tuple(kept))).contacts[0].pressure.max()
    except SmallStrainExceeded:
        return
    assert abs(other / length**2 / wanted.pressure.max() - 1.0) > 1e-3


def test_swapped_gears() -> None:
    """Exact but for the mesh: which gear is called the pinion, carries the pressure and drives does not change the mesh
    stiffness. The mean transmission error over a pitch at the same tooth force agrees within 1 %; seen to fail for a
    wheel of 10 % less modulus."""

    def mean_error(z: tuple[int, int], *settings: str) -> float:
        scene = pair(1.0, z, 0.0, *settings)
        degrees = 360.0 / z[0] * np.arange(12) / 12
        return float(swept(model_of(scene), degrees, [0.0])[0].of("transmission_error").mean())

    one, other = mean_error((20, 24)), mean_error((24, 20))
    assert abs(one) == pytest.approx(abs(other), rel=0.01)
    assert abs(mean_error((24, 20), "material.wheel.E_GPa=189")) != pytest.approx(abs(one), rel=0.01)


@pytest.mark.parametrize(("shape", "order"), [("triangle", 1), ("quadrilateral", 2), ("hexahedron", 1)])
def test_patch_test_on_distorted_meshes(shape: str, order: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Exact: a uniform pressure and shear pass any mesh, also one at a tenth of its scaled Jacobian. Failed by up to
    22 % of the pressure while γ itself, not 1/γ, was interpolated between nodes, which is how it is broken here."""
    patch = Patch(shape, order, friction=0.3)
    assert patch_cell(patch, 0.1).error < 1e-9
    original = paired_surfaces.contact_operator

    def interpolated(
        pairing: Pairing, first: Surface, second: Surface, stabiliser: Floats, frames: Floats
    ) -> ContactOperator:
        operator = original(pairing, first, second, stabiliser, frames)
        return replace(operator, stabiliser=operator.hat @ stabiliser[operator.nodes])

    monkeypatch.setattr(paired_surfaces, "contact_operator", interpolated)
    assert patch_cell(patch, 0.1).error > 1e-3


def test_steps_that_go_too_far_are_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    """A residual on which Newton's full step runs to and fro for ever, |x|^½ sgn x: solved by cut steps; without them
    it is said that it is not."""

    class Root:
        def residual(self, x: Floats) -> Floats:
            return np.sign(x) * np.sqrt(np.abs(x))

        def solve(self, x: Floats, right: Floats) -> Floats:
            return right * 2.0 * np.sqrt(np.abs(x))

        def scale(self, x: Floats) -> float:
            return 1.0

        def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
            return lambda α: -float(step @ self.residual(x - α * step))

    assert snes.solve(Root(), np.array([1.0]), "test", 60, 1e-6).converged
    monkeypatch.setattr(snes._SnesTangent, "_shortened", lambda _, step: step)
    assert not snes.solve(Root(), np.array([1.0]), "test", 60, 1e-6).converged


@pytest.mark.parametrize("broken", ["residual", "tangent"])
def test_nan_is_said(broken: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A NaN in the contact forces or in the step ends in NotConverged, never in a result."""
    cylinder = Cylinder(friction=0.0)
    assert attempt(cylinder.cell).iterations > 0
    if broken == "residual":
        original = equilibrium.coulomb
        monkeypatch.setattr(
            equilibrium, "coulomb", lambda t, μ: replace(original(t, μ), traction=np.nan * original(t, μ).traction)
        )
    else:
        monkeypatch.setattr(contact_equations.Tangent, "solve", lambda _, right: np.full_like(right, np.nan))
    cell: Cell = attempt(cylinder.cell)
    assert cell.refused and "not a number" in cell.refused
