"""One condensed sector closed to a ring, against the merged model of all sectors (exact up to rounding)."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent.fem.condensation.schur_complement import (
    Factor,
    SectorCondensation,
    SectorRecovery,
    SectorSystem,
    compliance,
)
from evolvent.gears.ring.chain_settings import ChainSettings
from evolvent.gears.ring.jump_map import JumpMap
from evolvent.gears.ring.ring_compliance import ChainedCompliance, MappedNodes
from evolvent_meshes.arrays import Floats, Ints
from tests.support.q1_elasticity import Ring, ring

SECTORS = 7
PITCH = 2 * np.pi / SECTORS
SHAPES = {"2D": (4, 6), "3D": (3, 4, 3)}
TEETH, FIRST = 4, -1


def picker(rows: Ints, size: int) -> sp.csr_matrix:
    return sp.csr_matrix((np.ones(len(rows)), (np.arange(len(rows)), rows)), shape=(len(rows), size))


def turned(angle: float, dimension: int) -> Floats:
    matrix = np.eye(dimension)
    matrix[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return matrix


def free_model(model: Ring, surface: Ints) -> tuple[sp.csr_matrix, sp.csr_matrix, Ints, Ints]:
    """K and the displacements of `surface` on the free dofs, cut faces in the numbering of the free dofs."""
    everything = picker(surface, model.stiffness.shape[0])
    number = np.full(model.stiffness.shape[0], -1)
    number[model.free] = np.arange(len(model.free))
    restricted = model.stiffness[model.free][:, model.free]
    return restricted, everything[:, model.free], number[model.low], number[model.high]


def sector_parts(shape: str, pitch: float = PITCH) -> tuple[sp.csr_matrix, sp.csr_matrix, Ints, Ints]:
    model = ring(SHAPES[shape], 1, pitch)
    return free_model(model, model.surface[0])


def sector_of(shape: str, pitch: float = PITCH) -> SectorCondensation:
    return SectorSystem.of(*sector_parts(shape, pitch)).condensed()


def merged(shape: str) -> tuple[Ring, Floats]:
    """The whole ring as one mesh, and the compliance of the teeth that are named."""
    model = ring(SHAPES[shape], SECTORS, PITCH, FIRST, closed=True)
    surface = picker(np.concatenate(model.surface[:TEETH]), model.stiffness.shape[0])
    return model, compliance(model.stiffness, surface, model.free)


def chained(shape: str) -> ChainedCompliance:
    sector = sector_of(shape)
    return ChainedCompliance.of(sector, ChainSettings(PITCH, TEETH, FIRST, dimension=len(SHAPES[shape])))


def all_rows(body: ChainedCompliance) -> Ints:
    return np.array([(tooth, node) for tooth in body.teeth for node in range(body.node_count)])


def parts(rows: Ints) -> list[MappedNodes]:
    """Rows (tooth, node), sorted by tooth, as a block wants them."""
    return [MappedNodes(int(tooth), rows[rows[:, 0] == tooth, 1]) for tooth in np.unique(rows[:, 0])]


@pytest.mark.parametrize("shape", SHAPES)
def test_chained_compliance_equals_the_merged_model(shape: str) -> None:
    """Compliance of four teeth of a ring of seven = that of one mesh of the ring, to 1e-12."""
    _, exact = merged(shape)
    gear = chained(shape)
    found = gear.jumps(parts(all_rows(gear)))
    assert np.abs(found - exact).max() < 1e-12 * np.abs(exact).max()
    # the test would not see a missing coupling if there were none
    across = exact[: len(exact) // TEETH, len(exact) // TEETH : 2 * len(exact) // TEETH]
    assert np.abs(across).max() > 1e-2 * np.abs(exact).max()


@pytest.mark.parametrize("shape", SHAPES)
def test_displacements_under_forces_equal_the_merged_model(shape: str) -> None:
    """Displacements of any rows under forces on others, in any order, = the same entries of the merged compliance."""
    _, exact = merged(shape)
    gear, d = chained(shape), len(SHAPES[shape])
    random = np.random.default_rng(1)
    chosen = random.permutation(all_rows(gear))
    rows_in, rows_out = chosen[:9], chosen[5:20]
    forces = random.normal(size=(9, d))

    def dofs(rows: Ints) -> Ints:
        return (((rows[:, 0] - FIRST) * gear.node_count + rows[:, 1])[:, None] * d + np.arange(d)).ravel()

    wanted = (exact[np.ix_(dofs(rows_out), dofs(rows_in))] @ forces.ravel()).reshape(-1, d)
    assert np.abs(gear.apply(rows_in, forces, rows_out) - wanted).max() < 1e-12 * np.abs(wanted).max()
    sorted_rows = rows_out[np.argsort(rows_out[:, 0], kind="stable")]
    wanted = exact[np.ix_(dofs(sorted_rows), dofs(sorted_rows))]
    assert np.abs(gear.jumps(parts(sorted_rows)) - wanted).max() < 1e-12 * np.abs(exact).max()


def random_map(random: np.random.Generator, nodes: int, d: int) -> JumpMap:
    """Two components at each of two nodes from all displacements of a flank."""
    mass, mixed = SurfaceMass(sp.identity(2, format="csr")), sp.csr_matrix(random.normal(size=(2, nodes)))
    return JumpMap(MortarProjection(mass, mixed), random.normal(size=(2, 2, d)))


@pytest.mark.parametrize("shape", SHAPES)
def test_mapped_compliance_equals_the_merged_model(shape: str) -> None:
    """E C Eᵀ with a random linear map on each tooth, teeth in any order, = the same from the merged compliance."""
    _, exact = merged(shape)
    gear, random = chained(shape), np.random.default_rng(3)
    d, n = len(SHAPES[shape]), gear.node_count
    size = n * d
    jumps = {tooth: random_map(random, n, d) for tooth in (1, -1, 0)}
    found = gear.jumps([MappedNodes(t, np.arange(n), E) for t, E in jumps.items()])
    maps = {tooth: E.jumps(np.eye(size)) for tooth, E in jumps.items()}
    E = np.zeros((12, len(exact)))
    for i, (tooth, own) in enumerate(maps.items()):
        E[4 * i : 4 * i + 4, (tooth - FIRST) * size : (tooth - FIRST + 1) * size] = own
    assert np.abs(found - E @ exact @ E.T).max() < 1e-12 * np.abs(E @ exact @ E.T).max()


def test_fields_of_sectors_equal_the_merged_model() -> None:
    """Field of every sector from cut-face displacements and forces = the merged model's field, turned back."""
    shape, d = "3D", 3
    model, _ = merged(shape)
    gear = chained(shape)
    recovery = SectorRecovery(*sector_parts(shape))
    rows = np.array([(0, 2), (0, 5), (1, 3)])
    forces = np.random.default_rng(2).normal(size=(3, d))
    load = np.zeros(model.stiffness.shape[0])
    for (tooth, node), force in zip(rows, forces, strict=True):
        load[model.surface[tooth - FIRST].reshape(-1, d)[node]] += force
    field = Factor(model.stiffness, free=model.free).solve(load).reshape(4, -1, 4, d)
    field[:, -1] = field[:, 0]
    for tooth, cut in gear.cut_displacements(rows, forces).items():
        turn = turned(tooth * PITCH, d)
        local = np.zeros((gear.node_count, d))
        local[rows[rows[:, 0] == tooth, 1]] = forces[rows[:, 0] == tooth] @ turn
        found = recovery.displacement(local.ravel(), cut).reshape(3, -1, 4, d) @ turn.T
        start = 4 * (tooth - FIRST)
        assert np.abs(found - field[1:, start : start + 5]).max() < 1e-12 * np.abs(field).max()


