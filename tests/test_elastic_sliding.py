"""The elastic part of the sliding on gear flanks, against pairs of material points followed between two solutions."""

from __future__ import annotations

import numpy as np
import pytest
from gear_cases import helical_scene, model_of, spur_scene
from mpi4py import MPI

from meshes.data import Floats
from solver.gear_contact import GearContact
from solver.gear_model import GearModel
from solver.gear_position import PositionResult, SharedPosition, shared_position
from solver.gear_sweep import uniform_pitch
from solver.kinematics import Stand, line_of_action
from solver.scene import Scene
from wear.gears import GearWear
from wear.law import Archard

TURN = 1e-3  # rad: the ripple of rolling over elements, as long as this, is not meant
RELIEF = tuple(f"{gear}.tip_relief_{key}" for gear in ("pinion", "wheel") for key in ("um=30", "form=parabolic"))


def spur(wheel_modulus: int) -> tuple[Scene, int]:
    """He's pair with tip relief, wheel_modulus [GPa]; positions a pitch."""
    return spur_scene("mesh.level=standard", *RELIEF, f"material.wheel.E_GPa={wheel_modulus}", "load.torque_Nm=60"), 60


SCENES = {
    "steel": lambda: spur(206),
    "plastic": lambda: spur(3),
    "helical": lambda: (helical_scene("contact.friction=0", "mesh.elements_per_contact_width=1"), 16),
}


def wearing(scene: Scene, positions: int) -> GearWear:
    """Without friction, both flanks wear alike."""
    model = model_of(scene)
    return GearWear(model, uniform_pitch(model.pair.pinion.z, positions, 0), 0.0, Archard(1e-10, 1e-10), MPI.COMM_SELF)


def stand_of(model: GearModel, found: SharedPosition) -> Stand:
    """Where the gears stand in the solution."""
    return found.contact.stand.turned(model.load.on, float(found.smooth.motion[0]))


def apart(model: GearModel, here: GearContact, found: SharedPosition) -> Floats:
    """(q, d) from the wheel's to the pinion's material points that the contact `here` pairs, in another solution."""
    stand, d, places = stand_of(model, found), here.d, []
    for gear, body in enumerate(model.bodies):
        rows, teeth = here.rows(gear)
        then = found.contact.rows(gear)[0]
        u = body.chain.apply(then, found.contact.pushed(gear, found.smooth.force), rows) @ stand.rotation(gear, d).T
        own = []
        for each, part in zip(here.teeth, teeth):
            pairing, field = each.pairing, np.zeros((len(body.flank.points), d))
            field[each.touched(gear)] = u[part]
            facets, xi = (pairing.facet1, pairing.xi1) if gear == 0 else (pairing.facet2, pairing.xi2)
            X = body.flank.positions(facets, xi[:, None])[:, 0] @ stand.rotation(gear, d, each.tooth).T
            own.append(stand.centre(gear, d) + X + body.flank.hat_matrix(facets, xi) @ field)
        places.append(np.concatenate(own))
    return np.asarray(places[0] - places[1])


@pytest.mark.parametrize(("kind", "tolerance"), [("steel", 0.02), ("plastic", 0.06), ("helical", 0.08)])
def test_material_points_followed(kind: str, tolerance: float) -> None:
    """A steel pinion on a wheel of steel or of plastic, and a helical pair, without friction. Two states TURN before
    and after a position say how its pairs of material points slide over one another. At each tooth the pressure's mean
    of that is what wear takes: less the nominal (1 + 1/u) ξ within 2 % of its largest with steel (0.06 mm/rad, where
    the load passes from tooth to tooth; the pinion's flank rolls by 26 mm/rad at the pitch point), 6 % with plastic
    (0.6 mm/rad), 8 % for the helical pair (0.09), whose mesh and position steps are coarse."""
    scene, positions = SCENES[kind]()
    gears = wearing(scene, positions)
    state, model = gears.evaluate(gears.begin), gears.model
    found, wanted = [], []
    for k in range(0, positions, positions // 6):
        here, contact = state.shared[k].contact, state.positions[k].contact
        angles = [gears.pitch.angles[k] + turn for turn in (-TURN, TURN)]
        sides = [shared_position(model, angle, here.stand.extra, [0.0], None) for angle in angles]
        moved = (apart(model, here, sides[1]) - apart(model, here, sides[0])) / (2.0 * TURN)
        pressed = state.shared[k].smooth.traction[:, 0] > 0.0
        nominal = (1.0 + 1.0 / model.pair.ratio) * contact.ξ
        sliding = moved[pressed] @ line_of_action(model.pair, here.d)[1]
        for tooth in np.unique(contact.tooth[~contact.edge]):
            own = (contact.tooth == tooth) & ~contact.edge
            share = (contact.weights * contact.pressure)[own]
            share /= share.sum()
            found.append(float(share @ (contact.sliding - nominal)[own]))
            wanted.append(float(share @ (sliding - nominal)[own]))
    np.testing.assert_allclose(found, wanted, atol=tolerance * np.abs(wanted).max())


def test_worn_flanks_meet_elsewhere() -> None:
    """Flanks worn by 20 and 10 µm everywhere are parallel curves, involutes of the same base circles: the free gear
    turns after, and the contact moves along the line of action by what the other gear has lost, h. So the sliding
    changes by (1 + 1/u) h, towards the gear that is held, within 2 % in the pressure's mean."""
    gears = wearing(spur_scene("mesh.level=quick", *RELIEF, "load.torque_Nm=60"), 6)
    pinion, wheel = gears.by_gear(gears.begin)
    fresh = gears.evaluate(gears.begin)
    worn = gears.evaluate(np.concatenate([np.full_like(pinion, 0.02), np.full_like(wheel, 0.01)]), fresh)
    further = (1.0 + 1.0 / gears.model.pair.ratio) * (0.01, -0.02)[gears.model.load.on]
    for old, new in zip(fresh.positions, worn.positions):
        assert mean_sliding(new) - mean_sliding(old) == pytest.approx(further, rel=0.02)


def mean_sliding(position: PositionResult) -> float:
    """Weighed by the pressure, beyond the nominal one."""
    c, growth = position.contact, 1.0 + 1.0 / position.stand.pair.ratio
    return float(np.average(c.sliding - growth * c.ξ, weights=c.weights * c.pressure))
