"""The elastic part of the sliding on gear flanks, against pairs of material points followed between two solutions."""

from __future__ import annotations

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation, line_of_action
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent.scene.scene import Scene
from evolvent.wear.archard import Archard
from evolvent.wear.gears.elastic_sliding import Deflection, Grids, PitchDeflection
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent.wear.gears.gear_wear import GearWear
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import helical_scene, model_of, spur_scene, with_load

TURN = 1e-3  # rad: the ripple of rolling over elements, as long as this, is not meant
RELIEF = tuple(f"{gear}.tip_relief_{key}" for gear in ("pinion", "wheel") for key in ("um=30", "form=parabolic"))


def spur(wheel_modulus: int) -> tuple[Scene, int]:
    """He's pair with tip relief, wheel_modulus [GPa]; positions a pitch."""
    return spur_scene("mesh.level=standard", *RELIEF, f"material.wheel.E_GPa={wheel_modulus}", "load.torque_Nm=60"), 60


SCENES = {
    "steel": lambda: spur(206),
    "plastic": lambda: spur(3),
    "helical": lambda: (helical_scene("contact.friction=0", "mesh.order=2", "mesh.elements_per_contact_width=1.1"), 16),
}


def wearing(model: GearModel, positions: int) -> GearWear:
    """Without friction, both flanks wear alike."""
    return GearWear(model, uniform_pitch(model.pair.pinion.z, positions), 0.0, Archard(1e-10, 1e-10), MPI.COMM_SELF)


def stand_of(model: GearModel, found: SharedPosition) -> PairRotation:
    """Where the gears stand in the solution."""
    return found.contact.stand.turned(model.load.on, float(found.smooth.motion[0]))


def apart(model: GearModel, here: ContactGeometry, found: SharedPosition) -> Floats:
    """(q, d) from the wheel's to the pinion's material points that the contact `here` pairs, in another solution."""
    stand, d, places = stand_of(model, found), here.d, []
    then, force = found.contact.geometry, found.smooth.force
    for gear, body in zip(Member, model.bodies):
        rows, teeth = here.rows(gear)
        u = body.chain.apply(then.rows(gear)[0], then.flank_forces(gear, force), rows) @ stand.rotation(gear, d).T
        own = []
        for each, part in zip(here.teeth, teeth):
            pairing, field = each.pairing, np.zeros((len(body.flank.points), d))
            field[each.coupled_nodes(gear)] = u[part]
            facets, xi = (pairing.facet1, pairing.xi1) if gear == 0 else (pairing.facet2, pairing.xi2)
            X = body.flank.positions(facets, xi[:, None])[:, 0] @ stand.rotation(gear, d, each.tooth).T
            own.append(stand.centre(gear, d) + X + body.flank.hat_matrix(facets, xi) @ field)
        places.append(np.concatenate(own))
    return np.asarray(places[0] - places[1])