@pytest.mark.parametrize(("shape", "sectors"), [("2D", 7), ("2D", 6), ("3D", 5), ("2D", 3)])
def test_closed_ring_equals_merged_ring(shape: str, sectors: int) -> None:
    """Compliance of all teeth of a closed ring (odd and even numbers) = that of one mesh of the whole ring."""
    pitch = 2 * np.pi / sectors
    model = ring(SHAPES[shape], sectors, pitch, -2, closed=True)
    exact = compliance(model.stiffness, picker(np.concatenate(model.surface), model.stiffness.shape[0]), model.free)
    gear = ChainedCompliance.of(
        sector_of(shape, pitch), ChainSettings(pitch, sectors, -2, dimension=len(SHAPES[shape]))
    )
    assert np.abs(gear.jumps(parts(all_rows(gear))) - exact).max() < 1e-12 * np.abs(exact).max()


@pytest.mark.parametrize("sectors", [7, 6])
def test_cut_faces_of_a_closed_ring_equal_the_merged_ring(sectors: int) -> None:
    """Displacements of both cut faces of every tooth of a loaded ring = those of one mesh of the ring."""
    pitch, first = 2 * np.pi / sectors, -2
    radial, angular = SHAPES["2D"]
    model = ring((radial, angular), sectors, pitch, first, closed=True)
    gear = ChainedCompliance.of(sector_of("2D", pitch), ChainSettings(pitch, sectors, first, dimension=2))
    rows, forces = np.array([(-2, 1), (1, 3)]), np.array([[1.0, -2.0], [0.5, 3.0]])
    load = np.zeros(model.stiffness.shape[0])
    for (tooth, node), force in zip(rows, forces, strict=True):
        load[model.surface[tooth - first].reshape(-1, 2)[node]] += force
    field = Factor(model.stiffness, model.free).solve(load).reshape(radial + 1, sectors * angular + 1, 2)
    field[:, -1] = field[:, 0]
    cuts = gear.cut_displacements(rows, forces)
    assert sorted(cuts) == list(gear.teeth)
    for tooth, cut in cuts.items():
        columns = (tooth - first) * angular, (tooth - first + 1) * angular
        wanted = np.concatenate([field[1:, column] for column in columns]) @ turned(tooth * pitch, 2)
        assert np.abs(cut - wanted.ravel()).max() < 1e-12 * np.abs(field).max()


