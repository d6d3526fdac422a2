"""Small systems of gear bodies against closed forms: gears of a hub and a rim with a spring between them."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.one_degree import one_degree
from evolvent.dynamics.small_system import GearShapes, SmallSystem, pair_system

RADIUS, HUB, RIM = 70.0, 3.0, 4.4
"""Of the base circle [mm], and moments of inertia [t·mm²]."""


def gear(spring: float) -> GearShapes:
    """spring: between hub and rim [N·mm/rad]; the mesh acts on the rim."""
    mass = np.array([[HUB + RIM, RIM], [RIM, RIM]])
    return GearShapes(mass, np.diag([0.0, spring]), np.array([RADIUS, RADIUS]))


def pair(spring: float) -> SmallSystem:
    """Of two such gears."""
    return pair_system(gear(spring), gear(spring))


def test_natural_frequency_of_hubs_and_rims() -> None:
    """Two such gears on a mesh of stiffness K swing against each other: (k + 2r²K − I_r ω²)(k − I_h ω²) = k²,
    whose roots are both natural frequencies to 1e-10; what they carry of the static deflection and in free motion, to
    1e-12."""
    spring, mesh = 2e9, 500e3
    first = spring + 2.0 * RADIUS**2 * mesh
    roots = np.roots([RIM * HUB, -(first * HUB + spring * RIM), first * spring - spring**2])
    system = pair(spring)
    assert system.natural(mesh) == pytest.approx(np.sqrt(np.sort(roots)), rel=1e-10)
    assert system.rigid_mass == pytest.approx((HUB + RIM) / (2.0 * RADIUS**2), rel=1e-12)
    g, b = system.closing, system.reading
    share, whole = HUB / (HUB + RIM), 2.0 * RADIUS**2 / spring
    assert system.compliance(g - b, g - b) == pytest.approx(whole, rel=1e-12)
    assert system.compliance(g, g) == pytest.approx(whole * share**2, rel=1e-12)
    assert system.compliance(g, b) == pytest.approx(-whole * share * (1.0 - share), rel=1e-12)


@pytest.mark.parametrize("hub", [1e-3, 0.1])
def test_light_hubs_on_soft_springs_are_not_the_pair_on_its_mesh(hub: float) -> None:
    """Springs that give way twice what the mesh does, and light hubs: these turn most under a torque at the bores, but
    what the mesh excites are both rims against each other. Exact: the lower root of the same equation, to 1e-9; once it
    was the upper one, at a hub of a thousandth of the rim ten times as fast."""
    mesh = 500e3
    spring, inertia = RADIUS**2 * mesh, hub * RIM
    mass = np.array([[inertia + RIM, RIM], [RIM, RIM]])
    light = GearShapes(mass, np.diag([0.0, spring]), np.array([RADIUS, RADIUS]))
    first = spring + 2.0 * RADIUS**2 * mesh
    roots = np.roots([RIM * inertia, -(first * inertia + spring * RIM), first * spring - spring**2])
    assert pair_system(light, light).natural(mesh)[0] == pytest.approx(np.sqrt(roots.min()), rel=1e-9)


def test_unequal_gears_do_not_mind_their_order() -> None:
    """Pinion and wheel exchanged: the same natural frequency and mass, to 1e-12; a wheel that is a hundred times
    stiffer and heavier leaves the pinion's alone, to 2 %."""
    one, other = gear(2e9), GearShapes(100.0 * gear(2e11).mass, gear(2e11).stiffness * 100.0, np.full(2, 90.0))
    both = pair_system(one, other), pair_system(other, one)
    assert both[0].natural(3e5)[0] == pytest.approx(both[1].natural(3e5)[0], rel=1e-12)
    assert both[0].rigid_mass == pytest.approx(both[1].rigid_mass, rel=1e-12)
    first = 2e9 + RADIUS**2 * 3e5
    alone = np.roots([RIM * HUB, -(first * HUB + 2e9 * RIM), first * 2e9 - 2e9**2])
    assert both[0].natural(3e5)[0] == pytest.approx(np.sqrt(np.min(alone)), rel=0.02)


def test_stiff_bodies_are_rigid() -> None:
    """Springs that give way a millionth of the mesh: one degree of freedom with the mass of rigid bodies, and nothing
    of the mesh's compliance missing, to 1e-6."""
    mesh = 400e3
    body = one_degree(pair(2e6 * RADIUS**2 * mesh), mesh)
    assert body.mass == pytest.approx((HUB + RIM) / (2.0 * RADIUS**2), rel=1e-6)
    assert abs(body.stiffer) < 1e-6 / mesh and abs(body.bore) < 1e-6 / mesh


def test_more_inertia_at_the_bore() -> None:
    """What a gear has beyond its body turns with the hub: the same as a heavier hub, to 1e-12."""
    heavier = gear(2e9).with_inertia(HUB + RIM + 5.0)
    hub = GearShapes(np.array([[HUB + 5.0 + RIM, RIM], [RIM, RIM]]), gear(2e9).stiffness, gear(2e9).closing)
    assert pair_system(heavier, heavier).natural(3e5) == pytest.approx(
        pair_system(hub, hub).natural(3e5), rel=1e-12
    )


def test_a_gear_of_some_width() -> None:
    """Per mm of face, twenty times as wide: natural frequency with twenty times the stiffness, the same to 1e-12, the
    mass twenty times, and a twentieth of the compliance."""
    one, wide = pair(2e9), pair_system(gear(2e9).scaled(20.0), gear(2e9).scaled(20.0))
    assert wide.natural(20.0 * 3e5) == pytest.approx(one.natural(3e5), rel=1e-12)
    assert wide.rigid_mass == pytest.approx(20.0 * one.rigid_mass, rel=1e-12)
    g = wide.closing
    assert wide.compliance(g, g) == pytest.approx(one.compliance(one.closing, one.closing) / 20.0, rel=1e-12)


def test_one_degree_has_the_natural_frequency_of_all() -> None:
    """On a mesh whose compliance between held bores is C: √(1/(C − δ)/m) is the natural frequency of the whole system
    on what C has beyond its bodies, to 1e-12."""
    spring, mesh = 6e9, 300e3
    system = pair(spring)
    body = one_degree(system, mesh)
    local = 1.0 / (1.0 / mesh - 2.0 * RADIUS**2 / spring)
    natural = np.sqrt(1.0 / (1.0 / mesh - body.stiffer) / body.mass)
    assert natural == pytest.approx(system.natural(local)[0], rel=1e-12)


def test_bodies_softer_than_the_mesh_are_refused() -> None:
    """Springs that give way more than the whole mesh between held bores: no mesh is left."""
    with pytest.raises(ValueError, match="wanted less than that of the mesh"):
        one_degree(pair(1e9), 2e9 / (2.0 * RADIUS**2))