@pytest.mark.parametrize(
    ("kind", "tolerance"),
    [("steel", 0.02), ("plastic", 0.06), pytest.param("helical", 0.08, marks=pytest.mark.evidence)],
)
def test_elastic_sliding_of_followed_material_points(kind: str, tolerance: float) -> None:
    """A steel pinion on a wheel of steel or of plastic, and a helical pair, without friction. Two states TURN before
    and after a position say how its pairs of material points slide over one another. At each tooth the pressure's mean
    of that is what wear takes: less the nominal (1 + 1/u) ξ within 2 % of its largest with steel (0.06 mm/rad, where
    the load passes from tooth to tooth; the pinion's flank rolls by 26 mm/rad at the pitch point), 6 % with plastic
    (0.6 mm/rad), 8 % for the helical pair (0.09), whose mesh and position steps are coarse."""
    scene, positions = SCENES[kind]()
    model = model_of(scene)
    gears = wearing(model, positions)
    state = gears.evaluate(gears.begin)
    found, wanted = [], []
    for k in range(0, positions, positions // (3 if kind == "helical" else 6)):
        here, contact = state.shared[k].contact.geometry, state.positions[k].contact
        angles = [gears.pitch.angles[k] + turn for turn in (-TURN, TURN)]
        sides = [shared_position(model, angle, here.stand.beyond_nominal, [0.0], None) for angle in angles]
        moved = (apart(model, here, sides[1]) - apart(model, here, sides[0])) / (2.0 * TURN)
        pressed = state.shared[k].smooth.traction[:, 0] > 0.0
        nominal = (1.0 + 1.0 / model.pair.ratio) * contact.roll_distance
        sliding = moved[pressed] @ line_of_action(model.pair, here.d)[1]
        for tooth in np.unique(contact.tooth[~contact.edge]):
            own = (contact.tooth == tooth) & ~contact.edge
            share = (contact.weights * contact.pressure)[own]
            share /= share.sum()
            found.append(float(share @ (contact.sliding - nominal)[own]))
            wanted.append(float(share @ (sliding - nominal)[own]))
    np.testing.assert_allclose(found, wanted, atol=tolerance * np.abs(wanted).max())


@pytest.mark.parametrize("on", Member)
def test_sliding_changes_as_worn_flanks_shift_the_contact(on: Member) -> None:
    """Flanks worn by 20 and 10 µm everywhere are parallel curves, involutes of the same base circles: the free gear
    turns after, and the contact moves along the line of action by what the other gear has lost, h. So the sliding
    changes by (1 + 1/u) h, towards the gear that is held, within 2 % in the mean of pressure and pitch."""
    model = model_of(spur_scene("mesh.level=quick", *RELIEF))
    gears = wearing(with_load(model, 3e3, on), 6)
    pinion, wheel = gears.by_gear(gears.begin)
    fresh = gears.evaluate(gears.begin)
    worn = gears.evaluate(np.concatenate([np.full_like(pinion, 0.02), np.full_like(wheel, 0.01)]), fresh)
    further = (1.0 + 1.0 / gears.model.pair.ratio) * (0.01, -0.02)[on]
    changes = [mean_sliding(new) - mean_sliding(old) for old, new in zip(fresh.positions, worn.positions)]
    assert np.mean(changes) == pytest.approx(further, rel=0.02)
    np.testing.assert_allclose(changes, further, rtol=0.05)


def mean_sliding(position: PositionResult) -> float:
    """Weighed by the pressure, beyond the nominal one."""
    c, growth = position.contact, 1.0 + 1.0 / position.stand.pair.ratio
    return float(np.average(c.sliding - growth * c.roll_distance, weights=c.weights * c.pressure))


def given(pair: GearPair, gear: Member, arc: Floats, z: Floats, φ: Floats) -> tuple[Floats, Floats]:
    """A made-up deflection u (q, 3) [mm] of tooth 0's flank at pinion rotations φ, and ∂u/∂φ of a material point."""
    waves = np.array([0.3 + 0.1 * gear, 0.2, 0.1])
    phase = arc[:, None] * waves + 0.05 * z[:, None] + 7.0 * φ[:, None] * np.array([1.0, -1.0, 2.0])
    return 1e-2 * np.sin(phase), 7e-2 * np.array([1.0, -1.0, 2.0]) * np.cos(phase)


def extra(pair: GearPair, φ: Floats) -> tuple[Floats, Floats]:
    """Made-up rotations ε beyond the nominal ones (2, q), the same in each pitch, and their derivatives."""
    wave = pair.pinion.z * np.stack([φ, φ + 0.01])
    return 1e-3 * np.sin(wave), 1e-3 * pair.pinion.z * np.cos(wave)


def made_up(pair: GearPair, grids: Grids, count: int) -> PitchDeflection:
    """A pitch of these, three teeth at each position, both flanks worn."""
    step = 2.0 * np.pi / pair.pinion.z / count
    stands, known, teeth = [], {}, np.array([-1, 0, 1])
    for k in range(count):
        ε = extra(pair, np.array([k * step]))[0][:, 0]
        stands.append(PairRotation(pair, k * step, (float(ε[0]), float(ε[1]))))
        fields, axes, seen = [], [], []
        for gear, grid in zip(Member, grids):
            z, arc = (a.ravel() for a in np.meshgrid(grid.heights, grid.arcs, indexing="ij"))
            angles = [np.full(len(z), k * step + 2.0 * np.pi * tooth / pair.pinion.z) for tooth in teeth]
            fields.append(np.stack([given(pair, gear, arc, z, φ)[0] for φ in angles]))
            axes.append(np.stack([line_of_action(pair, 3) @ stands[-1].rotation(gear, 3, tooth) for tooth in teeth]))
            seen.append(np.ones((3, len(grid.heights)), dtype=bool))
        known[k] = Deflection(teeth, (fields[0], fields[1]), (seen[0], seen[1]), (axes[0], axes[1]))
    worn = np.full(grids[0].node.size, 0.02), np.full(grids[1].node.size, 0.01)
    return PitchDeflection(grids, step, tuple(stands), known, worn)


@pytest.mark.parametrize("k", [0, 17, 79])
def test_elastic_sliding_of_given_deflections(k: int) -> None:
    """Points of a helical pair, u = 1.2, whose teeth deflect by given smooth functions of place and time: what is added
    is d/dφ of t·(x_1 − x_2), x = c + R(φ, ε)(X + u(X, φ)), less that of rigid gears, from 80 positions within 0.3 %;
    also at the first and the last position, whose neighbours are a tooth further."""
    pair = helical_scene().gear_pair()
    grids = tuple(
        FlankGrid.regular(np.linspace(0.5, 12.0, 400), np.linspace(-4.0, 4.0, 33), gear.base_helix_angle)
        for gear in pair.gears
    )
    pitch, count = made_up(pair, (grids[0], grids[1]), 80), 12
    z, s = np.linspace(-3.0, 3.0, count), np.linspace(-0.2, 0.2, count)
    stand, number = pitch.stands[k], 0 if k < 40 else -1
    tooth, ξ, none = np.full(count, number), stand.roll_distance(number, z), np.zeros(count)
    shut = none > 0.0
    points = ContactPoints(tooth, z, ξ, s, -s, none, none[:, None], none[:, None], none, shut, shut)
    φ, n, t = np.full(count, stand.angle + 2.0 * np.pi * number / pair.pinion.z), *line_of_action(pair, 3)
    ε_rate, wanted = extra(pair, φ)[1], none.copy()
    for gear, share, ρ in zip(Member, (1.0, 1.0 / pair.ratio), pair.curvature_radii(ξ)):
        u, u_rate = given(pair, gear, line_arc(pair, gear, ξ) + gear.sign * s, z, φ)
        R = stand.rotation(gear, 3, number)
        lost = gear.sign * (0.02, 0.01)[gear] * np.cos(pair.pinion.base_helix_angle)
        wanted += share * (u @ R.T @ n - lost) + ρ * ε_rate[gear] + gear.sign * (u_rate @ R.T @ t)
    found = pitch.elastic_sliding([k], [points])[0]
    np.testing.assert_allclose(found, wanted, atol=3e-3 * np.abs(wanted).max())