def test_cut_faces_under_several_loads_move_as_under_each() -> None:
    """Two loads at once on the same rows move the cut faces as each of them alone."""
    gear, rows = chained("2D"), np.array([(-1, 1), (1, 3)])
    forces = np.random.default_rng(4).normal(size=(3, 2, 2))
    together = gear.cut_displacements(rows, forces)
    for i, load in enumerate(forces):
        for tooth, cut in gear.cut_displacements(rows, load).items():
            np.testing.assert_allclose(together[tooth][i], cut, rtol=0, atol=1e-13 * np.abs(cut).max())


def test_naming_fewer_teeth_of_a_ring_changes_nothing() -> None:
    """Naming three of the seven teeth gives the same compliance as naming all: the others are still there."""
    pitch = 2 * np.pi / 7
    sector = sector_of("2D", pitch)
    whole = ChainedCompliance.of(sector, ChainSettings(pitch, 7, -3, dimension=2))
    window = ChainedCompliance.of(sector, ChainSettings(pitch, 3, -1, dimension=2))
    rows = all_rows(window)
    wanted = whole.jumps(parts(rows))
    assert np.abs(window.jumps(parts(rows)) - wanted).max() < 1e-14 * np.abs(wanted).max()


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_window_of_some_teeth_has_their_compliance(dtype: type) -> None:
    """Products with forces in the sectors' frames are those of the matrix between the same nodes, in either precision;
    the coupling of the same teeth is made once, whatever their nodes."""
    gear, wanted = chained("2D"), [(-1, np.array([1, 2])), (1, np.array([0, 3]))]
    window = gear.window(wanted)
    rows = np.array([(tooth, node) for tooth, nodes in wanted for node in nodes])
    f = np.random.default_rng(5).normal(size=(4, 2))
    turns = [turned(tooth * PITCH, 2) for tooth, _ in rows]
    moved = gear.apply(rows, np.array([R @ each for R, each in zip(turns, f)]), rows)
    exact = np.array([R.T @ each for R, each in zip(turns, moved)])
    found = window.times(f.astype(dtype))
    assert found.dtype == dtype
    assert found == pytest.approx(exact, abs=(1e-6 if dtype == np.float32 else 1e-12) * np.abs(exact).max())
    assert gear.window([(-1, np.array([0])), (1, np.array([2]))]).coupling is window.coupling
    assert gear.window(wanted[:1]).coupling is not window.coupling


def test_pitch_of_a_closed_ring_must_divide_the_circle() -> None:
    """17.5 sectors, or 8 teeth of 7, cannot be closed."""
    with pytest.raises(ValueError, match=r"17\.500000 to the circle"):
        ChainSettings(2 * np.pi / 17.5, 3)
    with pytest.raises(ValueError, match="and 8 teeth"):
        ChainSettings(PITCH, 8)


def test_rows_of_teeth_that_are_not_modelled_are_refused() -> None:
    """A tooth that is not modelled is an error, not a wrapped index."""
    gear = chained("2D")
    with pytest.raises(IndexError, match=r"teeth -1 to 2 .* found \(3, 0\)"):
        gear.jumps(parts(np.array([(0, 0), (3, 0)])))
