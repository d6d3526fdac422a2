"""Stiffness, loads, supports and rigid motions of a body, against exact solutions of elasticity."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import scipy.sparse.linalg as spla

from evolvent.fem.body import DIRECTIONS, Body, BodyForce, Fixed, Freedom, Rigid, Traction, assemble
from evolvent.fem.material import Material
from evolvent.fem.rigid_modes import rigid_modes
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import box, rectangle

CASES = [(s, o) for s in ("triangle", "quadrilateral", "tetrahedron", "hexahedron") for o in (1, 2)]


def _block(shape: str, order: int) -> MeshData:
    if shape in ("triangle", "quadrilateral"):
        return rectangle(3.0, 2.0, 3, 2, order, shape)
    return box((3.0, 2.0, 2.0), (3, 2, 2), order, shape)


@pytest.mark.parametrize(("shape", "order"), CASES)
def test_energy_of_a_uniform_strain(shape: str, order: int) -> None:
    """u = εx: uᵀKu = V ε:σ(ε) for any ε, and K is symmetric."""
    mesh, material = _block(shape, order), Material(200e3, 0.25)
    K, d = assemble(Body(mesh, material)).stiffness, mesh.dimension
    assert abs(K - K.T).max() < 1e-10 * abs(K).max()
    ε = np.random.default_rng(0).normal(size=(d, d))
    ε = ε + ε.T
    λ, μ = material.lame
    u = (mesh.points[:, :d] @ ε).ravel()
    volume = 6.0 if d == 2 else 12.0
    assert u @ (K @ u) == pytest.approx(volume * (λ * np.trace(ε) ** 2 + 2.0 * μ * (ε * ε).sum()), rel=1e-12)


@pytest.mark.parametrize(("shape", "order"), CASES)
def test_rigid_motions_cost_nothing(shape: str, order: int) -> None:
    """K times a small rigid motion is zero, to rounding."""
    mesh = _block(shape, order)
    K = assemble(Body(mesh)).stiffness
    modes = rigid_modes(mesh.points[:, : mesh.dimension]).reshape(K.shape[0], -1)
    assert np.abs(K @ modes).max() < 1e-9 * abs(K).max()


@pytest.mark.parametrize(("shape", "order"), CASES)
def test_resultant_of_a_traction(shape: str, order: int) -> None:
    """A traction's nodal forces add up to traction times area, and act in the middle of the face."""
    mesh = _block(shape, order)
    d = mesh.dimension
    vector = (3.0, -7.0, 2.0)[:d]
    load = assemble(Body(mesh, loads=(Traction("top", vector),))).load.reshape(-1, d)
    area = 3.0 if d == 2 else 6.0
    assert np.allclose(load.sum(axis=0), area * np.array(vector), rtol=1e-12)
    middle = (load[:, d - 1] @ mesh.points[:, :d]) / load[:, d - 1].sum()
    assert np.allclose(middle, [1.5, 2.0] if d == 2 else [1.5, 1.0, 2.0], rtol=1e-12)


@pytest.mark.parametrize(("shape", "order"), CASES)
def test_uniaxial_strain_of_a_column(shape: str, order: int) -> None:
    """Pressed between rollers: u_y = −p (1+ν)(1−2ν)/((1−ν)E) y with all sides held (uniaxial strain)."""
    mesh, material = _block(shape, order), Material(100e3, 0.3)
    up = "xyz"[mesh.dimension - 1]
    sides: tuple[Fixed, ...] = (Fixed("left", "x"), Fixed("right", "x"))
    sides += () if mesh.dimension == 2 else (Fixed("front", "y"), Fixed("back", "y"))
    load = Traction("top", (0.0,) * (mesh.dimension - 1) + (-50.0,))
    a = assemble(Body(mesh, material, (*sides, Fixed("bottom", up)), (load,)))
    u = np.zeros(a.stiffness.shape[0])
    u[a.free] = spla.spsolve(a.stiffness[a.free][:, a.free].tocsc(), a.load[a.free])
    height = mesh.points[:, mesh.dimension - 1]
    exact = -50.0 * (1.3 * 0.4) / (0.7 * 100e3) * height
    assert np.allclose(u.reshape(-1, mesh.dimension)[:, -1], exact, atol=1e-10 * np.abs(exact).max())
    assert a.motions.shapes.shape[2] == 0


@pytest.mark.parametrize("shape", ["quadrilateral", "hexahedron"])
def test_floating_body_has_its_rigid_motions_as_unknowns(shape: str) -> None:
    """Without supports all rigid motions are unknowns, and as many degrees of freedom are pinned: K is then regular,
    and a load's resultant is the load of the motions."""
    mesh = _block(shape, 1)
    d = mesh.dimension
    a = assemble(Body(mesh, loads=(Traction("top", (1.0,) * d),)))
    r = len(DIRECTIONS[d])
    assert a.motions.shapes.shape == (len(mesh.points), d, r)
    assert a.held.sum() == r
    assert np.linalg.matrix_rank(a.stiffness[a.free][:, a.free].toarray()) == len(a.free)
    assert np.allclose(a.motions.load, np.einsum("ndr,nd->r", a.motions.shapes, a.load.reshape(-1, d)))


