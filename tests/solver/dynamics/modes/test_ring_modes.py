"""Natural modes of a gear from one sector, against the eigenproblem of all its sectors."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, eigsh

from evolvent.dynamics.modes.gear_modes import GearModes, ModeChoice, gear_modes
from evolvent.fem.body import Body, Fixed
from evolvent.fem.condensation.schur_complement import Factor
from evolvent.fem.mass_matrix import mass_matrix
from evolvent.gears.condensed_gear import GearBody, matching_cuts
from evolvent.gears.full_gear import whole_mesh, whole_system
from evolvent.gears.problem.gear_inertia import polar_moment
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.rotation import turn
from tests.support.gear_cases import helical_scene, model_of, spur_scene

THREE = ModeChoice(0.0, per_harmonic=3)


@cache
def bodies(kind: str) -> tuple[GearBody, ...]:
    scenes = {
        "spur": lambda: spur_scene("mesh.level=quick"),
        "spur of order 1": lambda: spur_scene("mesh.level=quick", "mesh.order=1"),
        "helical": lambda: helical_scene("mesh.order=1", "pinion.face_width_mm=4", "wheel.face_width_mm=4"),
    }
    return model_of(scenes[kind]()).bodies


@cache
def three(kind: str, member: Member) -> GearModes:
    """Three modes of each harmonic."""
    return gear_modes(bodies(kind)[member], THREE)


def whole(body: GearBody, count: int) -> tuple[Floats, Floats]:
    """ω, and the flank functionals of tooth 0 and 1, of the modes of all sectors."""
    mesh = whole_mesh(body.mesh, matching_cuts(body.mesh, 2.0 * np.pi / body.gear.z), body.gear.z)
    safety = 2.0 if body.stabiliser is not None else None
    system = whole_system(mesh, body.material, body.gear.z, range(2), safety)
    free = system.free
    M = mass_matrix(Body(mesh, body.material, supports=(Fixed("bore"),)))[free][:, free]
    K = system.stiffness[free][:, free].tocsr()
    inverse = LinearOperator(K.shape, Factor(K).solve, dtype=float)
    values, shapes = eigsh(K, count, M=M, sigma=0.0, OPinv=inverse)
    order = np.argsort(values)
    return np.sqrt(values[order]), system.functionals[:, free] @ shapes[:, order]


@pytest.mark.parametrize("member", Member)
@pytest.mark.parametrize("kind", ["spur of order 1", "helical"])
def test_modes_are_those_of_the_whole_gear(kind: str, member: Member) -> None:
    """The lowest eight modes of the whole gear, with Nitsche's constant term on the pinion, from one sector:
    frequencies to 1e-8, and for each group of equal ones the same Φ_P Φ_Pᵀ on two teeth to 1e-6 of the largest."""
    body, found = bodies(kind)[member], three(kind, member)
    exact, shapes = whole(body, 10)
    order = np.argsort(found.modes.frequencies, kind="stable")[:8]
    assert found.modes.frequencies[order] == pytest.approx(exact[:8], rel=1e-8)
    turned = np.kron(np.eye(len(body.flank.points)), turn(2.0 * np.pi / body.gear.z, body.d))
    teeth = np.concatenate([found.modes.of_sector(0), turned @ found.modes.of_sector(1)])
    groups = np.split(np.arange(8), np.flatnonzero(np.diff(exact[:8]) > 1e-7 * exact[:7]) + 1)
    for group in groups[:-1]:  # the last one may be half of a pair
        mine, theirs = teeth[:, order[group]], shapes[:, group]
        scale = np.abs(theirs @ theirs.T).max()
        assert np.abs(mine @ mine.T - theirs @ theirs.T).max() < 1e-6 * scale


@pytest.mark.parametrize("kind", ["spur", "helical"])
def test_moment_of_inertia(kind: str) -> None:
    """That of the meshed sectors is that of the gear's section, per mm in 2D, within 1e-4 of a mesh of order 2, 1e-2 of
    order 1; modes have their inertia with a turn in harmonic 0 only, and at most all of it."""
    for member, body in zip(Member, bodies(kind)):
        found = three(kind, member)
        width = body.gear.face_width if body.d == 2 else 1.0
        exact = polar_moment(body.gear, 7.85e-9) / width
        assert found.moment_of_inertia == pytest.approx(exact, rel=1e-3 if body.mesh.order == 2 else 2e-2)
        assert not found.spun[found.modes.harmonic > 0].any()
        assert 0.3 < float(found.spun @ found.spun) / found.moment_of_inertia < 1.0


@pytest.mark.parametrize("kind", ["spur", "helical"])
def test_modes_up_to_a_frequency(kind: str) -> None:
    """All modes of three in each harmonic that are below 25 kHz, and no others; none at all below 100 Hz."""
    body = bodies(kind)[1]
    highest = 2.0 * np.pi * 25e3
    every = three(kind, Member.WHEEL).modes.frequencies
    found = gear_modes(body, ModeChoice(highest)).modes.frequencies
    assert 0 < len(found) < len(every)
    assert np.sort(found) == pytest.approx(np.sort(every[every < highest]), rel=1e-8)
    assert not gear_modes(body, ModeChoice(2.0 * np.pi * 100.0)).count


def test_at_least_some_modes_of_each_harmonic() -> None:
    """None lies below 100 Hz: at least two of each harmonic are the first ones, of ranks 0 and 1, a pair alike."""
    body = bodies("spur of order 1")[0]
    found = gear_modes(body, ModeChoice(2.0 * np.pi * 100.0, least=2)).modes
    first = gear_modes(body, ModeChoice(0.0, per_harmonic=2)).modes
    assert found.frequencies == pytest.approx(first.frequencies, rel=1e-8)
    assert np.bincount(found.harmonic).tolist() == [2, *[4] * 24, 2]
    assert found.rank[:6].tolist() == [0, 1, 0, 0, 1, 1] and set(found.rank.tolist()) == {0, 1}


def test_modes_beyond_those_of_a_held_sector() -> None:
    """Up to 150 kHz, where a sector between held cut faces vibrates, too, so that modes cannot be counted beforehand:
    all of ten in each harmonic that are below, and no others."""
    body = bodies("spur of order 1")[0]
    highest = 2.0 * np.pi * 150e3
    every = gear_modes(body, ModeChoice(0.0, per_harmonic=10)).modes.frequencies
    assert every.max() > highest
    found = gear_modes(body, ModeChoice(highest)).modes.frequencies
    assert np.sort(found) == pytest.approx(np.sort(every[every <= highest]), rel=1e-8)


def test_a_motion_a_pitch_earlier() -> None:
    """Random amplitudes: sector s moves with those of a pitch earlier as sector s + 1 did, to rounding."""
    modes = three("spur", Member.PINION).modes
    q = np.random.default_rng(3).standard_normal(len(modes.frequencies))
    for pitches in (1, -1, 5):
        for sector in (0, 3):
            moved = modes.of_sector(sector) @ modes.earlier(q, pitches)
            assert moved == pytest.approx(modes.of_sector(sector + pitches) @ q, abs=1e-12 * np.abs(q).max() * 1e9)


def test_each_harmonic_is_shown_once_its_modes_are_known() -> None:
    """A ring of 50 teeth has the harmonics 0 to 25: 26 calls."""
    shown: list[None] = []
    gear_modes(bodies("spur of order 1")[0], ModeChoice(0.0, per_harmonic=1), computed=lambda: shown.append(None))
    assert len(shown) == 26