def test_partly_supported_body_keeps_what_is_left() -> None:
    """Rollers below leave a plane body one shift: exactly that motion is free, and it is the shift along x."""
    mesh = _block("quadrilateral", 1)
    motions = assemble(Body(mesh, supports=(Fixed("bottom", "y"),))).motions
    shape = motions.shapes[:, :, 0]
    assert motions.shapes.shape[2] == 1
    assert np.allclose(shape[:, 0], shape[0, 0])
    assert np.abs(shape[:, 1]).max() < 1e-10 * abs(shape[0, 0])


def test_rigid_coupling_turns_about_its_centre() -> None:
    """The coupled group is at rest in its frame; a rotation about the coupling's centre is e_z × (x − c)."""
    mesh = _block("triangle", 2)
    rigid = Rigid("top", (Freedom("rz", load=5.0), Freedom("x", displacement=0.1)), centre=(1.0, 2.0, 0.0))
    a = assemble(Body(mesh, rigid=rigid))
    top = np.unique(mesh.facets["top"])
    assert a.held.reshape(-1, 2)[top].all()
    arm = mesh.points[:, :2] - (1.0, 2.0)
    assert np.allclose(a.motions.shapes[:, :, 0], np.column_stack([-arm[:, 1], arm[:, 0]]))
    assert np.array_equal(a.motions.free, [0])
    assert a.motions.load[0] == 5.0
    assert a.motions.value[1] == 0.1


@pytest.mark.parametrize(("shape", "order"), CASES)
def test_weight_of_a_column(shape: str, order: int) -> None:
    """A standing column, ν = 0, of length L under f = ϱg: u(z) = −f (L z − z²/2)/E, which second-order cells have
    exactly; the load adds up to f times the volume in all."""
    mesh = _block(shape, order)
    d = mesh.dimension
    up, f, E = "xyz"[d - 1], 2.0, 100e3
    sides = (Fixed("left", "x"), Fixed("bottom", up), *(() if d == 2 else (Fixed("front", "y"),)))
    a = assemble(Body(mesh, Material(E, 0.0), sides, (BodyForce((0.0,) * (d - 1) + (-f,)),)))
    load = a.load.reshape(-1, d).sum(axis=0)
    assert np.allclose(load, [0.0] * (d - 1) + [-f * (6.0 if d == 2 else 12.0)], atol=1e-12)
    u = np.zeros(a.stiffness.shape[0])
    u[a.free] = spla.spsolve(a.stiffness[a.free][:, a.free].tocsc(), a.load[a.free])
    z = mesh.points[:, d - 1]
    exact = -f * (2.0 * z - z**2 / 2.0) / E
    assert order == 1 or np.allclose(u.reshape(-1, d)[:, -1], exact, atol=1e-10 * np.abs(exact).max())


def test_prescribed_displacement_of_a_face() -> None:
    """A face that moves by a prescribed displacement is held there, the others of its directions are free; of two
    supports that agree at a node both hold it."""
    mesh = _block("quadrilateral", 2)
    a = assemble(Body(mesh, supports=(Fixed("top", "y", 0.25), Fixed("right", "y", 0.25))))
    held, value = a.held.reshape(-1, 2), a.prescribed.reshape(-1, 2)
    moved = np.union1d(mesh.facets["top"], mesh.facets["right"])
    assert np.array_equal(np.flatnonzero(value[:, 1]), moved)
    assert np.all(value[moved] == (0.0, 0.25))
    assert held[moved, 1].all()
    assert held[:, 0].sum() == 1  # the pin of the shift along x


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda m: Body(m, supports=(Fixed("floor"),)), "floor"),
        (lambda m: Body(m, loads=(Traction("roof", (0.0, 1.0)),)), "roof"),
        (lambda m: Body(m, rigid=Rigid("lid")), "lid"),
        (lambda m: assemble(Body(m, rigid=Rigid("top", (Freedom("z", load=1.0),)))), "'z'"),
        (
            lambda m: assemble(Body(m, supports=(Fixed("bottom"),), rigid=Rigid("top", (Freedom("y", load=1.0),)))),
            "top",
        ),
    ],
)
def test_impossible_bodies_are_refused(make: Callable[[MeshData], object], message: str) -> None:
    """Unknown facet groups, a motion that a plane body has not, a support against a rigid coupling: ValueError that
    names what was found."""
    with pytest.raises(ValueError, match=message):
        make(_block("quadrilateral", 1))
